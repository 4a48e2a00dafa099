#include "tools/program/measure/fabric_laws.h"

#include <cmath>

#include "engine/geometry.h"

namespace weft::tools {
namespace {

using mesh::dot;

/// Two sides of the triangle at rest, along the warp and along the weft.
struct RestSides {
  double u1, v1, u2, v2;
  double twice_area() const { return u1 * v2 - u2 * v1; }
};
RestSides sides_of(const MembraneElement& element) {
  const auto& at = element.rest;
  return {at[1][0] - at[0][0], at[1][1] - at[0][1], at[2][0] - at[0][0], at[2][1] - at[0][1]};
}

}  // namespace

FabricStrain fabric_strain(const MembraneElement& element, Vec3 a, Vec3 b, Vec3 c) {
  const RestSides rest = sides_of(element);
  const Vec3 first{b.x - a.x, b.y - a.y, b.z - a.z}, second{c.x - a.x, c.y - a.y, c.z - a.z};
  const auto combined = [&](double s, double t) {
    return Vec3{s * first.x + t * second.x, s * first.y + t * second.y, s * first.z + t * second.z};
  };
  const double twice = rest.twice_area();
  const Vec3 warp = combined(rest.v2 / twice, -rest.v1 / twice);
  const Vec3 weft = combined(-rest.u2 / twice, rest.u1 / twice);
  const double along = std::sqrt(dot(warp, warp)), across = std::sqrt(dot(weft, weft));
  return {along - 1, across - 1, dot(warp, weft) / (along * across)};
}

double rest_area(const MembraneElement& element) {
  return std::abs(sides_of(element).twice_area()) / 2;
}

}  // namespace weft::tools
