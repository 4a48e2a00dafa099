/// Particles that slide along rails: beads on a wire, rings on a rod, cords over a drum.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_sliders {
namespace {

constexpr int kRates[] = {30, 60, 240};

Settings small_steps(Backend backend) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// Adds fixed particles as a rail, which is closed or not. Returns where it begins and ends.
std::array<std::uint32_t, 2> add_rail(SceneDescription& scene, const std::vector<Vec3>& points,
                                      bool is_closed = false) {
  const auto first = static_cast<std::uint32_t>(scene.rail_particles.size());
  const auto particle = static_cast<std::uint32_t>(scene.positions.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    scene.positions.push_back(points[i]);
    scene.masses.push_back(1);
    scene.fixed.push_back(particle + i);
    scene.rail_particles.push_back(particle + i);
  }
  if (is_closed) scene.rail_particles.push_back(particle);
  return {first, static_cast<std::uint32_t>(scene.rail_particles.size()) - 1};
}

/// A bead on a circle of 1 m that stands upright, `angle` rad from its lowest point.
SceneDescription bead(double angle, std::size_t corners) {
  SceneDescription scene;
  scene.positions = {{std::sin(angle), -std::cos(angle), 0}};
  scene.masses = {0.01};
  std::vector<Vec3> circle;
  for (std::size_t i = 0; i < corners; ++i) {
    const double at = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    circle.push_back({std::cos(at), std::sin(at), 0});
  }
  const auto [first, last] = add_rail(scene, circle, true);
  scene.sliders = {{.particle = 0, .first = first, .last = last}};
  return scene;
}

TEST_CASE("a bead on a circular wire swings as a pendulum, at any frame rate") {
  for (const Backend backend : kBackends) {
    for (const std::size_t corners : {24u, 60u}) {
      for (const int rate : kRates) {
        CAPTURE(rate);
        CAPTURE(corners);
        const double frame = 1. / rate, period = pendulum_period(1.2);
        Cloth cloth = cloth_of(bead(1.2, corners), small_steps(backend));
        double before = cloth.position(0).x, begun = 0, passed = 0;
        int passes = 0;
        for (int k = 1; k * frame < 3.2 * period; ++k) {
          const StepReport report = step(cloth, frame);
          CHECK(report.status == Status::converged);
          CHECK(report.max_rail_gap <= 1e-4);
          const double now = cloth.position(0).x;
          if ((before > 0) != (now > 0)) {
            const double at = frame * (k - 1 + before / (before - now));
            if (passes++ == 0) begun = at;
            passed = at;
          }
          before = now;
        }
        CHECK(passes >= 6);
        CHECK(2 * (passed - begun) / (passes - 1) == doctest::Approx(period).epsilon(0.01));
        const double height = cloth.energy().total() / (0.01 * 10);
        CHECK(height == doctest::Approx(-std::cos(1.2)).epsilon(0.03));
      }
    }
  }
}

/// A ring on a rod along x, from -1 to 4 m, which moves at 2 m/s.
SceneDescription ring(double friction) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}};
  scene.velocities = {{2, 0, 0}, {}, {}};
  scene.masses = {0.03};
  const auto [first, last] = add_rail(scene, {{-1, 0, 0}, {4, 0, 0}});
  scene.sliders = {{.particle = 0, .first = first, .last = last, .friction = friction}};
  return scene;
}

