/// What is done to a cloth from outside, and cloths that nothing holds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

/// A ribbon between two bars; one bar turns ten times and back. Twisted it is too short, and has to
/// say so; untwisted it must be whole again: the figure is the strain in the end.
Outcome run_twist(const Setup& setup) {
  constexpr double kTurns = 10;
  Trial trial{ribbon(41, 3, 0.05), setup.settings(kStrain)};
  trial.settings.max_iterations = 100'000;
  trial.steps = setup.steps(2400, 360);
  const std::uint32_t bar[] = {120, 121, 122};
  Vec3 start[3];
  for (int k = 0; k < 3; ++k) start[k] = trial.scene.positions[bar[k]];
  const double to_and_fro = 0.8 * trial.steps;
  trial.before_step = [=](Cloth& cloth, int step) {
    const double part = std::min(1.0, step / to_and_fro);
    const double angle = 2 * std::numbers::pi * kTurns * (1 - std::abs(2 * part - 1));
    Vec3 places[3];
    for (int k = 0; k < 3; ++k) {
      const double z = start[k].z - start[1].z;
      places[k] = {start[k].x - 0.1, z * std::sin(angle), start[1].z + z * std::cos(angle)};
    }
    (void)(step == 0 ? cloth.place_fixed(bar, places) : cloth.move_fixed(bar, places));
  };
  const Observed o = observe(trial);
  Outcome result = outcome(o.end_strain, o, kAnyEnergy);
  if (o.most_kinetic > 1e3) result.failure = "the ribbon exploded";
  return result;
}

/// Every 20 steps the whole pinned side is somewhere else.
Outcome run_teleports(const Setup& setup) {
  Trial trial{sheet("hang", 10), setup.settings(kStrain)};
  trial.steps = setup.steps(200, 60);
  const std::vector<Vec3> start = trial.scene.positions;
  trial.before_step = [start, fixed = trial.scene.fixed](Cloth& cloth, int step) {
    if (step % 20 != 10) return;
    const Vec3 jump{step % 40 == 10 ? 0.5 : 0, 0.3, -0.2};
    for (const std::uint32_t p : fixed) (void)cloth.place_fixed(p, start[p] + jump);
  };
  return strain_outcome(trial, kAnyEnergy);
}

/// A sheet that hangs from two corners is let go at one.
Outcome run_release(const Setup& setup) {
  Trial hanging{sheet("corners", 11), setup.settings(kStrain)};
  hanging.steps = setup.steps(200, 60);
  const Observed taut = observe(hanging);
  Trial trial = hanging;
  trial.scene.positions = taut.end.positions;
  trial.scene.velocities = taut.end.velocities;
  trial.scene.fixed.pop_back();
  return strain_outcome(trial, 1e-3);
}

/// A sheet between four corners: one of them is let go under tension, and the sheet caught again by
/// a particle of its side.
Outcome run_let_go(const Setup& setup) {
  constexpr int kSize = 11;
  Trial trial{sheet("four_pins", kSize), setup.settings(kStrain)};
  trial.steps = setup.steps(240, 60);
  const std::uint32_t corner = trial.scene.fixed.back();
  const std::uint32_t side = corner - kSize / 2;
  trial.scene.fixed.pop_back();  // what is not fixed in the end has an energy
  trial.before_step = [=, last = trial.steps](Cloth& cloth, int step) {
    if (step == 0) (void)cloth.change({.fix = {corner}});
    if (step == last / 3) (void)cloth.change({.release = {corner}});
    if (step == 2 * last / 3) (void)cloth.change({.fix = {side}});
  };
  return strain_outcome(trial, 1e-3);
}

/// A plane sheet hangs from two corners, `wider` times as far apart as in it. (Others than yarns
/// take tens of thousands of sweeps a step.)
Outcome run_banner(const Setup& setup, double wider) {
  Trial trial{sheet("banner", 20), setup.settings(kStrain)};
  trial.scene.positions[trial.scene.fixed.back()].z *= wider;
  trial.dt = 1.0 / 60;
  trial.steps = setup.steps(300, 60);
  return strain_outcome(trial, 1e-2);
}

/// A sphere falls onto a held sheet, so fast that one step takes it from above to below. The figure
/// is the number of steps after which some of the sheet had changed sides without a word of it.
Outcome run_crossing(const Setup& setup) {
  int silent = 0, steps = 0;
  for (const double speed : {5., 10., 20., 40., 60., 100., 300., 1000.}) {
    Trial trial{held_sheet_under_sphere(speed), setup.settings(kStrain)};
    trial.settings.max_iterations = 20'000;
    trial.steps = 12;
    Snapshot before{trial.scene.positions, trial.scene.velocities};
    const auto sphere = trial.scene.spheres.front();
    const auto model = build_model(trial.scene);
    auto cloth = Cloth::create(model.value(), trial.settings);
    for (int k = 0; k < trial.steps; ++k, ++steps) {
      const auto report = cloth.value().step(trial.dt);
      const Snapshot now = snapshot(cloth.value());
      silent += went_through(trial.scene, before, now, sphere) &&
                report.value().status != Status::passed_through;
      before = now;
    }
  }
  return {static_cast<double>(silent), fmt::format("{} steps at 5 to 1000 m/s", steps), {}, 0};
}

