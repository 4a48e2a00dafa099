/// What is no number: refused with the particle and the value, the state as it was.
#include <fmt/format.h>

#include <limits>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kSpoilt = 17;

/// spoil: returns what the cloth says. named: by what it says.
struct Input {
  const char* name;
  std::string (*spoil)(Cloth&);
  const char* named;
};

/// The figure is 0 where the cloth refuses, names what it refuses, keeps its state, and goes on
/// afterwards as one that was never asked.
Outcome run_spoilt(const Setup& setup, const Input& input) {
  const auto model = build_model(sheet("hang", 10));
  auto cloth = Cloth::create(model.value(), setup.settings(0.01));
  auto untouched = Cloth::create(model.value(), setup.settings(0.01));
  for (int k = 0; k < 10; ++k) {
    (void)cloth.value().step(0.01);
    (void)untouched.value().step(0.01);
  }
  const std::string said = input.spoil(cloth.value());
  Outcome outcome{0, said, {}, 0};
  if (cloth.value().state_hash() != untouched.value().state_hash()) {
    outcome.failure = "the state changed";
  }
  if (said.find(input.named) == std::string::npos) {
    outcome.failure = fmt::format("'{}' is not named", input.named);
  }
  (void)cloth.value().write_forces({});
  (void)cloth.value().step(0.01);
  (void)untouched.value().step(0.01);
  if (cloth.value().state_hash() != untouched.value().state_hash()) {
    outcome.failure = "the next step is another";
  }
  return outcome;
}

std::string answer(const Result<void>& written) { return written ? "taken" : written.error(); }

std::string nan_force(Cloth& cloth) {
  std::vector<Vec3> forces(cloth.particle_count());
  forces[kSpoilt] = {0, kNaN, 0};
  return answer(cloth.write_forces(forces));
}

std::string infinite_particle(Cloth& cloth) {
  std::vector<Vec3> positions = snapshot(cloth).positions;
  positions[kSpoilt] = {kInfinity, 0, 0};
  return answer(cloth.write_positions(positions));
}

std::string infinite_speed(Cloth& cloth) {
  std::vector<Vec3> velocities = snapshot(cloth).velocities;
  velocities[kSpoilt] = {0, 0, -kInfinity};
  return answer(cloth.write_velocities(velocities));
}

/// A number, but no step can be made with it.
std::string enormous_force(Cloth& cloth) {
  std::vector<Vec3> forces(cloth.particle_count());
  forces[kSpoilt] = {1e300, 0, 0};
  if (!cloth.write_forces(forces)) return "refused";
  const auto report = cloth.step(0.01);
  return fmt::format("{}: particle {}", name(report.value().status),
                     report.value().failed_particle);
}

std::string nan_step(Cloth& cloth) {
  const auto report = cloth.step(kNaN);
  return report ? "taken" : report.error();
}

}  // namespace

std::vector<Case> input_cases() {
  constexpr Input kInputs[] = {
      {"input_nan_force", nan_force, "forces[17]"},
      {"input_infinite_particle", infinite_particle, "positions[17]"},
      {"input_infinite_speed", infinite_speed, "velocities[17]"},
      {"input_enormous_force", enormous_force, "non_finite_input: particle 17"},
      {"input_dt_nan", nan_step, "dt"},
  };
  std::vector<Case> cases;
  for (const Input& input : kInputs) {
    cases.push_back({input.name, "0 if refused and the state kept", 0,
                     [input](const Setup& setup) { return run_spoilt(setup, input); }});
  }
  return cases;
}

}  // namespace weft::tools::hard