TEST_CASE("a ring on a rod comes to rest by Coulomb's law, and goes on without it") {
  for (const Backend backend : kBackends) {
    for (const int rate : kRates) {
      CAPTURE(rate);
      const double frame = 1. / rate;
      Cloth rough = cloth_of(ring(0.3), small_steps(backend));
      run(rough, frame, rate);
      CHECK(rough.position(0).x == doctest::Approx(2. * 2 / (2 * 0.3 * 10)).epsilon(0.01));
      CHECK(length(rough.velocity(0)) < 1e-3);
      const double rests = rough.position(0).x;
      run(rough, frame, rate);
      CHECK(std::abs(rough.position(0).x - rests) < 1e-6);
      Cloth smooth = cloth_of(ring(0), small_steps(backend));
      run(smooth, frame, rate);
      CHECK(smooth.position(0).x == doctest::Approx(2).epsilon(1e-4));
      CHECK(std::abs(smooth.position(0).y) <= 1e-4);
      run(smooth, frame, 2 * rate);  // the end of the rod is a stop
      CHECK(smooth.position(0).x <= 4 + 1e-4);
      CHECK(smooth.position(0).x > 3.9);
    }
  }
}

constexpr double kDrum = 0.3, kHanging = 0.3, kCordMass = 0.4;  // m, m at either end, kg

/// At s m along a rail: up, over half of a drum, and down.
Vec3 over_drum(double s) {
  const double half = std::numbers::pi * kDrum;
  if (s < 0) return {-kDrum, s, 0};
  if (s > half) return {kDrum, half - s, 0};
  return {-kDrum * std::cos(s / kDrum), kDrum * std::sin(s / kDrum), 0};
}

/// A cord over the drum. Its particles come first, and the last of them is the right end.
SceneDescription cord_over_drum(double friction, int links) {
  SceneDescription scene;
  scene.gravity = {};
  const double way = std::numbers::pi * kDrum + 2 * kHanging;
  for (int i = 0; i <= links; ++i) {
    scene.positions.push_back(over_drum(way * i / links - kHanging));
    scene.masses.push_back(kCordMass / links);
  }
  for (std::uint32_t i = 1; i < scene.positions.size(); ++i)
    scene.constraints.push_back({i - 1, i, distance(scene.positions[i - 1], scene.positions[i])});
  const auto count = static_cast<std::uint32_t>(scene.positions.size());
  std::vector<Vec3> rail;
  for (int i = -40; i <= 80; ++i) rail.push_back(over_drum(i * std::numbers::pi * kDrum / 40));
  const auto [first, last] = add_rail(scene, rail);
  for (std::uint32_t i = 0; i < count; ++i) scene.sliders.push_back({i, first, last, friction});
  return scene;
}

/// The ways of the right end in a quarter of a second and in half of one, where 10 N draw at the
/// left end and `force` at the right one.
std::array<double, 2> drawn_over_drum(const SceneDescription& scene, int links, double force,
                                      int rate) {
  Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
  const auto end = static_cast<std::uint32_t>(links);
  std::vector<Vec3> forces(scene.positions.size());
  forces[0].y = -10;
  forces[end].y = -force;
  REQUIRE(cloth.write_forces(forces));
  const double before = cloth.position(end).y;
  double quarter = 0;
  for (int k = 1; k <= rate / 2; ++k) {
    const StepReport report = step(cloth, 1. / rate);
    CHECK(report.max_rail_gap <= 1e-4);
    if (k > rate / 4) continue;
    CHECK(report.status == Status::converged);
    quarter = before - cloth.position(end).y;
  }
  return {quarter, before - cloth.position(end).y};
}

/// While it slides, by a, the tension over the drum obeys dT = (friction T + m R a) dangle, with
/// the mass m of a metre.
TEST_CASE("a cord over a drum holds e^(friction angle) times the force, within 3 %") {
  for (const double friction : {0.25, 0.5}) {
    const double holds = std::exp(friction * std::numbers::pi);
    for (const int rate : kRates) {
      for (const int links : {40, 70}) {
        CAPTURE(friction);
        CAPTURE(rate);
        CAPTURE(links);
        const SceneDescription scene = cord_over_drum(friction, links);
        const auto [soon, later] = drawn_over_drum(scene, links, 0.97 * 10 * holds, rate);
        CHECK(std::abs(soon) < 0.01 * 1.6);  // the cord is longer by its tolerance
        CHECK(std::abs(later - soon) < 2e-3);
        const double force = 1.1 * 10 * holds, time = (rate / 4) / static_cast<double>(rate);
        const double a = 2 * drawn_over_drum(scene, links, force, rate)[0] / (time * time);
        const double metre = kCordMass / (std::numbers::pi * kDrum + 2 * kHanging);
        const double hanging = metre * kHanging * a, over = metre * kDrum * a / friction;
        CHECK((force - hanging + over) / (10 + hanging + over) ==
              doctest::Approx(holds).epsilon(0.03));
      }
    }
  }
}

