/// Cloth::carry and teleport: what is taken along moves on as if it had been there before.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_carry {
namespace {

constexpr RigidMotion kMotion{
    .translation = {3, -2, 5}, .rotation = {0.7, -1.1, 0.4}, .about = {1, 2, 0}};

/// By Rodrigues' formula.
Vec3 turned(Vec3 v) {
  const double angle = length(kMotion.rotation);
  const Vec3 axis = (1 / angle) * kMotion.rotation;
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         ((1 - std::cos(angle)) * dot(axis, v)) * axis;
}
Vec3 moved(Vec3 p) { return kMotion.about + turned(p - kMotion.about) + kMotion.translation; }

template <class Map>
std::vector<Vec3> mapped(std::vector<Vec3> vectors, Map map) {
  for (Vec3& v : vectors) v = map(v);
  return vectors;
}

/// Woven, of triangles and of springs with anchors.
SceneDescription springs_with_anchors(int size) {
  SceneDescription scene = scene_of("cape", size);
  for (Constraint& c : scene.constraints) c.compliance = 1e-5;
  for (std::uint32_t i = 0; i < scene.positions.size(); i += 3) {
    if (std::ranges::find(scene.fixed, i) != scene.fixed.end()) continue;
    scene.anchors.push_back({.particle = i,
                             .point = scene.positions[i],
                             .normal = {0.6, 0, 0.8},
                             .max_distance = 0.03,
                             .backstop_distance = 0.005,
                             .backstop_radius = 0.5});
  }
  return scene;
}

/// m, by which a cloth that was carried differs from one that was not, and was turned in the end.
double difference(const SceneDescription& scene, const Settings& settings, int frames_after) {
  Cloth stays = cloth_of(scene, settings), carried = stays.clone();
  std::vector<Vec3> points;
  for (const Anchor& anchor : scene.anchors) points.push_back(anchor.point);
  const auto frame = [&](Cloth& cloth, double t, bool is_carried) {
    const Vec3 by{0.2 * t, 0, 0.1 * t};
    const auto place = [&](Vec3 p) { return is_carried ? moved(p + by) : p + by; };
    for (const std::uint32_t i : scene.fixed)
      REQUIRE(cloth.move_fixed(i, place(scene.positions[i])));
    if (!points.empty()) REQUIRE(cloth.move_anchors(mapped(points, place)));
    step(cloth, 0.01);
  };
  double t = 0;
  for (int k = 0; k < 12; ++k) {
    t += 0.01;
    frame(stays, t, false);
    frame(carried, t, false);
  }
  REQUIRE(stays.state_hash() == carried.state_hash());
  REQUIRE(carried.teleport(kMotion));
  REQUIRE(carried.set_gravity(turned(scene.gravity)));
  CHECK(largest_distance(positions(carried), mapped(positions(stays), moved)) < 1e-12);
  CHECK(largest_distance(velocities(carried), mapped(velocities(stays), turned)) < 1e-12);
  for (int k = 0; k < frames_after; ++k) {
    t += 0.01;
    frame(stays, t, false);
    frame(carried, t, true);
  }
  return largest_distance(positions(carried), mapped(positions(stays), moved));
}

TEST_CASE("what was carried moves on as what was not, turned: small steps of both schemes") {
  for (const Backend backend : kBackends) {
    for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
      for (const SceneDescription& scene :
           {scene_of("hang", 13), scene_of("cape", 13), springs_with_anchors(13)}) {
        Settings settings{.substeps = 10, .solver = Solver::small_steps, .scheme = scheme};
        settings.iterations = 1;  // no local passes, whose choices differ by rounding
        CAPTURE(name(backend));
        CAPTURE(name(scheme));
        const double apart = difference(scene, on(backend, settings), 6);
        CHECK(apart < (backend == Backend::reference ? 1e-9 : 1e-5));
      }
    }
  }
}

TEST_CASE("and by the other solvers, within what their tolerances leave") {
  for (const Solver solver : {Solver::gauss_seidel, Solver::direct, Solver::yarn}) {
    for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
      const Settings settings{.tolerance = 1e-4, .solver = solver, .scheme = scheme};
      CAPTURE(name(solver));
      CAPTURE(name(scheme));
      CHECK(difference(scene_of("hang", 9), settings, 4) < 1e-3);
    }
  }
}

TEST_CASE("moves of pins that were asked for before are carried along") {
  for (const Backend backend : kBackends) {
    const SceneDescription scene = scene_of("hang", 9);
    const Settings settings{.solver = Solver::small_steps};
    Cloth first = cloth_of(scene, on(backend, settings)), second = first.clone();
    const Vec3 by{0.05, 0, 0};
    for (const std::uint32_t i : scene.fixed) REQUIRE(first.move_fixed(i, scene.positions[i] + by));
    REQUIRE(first.teleport(kMotion));
    REQUIRE(second.teleport(kMotion));
    for (const std::uint32_t i : scene.fixed)
      REQUIRE(second.move_fixed(i, moved(scene.positions[i] + by)));
    run(first, 0.01, 3);
    run(second, 0.01, 3);
    CHECK(largest_distance(positions(first), positions(second)) < 1e-9);
  }
}

