#include "tests/support/bending.h"

#include <set>
#include <vector>

#include "tests/support/vectors.h"

namespace weft::test {
namespace {

/// Of the angle at `at`.
double cotangent(const std::vector<Vec3>& x, std::uint32_t at, std::uint32_t p, std::uint32_t q) {
  const Vec3 a = x[p] - x[at], b = x[q] - x[at];
  return dot(a, b) / length(cross(a, b));
}

SceneDescription strip_of(const Strip& strip, bool clamped) {
  SceneDescription scene;
  const double dx = strip.length / strip.segments, mass = strip.density * dx;
  const std::uint32_t behind = clamped ? 1 : 0, particles = strip.segments + 1 + behind;
  for (std::uint32_t i = 0; i < particles; ++i) {
    scene.positions.push_back({dx * (static_cast<double>(i) - behind), 0, 0});
    scene.masses.push_back(mass);
    if (i > 0) scene.constraints.push_back({i - 1, i, dx});
    if (i > 1) {
      scene.bending.push_back(
          {{i - 2, i - 1, i, kNoIndex}, {1, -2, 1, 0}, 0, dx * dx * dx / strip.stiffness});
    }
  }
  scene.masses.back() = mass / 2;
  if (!clamped) {
    scene.masses.front() = mass / 2;
    return scene;
  }
  scene.fixed = {0, 1};
  scene.bending.front().compliance /= 2;  // half a segment bends there
  return scene;
}

}  // namespace

SceneDescription cantilever(const Strip& strip) { return strip_of(strip, true); }
SceneDescription free_strip(const Strip& strip) { return strip_of(strip, false); }

SceneDescription with_hinges(SceneDescription scene, double stiffness) {
  std::vector<std::set<std::uint32_t>> joined(scene.positions.size());
  for (const Constraint& c : scene.constraints) {
    joined[c.a].insert(c.b);
    joined[c.b].insert(c.a);
  }
  const std::vector<Vec3>& x = scene.positions;
  for (const Constraint& c : scene.constraints) {
    std::vector<std::uint32_t> tips;
    for (const std::uint32_t tip : joined[c.a]) {
      if (joined[c.b].contains(tip)) tips.push_back(tip);
    }
    if (tips.size() != 2) continue;
    BendingElement element{.particles = {c.a, c.b, tips[0], tips[1]}};
    double areas = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double at_a = cotangent(x, c.a, c.b, tips[k]), at_b = cotangent(x, c.b, c.a, tips[k]);
      element.weights[0] += at_b;
      element.weights[1] += at_a;
      element.weights[2 + k] = -at_a - at_b;
      areas += 0.5 * length(cross(x[c.b] - x[c.a], x[tips[k]] - x[c.a]));
    }
    element.compliance = areas / (3 * stiffness);
    scene.bending.push_back(element);
  }
  return scene;
}

SceneDescription with_rows(SceneDescription scene, std::uint32_t n, double stiffness) {
  const double dx = scene.constraints.front().rest_length;
  for (const std::uint32_t step : {1u, n}) {
    for (std::uint32_t i = 0; i + 2 * step < n * n; ++i) {
      if (step == 1 && i % n + 2 >= n) continue;
      scene.bending.push_back(
          {{i, i + step, i + 2 * step, kNoIndex}, {1, -2, 1, 0}, 0, dx * dx / stiffness});
    }
  }
  return scene;
}

}  // namespace weft::test
