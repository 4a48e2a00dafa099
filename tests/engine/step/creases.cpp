/// Hinges that yield: single ones and sheets against closed forms, and what becomes of creases.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_creases {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kRates[] = {30, 60, 240};  // Hz
constexpr double kCell = 0.01;           // m

/// Rows by 3 vertices, level, along x. Pins hold the first half, and carry the second around the
/// row of the fold, which is free.
struct Sheet {
  MeshDescription mesh = {};
  std::uint32_t rows = 0, fold = 0;
  std::vector<std::uint32_t> carried = {};

  std::uint32_t at(std::uint32_t row, std::uint32_t column) const { return 3 * row + column; }
};

Sheet sheet_to_fold(const Material& material, bool has_triangles, std::uint32_t half) {
  Sheet s{.rows = 2 * half + 1, .fold = half};
  s.mesh = sheet(
      s.rows, 3,
      [](double row, double column) {
        return Vec3{kCell * row, 0, kCell * column};
      },
      [&](std::uint32_t row, std::uint32_t column) {
        return !has_triangles ? Cut::none : (row + column) % 2 == 0 ? Cut::first : Cut::second;
      });
  s.mesh.material = material;
  for (std::uint32_t i = 0; i < 3 * s.rows; ++i) {
    if (i / 3 == s.fold) continue;
    s.mesh.pins.push_back(i);
    if (i / 3 > s.fold) s.carried.push_back(i);
  }
  return s;
}

/// Stiff along, so that what bends alone counts, and damped so that it comes to rest.
Material paper(double yield, double hardening = 0) {
  return {.density = 0.1,
          .warp = 4000,
          .weft = 4000,
          .shear = 400,
          .bending = 2e-4,
          .damping_motion = 30,
          .bending_yield = yield,
          .bending_hardening = hardening};
}

/// Takes the second half around the fold by pins, from one angle to another, and holds it there.
void fold(Cloth& cloth, const Sheet& s, const SceneDescription& scene, double from, double to,
          int frames, double dt) {
  const double middle = kCell * s.fold;
  for (int k = 1; k <= frames; ++k) {
    const double angle = kDegree * (from + (to - from) * k / frames);
    for (const std::uint32_t i : s.carried) {
      const Vec3 p = scene.positions[i];
      const double r = p.x - middle;
      REQUIRE(cloth.move_fixed(i, {middle + r * std::cos(angle), r * std::sin(angle), p.z}));
    }
    CHECK(step(cloth, dt).status == Status::converged);
  }
  run(cloth, dt, 3);
}

/// Degrees, of the fold alone, from -90 to 270.
double angle_of(const Cloth& cloth, const Sheet& s) {
  const auto slope = [&](std::uint32_t row) {
    const Vec3 way = cloth.position(s.at(row + 1, 1)) - cloth.position(s.at(row, 1));
    return std::atan2(way.y, way.x) / kDegree;
  };
  const double angle = std::remainder(slope(s.fold) - slope(s.fold - 1), 360);
  return angle < -90 ? angle + 360 : angle;
}

SceneDescription weightless(const Sheet& s) {
  SceneDescription scene = made(s.mesh).scene;
  scene.gravity = {};
  return scene;
}

/// An angle is kept but for that at which the fold yields, its curvature being over one cell. It is
/// let go with a quarter of the moment left: by all of it the rest of the sheet, which has not
/// hardened, would yield as it springs.
TEST_CASE("a sheet that was folded nearly flat and is let go keeps its crease") {
  for (const bool has_triangles : {false, true}) {
    for (const int rate : kRates) {
      for (const double pressed : {120., 178.}) {
        for (const double yield : {10., 60.}) {
          for (const double hardening : {0., yield / 200}) {
            CAPTURE(has_triangles);
            CAPTURE(rate);
            CAPTURE(pressed);
            CAPTURE(yield);
            CAPTURE(hardening);
            const Sheet s = sheet_to_fold(paper(yield, hardening), has_triangles, 3);
            const SceneDescription scene = weightless(s);
            Cloth cloth = cloth_of(scene, {.threads = 1});
            const double kept = (pressed - yield * kCell / kDegree) / (1 + hardening);
            const double let_go = kept + (pressed - kept) / 4;
            fold(cloth, s, scene, 0, pressed, rate / 2, 1. / rate);
            fold(cloth, s, scene, pressed, let_go, rate / 4, 1. / rate);
            REQUIRE(cloth.change({.release = s.carried}));
            run(cloth, 1. / rate, 3 * rate);
            CHECK(angle_of(cloth, s) == doctest::Approx(kept).epsilon(0.03));
          }
        }
      }
    }
  }
}

