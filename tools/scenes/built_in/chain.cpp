/// Particles of 1 kg in a level line along x, 0.01 apart; the first is fixed, the last has the mass
/// Options::end_mass. It has no material.
#include <cstdint>
#include <utility>

#include "tools/scenes/built_in.h"

namespace weft::scenes::built_in {
namespace {

Result<Scene> make_chain(const Options& options) {
  constexpr double kSpacing = 0.01;
  if (auto checked = check_mass("end_mass", options.end_mass); !checked)
    return Error{checked.error()};
  if (options.material) return Error{"a line of particles has no material"};
  SceneDescription description;
  for (int i = 0; i < options.size; ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    description.positions.push_back({kSpacing * i, 0, 0});
    description.masses.push_back(1);
    if (i > 0) description.constraints.push_back({number - 1, number, kSpacing});
  }
  description.masses.back() = options.end_mass;
  description.fixed = {0};
  tools::Mesh mesh = tools::line_mesh(description);
  return Scene{std::move(description), std::move(mesh)};
}

}  // namespace

BuiltIn chain() { return {.summary = "a line of particles with a heavy end", .make = make_chain}; }

}  // namespace weft::scenes::built_in
