/// The motion that pins have in common, and the work that they do on what they carry along.
#include "engine/step/pin_work.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "tests/support/clothes.h"

namespace weft::test::engine_step_pin_work {
namespace {

using kernels::Vector;

constexpr double kStep = 0.01;

/// Where it is halfway through the step.
struct Pin {
  Vector middle, velocity;
  int holds = 1;
};

/// Each pin holds free particles of its own.
State held_by(const std::vector<Pin>& pins) {
  SceneDescription scene;
  scene.masses.assign(pins.size(), 1);
  for (std::uint32_t i = 0; i < pins.size(); ++i) {
    scene.fixed.push_back(i);
    const Vector at = pins[i].middle - (kStep / 2) * pins[i].velocity;
    scene.positions.push_back({at.x, at.y, at.z});
  }
  for (std::uint32_t i = 0; i < pins.size(); ++i) {
    for (int k = 0; k < pins[i].holds; ++k) {
      scene.constraints.push_back({i, static_cast<std::uint32_t>(scene.positions.size()), 1});
      scene.positions.push_back({scene.positions[i].x, scene.positions[i].y - 1, k + 0.});
      scene.masses.push_back(1);
    }
  }
  State s(std::make_shared<const Model>(scene), Settings{});
  for (std::uint32_t i = 0; i < pins.size(); ++i) {
    s.velocity.set(s.model->ordering.slot_of[i], pins[i].velocity);
  }
  return s;
}

PinMotion motion_of(const std::vector<Pin>& pins) { return motion_of_pins(held_by(pins), kStep); }

std::vector<Pin> spinning(const std::vector<Vector>& middles, Vector centre, Vector velocity,
                          Vector spin) {
  std::vector<Pin> pins;
  for (const Vector x : middles) pins.push_back({x, velocity + cross(spin, x - centre)});
  return pins;
}

void check_near(Vector found, Vector expected) { CHECK(length(found - expected) < 1e-6); }

const std::vector<Vector> kCorners{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-1, -2, -3}};  // about 0
const std::vector<Vector> kLine{{-1, 1, 2}, {0, 1, 2}, {4, 1, 2}};                  // about kMid
constexpr Vector kMid{1, 1, 2};

TEST_CASE("pins at rest have no motion") {
  const PinMotion motion = motion_of(spinning(kCorners, {}, {}, {}));
  CHECK(length(motion.velocity) == 0);
  CHECK(length(motion.spin) == 0);
  CHECK(motion.stray == 0);
  CHECK(length(motion.at({5, 6, 7})) == 0);
}

TEST_CASE("pins that move alike do not spin") {
  const Vector u{1, -2, 3};
  for (const auto& middles : {kCorners, kLine, {kMid}}) {
    const PinMotion motion = motion_of(spinning(middles, {}, u, {}));
    check_near(motion.velocity, u);
    CHECK(length(motion.spin) < 1e-12);
    CHECK(motion.stray < 1e-12);
    check_near(motion.at({5, 6, 7}), u);
  }
}

TEST_CASE("pins that turn about any axis while they travel do so as they are halfway") {
  const Vector u{1, -2, 3}, spin{4, 5, -6};
  const PinMotion motion = motion_of(spinning(kCorners, {}, u, spin));
  check_near(motion.centre, {});
  check_near(motion.velocity, u);
  check_near(motion.spin, spin);
  CHECK(motion.stray < 1e-6);
  check_near(motion.at({5, 6, 7}), u + cross(spin, {5, 6, 7}));
}

TEST_CASE("pins in a line turn across it, not about it") {
  const PinMotion motion = motion_of(spinning(kLine, kMid, {}, {7, 2, -3}));
  check_near(motion.centre, kMid);
  check_near(motion.spin, {0, 2, -3});
  CHECK(motion.stray < 1e-6);
}

TEST_CASE("a pin counts as often as it holds something") {
  const Vector along{3, 0, 0};
  const PinMotion motion = motion_of({{{0, 0, 0}, along, 2}, {{3, 0, 0}, {}, 1}});
  check_near(motion.centre, {1, 0, 0});
  check_near(motion.velocity, {2, 0, 0});
  CHECK(length(motion.spin) < 1e-12);
  CHECK(motion.stray == doctest::Approx(2));  // the one at rest
}

TEST_CASE("what holds nothing strays, and leaves the others their motion") {
  const Vector u{1, 0, 0}, v{1, 4, 3};
  for (const bool alone : {false, true}) {
    std::vector<Pin> pins = spinning(kCorners, {}, alone ? Vector{} : u, {});
    pins.push_back({{9, 9, 9}, v, 0});
    const PinMotion motion = motion_of(pins);
    check_near(motion.velocity, alone ? Vector{} : u);
    CHECK(length(motion.spin) < 1e-12);
    CHECK(motion.stray == doctest::Approx(alone ? length(v) : 5));
    const State s = held_by(pins);  // four free particles of 1 kg
    CHECK(stray_energy(motion, s) == doctest::Approx(2 * motion.stray * motion.stray));
  }
}

/// A substep of all free particles, halfway at x with `before` and `after` of x.
template <class Before, class After>
void move_free(State& s, const Before& before, const After& after) {
  s.solved = s.position;
  s.next_velocity = s.velocity;
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    const Vector x = s.position[slot], travel = kStep * before(x);
    s.position.set(slot, x - 0.5 * travel);
    s.solved.set(slot, x + 0.5 * travel);
    s.velocity.set(slot, before(x));
    s.next_velocity.set(slot, after(x));
  }
}