TEST_CASE("a sheet that was bent by less than its yield springs back flat") {
  const Sheet s = sheet_to_fold(paper(100), false, 3);
  const SceneDescription scene = weightless(s);
  for (const Backend backend : kBackends) {
    Cloth cloth =
        cloth_of(scene, {.solver = Solver::small_steps, .backend = backend, .threads = 1});
    fold(cloth, s, scene, 0, 40, 30, 1. / 60);
    REQUIRE(cloth.change({.release = s.carried}));
    run(cloth, 1. / 60, 60);
    CHECK(std::abs(angle_of(cloth, s)) < 0.5);
  }
}

TEST_CASE("a crease is opened as far as it is bent back") {
  const Sheet s = sheet_to_fold(paper(20), false, 3);
  const SceneDescription scene = weightless(s);
  Cloth cloth = cloth_of(scene, {.threads = 1});
  fold(cloth, s, scene, 0, 150, 30, 1. / 60);
  fold(cloth, s, scene, 150, 40, 30, 1. / 60);
  REQUIRE(cloth.change({.release = s.carried}));
  run(cloth, 1. / 60, 60);
  CHECK(angle_of(cloth, s) == doctest::Approx(40 + 20 * kCell / kDegree).epsilon(0.03));
}

TEST_CASE("friction holds a part of the bend that a sheet is let go at") {
  constexpr double kFriction = 4e-3, kSlip = 10;  // N, 1/m
  Material material = paper(std::numeric_limits<double>::infinity());
  material.bending_friction = kFriction;
  material.bending_slip = kSlip;
  material.damping_motion = 400;  // it comes back without a swing
  for (const int rate : kRates) {
    CAPTURE(rate);
    const Sheet s = sheet_to_fold(material, false, 3);
    const SceneDescription scene = weightless(s);
    Cloth cloth = cloth_of(scene, {.threads = 1});
    fold(cloth, s, scene, 0, 40, rate / 2, 1. / rate);
    REQUIRE(cloth.change({.release = s.carried}));
    run(cloth, 1. / rate, 2 * rate);
    // It comes back as far as the moment of bending is larger than that of friction.
    const double rest = kFriction / material.bending * kCell / kDegree;
    CHECK(angle_of(cloth, s) == doctest::Approx(rest).epsilon(0.03));
  }
}

/// A sheet by chance with its velocities; nothing holds it and nothing damps it.
SceneDescription flying_sheet(std::uint32_t seed) {
  Random random(seed);
  Material material = paper(random.between(5, 100), random.below(2) == 0 ? 0 : 1);
  material.damping_motion = 0;
  if (random.below(2) == 0) material.bending_friction = material.bending * random.between(5, 50);
  MeshDescription mesh = random.below(2) == 0 ? quads(6) : irregular_triangles(6, 0.2, random);
  for (Vec3& p : mesh.positions) p = kCell * p;
  mesh.material = material;
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {};
  const double speed = random.between(0.1, 3);
  for (std::size_t i = 0; i < scene.positions.size(); ++i)
    scene.velocities.push_back(speed * random.in_box(1));
  return scene;
}

TEST_CASE("a sheet that yields gains no energy, and crumples") {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    for (const int rate : kRates) {
      CAPTURE(seed);
      CAPTURE(rate);
      Cloth cloth = cloth_of(flying_sheet(seed), {.threads = 1});
      const double most = cloth.energy().kinetic;
      double lost = 0;
      for (int k = 0; k < rate / 4; ++k) {
        const StepReport report = step(cloth, 1. / rate);
        lost += report.energy_lost;
        const Energy energy = cloth.energy();
        REQUIRE(energy.kinetic + energy.elastic <= 1.01 * most);
      }
      CHECK(lost > 0);
      CHECK(std::isfinite(cloth.energy().elastic));
    }
  }
}

/// The moments of both layers are each their own.
TEST_CASE("yield and friction of one material do not know each other") {
  Material material = paper(30);
  const Sheet alone = sheet_to_fold(material, false, 2);
  material.bending_friction = 1e-3;
  const Sheet both = sheet_to_fold(material, false, 2);
  const SceneDescription one = weightless(alone), two = weightless(both);
  REQUIRE(two.bending.size() == 2 * one.bending.size());
  for (std::size_t i = 0; i < one.bending.size(); ++i) {
    const BendingElement &first = two.bending[i], &second = two.bending[i + one.bending.size()];
    CHECK(first.particles == second.particles);
    CHECK(first.yield == one.bending[i].yield);
    CHECK(second.yield / first.yield == doctest::Approx(10. / 30));
    CHECK(first.compliance / second.compliance == doctest::Approx(1e-3 / 10 / material.bending));
    CHECK(first.particles[3] != kNoIndex);
  }
}

