#include "tools/studies/forms/elastica.h"

#include <cmath>
#include <numbers>

namespace weft::tools::forms {
namespace {

/// Where a function that rises is 0.
template <class Function>
double root(double low, double high, Function&& rising) {
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (rising(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

struct Shape {
  double theta, rate, x, y;  // x, y: from the tip
};

Shape operator+(Shape a, Shape b) {
  return {a.theta + b.theta, a.rate + b.rate, a.x + b.x, a.y + b.y};
}
Shape operator*(double k, Shape a) { return {k * a.theta, k * a.rate, k * a.x, k * a.y}; }

/// What pulls a strip down: its own weight, or a force at its end.
enum class Load { weight, end };

/// By what the shape changes with the distance from the tip, r = 1 - s.
Shape slope(Load kind, double load, double r, Shape f) {
  const double beyond = kind == Load::weight ? load * r : load;
  return {f.rate, -beyond * std::cos(f.theta), -std::cos(f.theta), std::sin(f.theta)};
}

/// At the clamp, for this slope at the tip, or where it becomes level before; by Runge and Kutta's
/// method of fourth order.
Shape from_tip(Load kind, double load, double theta) {
  constexpr int kSteps = 1000;
  constexpr double kStep = 1.0 / kSteps;
  Shape f{theta, 0, 0, 0};
  for (int i = 0; i < kSteps && f.theta >= 0; ++i) {
    const double r = kStep * i;
    const Shape a = slope(kind, load, r, f);
    const Shape b = slope(kind, load, r + kStep / 2, f + (kStep / 2) * a);
    const Shape c = slope(kind, load, r + kStep / 2, f + (kStep / 2) * b);
    const Shape d = slope(kind, load, r + kStep, f + kStep * c);
    f = f + (kStep / 6) * (a + 2 * b + 2 * c + d);
  }
  return f;
}

Tip tip(Load kind, double load) {
  const double theta = root(0, std::numbers::pi / 2,
                            [&](double slope) { return from_tip(kind, load, slope).theta; });
  const Shape clamp = from_tip(kind, load, theta);
  return {-clamp.x, -clamp.y};
}

}  // namespace

Tip heavy_elastica(double load) { return tip(Load::weight, load); }

Tip end_loaded_elastica(double load) { return tip(Load::end, load); }

double buckled_height(double nearer) {
  const double p = root(0, 0.999, [&](double modulus) {
    return 2 - nearer - 2 * std::comp_ellint_2(modulus) / std::comp_ellint_1(modulus);
  });
  return p / std::comp_ellint_1(p);
}

}  // namespace weft::tools::forms