TEST_CASE("pins that carry a body along do the work of what they add to its momentum") {
  const Vector before{1, 2, 3}, u{2, 2, 2.5}, after{3, 2, 2};
  State s = held_by(spinning(kCorners, {}, u, {}));
  s.gravity = {};
  move_free(
      s, [&](Vector) { return before; }, [&](Vector) { return after; });
  const double mass = 4;
  const double work = work_of(motion_of_pins(s, kStep), s, kStep);
  CHECK(work == doctest::Approx(mass * dot(u, after - before)).epsilon(1e-12));
  // u is halfway between the two.
  const double gained = mass / 2 * (dot(after, after) - dot(before, before));
  CHECK(work == doctest::Approx(gained).epsilon(1e-12));
}

TEST_CASE("pins that hold a weight up do the work of lifting it") {
  const Vector u{5, 2, 0};
  State s = held_by(spinning(kCorners, {}, u, {}));
  s.gravity = {0, -10, 0};
  move_free(
      s, [&](Vector) { return u; }, [&](Vector) { return u; });
  const double weight = 4 * 10;
  CHECK(work_of(motion_of_pins(s, kStep), s, kStep) ==
        doctest::Approx(weight * u.y * kStep).epsilon(1e-12));
  s.force = kernels::Vectors(s.model->slots());
  for (double& f : s.force.y) f = 10;
  CHECK(std::abs(work_of(motion_of_pins(s, kStep), s, kStep)) < 1e-12);
}

TEST_CASE("pins that spin a body up do the work of what they add to its angular momentum") {
  const Vector axis{0, 0, 1};
  const double before = 2, spin = 3, after = 4;
  State s = held_by(spinning(kCorners, {}, {}, spin * axis));
  s.gravity = {};
  double inertia = 0;
  for (std::size_t slot = 0; slot < s.model->slots(); ++slot) {
    if (s.model->inverse_mass[slot] == 0) continue;
    const Vector x = s.position[slot];
    inertia += x.x * x.x + x.y * x.y;
  }
  move_free(
      s, [&](Vector x) { return before * cross(axis, x); },
      [&](Vector x) { return after * cross(axis, x); });
  CHECK(work_of(motion_of_pins(s, kStep), s, kStep) ==
        doctest::Approx(inertia * spin * (after - before)).epsilon(1e-7));
}

// -------------------------------------------------------------------------------
// StepReport::pin_work

/// Ten links of 0.1 m and 0.2 kg each, straight down from the origin: 2 kg.
SceneDescription plumb_line() {
  SceneDescription scene;
  for (std::uint32_t i = 0; i <= 10; ++i) {
    scene.positions.push_back({0, -0.1 * i, 0});
    scene.masses.push_back(0.2);
    if (i > 0) scene.constraints.push_back({i - 1, i, 0.1});
  }
  scene.fixed = {0};
  return scene;
}

/// From 0 to 1 without a jerk.
double eased(double t) { return t < 1 ? t * t * (3 - 2 * t) : 1; }

struct Carried {
  double work = 0;         ///< of pins, J
  double gain = 0;         ///< of energy, J
  double most_beyond = 0;  ///< of energy beyond the work until then, J
};

/// Through two seconds; place(x, t) of a pin that began at x.
template <class Place>
Carried carry(const SceneDescription& scene, Cloth& cloth, double dt, const Place& place) {
  const double energy = cloth.energy().total();
  Carried carried;
  for (int frame = 1; frame * dt < 2; ++frame) {
    for (const std::uint32_t pin : scene.fixed) {
      REQUIRE(cloth.move_fixed(pin, place(scene.positions[pin], frame * dt)));
    }
    const StepReport report = step(cloth, dt);
    REQUIRE(report.status == Status::converged);
    carried.work += report.pin_work;
    carried.gain = cloth.energy().total() - energy;
    carried.most_beyond = std::max(carried.most_beyond, carried.gain - carried.work);
  }
  return carried;
}

