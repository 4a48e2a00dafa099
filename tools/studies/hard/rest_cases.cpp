/// Cloth in air and at rest, at usual frame rates: what decays comes to rest, a flag flutters alike
/// at any of them, and what is put somewhere stays there.
#include <fmt/format.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kTolerance = 0.01;
constexpr double kFrame = 1. / 60;
constexpr double kMostSpeed = 1e-3;       // m/s, of what rests
constexpr double kMostPlacedSpeed = 0.1;  // m/s

bool chosen_by_default(const Method& method) { return label(method) == "auto"; }
bool by_small_steps_or_default(const Method& method) {
  return method.solver == Solver::small_steps || chosen_by_default(method);
}

double top_speed(const Snapshot& state) {
  double most = 0;
  for (const Vec3& v : state.velocities) most = std::max(most, length(v));
  return most;
}

double largest_way(const Snapshot& from, const Snapshot& to) {
  double most = 0;
  for (std::size_t i = 0; i < to.positions.size(); ++i)
    most = std::max(most, length(to.positions[i] - from.positions[i]));
  return most;
}

// Rest

SceneDescription sheet_of(const char* material, std::string_view name, int size) {
  scenes::Options options;
  options.size = size;
  options.material = find_material(material).value();
  return built_in(name, options);
}

SceneDescription sheet_of_ropes(int size) {
  scenes::Options options;
  options.size = size;
  options.ropes = options.diagonals = true;
  return built_in("corners", options);
}

/// What is fixed may come 2 cm away from where it is.
SceneDescription on_anchors(SceneDescription scene) {
  for (const std::uint32_t particle : scene.fixed) {
    scene.anchors.push_back(
        {.particle = particle, .point = scene.positions[particle], .max_distance = 0.02});
  }
  scene.fixed.clear();
  return scene;
}

/// The largest speed within half a second, of what is reported and of what positions show, after so
/// long that a swing of 1 m has less than a tenth of a millimetre left, and that a fold which is
/// nearly in balance has lost it (cotton at 30 Hz: after 12.5 s).
Outcome run_rest(const Setup& setup, const SceneDescription& scene, double rate, double decay) {
  const double seconds = 10 + 24 / decay;
  Trial trial{scene, setup.settings(kTolerance)};
  trial.scene.damping.motion = decay;
  trial.dt = 1 / rate;
  trial.steps = static_cast<int>(seconds * rate);
  const int watched = trial.steps - static_cast<int>(0.5 * rate);
  double most = 0;
  Snapshot before;
  trial.after_step = [&](const Cloth& cloth, int step) {
    Snapshot now = snapshot(cloth);
    if (step >= watched) most = std::max({most, top_speed(now), rate * largest_way(before, now)});
    if (step >= watched - 1) before = std::move(now);
  };
  Outcome result = strain_outcome(observe(trial), kAnyEnergy);
  result.figure = most;
  return result;
}

void add_rest(std::vector<Case>& cases) {
  const std::pair<const char*, SceneDescription> scenes[] = {
      {"ropes", sheet_of_ropes(11)},
      {"cotton", sheet_of("cotton", "corners", 11)},
      {"silk", sheet_of("silk", "corners", 11)},
      {"anchors", on_anchors(sheet_of("cotton", "hang", 11))},
      {"rigid_on_anchors", on_anchors(sheet("corners", 11))},
  };
  for (const auto& [name, scene] : scenes) {
    for (const double rate : {30., 60., 240.}) {
      if (rate == 30 && std::string_view(name) == "ropes") continue;  // tests/README.md says why
      for (const double decay : {0.3, 3.}) {
        cases.push_back(
            {fmt::format("rest_{}_{:g}_Hz_decay_{:g}", name, rate, decay), "m/s in the end",
             kMostSpeed,
             [=, scene = scene](const Setup& setup) { return run_rest(setup, scene, rate, decay); },
             chosen_by_default});
      }
    }
  }
}

// Wind

