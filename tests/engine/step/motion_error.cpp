/// The error of motion that small steps estimate and hold, and the energy that a step loses.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tools/scenes/scenes.h"

namespace weft::test::engine_step_motion_error {
namespace {

constexpr double kFrame = 0.01;

Settings small_steps(double motion_tolerance = 0) {
  Settings settings;
  settings.solver = Solver::small_steps;
  settings.motion_tolerance = motion_tolerance;
  settings.threads = 1;
  return settings;
}

TEST_CASE("a body in free fall has no error by bdf2, and half of g h by the implicit method") {
  SceneDescription bar = free_bar(1, 2);
  bar.gravity = {0, -10, 0};
  for (const Backend backend : kBackends) {
    Settings settings = small_steps();
    settings.backend = backend;
    settings.substeps = 4;
    Cloth cloth = cloth_of(bar, settings);
    settings.scheme = Scheme::implicit;
    Cloth of_first_order = cloth_of(bar, settings);
    for (int frame = 0; frame < 10; ++frame) {
      CHECK(step(cloth, kFrame).motion_error < 2e-6);
      CHECK(step(of_first_order, kFrame).motion_error ==
            doctest::Approx(10 * kFrame / 4 / 2).epsilon(1e-4));
    }
  }
}

/// Two masses of 1 kg swing by x = 0.05 cos(w t) each, w^2 = 2 / compliance. BDF2 has the local
/// error h^3 / 3 of the third derivative of x, which its formula takes at the middle of the last
/// two substeps.
TEST_CASE("the error of a spring that swings is that of BDF2") {
  SceneDescription scene = free_bar(1, 1);
  const double w = 10, amplitude = 0.05;
  scene.positions[1].x += 2 * amplitude;
  scene.constraints[0].compliance = 2 / (w * w);
  for (const Backend backend : kBackends) {
    Settings settings = small_steps();
    settings.backend = backend;
    settings.substeps = 1;
    settings.tolerance = 0.5;
    Cloth cloth = cloth_of(scene, settings);
    const double h = kFrame, most = h * h / 3 * amplitude * w * w * w;
    for (int frame = 1; frame <= 35; ++frame) {
      const double error = step(cloth, h).motion_error;
      if (frame < 8) continue;  // it starts at first order
      CHECK(std::abs(error - most * std::abs(std::sin(w * h * (frame - 1)))) < 0.08 * most);
    }
  }
}

TEST_CASE("lanes estimate what the reference in double does") {
  for (const char* name : {"hang", "corners"}) {
    for (const double motion_tolerance : {0., 0.01}) {
      Settings settings = small_steps(motion_tolerance);
      if (motion_tolerance == 0) settings.substeps = 12;
      Cloth lanes = cloth_of(scene_of(name, 17), settings);
      settings.backend = Backend::reference;
      Cloth reference = cloth_of(scene_of(name, 17), settings);
      for (int frame = 0; frame < 12; ++frame) {
        const StepReport a = step(lanes, kFrame), b = step(reference, kFrame);
        CHECK(a.substeps == b.substeps);
        CHECK(std::abs(a.motion_error - b.motion_error) < 0.05 * b.motion_error + 1e-4);
      }
    }
  }
}

/// Where cloth snaps taut the estimate need not fall, and the status says so.
std::vector<Vec3> after(Cloth cloth, double seconds, std::int64_t& substeps) {
  const double asked = cloth.settings().motion_tolerance;
  for (int frame = 0; frame < std::lround(seconds / kFrame); ++frame) {
    const StepReport report = step(cloth, kFrame);
    const bool is_held = asked == 0 || report.motion_error <= asked;
    REQUIRE(report.status == (is_held ? Status::converged : Status::iteration_limit));
    substeps += report.substeps;
  }
  return positions(cloth);
}

TEST_CASE("the distance from the true motion is what was asked for, within a factor of four") {
  for (const auto& [name, size] : {std::pair{"hang", 20}, std::pair{"corners", 21}}) {
    const SceneDescription scene = scene_of(name, size);
    Settings fine = small_steps();
    fine.substeps = 256;
    std::int64_t most = 0;
    const double seconds = 0.4;
    const std::vector<Vec3> truth = after(cloth_of(scene, fine), seconds, most);
    std::int64_t before = 0;
    for (const double asked : {0.01, 0.003, 0.001}) {
      CAPTURE(std::string(name));
      CAPTURE(asked);
      std::int64_t substeps = 0;
      const double got =
          largest_distance(after(cloth_of(scene, small_steps(asked)), seconds, substeps), truth) /
          seconds;
      CHECK(got < 4 * asked);
      CHECK(got > asked / 4);
      CHECK(substeps > before);
      CHECK(substeps < most);
      before = substeps;
    }
  }
}

TEST_CASE(
    "a frame of fabric in which motion sets in holds what is asked for, or says that it does not") {
  for (const char* name : {"drape", "flag"}) {
    for (const char* material : {"cotton", "silk"}) {
      const SceneDescription scene =
          scenes::make(name, {.size = 13, .material = find_material(material).value()}).value();
      for (const int rate : {30, 60, 240}) {
        CAPTURE(std::string(name));
        CAPTURE(std::string(material));
        CAPTURE(rate);
        const double asked = 0.02;
        Cloth cloth = cloth_of(scene, small_steps(asked));
        int repeated = 0, missed = 0;
        for (int frame = 0; frame < rate; ++frame) {
          const StepReport report = step(cloth, 1. / rate);
          const bool is_held = report.motion_error <= asked;
          REQUIRE(report.status == (is_held ? Status::converged : Status::iteration_limit));
          repeated += report.halvings > 0 ? 1 : 0;
          missed += is_held ? 0 : 1;
        }
        CHECK(missed <= 1);
        CHECK(repeated > 0);
        CHECK(repeated < 25);
      }
    }
  }
}

TEST_CASE("what is asked for stays within bounds where it cannot be held, and the status tells") {
  const double asked = 1e-5;  // near what floats carry
  Cloth cloth = cloth_of(scene_of("hang", 20), small_steps(asked));
  int missed = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const StepReport report = step(cloth, kFrame);
    const bool is_held = report.motion_error <= asked;
    REQUIRE(report.status == (is_held ? Status::converged : Status::iteration_limit));
    CHECK(report.substeps < 512);
    missed += is_held ? 0 : 1;
  }
  CHECK(missed > 50);
}

TEST_CASE("a cloth at rest takes few substeps again") {
  SceneDescription scene = scene_of("hang", 12);
  scene.damping.motion = 2;
  Cloth cloth = cloth_of(scene, small_steps(0.001));
  int most = 0;
  for (int frame = 0; frame < 100; ++frame) most = std::max(most, step(cloth, kFrame).substeps);
  run(cloth, kFrame, 400);
  CHECK(step(cloth, kFrame).substeps < most);
}

TEST_CASE("where the motion is held clones, copies and threads change no bit") {
  for (const auto& [name, size] : {std::pair{"corners", 21}, std::pair{"hang", 90}}) {
    const auto hash = [&, name = name, size = size](int threads) {
      tbb::task_arena arena(threads);
      return arena.execute([&] {
        Settings settings = small_steps(0.003);
        settings.threads = threads;
        Cloth cloth = cloth_of(scene_of(name, size), settings);
        run(cloth, kFrame, 12);
        return cloth.state_hash();
      });
    };
    CHECK(hash(2) == hash(1));
  }
  Cloth cloth = cloth_of(scene_of("corners", 21), small_steps(0.003));
  auto other = Cloth::create(cloth.model(), small_steps(0.003));
  REQUIRE(other);
  run(cloth, kFrame, 45);
  Cloth clone = cloth.clone();
  REQUIRE(other.value().copy_state(cloth));
  for (Cloth* each : {&cloth, &clone, &other.value()}) run(*each, kFrame, 5);
  CHECK(clone.state_hash() == cloth.state_hash());
  CHECK(other.value().state_hash() == cloth.state_hash());
}

TEST_CASE("automatic takes small steps for the motion, at any tolerance") {
  for (const double tolerance : {0.01, 1e-5}) {
    Settings settings;
    settings.tolerance = tolerance;
    settings.motion_tolerance = 0.01;
    CHECK(cloth_of(scene_of("hang", 8), settings).settings().solver == Solver::small_steps);
  }
}

/// Pins go to and fro, or stay.
void check_energy_lost(SceneDescription scene, const Settings& settings, double speed) {
  Cloth cloth = cloth_of(scene, settings);
  const double scale = std::abs(cloth.energy().total()) + 1;
  for (int frame = 0; frame < 40; ++frame) {
    const double before = cloth.energy().total();
    for (const std::uint32_t pin : scene.fixed) {
      if (speed == 0) break;
      Vec3 to = cloth.position(pin);
      to.x += speed * kFrame * (frame % 20 < 10 ? 1 : -1);
      REQUIRE(cloth.move_fixed(pin, to));
    }
    const StepReport report = step(cloth, kFrame);
    const double lost = before + report.pin_work - cloth.energy().total();
    CHECK(std::abs(report.energy_lost - lost) < 1e-7 * scale);
  }
}

TEST_CASE("energy_lost is what kinetic, potential and elastic energy and the pins' work leave") {
  for (const Solver solver : {Solver::small_steps, Solver::yarn, Solver::direct}) {
    for (const char* name : {"hang", "corners"}) {
      for (const double speed : {0., 0.5}) {
        CAPTURE(std::string(weft::name(solver)));
        CAPTURE(std::string(name));
        CAPTURE(speed);
        check_energy_lost(scene_of(name, 13), {.solver = solver, .threads = 1}, speed);
      }
    }
  }
  SceneDescription spring = free_bar(1, 1);
  spring.positions[1].x += 0.1;
  spring.constraints[0].compliance = 0.02;
  Settings settings = small_steps();
  settings.substeps = 8;
  settings.tolerance = 0.5;
  Cloth once = cloth_of(spring, settings);
  run(once, kFrame, 1);  // until then nothing is known of the substeps' length
  for (int frame = 0; frame < 40; ++frame) {
    const double before = once.energy().total();
    const double lost = step(once, kFrame).energy_lost;
    CHECK(std::abs(lost - (before - once.energy().total())) < 1e-7);
  }
}

}  // namespace
}  // namespace weft::test::engine_step_motion_error
