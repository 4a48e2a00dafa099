#include "tools/studies/hard/hard_case.h"

#include <fmt/format.h>

namespace weft::tools::hard {
namespace {

/// Why an outcome fails whatever its figure is; empty: it does not.
std::string failure_of(const Observed& observed, double energy_allowed) {
  if (!observed.refusal.empty()) return observed.refusal;
  if (observed.stopped) return fmt::format("it ended with step {}", observed.steps);
  if (!observed.finite) return "a state that is not finite";
  if (observed.false_claims > 0) return "a report that is not true";
  if (observed.energy_gain <= energy_allowed) return {};
  return fmt::format("{:.3g} J gained, {:.3g} J allowed", observed.energy_gain, energy_allowed);
}

}  // namespace

std::string label(const Method& method) {
  std::string label(name(method.solver));
  const bool plain = method.scheme == Scheme::paper || method.scheme == Scheme::automatic;
  if (!plain) label += fmt::format("+{}", name(method.scheme));
  return label;
}

Settings Setup::settings(double tolerance) const {
  Settings settings;
  settings.tolerance = tolerance;
  settings.solver = method.solver;
  settings.scheme = method.scheme;
  settings.threads = 1;
  return settings;
}

bool not_by_relaxation(const Method& method) {
  return method.solver != Solver::gauss_seidel && method.solver != Solver::small_steps;
}

bool by_yarns(const Method& method) {
  if (method.solver == Solver::automatic) return method.scheme == Scheme::automatic;
  return method.solver == Solver::yarn && method.scheme == Scheme::paper;
}

double energy_of_the_catch(int size, double tolerance, double dt) {
  const double spacing = 1.0 / (size - 1), fall = 10 * dt * dt / 2;
  const double error = tolerance * spacing + fall * fall / (2 * spacing);
  return (error / dt) * (error / dt) / 2;
}

Outcome outcome(double figure, const Observed& observed, double energy_allowed) {
  return {figure, text(observed), failure_of(observed, energy_allowed), observed.ms_per_step()};
}

Outcome strain_outcome(const Trial& trial, double energy_allowed) {
  return strain_outcome(observe(trial), energy_allowed);
}

Outcome gain_outcome(const Trial& trial) {
  const Observed observed = observe(trial);
  Outcome result = strain_outcome(observed, kAnyEnergy);
  result.figure = observed.energy_gain;
  return result;
}

Outcome strain_outcome(const Observed& observed, double energy_allowed) {
  Outcome result = outcome(observed.max_strain, observed, energy_allowed);
  if (observed.missed > 0 && result.failure.empty()) {
    result.failure =
        fmt::format("{} of {} steps did not converge", observed.missed, observed.steps);
  }
  return result;
}

Outcome honesty_outcome(const Trial& trial, double energy_allowed) {
  return honesty_outcome(observe(trial), energy_allowed);
}

Outcome honesty_outcome(const Observed& observed, double energy_allowed) {
  return outcome(observed.false_claims, observed, energy_allowed);
}

}  // namespace weft::tools::hard