TEST_CASE(
    "a creased cloth goes on as it was saved, and as a clone of it does; a new shape is flat") {
  const Sheet s = sheet_to_fold(paper(20), true, 3);
  const SceneDescription scene = weightless(s);
  for (const Backend backend : kBackends) {
    const Settings settings{.solver = Solver::small_steps, .backend = backend, .threads = 1};
    Cloth cloth = cloth_of(scene, settings);
    const std::string path =
        (std::filesystem::temp_directory_path() / "weft_creases.recording").string();
    REQUIRE(cloth.begin_recording(path));
    fold(cloth, s, scene, 0, 120, 20, 1. / 60);
    REQUIRE(cloth.change({.release = s.carried}));
    step(cloth, 1. / 60);
    Cloth copy = cloth.clone();
    auto model = load_model(save_model(*cloth.model()));
    REQUIRE_MESSAGE(model, model.error());
    Cloth loaded = Cloth::create(model.value(), settings).value();
    REQUIRE(loaded.load_state(cloth.save_state()));
    for (int k = 0; k < 30; ++k) {
      for (Cloth* each : {&cloth, &copy, &loaded}) step(*each, 1. / 60);
      REQUIRE(copy.state_hash() == cloth.state_hash());
      REQUIRE(loaded.state_hash() == cloth.state_hash());
    }
    REQUIRE(cloth.end_recording());
    std::filesystem::remove(path);
    CHECK(angle_of(cloth, s) > 60);
    const double before = cloth.energy().elastic;
    REQUIRE(cloth.set_rest_shape(scene));
    CHECK(cloth.energy().elastic > 10 * before);  // a crease of 90 degrees is a load again
  }
}

TEST_CASE("a step that fails leaves creases as they were") {
  const Sheet s = sheet_to_fold(paper(20), false, 3);
  const SceneDescription scene = weightless(s);
  Cloth cloth = cloth_of(scene, {.threads = 1});
  fold(cloth, s, scene, 0, 120, 20, 1. / 60);
  Cloth other = cloth.clone();
  std::vector<Vec3> forces(scene.positions.size(), Vec3{0, 1e308, 0});
  REQUIRE(cloth.write_forces(forces));
  CHECK_FALSE(committed(step(cloth, 1. / 60).status));
  REQUIRE(cloth.write_forces(std::vector<Vec3>(scene.positions.size())));
  for (Cloth* each : {&cloth, &other}) {
    REQUIRE(each->change({.release = s.carried}));
    run(*each, 1. / 60, 60);
  }
  CHECK(angle_of(cloth, s) == doctest::Approx(angle_of(other, s)).epsilon(1e-3));
  CHECK(angle_of(cloth, s) > 90);
}

/// A crease that was lost would be a load.
TEST_CASE("a creased sheet that tears keeps its creases on both sides of the tear") {
  Material material = paper(20);
  material.strength = 50;
  const Sheet s = sheet_to_fold(material, true, 3);
  const SceneDescription scene = weightless(s);
  Cloth cloth = cloth_of(scene, {.threads = 1});
  fold(cloth, s, scene, 0, 120, 20, 1. / 60);
  REQUIRE(cloth.change({.release = s.carried}));
  run(cloth, 1. / 60, 40);
  Cloth flat = cloth.clone();
  REQUIRE(flat.set_rest_shape(scene));
  const double lost = flat.energy().elastic;
  std::vector<Vec3> forces(cloth.particle_count());
  double before = 0;
  bool has_torn = false;
  for (int k = 1; k <= 200 && !has_torn; ++k) {
    forces[s.at(s.rows - 1, 0)] = {0, 0, -0.01 * k};
    forces[s.at(s.rows - 1, 2)] = {0, 0, 0.01 * k};
    REQUIRE(cloth.write_forces(forces));
    before = cloth.energy().elastic;
    has_torn = step(cloth, 1. / 60).torn > 0;
  }
  REQUIRE(cloth.particle_count() > scene.positions.size());
  CHECK(cloth.energy().elastic < before + 0.1 * lost);
}

TEST_CASE("a yield that cannot be is refused by name and value") {
  const SceneDescription good = weightless(sheet_to_fold(paper(20), false, 2));
  const auto error_with = [&](auto&& change) {
    SceneDescription scene = good;
    change(scene.bending[0]);
    const auto built = build_model(scene);
    REQUIRE_FALSE(built);
    return built.error();
  };
  CHECK(build_model(good));
  CHECK(error_with([](auto& e) { e.yield = 0; }).starts_with("bending[0].yield: "));
  CHECK(error_with([](auto& e) { e.yield = 1e-200; }).starts_with("bending[0].yield: "));
  CHECK(error_with([](auto& e) { e.hardening = -1; }).starts_with("bending[0].hardening: "));
  CHECK(error_with([](auto& e) { e.arm = 0; }).starts_with("bending[0].arm: "));
  CHECK(error_with([](auto& e) { e.fold = 3 * e.arm; }).find("longer than both arms") !=
        std::string::npos);
  CHECK(error_with([](auto& e) {
          e.particles[3] = kNoIndex;
          e.weights = {1, -2, 1, 0};
        }).find("three particles have no side") != std::string::npos);
  CHECK(error_with([](auto& e) { e.rest = 1e-3; }).find("has a rest besides") != std::string::npos);
}

}  // namespace
}  // namespace weft::test::engine_step_creases
