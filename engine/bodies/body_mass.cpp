#include "engine/bodies/body_mass.h"

#include <weft/shape_fields.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/bodies/body_shape.h"
#include "engine/public_vectors.h"
#include "engine/validation.h"

namespace weft {
namespace {

using kernels::Vector;

BodyMass mass_from(const BodyMoments& m, double density) {
  BodyMass mass{.mass = density * m.volume, .centre = to_public((1 / m.volume) * m.first)};
  const Vector c = to_internal(mass.centre);
  const double about[] = {c.x * c.x, c.y * c.y, c.z * c.z, c.y * c.z, c.z * c.x, c.x * c.y};
  std::array<double, 6> s{};
  for (std::size_t i = 0; i < 6; ++i) s[i] = density * (m.second[i] - m.volume * about[i]);
  mass.inertia = {s[1] + s[2], s[2] + s[0], s[0] + s[1], -s[3], -s[4], -s[5]};
  return mass;
}

/// All of its principal minors are.
bool is_positive(const SymmetricTensor& m) {
  const auto& [xx, yy, zz, yz, zx, xy] = m.of;
  const double determinant =
      xx * (yy * zz - yz * yz) + xy * (yz * zx - xy * zz) + zx * (xy * yz - yy * zx);
  return xx > 0 && xx * yy - xy * xy > 0 && determinant > 0;
}

}  // namespace

std::string shapes_with_mass() {
  std::vector<std::string> texts;
  for_each_shape([&]<class Shape> {
    if (kShapeKind<Shape>.has_mass) texts.emplace_back(kShapeKind<Shape>.text);
  });
  std::string all;
  for (std::size_t i = 0; i < texts.size(); ++i)
    all += (i == 0 ? "" : i + 1 < texts.size() ? ", " : " or ") + texts[i];
  return all;
}

SymmetricTensor inverse(const SymmetricTensor& m) {
  const auto& [xx, yy, zz, yz, zx, xy] = m.of;
  const double a = yy * zz - yz * yz, b = yz * zx - xy * zz, c = xy * yz - yy * zx;
  const double over = 1 / (xx * a + xy * b + zx * c);
  return {{over * a, over * (xx * zz - zx * zx), over * (xx * yy - xy * xy),
           over * (xy * zx - xx * yz), over * c, over * b}};
}

Result<void> validate(const BodyMass& mass) {
  if (auto r = validate_positive("mass.mass", mass.mass); !r) return r;
  if (!finite(mass.centre)) return refuse("mass.centre", "must be finite", text(mass.centre));
  const auto& i = mass.inertia;
  for (std::size_t k = 0; k < 6; ++k) {
    if (!std::isfinite(i[k]))
      return refuse(element("mass.inertia", k), "must be finite", number(i[k]));
  }
  // The sums of m x x and so on, of which the inertia is made, are those of a body.
  const double half = (i[0] + i[1] + i[2]) / 2, slack = 1e-9 * half;
  const SymmetricTensor sums{
      {half - i[0] + slack, half - i[1] + slack, half - i[2] + slack, -i[3], -i[4], -i[5]}};
  if (is_positive({i}) && is_positive(sums)) return {};
  return refuse("mass.inertia", "is that of no body",
                number(i[0]) + ", " + number(i[1]) + ", " + number(i[2]) + ", " + number(i[3]) +
                    ", " + number(i[4]) + ", " + number(i[5]));
}

Result<BodyMass> mass_of(const BodyShape& shape, double density) {
  if (auto r = validate_positive("density", density); !r) return Error{r.error()};
  if (!shape.moments())
    return refuse("shape", "has a mass as " + shapes_with_mass() + " alone",
                  kind_of(shape.description()).text);
  const BodyMass mass = mass_from(*shape.moments(), density);
  if (auto r = validate(mass); !r) return Error{r.error()};
  return mass;
}

}  // namespace weft
