/// Cloth that begins crossed is drawn apart (SelfContact::untangle).
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/layers.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_untangling {
namespace {

constexpr double kPi = std::numbers::pi;
/// m/s, at which what crosses is drawn apart.
constexpr double kSpeed = 0.2;

/// Cells along a third of a metre, and a material.
struct Fabric {
  std::uint32_t cells = 0;
  const char* material = "";
};
constexpr std::array<Fabric, 2> kFabrics{{{16, "cotton"}, {25, "denim"}}};

struct Tangle {
  const char* name;
  double time;  // s, in which it has come out
  SceneDescription (*scene)(const Fabric& fabric);
};

SceneDescription drawn(SceneDescription scene) {
  scene.self_contact.untangle = true;
  return scene;
}
SceneDescription without_weight(SceneDescription scene) {
  scene.gravity = {};
  return scene;
}

/// A pocket of half the width on a shirt, both held by their upper rows. One of its lower corners
/// begins behind the shirt, and so does a part of its upper row.
SceneDescription pocket(const Fabric& fabric) {
  const std::uint32_t n = fabric.cells, half = n / 2;
  std::vector<std::uint32_t> pins;
  for (std::uint32_t i = 0; i <= n; ++i) pins.push_back(i);
  for (std::uint32_t i = 0; i <= half; ++i) pins.push_back((n + 1) * (n + 1) + i);
  return scene_of({{n, n,
                    [](double u, double v) {
                      return Vec3{0.33 * v, -0.33 * u, 0};
                    }},
                   {half, half,
                    [](double u, double v) {
                      return Vec3{0.081 + 0.16 * v, -0.101 - 0.16 * u, 0.006 - 0.008 * (u + v)};
                    }}},
                  0.3, pins, fabric.material);
}
/// Two sheets whose line ends at a border of each.
SceneDescription crossed(const Fabric& fabric) {
  const std::uint32_t n = fabric.cells;
  return without_weight(scene_of({{n, n,
                                   [](double u, double v) {
                                     return Vec3{0.33 * u, 0, 0.33 * v};
                                   }},
                                  {n + 1, n,
                                   [](double u, double v) {
                                     return Vec3{0.22 + 0.33 * u, std::sin(1.) * 0.33 * (v - 0.497),
                                                 0.17 + std::cos(1.) * 0.33 * (v - 0.497)};
                                   }}},
                                 0.3, {0}, fabric.material));
}
/// A bump of one sheet through another one; over both is a third.
SceneDescription poked(const Fabric& fabric) {
  const std::uint32_t n = fabric.cells;
  const auto level = [](double height) {
    return [height](double u, double v) { return Vec3{0.33 * u, height, 0.33 * v}; };
  };
  return without_weight(scene_of({{n, n,
                                   [](double u, double v) {
                                     const double x = 0.33 * u, z = 0.33 * v,
                                                  d = std::hypot(x - 0.171, z - 0.159) / 0.06;
                                     return Vec3{x, 0.03 * std::exp(-d * d), z};
                                   }},
                                  {n + 1, n, level(0.0061)},
                                  {n, n + 1, level(0.034)}},
                                 0.3, {0, n}, fabric.material));
}
/// A sleeve, held at one end, whose other end begins through a sheet. Its sides are welded.
SceneDescription sleeve(const Fabric& fabric) {
  const std::uint32_t n = fabric.cells;
  std::vector<std::uint32_t> pins;
  for (std::uint32_t i = 0; i < n; ++i) pins.push_back(i);
  return without_weight(
      scene_of({{n, n,
                 [](double u, double v) {
                   const double turn = v < 1 ? 2 * kPi * v : 0;
                   return Vec3{0.05 * std::cos(turn), 0.05 * std::sin(turn), -0.26 + 0.32 * u};
                 }},
                {n, n + 1,
                 [](double u, double v) {
                   return Vec3{0.33 * (u - 0.5), 0.33 * (v - 0.49), 0.0017};
                 }}},
               0.3, pins, fabric.material));
}

constexpr std::array<Tangle, 4> kTangles{
    {{"a pocket that is held on both sides of a shirt", 1, pocket},
     {"two sheets, from border to border", 3, crossed},
     {"a bump through a sheet", 0.5, poked},
     {"the end of a sleeve in a sheet", 0.6, sleeve}}};

/// Pairs of triangles.
int crossings(const Cloth& cloth, const SceneDescription& scene) {
  const std::vector<Vec3> x = positions(cloth);
  return count_self_crossings({x, scene.surface});
}

/// J, of motion and weight: in the beginning nothing is stretched or bent.
double energy_of(const Cloth& cloth, const SceneDescription& scene) {
  return energy(scene, positions(cloth), velocities(cloth));
}

struct Course {
  double out = -1;  // s, when nothing crosses any longer
  double gain = 0;  // J, of energy beyond the work that is told, at most
  double work = 0;  // J
  int tangled = 0, missed = 0;
};

Course run_for(const SceneDescription& scene, double time, int rate) {
  Cloth cloth = cloth_of(scene, {});
  const double before = energy_of(cloth, scene);
  Course course;
  const int frames = static_cast<int>(std::lround(time * rate));
  for (int frame = 1; frame <= frames; ++frame) {
    const StepReport report = step(cloth, 1.0 / rate);
    course.tangled = report.tangled;
    course.missed += report.status == Status::converged ? 0 : 1;
    course.work += report.untangling_work;
    course.gain = std::max(course.gain, energy_of(cloth, scene) - before - course.work);
    if (course.tangled > 0) course.out = -1;
    if (course.tangled == 0 && course.out < 0) course.out = frame / static_cast<double>(rate);
  }
  CHECK(crossings(cloth, scene) == 0);
  return course;
}

double mass_of(const SceneDescription& scene) {
  double mass = 0;
  for (const double m : scene.masses) mass += m;
  return mass;
}

TEST_CASE("what begins crossed comes out, in one time at any length of frames" *
          doctest::test_suite("long")) {
  for (const Tangle& tangle : kTangles) {
    for (const Fabric& fabric : kFabrics) {
      CAPTURE(std::string(tangle.name));
      CAPTURE(std::string(fabric.material));
      const SceneDescription scene = drawn(tangle.scene(fabric));
      const double fast = 0.5 * mass_of(scene) * kSpeed * kSpeed;
      std::vector<double> times;
      for (const int rate : {30, 60, 240}) {
        CAPTURE(rate);
        const Course course = run_for(scene, tangle.time, rate);
        CHECK(course.tangled == 0);
        CHECK(course.missed == 0);
        CHECK(course.out > 0);
        CHECK(course.work < fast);
        CHECK(course.gain < 0.02 * fast);
        times.push_back(course.out);
      }
      const auto [least, most] = std::ranges::minmax(times);
      CHECK(most < 1.25 * least + 1.0 / 30);
    }
  }
}

/// A pocket of a third of the width that is sewn on along three sides and begins bulged through the
/// shirt.
SceneDescription sewn_pocket(std::uint32_t cells, const char* material) {
  const std::uint32_t n = 3 * cells, first = (n + 1) * (n + 1);
  std::vector<std::uint32_t> pins;
  for (std::uint32_t i = 0; i <= n; ++i) pins.push_back(i);
  SceneDescription scene =
      scene_of({{n, n,
                 [](double u, double v) {
                   return Vec3{0.5 * v, -0.5 * u, 0};
                 }},
                {cells, cells,
                 [](double u, double v) {
                   const double bulge = 0.02 * 4 * v * (1 - v) * std::sin(kPi * u);
                   return Vec3{(1 + v) / 6, -(1 + u) / 6, 5e-4 + 0.004 * (1 - u) - bulge};
                 }}},
               0.3, pins, material);
  const auto sew = [&](std::uint32_t row, std::uint32_t column) {
    scene.seams.push_back({.a = first + row * (cells + 1) + column,
                           .b = (cells + row) * (n + 1) + cells + column,
                           .time = 0.3});
  };
  for (std::uint32_t i = 0; i <= cells; ++i) {
    sew(i, 0);
    sew(i, cells);
    if (i > 0 && i < cells) sew(cells, i);
  }
  return scene;
}

void check_sewn_pocket(const char* material, std::uint32_t cells) {
  for (const int rate : {30, 60, 240}) {
    CAPTURE(rate);
    const SceneDescription scene = drawn(without_weight(sewn_pocket(cells, material)));
    Cloth cloth = cloth_of(scene, {});
    const int began = step(cloth, 1e-3).tangled;
    CHECK(began > 30);
    StepReport report;
    for (int frame = 0; frame < rate; ++frame) report = step(cloth, 1.0 / rate);
    CHECK(report.tangled <= began / 3);
  }
}

TEST_CASE("a pocket of cotton that is sewn on comes out, but for a few cells beside its seam" *
          doctest::test_suite("long")) {
  check_sewn_pocket("cotton", 8);
}
TEST_CASE("a pocket of denim that is sewn on comes out, but for a few cells beside its seam" *
          doctest::test_suite("long")) {
  check_sewn_pocket("denim", 12);
}

TEST_CASE("without it what begins crossed stays so") {
  for (const Tangle& tangle : kTangles) {
    CAPTURE(std::string(tangle.name));
    const SceneDescription scene = tangle.scene(kFabrics[0]);
    Cloth cloth = cloth_of(scene, {});
    StepReport report;
    for (int frame = 0; frame < 60 * tangle.time; ++frame) report = step(cloth, 1.0 / 60);
    CHECK(report.tangled > 0);
    CHECK(report.untangling_work == 0);
  }
}

TEST_CASE("the cloth beside what is drawn apart crosses nothing" * doctest::test_suite("long")) {
  for (const Fabric& fabric : kFabrics) {
    const SceneDescription scene = drawn(poked(fabric));
    const std::uint32_t n = fabric.cells, first = (n + 1) * (n + 1) + (n + 2) * (n + 1);
    std::vector<std::array<std::uint32_t, 3>> others, third;
    for (const auto& triangle : scene.surface)
      (triangle[0] < first ? others : third).push_back(triangle);
    Cloth cloth = cloth_of(scene, {});
    for (int frame = 0; frame < 60; ++frame) {
      step(cloth, 1.0 / 60);
      const std::vector<Vec3> x = positions(cloth);
      CHECK(count_crossings({x, others}, {x, third}) == 0);
    }
  }
}

TEST_CASE("what is drawn apart keeps momentum and angular momentum") {
  SceneDescription scene = drawn(crossed(kFabrics[0]));
  scene.fixed.clear();
  Cloth cloth = cloth_of(scene, {});
  Vec3 momentum{}, turn{};
  double speeds = 0;
  for (int frame = 0; frame < 60; ++frame) {
    step(cloth, 1.0 / 60);
    const std::vector<Vec3> x = positions(cloth), v = velocities(cloth);
    momentum = turn = {};
    speeds = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      momentum = momentum + scene.masses[i] * v[i];
      turn = turn + scene.masses[i] * cross(x[i] - Vec3{0.3, 0, 0.17}, v[i]);
      speeds += scene.masses[i] * length(v[i]);
    }
  }
  CHECK(speeds > 1e-4);
  CHECK(length(momentum) < 1e-4 * speeds);
  CHECK(length(turn) < 0.02 * 0.33 * speeds);
}

TEST_CASE("cloth that does not cross itself has the same bits with it") {
  SceneDescription scene = scene_of(stack(3, 8, 0.01), 0.3, {0, 8});
  Cloth plain = cloth_of(scene, {}), drawing = cloth_of(drawn(scene), {});
  for (int frame = 0; frame < 60; ++frame) {
    step(plain, 1.0 / 60);
    CHECK(step(drawing, 1.0 / 60).untangling_work == 0);
  }
  CHECK(largest_distance(positions(plain), positions(drawing)) == 0);
  CHECK(largest_distance(velocities(plain), velocities(drawing)) == 0);
}

TEST_CASE("a cloth that is drawn apart goes on from its bytes, and on any number of threads") {
  const SceneDescription scene = drawn(poked({32, "cotton"}));
  Settings settings;
  settings.threads = 1;
  Cloth cloth = cloth_of(scene, settings);
  settings.threads = 2;
  Cloth other = cloth_of(scene, settings);
  run(cloth, 1.0 / 60, 3);
  run(other, 1.0 / 60, 3);
  CHECK(cloth.state_hash() == other.state_hash());
  Cloth loaded = cloth_of(scene, settings);
  REQUIRE(loaded.load_state(cloth.save_state()));
  run(cloth, 1.0 / 60, 3);
  run(loaded, 1.0 / 60, 3);
  CHECK(cloth.state_hash() == loaded.state_hash());
}

TEST_CASE("a strip that is held at both ends, through a sheet that is held, stays and is told") {
  for (const int rate : {30, 240}) {
    SceneDescription scene =
        drawn(without_weight(scene_of({{12, 12,
                                        [](double u, double v) {
                                          return Vec3{0.3 * u, 0, 0.3 * v};
                                        }},
                                       {3, 20,
                                        [](double u, double v) {
                                          return Vec3{0.12 + 0.05 * u, 0.3 * v - 0.151, 0.143};
                                        }}},
                                      0.3)));
    const std::uint32_t first = 13 * 13;
    for (const std::uint32_t corner : {0u, 12u, 12 * 13u, 12 * 13u + 12})
      scene.fixed.push_back(corner);
    for (std::uint32_t row = 0; row < 4; ++row) {
      scene.fixed.push_back(first + 21 * row);
      scene.fixed.push_back(first + 21 * row + 20);
    }
    Cloth cloth = cloth_of(scene, {});
    double fastest = 0;
    for (int frame = 0; frame < 2 * rate; ++frame) {
      const StepReport report = step(cloth, 1.0 / rate);
      CHECK(report.tangled > 0);
      for (const Vec3& v : velocities(cloth)) fastest = std::max(fastest, length(v));
    }
    CHECK(fastest < 5 * kSpeed);
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_untangling
