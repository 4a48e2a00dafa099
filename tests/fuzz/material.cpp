/// The text of a material file.
#include <fmt/format.h>

#include <cmath>

#include "tests/fuzz/checks.h"
#include "tools/program/options/material_options.h"

namespace weft::fuzz {
namespace {

/// Without a sign of 0, which JSON loses: it reads "-0" as an integer.
std::string number(double x) { return fmt::format("{}", x + 0.); }

std::string material_text(const Material& m) {
  return fmt::format(
      R"({{"density": {}, "thickness": {}, "warp": {}, "weft": {}, "shear": {}, "bending": {}, )"
      R"("damping_stretch": {}, "damping_bending": {}, "damping_motion": {}, "drag": {}, "lift": {}, "ram": {}, "friction": {}}})",
      number(m.density), number(m.thickness), number(m.warp), number(m.weft), number(m.shear),
      number(m.bending), number(m.damping_stretch), number(m.damping_bending),
      number(m.damping_motion), number(m.drag), number(m.lift), number(m.ram), number(m.friction));
}

/// Two triangles of it.
void make_cloth(const Material& material) {
  MeshDescription mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {0, 1, 0}};
  mesh.corners = {0, 1, 2, 0, 2, 3};
  mesh.material = material;
  const auto cloth = cloth_from_mesh(mesh);
  if (!cloth) return check_message(cloth.error());
  const auto model = build_model(cloth.value().scene);
  if (!model) check_message(model.error());
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(material)(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  const auto material = tools::parse_material(fuzz::text_of(data, size));
  if (!material) return check_message(material.error()), 0;
  const auto again = tools::parse_material(material_text(material.value()));
  check(static_cast<bool>(again), "a material survives writing and reading again");
  check(material_text(again.value()) == material_text(material.value()), "every number of it does");
  if (const auto checked = check_material(material.value()); !checked)
    return check_message(checked.error()), 0;
  note_accepted();
  make_cloth(material.value());
  return 0;
}
