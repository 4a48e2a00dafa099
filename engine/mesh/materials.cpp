#include <weft/mesh.h>

#include <string>

#include "engine/validation.h"

namespace weft {
namespace {

// Springs are linear and cloth is not: stiffnesses are those of small strains, where folds form.
// 1 gf/(cm degree) of shear is 56.2 N/m per radian, 1 gf cm^2/cm of bending 98.1e-6 N m. Damping
// is chosen so that creases settle within a few swings. A plate across the stream has a drag of
// about 1.2, and where only pressure acts, along the normal, the same of lift.
constexpr double kPlate = 1.2;

Material material(double density, double thickness, double warp, double weft, double shear,
                  double bending) {
  return {.density = density,
          .thickness = thickness,
          .warp = warp,
          .weft = weft,
          .shear = shear,
          .bending = bending,
          .damping_stretch = 1e-4,
          .damping_bending = 1e-2,
          .damping_motion = 0,
          .drag = kPlate,
          .lift = kPlate};
}

constexpr std::string_view kKawabata =
    "rounded from the ranges of Kawabata, The Standardization and Analysis of Hand Evaluation, "
    "1980";

const NamedMaterial kMaterials[] = {
    {"cotton", material(0.13, 0.4e-3, 4000, 3000, 60, 7e-6), kKawabata},
    {"denim", material(0.324, 0.9e-3, 2028, 2028, 86, 64e-6),
     "11 oz black denim of Wang, O'Brien and Ramamoorthi, Data-Driven Elastic Models for Cloth, "
     "2011, at small strains; shear and thickness of denims by the Kawabata system"},
    {"linen", material(0.19, 0.5e-3, 6000, 5000, 50, 15e-6), kKawabata},
    {"polyester", material(0.128, 0.3e-3, 4055, 4055, 40, 52e-6),
     "white dots on black of Wang, O'Brien and Ramamoorthi, Data-Driven Elastic Models for Cloth, "
     "2011, at small strains; shear and thickness by the ranges of Kawabata, 1980"},
    {"silk", material(0.07, 0.2e-3, 3000, 2000, 15, 3e-6), kKawabata},
    {"wool", material(0.25, 0.8e-3, 2500, 1500, 40, 12e-6), kKawabata},
};

}  // namespace

Result<void> check_material(const Material& m) {
  const std::pair<std::string_view, double> above_zero[] = {
      {"material.density", m.density}, {"material.warp", m.warp}, {"material.weft", m.weft}};
  for (const auto& [field, value] : above_zero) {
    if (auto r = validate_positive(field, value); !r) return r;
    if (auto r = validate_square(field, value); !r) return r;
  }
  const std::pair<std::string_view, double> from_zero[] = {
      {"material.thickness", m.thickness},
      {"material.friction", m.friction},
      {"material.shear", m.shear},
      {"material.bending", m.bending},
      {"material.damping_stretch", m.damping_stretch},
      {"material.damping_bending", m.damping_bending},
      {"material.damping_motion", m.damping_motion},
      {"material.drag", m.drag},
      {"material.lift", m.lift},
      {"material.ram", m.ram},
      {"material.bending_hardening", m.bending_hardening},
      {"material.bending_friction", m.bending_friction}};
  for (const auto& [field, value] : from_zero) {
    if (auto r = validate_not_negative(field, value); !r) return r;
  }
  for (const auto& [field, value] : {std::pair{"material.strength", m.strength},
                                     std::pair{"material.bending_yield", m.bending_yield}}) {
    if (!(value > 0)) return refuse(field, "must be greater than 0, or infinite", number(value));
  }
  if (auto r = validate_positive("material.bending_slip", m.bending_slip); !r) return r;
  return validate_square("material.bending_slip", m.bending_slip);
}

std::span<const NamedMaterial> materials() { return kMaterials; }

Result<Material> find_material(std::string_view name) {
  std::string names;
  for (const NamedMaterial& named : kMaterials) {
    if (named.name == name) return named.material;
    names += (names.empty() ? "" : ", ") + std::string(named.name);
  }
  return Error{"material: there is no '" + in_one_line(std::string(name)) + "', there are " +
               names};
}

}  // namespace weft