/// m/s, the root mean square of a flag of 1 x 1 m from its 2nd second on.
double speed_of_flag(const Setup& setup, const SceneDescription& scene, double rate,
                     Outcome& outcome) {
  Trial trial{scene, setup.settings(kTolerance)};
  trial.dt = 1 / rate;
  trial.steps = static_cast<int>(setup.steps(12, 8) * rate);
  double squares = 0, count = 0;
  trial.after_step = [&](const Cloth& cloth, int step) {
    if (step < 2 * rate) return;
    for (const Vec3& v : snapshot(cloth).velocities) {
      squares += length(v) * length(v);
      ++count;
    }
  };
  const Outcome of_run = strain_outcome(observe(trial), kAnyEnergy);
  outcome.failure += of_run.failure;
  outcome.ms_per_step = of_run.ms_per_step;
  return std::sqrt(squares / count);
}

Outcome run_wind(const Setup& setup, const char* material, double wind) {
  SceneDescription scene = sheet_of(material, "flag", 16);
  scene.air.wind = {wind, 0, 0.1 * wind};
  Outcome outcome;
  const double often = speed_of_flag(setup, scene, 240, outcome),
               seldom = speed_of_flag(setup, scene, 60, outcome);
  outcome.figure = std::abs(seldom / often - 1);
  outcome.detail = fmt::format("{:.3g} m/s at 60 Hz, {:.3g} m/s at 240 Hz", seldom, often);
  return outcome;
}

void add_wind(std::vector<Case>& cases) {
  for (const auto& [material, wind] : {std::pair{"cotton", 8.}, {"cotton", 16.}, {"silk", 8.}}) {
    cases.push_back({fmt::format("flag_of_{}_in_{:g}_m_per_s", material, wind),
                     "speed at 60 Hz and at 240 Hz, relative difference", 0.1,
                     [=](const Setup& setup) { return run_wind(setup, material, wind); },
                     chosen_by_default});
  }
}

// Pins that are put down elsewhere

Outcome run_placed(const Setup& setup, const SceneDescription& scene, double jump) {
  constexpr int kJump = 3;
  Trial trial{scene, setup.settings(kTolerance)};
  trial.dt = kFrame;
  trial.steps = setup.steps(60, 20);
  double speed = 0;
  trial.before_step = [&](Cloth& cloth, int step) {
    if (step != kJump) return;
    for (const std::uint32_t pin : scene.fixed)
      (void)cloth.place_fixed(pin, cloth.position(pin) + Vec3{0, jump, 0});
  };
  trial.after_step = [&](const Cloth& cloth, int step) {
    if (step == kJump) speed = top_speed(snapshot(cloth));
  };
  Outcome result = strain_outcome(observe(trial), kAnyEnergy);
  result.figure = speed;
  return result;
}

/// 1 m x 1 m that hangs still from its upper side.
SceneDescription curtain(SceneDescription scene) {
  for (Vec3& position : scene.positions) position = {0, -position.x, position.z};
  return scene;
}

void add_placed(std::vector<Case>& cases) {
  const std::pair<const char*, SceneDescription> scenes[] = {
      {"rigid", curtain(sheet("hang", 16))},
      {"cotton", curtain(sheet_of("cotton", "hang", 16))},
      {"silk", curtain(sheet_of("silk", "hang", 16))},
  };
  for (const auto& [name, scene] : scenes) {
    for (const double jump : {0.02, 0.1, 0.3}) {
      cases.push_back(
          {fmt::format("placed_{}_{:g}_m_higher", name, jump), "m/s after the frame",
           kMostPlacedSpeed,
           [=, scene = scene](const Setup& setup) { return run_placed(setup, scene, jump); },
           by_small_steps_or_default});
    }
  }
}

}  // namespace

std::vector<Case> rest_cases() {
  std::vector<Case> cases;
  add_rest(cases);
  add_wind(cases);
  add_placed(cases);
  return cases;
}

}  // namespace weft::tools::hard
