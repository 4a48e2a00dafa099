/// Ropes, seams and anchors that break: loads and strengths against closed forms.
#include <doctest/doctest.h>
#include <weft/weft.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/model/change.h"
#include "tests/support/clothes.h"

namespace weft::test::engine_step_tearing_connections {
namespace {

constexpr double kRates[] = {30, 60, 240};  // Hz
constexpr double kUnbreakable = std::numeric_limits<double>::infinity();
constexpr int kSubsteps[] = {8, 16, kAutomaticSubsteps};

/// A rope of `links` from the origin down, of 20 g each, with a weight at its end.
SceneDescription hanging_rope(std::uint32_t links, double weight, double compliance,
                              double strength) {
  SceneDescription scene;
  for (std::uint32_t i = 0; i <= links; ++i) {
    scene.positions.push_back({0, -0.1 * i, 0});
    scene.masses.push_back(i == links ? weight : 0.02);
    if (i > 0)
      scene.constraints.push_back({.a = i - 1,
                                   .b = i,
                                   .rest_length = 0.1,
                                   .kind = ConstraintKind::rope,
                                   .compliance = compliance,
                                   .strength = strength});
  }
  scene.fixed = {0};
  scene.damping.motion = 3;
  return scene;
}

/// N: the end of the rope is pulled down by a force that grows by `rate` N/s, until something
/// breaks.
double force_at_break(Cloth& cloth, std::vector<std::uint32_t> ends, double from, double rate,
                      double dt, double most, Vec3 towards = {0, -1, 0}) {
  std::vector<Vec3> forces(cloth.particle_count());
  const double share = 1.0 / static_cast<double>(ends.size());
  for (double force = from; force < most; force += rate * dt) {
    for (const std::uint32_t end : ends)
      forces[end] = {share * force * towards.x, share * force * towards.y,
                     share * force * towards.z};
    REQUIRE(cloth.write_forces(forces));
    if (step(cloth, dt).torn > 0) return force;
  }
  return most;
}

TEST_CASE("a rope parts where it carries its strength, at any rate and length of substeps") {
  for (const Backend backend : {Backend::simd, Backend::reference}) {
    for (const double compliance : {0.0, 1e-4}) {
      for (const double rate : kRates) {
        for (const int substeps : kSubsteps) {
          CAPTURE(compliance);
          CAPTURE(rate);
          CAPTURE(substeps);
          Cloth cloth = cloth_of(hanging_rope(6, 0.2, compliance, 10),
                                 {.tolerance = 1e-3, .substeps = substeps, .backend = backend});
          // The weights of all but the first particle hang on the first link.
          const double weight = 10 * (0.2 + 5 * 0.02);
          for (int i = 0; i < rate; ++i) REQUIRE(step(cloth, 1 / rate).torn == 0);
          const double force = force_at_break(cloth, {6}, 0, 2, 1 / rate, 12);
          CHECK(force + weight == doctest::Approx(10).epsilon(0.01));
          REQUIRE(cloth.torn().size() == 1);
          CHECK(cloth.torn()[0].kind == Tear::constraint);
          CHECK(cloth.torn()[0].index == 0);
          CHECK(cloth.torn()[0].load == doctest::Approx(10).epsilon(0.01));
        }
      }
    }
  }
}

/// Two threads on each other, joined by seams, each pinned at its first particle.
SceneDescription zip(std::uint32_t stitches, double strength) {
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  for (std::uint32_t i = 0; i < stitches; ++i) {
    for (std::uint32_t k = 0; k < 2; ++k) {
      scene.positions.push_back({0.05 * i, 0, 0});
      scene.masses.push_back(0.01);
      if (i > 0)
        scene.constraints.push_back({.a = 2 * i - 2 + k, .b = 2 * i + k, .rest_length = 0.05});
    }
    scene.seams.push_back({.a = 2 * i, .b = 2 * i + 1, .strength = strength});
  }
  scene.fixed = {0, 1};
  scene.damping.motion = 1;
  return scene;
}

TEST_CASE("a seam opens from its end, stitch by stitch") {
  for (const double rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(zip(12, 3), {});
    std::vector<std::uint32_t> order;
    const double speed = 0.5;
    for (int i = 1; i <= 2 * rate; ++i) {
      const double y = speed * i / rate;
      REQUIRE(cloth.move_fixed(0, {0, y, 0}));
      REQUIRE(cloth.move_fixed(1, {0, -y, 0}));
      const StepReport report = step(cloth, 1 / rate);
      CHECK(report.torn == static_cast<int>(cloth.torn().size()));
      for (const Torn& torn : cloth.torn()) {
        CHECK(torn.kind == Tear::seam);
        CHECK(torn.load > 3);
        order.push_back(torn.index);
      }
    }
    CHECK(order.size() >= 6);
    CHECK(std::ranges::is_sorted(order));
    CHECK(step(cloth, 1 / rate).open_seams == 0);
  }
}

/// A particle that hangs on an anchor, with a rope of three links at it.
SceneDescription on_anchor(double strength, double reach, double compliance) {
  SceneDescription scene = hanging_rope(3, 0.2, compliance, kUnbreakable);
  scene.fixed.clear();
  scene.anchors = {
      {.particle = 0, .point = {0, reach, 0}, .max_distance = reach, .strength = strength}};
  return scene;
}

TEST_CASE("an anchor lets go of what pulls more than its strength") {
  for (const double reach : {0.0, 0.05}) {
    for (const double compliance : {0.0, 1e-4}) {
      for (const double rate : kRates) {
        CAPTURE(reach);
        CAPTURE(compliance);
        CAPTURE(rate);
        const SceneDescription scene = on_anchor(10, reach, compliance);
        Cloth cloth = cloth_of(scene, {.tolerance = 1e-3});
        for (int i = 0; i < 2 * rate; ++i) REQUIRE(step(cloth, 1 / rate).torn == 0);
        const double weight = 10 * (0.2 + 3 * 0.02);
        const double force = force_at_break(cloth, {3}, 0, 2, 1 / rate, 12);
        CHECK(force + weight == doctest::Approx(10).epsilon(0.01));
        REQUIRE(cloth.torn().size() == 1);
        CHECK(cloth.torn()[0].kind == Tear::anchor);
        for (int i = 0; i < rate; ++i) CHECK(step(cloth, 1 / rate).torn == 0);
        CHECK(cloth.position(0).y < -2);  // it falls
        REQUIRE(cloth.limit_anchor(0, {.max_distance = reach}));
      }
    }
  }
}

TEST_CASE("a rope that has parted gets another length, and stays parted") {
  const SceneDescription scene = hanging_rope(6, 0.2, 0, 3);
  Cloth cloth = cloth_of(scene, {});
  REQUIRE(force_at_break(cloth, {6}, 0, 60, 1.0 / 60, 20) < 20);
  REQUIRE(cloth.set_rest_shape(scene, 1.5));
  const SceneDescription now = description_of(*cloth.model());
  CHECK(now.constraints[0].rest_length == 1.5 * 0.1);
  CHECK(std::ranges::count(now.constraints, 0.0, &Constraint::strength) > 0);
}

}  // namespace
}  // namespace weft::test::engine_step_tearing_connections
