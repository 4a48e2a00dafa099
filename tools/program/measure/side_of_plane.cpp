#include "tools/program/measure/side_of_plane.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace weft::tools {
namespace {

/// A number as a sum of doubles that do not overlap, the smallest first (Shewchuk, Adaptive
/// Precision Floating-Point Arithmetic, 1997).
class Sum {
 public:
  void add(double x) {
    std::vector<double> parts;
    for (const double part : parts_) {
      const double sum = x + part, rounded = sum - x;
      const double rest = (x - (sum - rounded)) + (part - rounded);
      if (rest != 0) parts.push_back(rest);
      x = sum;
    }
    if (x != 0) parts.push_back(x);
    parts_ = std::move(parts);
  }
  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }
  const std::vector<double>& parts() const { return parts_; }
  int sign() const {
    if (parts_.empty()) return 0;
    return parts_.back() > 0 ? 1 : -1;
  }

 private:
  std::vector<double> parts_;
};

Sum difference(double x, double y) {
  Sum sum;
  sum.add(x);
  sum.add(-y);
  return sum;
}

Sum product(const Sum& x, const Sum& y) {
  Sum sum;
  for (const double a : x.parts()) {
    for (const double b : y.parts()) sum.add_product(a, b);
  }
  return sum;
}

void add(const Sum& x, double sign, Sum& sum) {
  for (const double part : x.parts()) sum.add(sign * part);
}

using Row = std::array<Sum, 3>;

Row row(Vec3 p, Vec3 from) {
  return {difference(p.x, from.x), difference(p.y, from.y), difference(p.z, from.z)};
}

int exact_side(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Row u = row(a, d), v = row(b, d), w = row(c, d);
  Sum volume;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    add(product(u[i], product(v[j], w[k])), 1, volume);
    add(product(u[i], product(v[k], w[j])), -1, volume);
  }
  return volume.sign();
}

}  // namespace

int side_of_plane(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  constexpr double kHalfUlp = std::numeric_limits<double>::epsilon() / 2;
  constexpr double kBound = (7 + 56 * kHalfUlp) * kHalfUlp;  // of the sum of all products' sizes
  const std::array<double, 3> u{a.x - d.x, a.y - d.y, a.z - d.z},
      v{b.x - d.x, b.y - d.y, b.z - d.z}, w{c.x - d.x, c.y - d.y, c.z - d.z};
  double volume = 0, size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    volume += u[i] * (v[j] * w[k] - v[k] * w[j]);
    size += std::abs(u[i]) * (std::abs(v[j] * w[k]) + std::abs(v[k] * w[j]));
  }
  if (std::abs(volume) > kBound * size) return volume > 0 ? 1 : -1;
  return exact_side(a, b, c, d);
}

}  // namespace weft::tools
