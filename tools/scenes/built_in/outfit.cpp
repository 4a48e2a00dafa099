/// The tunic of the mannequin, and over it a wide skirt of 0.4 m whose waist goes with the trunk of
/// the body. It has self-contact.
#include <cstdint>
#include <utility>

#include "tools/scenes/built_in.h"
#include "tools/scenes/garments.h"
#include "tools/scenes/wearer.h"

namespace weft::scenes::built_in {
namespace {

/// All of the second, at rest beside the first.
void add_garment(const Layout& garment, Layout& layout) {
  constexpr double kApart = 6;  // m
  const auto first = static_cast<std::uint32_t>(layout.start.size());
  layout.start.insert(layout.start.end(), garment.start.begin(), garment.start.end());
  for (const Vec3 rest : garment.rest) layout.rest.push_back({rest.x + kApart, rest.y, rest.z});
  for (Face face : garment.faces) {
    for (std::uint32_t& corner : face) corner += first;
    layout.faces.push_back(std::move(face));
  }
  for (const auto& [a, b] : garment.seams) layout.seams.push_back({first + a, first + b});
  for (const std::uint32_t pin : garment.pins) layout.pins.push_back(first + pin);
}

Result<Layout> outfit_layout(const Options& options) {
  auto layout = dressed_wearer(options);
  if (!layout) return layout;
  const auto over_it = outer_skirt(options);
  if (!over_it) return Error{over_it.error()};
  add_garment(over_it.value(), layout.value());
  tools::PinMove waist = walk_of_trunk();
  waist.particles = layout.value().pins;
  layout.value().moves.push_back(std::move(waist));
  layout.value().touches_itself = true;
  return layout;
}

}  // namespace

BuiltIn outfit() {
  return {.summary = "a skirt over a tunic, of cotton, on a body that walks",
          .is_fabric = true,
          .smallest_size = 20,
          .make = cloth<outfit_layout>};
}

}  // namespace weft::scenes::built_in