/// A rope hangs from a pin in a frame that accelerates along x by 4 m/s^2, of which it is to feel
/// the share s; it begins at the angle at which it is at rest then. The largest that the tangent of
/// its angle comes to differ.
double swing(Backend backend, double s) {
  constexpr double kAcceleration = 4;
  const double tangent = s * kAcceleration / 10, over = 1 / std::hypot(1, tangent);
  SceneDescription scene;
  for (std::uint32_t i = 0; i <= 8; ++i) {
    scene.positions.push_back(-0.05 * i * over * Vec3{tangent, 1, 0});
    scene.masses.push_back(0.01);
    if (i > 0) scene.constraints.push_back({i - 1, i, 0.05, ConstraintKind::rope});
  }
  scene.fixed = {0};
  Cloth cloth =
      cloth_of(scene, {.substeps = 40, .solver = Solver::small_steps, .backend = backend});
  double place = 0, most = 0;
  for (int frame = 1; frame <= 100; ++frame) {
    const double before = place, t = 0.01 * frame;
    place = 0.5 * kAcceleration * t * t;
    REQUIRE(cloth.carry({.translation = {place - before, 0, 0}}, 1 - s));
    REQUIRE(cloth.move_fixed(0, {place, 0, 0}));
    step(cloth, 0.01);
    const Vec3 along = cloth.position(8) - cloth.position(0);
    most = std::max(most, std::abs(along.x / along.y - tangent));
  }
  return most;
}

TEST_CASE("a frame that accelerates is felt by the share that is asked for") {
  for (const Backend backend : kBackends) {
    CHECK(swing(backend, 0) < 1e-4);
    CHECK(swing(backend, 0.5) < 5e-4);
    CHECK(swing(backend, 1) < 5e-4);
  }
}

TEST_CASE("a motion that cannot be is refused, and nothing is changed") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Cloth cloth = cloth_of(scene_of("hang", 5), {});
  run(cloth, 0.01, 3);
  const std::uint64_t before = cloth.state_hash();
  const auto check = [&](const RigidMotion& motion, double share, const char* part) {
    const auto carried = cloth.carry(motion, share);
    REQUIRE_FALSE(carried);
    CAPTURE(carried.error());
    CHECK(carried.error().find(part) != std::string::npos);
    CHECK(cloth.state_hash() == before);
  };
  check({.translation = {0, kNan, 0}}, 1, "motion.translation");
  check({.rotation = {0, 0, kNan}}, 1, "motion.rotation");
  check({.about = {kNan, 0, 0}}, 1, "motion.about");
  check({}, -0.1, "share");
  check({}, 1.1, "share");
  check({}, kNan, "share");
  check({.translation = {1.7e308, 0, 0}, .about = {1.7e308, 0, 0}}, 1, "range");
  REQUIRE(cloth.carry(kMotion, 0));
  CHECK(cloth.state_hash() == before);
}

/// Of cotton, 0.2 m x 1 m, that hangs from its first row.
SceneDescription strip() {
  MeshDescription mesh = sheet(
      11, 3,
      [](double row, double column) {
        return 0.1 * Vec3{0, -row, column};
      },
      [](std::uint32_t, std::uint32_t) { return Cut::none; });
  mesh.material = find_material("cotton").value();
  mesh.pins = {0, 1, 2};
  return made(mesh).scene;
}

/// A strip of cotton whose upper end walks at 3 m/s, carried along or moved: how far its hem comes
/// to hang behind, m.
double behind(double share, Backend backend) {
  SceneDescription scene = strip();
  Cloth cloth = cloth_of(scene, on(backend, {.solver = Solver::small_steps, .threads = 1}));
  double x = 0;
  for (int frame = 0; frame < 240; ++frame) {
    const double way = 3. / 60;
    x += way;
    REQUIRE(cloth.carry({.translation = {way, 0, 0}}, share));
    for (const std::uint32_t i : scene.fixed)
      REQUIRE(cloth.move_fixed(i, scene.positions[i] + Vec3{x, 0, 0}));
    step(cloth, 1. / 60);
  }
  return x - cloth.position(static_cast<std::uint32_t>(scene.positions.size() - 1)).x;
}

TEST_CASE("a steady walk blows at a cloth that is carried along as at one that is not") {
  const double moved = behind(0, Backend::simd), carried = behind(1, Backend::simd);
  CHECK(moved > 0.2);
  CHECK(carried == doctest::Approx(moved).epsilon(0.1));
  CHECK(behind(0.5, Backend::simd) == doctest::Approx(moved).epsilon(0.1));
}

TEST_CASE("a turn blows at what is far from its axis, and a teleport at nothing") {
  SceneDescription scene;
  scene.positions = {{2, 0, 0}, {2, 1, 0}, {2, 0, 1}};
  scene.masses = {1, 1, 1};
  scene.gravity = {0, 0, 0};
  scene.constraints = {{0, 1, 1}, {0, 2, 1}, {1, 2, std::sqrt(2.)}};
  scene.air.triangles = {{0, 1, 2}};
  scene.air.drag = 1;
  Cloth turned = cloth_of(scene, {.solver = Solver::small_steps}), jumped = turned.clone();
  REQUIRE(turned.carry({.translation = {0.04, 0, 0}}, 1));
  REQUIRE(jumped.teleport({.translation = {0.04, 0, 0}}));
  step(turned, 0.01);
  step(jumped, 0.01);
  // 1/2 density area v^2 / m = 0.6 * 0.5 * 16 / 3 m/s^2
  CHECK(turned.velocity(0).x == doctest::Approx(-0.016).epsilon(0.01));
  CHECK(length(jumped.velocity(0)) == 0);
  Cloth spun = cloth_of(scene, {.solver = Solver::small_steps});
  REQUIRE(spun.carry({.rotation = {0, 0, -0.02}, .about = {2, -2, 0}}, 1));
  step(spun, 0.01);  // 4 to 6 m/s along x
  CHECK(spun.velocity(1).x < -0.016);
}

}  // namespace
}  // namespace weft::test::engine_step_carry