Vec3 centre_of_mass(const SceneDescription& scene, const Snapshot& state) {
  Vec3 sum;
  double mass = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    sum = sum + scene.masses[i] * state.positions[i];
    mass += scene.masses[i];
  }
  return (1 / mass) * sum;
}

/// In doubles: float lanes round off some of the momentum that they move.
Trial free_flight(const Setup& setup) {
  Trial trial{spinning_sheet(10), setup.settings(kStrain)};
  trial.settings.backend = Backend::reference;
  trial.steps = setup.steps(5'000, 1'000);
  return trial;
}

Outcome flight_outcome(double lost, const Observed& observed) {
  Outcome result = outcome(lost, observed, kAnyEnergy);
  if (observed.missed > 0 && result.failure.empty()) result.failure = "steps did not converge";
  return result;
}

Outcome run_momentum(const Setup& setup, Backend backend) {
  Trial trial = free_flight(setup);
  trial.settings.backend = backend;
  const Snapshot start{trial.scene.positions, trial.scene.velocities};
  const Observed o = observe(trial);
  const Vec3 before = momentum(trial.scene, start);
  const double lost = length(momentum(trial.scene, o.end) - before) / length(before);
  return flight_outcome(lost, o);
}

Outcome run_angular_momentum(const Setup& setup) {
  Trial trial = free_flight(setup);
  trial.dt = 0.0005;  // the guard of scheme rattle never falls back
  const Snapshot start{trial.scene.positions, trial.scene.velocities};
  const Observed o = observe(trial);
  const Vec3 before = angular_momentum(trial.scene, start, centre_of_mass(trial.scene, start));
  const Vec3 after = angular_momentum(trial.scene, o.end, centre_of_mass(trial.scene, o.end));
  return flight_outcome(length(after - before) / length(before), o);
}

/// Yarns and small steps are for lanes of floats.
bool runs_in_doubles(const Method& method) {
  return method.solver != Solver::yarn && method.solver != Solver::small_steps;
}

/// Scheme paper, which automatic is on the reference backend, does not: impulses along the
/// previewed directions turn a little against the positions that they lead to.
bool keeps_angular_momentum(const Method& method) {
  return method.scheme == Scheme::rattle && runs_in_doubles(method);
}

/// A free sheet that spins fast enough to tear one that cannot hold its length.
Outcome run_spin(const Setup& setup) {
  Trial trial{spinning_sheet(20), setup.settings(kStrain)};
  for (Vec3& v : trial.scene.velocities) v = 5 * v;
  trial.steps = setup.steps(500, 100);
  return strain_outcome(
      trial, 1e-3 * kinetic_energy(trial.scene, {trial.scene.positions, trial.scene.velocities}));
}

/// By the strain that is tolerated, and by nothing else.
bool hangs_taut(const Method& method) {
  return by_yarns(method) || method.solver == Solver::small_steps;
}

/// Those of small steps are floats, rounded in each substep.
bool velocities_in_doubles(const Method& method) {
  return method.solver != Solver::small_steps && label(method) != "auto";
}

}  // namespace

std::vector<Case> motion_cases() {
  return {
      {"twist_ten_turns", "strain in the end", kStrain, run_twist},
      {"pins_teleport", "max strain", kStrain, run_teleports},
      {"pin_released", "max strain", kStrain, run_release},
      {"pin_released_under_tension", "max strain", kStrain, run_let_go, hangs_taut},
      {"banner", "max strain", kStrain, [](const Setup& setup) { return run_banner(setup, 1); },
       hangs_taut},
      {"banner_too_narrow", "max strain", kStrain,
       [](const Setup& setup) { return run_banner(setup, 1 + 0.7 * kStrain); }, hangs_taut},
      {"sphere_crosses", "unreported crossings", 0, run_crossing},
      {"free_flight", "momentum lost, relative", 1e-9,
       [](const Setup& setup) { return run_momentum(setup, Backend::reference); }, runs_in_doubles},
      {"free_flight_in_lanes", "momentum lost, relative, in float lanes", 1e-7,
       [](const Setup& setup) { return run_momentum(setup, Backend::simd); },
       velocities_in_doubles},
      {"free_flight_by_small_steps", "momentum lost, relative, in float lanes", 1e-4,
       [](const Setup& setup) { return run_momentum(setup, Backend::simd); },
       [](const Method& method) { return !velocities_in_doubles(method); }},
      {"free_flight_angular", "angular momentum lost, relative", 1e-9, run_angular_momentum,
       keeps_angular_momentum},
      {"spinning_sheet", "max strain", kStrain, run_spin},
  };
}

}  // namespace weft::tools::hard
