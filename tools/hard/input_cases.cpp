/// What is no number: refused with the particle and the value, the state as it was.
#include <fmt/format.h>

#include <functional>
#include <limits>

#include "tools/hard/scenes.h"
#include "tools/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kSpoilt = 17;

/// The figure is 0 where the cloth refuses, names the particle, keeps its state, and goes on
/// afterwards as one that was never asked.
Outcome run_spoilt(const Setup& setup, const std::function<std::string(Cloth&)>& spoil) {
  const auto model = build_model(sheet("hang", 10));
  auto cloth = Cloth::create(model.value(), setup.settings(0.01));
  auto untouched = Cloth::create(model.value(), setup.settings(0.01));
  for (int k = 0; k < 10; ++k) {
    (void)cloth.value().step(0.01);
    (void)untouched.value().step(0.01);
  }
  const std::string said = spoil(cloth.value());
  Outcome outcome{0, said, {}, 0};
  if (cloth.value().state_hash() != untouched.value().state_hash()) {
    outcome.failure = "the state changed";
  }
  if (said.find(std::to_string(kSpoilt)) == std::string::npos) {
    outcome.failure = "the particle is not named";
  }
  (void)cloth.value().write_forces({});
  (void)cloth.value().step(0.01);
  (void)untouched.value().step(0.01);
  if (cloth.value().state_hash() != untouched.value().state_hash()) {
    outcome.failure = "the next step is another";
  }
  return outcome;
}

std::string nan_force(Cloth& cloth) {
  std::vector<Vec3> forces(cloth.particle_count());
  forces[kSpoilt] = {0, kNaN, 0};
  return cloth.write_forces(forces).error();
}

std::string infinite_particle(Cloth& cloth) {
  std::vector<Vec3> positions = snapshot(cloth).positions;
  positions[kSpoilt] = {kInfinity, 0, 0};
  return cloth.write_positions(positions).error();
}

std::string infinite_speed(Cloth& cloth) {
  std::vector<Vec3> velocities = snapshot(cloth).velocities;
  velocities[kSpoilt] = {0, 0, -kInfinity};
  return cloth.write_velocities(velocities).error();
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

std::string step_of(Cloth& cloth, double dt) {
  const auto report = cloth.step(dt);
  return report ? "taken" : fmt::format("{}: no particle {}", report.error(), kSpoilt);
}

}  // namespace

std::vector<Case> input_cases() {
  const std::pair<const char*, std::function<std::string(Cloth&)>> inputs[] = {
      {"input_nan_force", nan_force},
      {"input_infinite_particle", infinite_particle},
      {"input_infinite_speed", infinite_speed},
      {"input_enormous_force", enormous_force},
      {"input_dt_nan", [](Cloth& cloth) { return step_of(cloth, kNaN); }},
  };
  std::vector<Case> cases;
  for (const auto& [name, spoil] : inputs) {
    cases.push_back({name, "0 if refused and the state kept", 0,
                     [spoil = spoil](const Setup& setup) { return run_spoilt(setup, spoil); }});
  }
  return cases;
}

}  // namespace weft::tools::hard