const Settings kSolvers[] = {
    {.tolerance = 1e-5, .substeps = 1, .solver = Solver::yarn},
    {.tolerance = 1e-5, .substeps = 1, .solver = Solver::direct},
    {.tolerance = 1e-5, .substeps = 1, .solver = Solver::gauss_seidel},
    {.tolerance = 1e-5,
     .substeps = 1,
     .solver = Solver::gauss_seidel,
     .backend = Backend::reference},
    {.tolerance = 1e-5, .substeps = 4, .solver = Solver::yarn},
    {.tolerance = 1e-5, .substeps = 1, .solver = Solver::direct, .scheme = Scheme::rattle}};

std::string text(const Settings& settings) {
  return std::string(name(settings.solver)) + ", " + std::string(name(settings.scheme)) + ", " +
         std::string(name(settings.backend)) + ", " + std::to_string(settings.substeps);
}

/// A pin changes its speed at the beginning of each step, by d: on M it does work M d (u + d), of
/// which the motion has M d (u + d / 2). The rest for 1 kg, of a pin that is eased over 1 m.
double lost_in_jerks() {
  double sum = 0, last = 0;
  for (int frame = 1; frame <= 101; ++frame) {
    const double speed = (eased(0.01 * frame) - eased(0.01 * (frame - 1))) / 0.01;
    sum += 0.5 * (speed - last) * (speed - last);
    last = speed;
  }
  return sum;
}

TEST_CASE("who lifts a hanging line does the work of its weight, and who lowers it gets it back") {
  constexpr double kMass = 2, kWeight = 10 * kMass;
  const double lost = kMass * 0.5 * 0.5 * lost_in_jerks();
  for (const Settings& settings : kSolvers) {
    for (const double height : {0.5, -0.5}) {
      CAPTURE(text(settings));
      CAPTURE(height);
      const SceneDescription scene = plumb_line();
      Cloth cloth = cloth_of(scene, settings);
      run(cloth, 0.01, 5);
      const auto lift = [&](Vec3 x, double t) { return Vec3{x.x, x.y + height * eased(t), x.z}; };
      const Carried carried = carry(scene, cloth, 0.01, lift);
      CHECK(carried.gain == doctest::Approx(kWeight * height).epsilon(1e-6));
      CHECK(carried.work == doctest::Approx(kWeight * height + lost).epsilon(1e-6));
      // What sinks at 0.75 m/s seems to have g h / 2 more (Cloth::velocity).
      CHECK(carried.most_beyond < kMass * 0.75 * 10 * 0.01 / 2);
    }
  }
}

Vec3 swung(Vec3 x, double t) {
  const double turn = 2 * eased(t), z = x.z - 0.5;
  return {z * std::sin(turn), 0.5 * eased(t), 0.5 + z * std::cos(turn) + 0.3 * eased(t)};
}

TEST_CASE("a cloth gains no more energy than the pins that turn and carry it bring") {
  const SceneDescription scene = scene_of("hang", 9);
  for (const Settings& settings : kSolvers) {
    CAPTURE(text(settings));
    Cloth cloth = cloth_of(scene, settings);
    const Carried carried = carry(scene, cloth, 0.01, swung);
    CHECK(carried.work > 3);
    CHECK(carried.gain > 1);
    CHECK(carried.most_beyond < 1e-3);
  }
}

TEST_CASE("what pins that turn and carry a cloth bring is what it gains in short steps") {
  const SceneDescription scene = scene_of("hang", 9);
  const auto share = [&](double dt) {
    Cloth cloth = cloth_of(
        scene,
        {.tolerance = 1e-6, .substeps = 1, .solver = Solver::direct, .scheme = Scheme::rattle});
    const Carried carried = carry(scene, cloth, dt, swung);
    return carried.gain / carried.work;
  };
  CHECK(share(0.004) < 0.9);
  CHECK(share(0.0005) == doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("pins that rest or are placed do no work, nor do those of a step that is refused") {
  Cloth cloth = cloth_of(plumb_line(), {});
  CHECK(step(cloth, 0.01).pin_work == 0);
  REQUIRE(cloth.move_fixed(0, {0, 0, 0}));
  CHECK(step(cloth, 0.01).pin_work == 0);
  REQUIRE(cloth.move_fixed(0, {0, 0.001, 0}));
  CHECK(step(cloth, 1e200).pin_work == 0);
  REQUIRE(cloth.move_fixed(0, {0, 0.002, 0}));
  CHECK(step(cloth, 0.01).pin_work > 0);
  REQUIRE(cloth.place_fixed(0, {0, 1, 0}));
  CHECK(step(cloth, 0.01).pin_work == 0);
}

}  // namespace
}  // namespace weft::test::engine_step_pin_work