/// A cord that runs over a fixed eyelet, as its rail, and turns there by 30 degrees.
TEST_CASE("a cord that turns over an eyelet holds e^(friction angle) times the force") {
  constexpr double kTurn = std::numbers::pi / 6, kFriction = 0.3;
  constexpr std::uint32_t kLinks = 40;
  for (const int rate : kRates) {
    const auto way_of_end = [&](double share) {
      SceneDescription scene;
      scene.gravity = {};
      scene.positions = {{0, 0, 0}};
      scene.masses = {1};
      scene.fixed = {0};
      const Vec3 right{std::cos(kTurn / 2), -std::sin(kTurn / 2), 0}, left{-right.x, right.y, 0};
      for (std::uint32_t i = 0; i <= kLinks; ++i) {
        const double at = 0.02 * (i - 0.5 * kLinks);
        scene.positions.push_back(std::abs(at) * (at < 0 ? left : right));
        scene.masses.push_back(0.01);
        scene.rail_particles.push_back(i + 1);
        if (i > 0) scene.constraints.push_back({i, i + 1, 0.02});
      }
      scene.sliders = {{0, 0, kLinks, kFriction}};
      Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
      std::vector<Vec3> forces(scene.positions.size());
      forces[1] = 10 * left;
      forces[kLinks + 1] = 10 * share * std::exp(kFriction * kTurn) * right;
      REQUIRE(cloth.write_forces(forces));
      run(cloth, 1. / rate, rate / 3);
      return length(cloth.position(kLinks + 1)) - 0.4;
    };
    CAPTURE(rate);
    CHECK(std::abs(way_of_end(0.97)) < 4e-3);
    CHECK(way_of_end(1.05) > 0.02);
  }
}

/// A ring of 0.2 kg on a cord of 13 particles of 50 g, which nothing holds.
SceneDescription ring_on_free_cord(double friction) {
  SceneDescription scene;
  scene.gravity = {};
  for (int i = 0; i < 13; ++i) {
    scene.positions.push_back({0.1 * i, 0.02 * (i % 2), 0});
    scene.masses.push_back(0.05);
    scene.velocities.push_back({0, 0, 0.3 * (i == 6)});
    scene.rail_particles.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::uint32_t i = 1; i < 13; ++i)
    scene.constraints.push_back({i - 1, i, distance(scene.positions[i - 1], scene.positions[i])});
  scene.positions.push_back({0.25, 0.01, 0});
  scene.masses.push_back(0.2);
  scene.velocities.push_back({0.4, 0.5, 0});
  scene.sliders = {{.particle = 13, .first = 0, .last = 12, .friction = friction}};
  return scene;
}

