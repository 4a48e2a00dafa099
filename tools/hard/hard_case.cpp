#include "tools/hard/hard_case.h"

#include <fmt/format.h>

#include "tools/enumerators.h"

namespace weft::tools::hard {
namespace {

/// Not every solver goes with every scheme.
bool is_offered(const Method& method) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}};
  scene.masses = {1};
  const auto model = build_model(scene);
  return static_cast<bool>(Cloth::create(model.value(), Setup{method}.settings(0.01)));
}

Outcome outcome_of(const Observed& observed, double energy_allowed) {
  Outcome outcome;
  outcome.detail = text(observed);
  outcome.ms_per_step = observed.ms_per_step();
  if (!observed.refusal.empty()) outcome.failure = observed.refusal;
  if (!observed.finite) outcome.failure = "a state that is not finite";
  if (observed.energy_gain > energy_allowed) {
    outcome.failure =
        fmt::format("{:.3g} J gained, {:.3g} J allowed", observed.energy_gain, energy_allowed);
  }
  return outcome;
}

}  // namespace

std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (const Scheme scheme : enumerators<Scheme>()) {
    for (const Solver solver : enumerators<Solver>()) {
      if (is_offered({solver, scheme})) methods.push_back({solver, scheme});
    }
  }
  return methods;
}

std::string label(const Method& method) {
  std::string label(name(method.solver));
  if (method.scheme != Scheme::paper) label += fmt::format("+{}", name(method.scheme));
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

bool not_by_relaxation(const Method& method) { return method.solver != Solver::gauss_seidel; }

bool by_yarns(const Method& method) {
  const bool yarns = method.solver == Solver::yarn || method.solver == Solver::automatic;
  return yarns && method.scheme == Scheme::paper;
}

double energy_of_the_catch(int size, double tolerance, double dt) {
  const double spacing = 1.0 / (size - 1), fall = 10 * dt * dt / 2;
  const double error = tolerance * spacing + fall * fall / (2 * spacing);
  return (error / dt) * (error / dt) / 2;
}

Outcome strain_outcome(const Trial& trial, double energy_allowed) {
  return strain_outcome(observe(trial), energy_allowed);
}

Outcome strain_outcome(const Observed& observed, double energy_allowed) {
  Outcome outcome = outcome_of(observed, energy_allowed);
  outcome.figure = observed.max_strain;
  if (observed.missed > 0 && outcome.failure.empty()) {
    outcome.failure =
        fmt::format("{} of {} steps did not converge", observed.missed, observed.steps);
  }
  if (observed.false_claims > 0) outcome.failure = "a report that is not true";
  return outcome;
}

Outcome honesty_outcome(const Trial& trial, double energy_allowed) {
  return honesty_outcome(observe(trial), energy_allowed);
}

Outcome honesty_outcome(const Observed& observed, double energy_allowed) {
  Outcome outcome = outcome_of(observed, energy_allowed);
  outcome.figure = observed.false_claims;
  return outcome;
}

}  // namespace weft::tools::hard