TEST_CASE("a ring on a cord that moves freely keeps the momentum of both") {
  for (const Backend backend : kBackends) {
    for (const double friction : {0., 0.3}) {
      for (const int rate : kRates) {
        CAPTURE(rate);
        CAPTURE(friction);
        const SceneDescription scene = ring_on_free_cord(friction);
        Cloth cloth = cloth_of(scene, small_steps(backend));
        std::vector<Vec3> x(14), v(14);
        step(cloth, 1. / rate);
        const auto read = [&] {
          REQUIRE(cloth.read_positions(x));
          REQUIRE(cloth.read_velocities(v));
        };
        read();
        const Vec3 before = momentum(scene.masses, v);
        const Vec3 turning = angular_momentum(scene.masses, x, v);
        const double energy = cloth.energy().total();
        for (int k = 0; k < rate; ++k) {
          const StepReport report = step(cloth, 1. / rate);
          CHECK(report.status == Status::converged);
          CHECK(report.max_rail_gap <= 1e-4);
        }
        read();
        CHECK(distance(momentum(scene.masses, v), before) < 1e-4 * length(before));
        CHECK(distance(angular_momentum(scene.masses, x, v), turning) < 0.01 * length(before));
        CHECK(cloth.energy().total() <= 1.001 * energy);
      }
    }
  }
}

TEST_CASE("a slider that begins beside its rail is drawn to it without a blow") {
  SceneDescription scene = ring(0.2);
  scene.velocities = {};
  scene.positions[0] = {0.5, 0.2, 0};
  Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
  CHECK(step(cloth, 1. / 60).max_rail_gap <= 1e-4);
  CHECK(length(cloth.velocity(0)) < 0.01);
  CHECK(cloth.position(0).x == doctest::Approx(0.5).epsilon(1e-3));
}

TEST_CASE("clones, saved states and changes go on where sliders are on their rails") {
  Cloth cloth = cloth_of(ring_on_free_cord(0.1), small_steps(Backend::simd));
  Cloth loaded = cloth_of(ring_on_free_cord(0.1), small_steps(Backend::simd));
  run(cloth, 1. / 60, 20);
  Cloth clone = cloth.clone(), changed = cloth.clone();
  REQUIRE(loaded.load_state(cloth.save_state()));
  REQUIRE(changed.change({.damping = Damping{}}));
  for (Cloth* each : {&cloth, &clone, &loaded, &changed}) run(*each, 1. / 60, 20);
  for (Cloth* each : {&clone, &loaded, &changed}) CHECK(each->state_hash() == cloth.state_hash());
  const auto model = load_model(save_model(*cloth.model()));
  REQUIRE(model);
  CHECK(cloth_of(ring_on_free_cord(0.1), small_steps(Backend::simd)).state_hash() ==
        Cloth::create(model.value(), small_steps(Backend::simd)).value().state_hash());
}

TEST_CASE("sliders that make no sense, and solvers that know none, are refused") {
  const auto refusal_of = [](auto&& change) {
    SceneDescription scene = ring(0);
    change(scene);
    const auto model = build_model(scene);
    return model ? std::string() : model.error();
  };
  CHECK(refusal_of([](auto& s) { s.sliders[0].particle = 9; }).find("sliders[0].particle") == 0);
  CHECK(refusal_of([](auto& s) { s.sliders[0].last = 2; }) ==
        "sliders[0].last: is not in rail_particles, which has 2 (2)");
  CHECK(refusal_of([](auto& s) { s.sliders[0].first = 1; }) ==
        "sliders[0].first: must be before the last (1)");
  CHECK(refusal_of([](auto& s) { s.sliders[0].friction = -1; }).find("sliders[0].friction") == 0);
  CHECK(refusal_of([](auto& s) { s.rail_particles[1] = 0; }) ==
        "rail_particles[1]: slides on this rail itself (0)");
  CHECK(refusal_of([](auto& s) { s.rail_particles[1] = 1; }) ==
        "rail_particles[1]: follows itself (1)");
  CHECK(refusal_of([](auto& s) { s.rail_particles.push_back(7); }).find("rail_particles[2]") == 0);
  CHECK(refusal_of([](auto& s) { s.sliders.push_back(s.sliders[0]); }) ==
        "sliders[1].particle: slides on a rail already (0)");
  const auto cloth = Cloth::create(model_of(ring(0)), {.solver = Solver::yarn});
  REQUIRE_FALSE(cloth);
  CHECK(cloth.error().find("sliders") == 0);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_sliders
