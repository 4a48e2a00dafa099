/// Masses that differ, and masses that are very small or large.
#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

/// Masses that differ by more than a hundred: one sweep to a substep does not find out in time.
bool not_by_small_steps(const Method& method) { return method.solver != Solver::small_steps; }
constexpr double kHeaviestBySmallSteps = 1;  // kg, of a sphere

/// Relaxations need tens of thousands of iterations in the step in which a sphere lands, and are
/// sometimes infeasible.
bool relaxes(const Method& method) { return method.solver == Solver::gauss_seidel; }
constexpr double kHeaviestByRelaxation = 1;  // kg, on a sheet that is not taut

constexpr double kChainStrain = 0.001;
constexpr double kDropStrain = 0.01;

/// Of what the whole chain gives off when it falls by its length.
constexpr double kChainGain = 1e-4;

double energy_of_the_fall(const SceneDescription& scene) {
  double mass = 0, way = 0;
  for (const double m : scene.masses) mass += m;
  for (const Constraint& c : scene.constraints) way += c.rest_length;
  return mass * length(scene.gravity) * way;
}

/// A chain of 1 kg particles swings down under a heavy end. One that stretches it by hundreds of
/// metres: extended position-based dynamics, 100 iterations, an end of 10^5 kg.
Outcome run_chain(const Setup& setup, double end_mass) {
  scenes::Options options;
  options.end_mass = end_mass;
  Trial trial{built_in("chain", options), setup.settings(kChainStrain)};
  trial.dt = 1.0 / 60;
  trial.steps = setup.steps(300, 60);
  return strain_outcome(trial, kChainGain * energy_of_the_fall(trial.scene));
}

/// More passes than one frame may cost, from here on.
constexpr int kMostByRelaxation = 3;

std::vector<Case> chain_cases() {
  std::vector<Case> cases;
  for (int power = 0; power <= 6; ++power) {
    Case chain;
    chain.name = fmt::format("chain_end_1e{}", power);
    chain.measures = "max strain";
    chain.bound = kChainStrain;
    chain.run = [power](const Setup& setup) { return run_chain(setup, std::pow(10, power)); };
    constexpr int kMostBySmallSteps = 2;
    if (power > kMostBySmallSteps) chain.claimed = not_by_small_steps;
    if (power > kMostByRelaxation) chain.claimed = not_by_relaxation;
    cases.push_back(chain);
  }
  return cases;
}

Trial drop(const Setup& setup, double sphere_mass, double slack) {
  scenes::Options options;
  options.size = setup.quick ? 10 : 20;
  options.sphere_mass = sphere_mass;
  options.slack = slack;
  Trial trial{built_in("sphere_drop", options), setup.settings(kDropStrain)};
  trial.steps = setup.steps(200, 45);  // it lands with the 24th
  return trial;
}

/// By every method. A heavier sphere may leave a step without an answer, after bounded work: it
/// must say so, and the sheet must hold. One that is taut can only stop a sphere by forces far
/// beyond its weight.
constexpr double heaviest_caught(double slack) { return slack > 0 ? 10 : 1; }
constexpr double kHeaviestCaughtByYarns = 100;

Outcome run_heaviest(const Setup& setup, double sphere_mass, double slack) {
  Trial trial = drop(setup, sphere_mass, slack);
  trial.settings.max_iterations = 20'000;
  trial.steps = setup.steps(80, 45);
  const Observed o = observe(trial);
  Outcome result = honesty_outcome(o, kAnyEnergy);
  if (o.max_strain > 1) result.failure = "the sheet does not hold";
  return result;
}

Case drop_case(std::string_view what, double mass, double slack) {
  Case drop_case;
  drop_case.name = fmt::format("sphere_{}_{:g}_kg{}", what, mass, slack > 0 ? "" : "_taut");
  return drop_case;
}

Case caught(std::string_view what, double mass, double slack) {
  Case caught = drop_case(what, mass, slack);
  caught.measures = "max strain";
  caught.bound = kDropStrain;
  caught.run = [=](const Setup& setup) {
    return strain_outcome(drop(setup, mass, slack), kAnyEnergy);
  };
  return caught;
}

Case too_heavy(double mass, double slack) {
  Case too_heavy = drop_case("drop", mass, slack);
  too_heavy.measures = "false reports";
  too_heavy.run = [=](const Setup& setup) { return run_heaviest(setup, mass, slack); };
  return too_heavy;
}

std::vector<Case> drop_cases() {
  std::vector<Case> cases;
  for (const double slack : {0.05, 0.0}) {
    for (const double mass : {1.0, 10.0, 100.0, 1000.0}) {
      const bool by_all = mass <= heaviest_caught(slack);
      cases.push_back(by_all ? caught("drop", mass, slack) : too_heavy(mass, slack));
      const bool too_heavy_to_relax = slack == 0 || mass > kHeaviestByRelaxation;
      cases.back().claimed = [=](const Method& method) {
        if (by_all && too_heavy_to_relax && relaxes(method)) return false;
        return mass <= kHeaviestBySmallSteps || not_by_small_steps(method);
      };
      if (by_all || mass > kHeaviestCaughtByYarns) continue;
      cases.push_back(caught("caught", mass, slack));
      cases.back().claimed = by_yarns;
    }
  }
  return cases;
}

/// The masses of a hanging sheet, all alike.
Outcome run_uniform(const Setup& setup, double mass) {
  constexpr int kSize = 10;
  Trial trial{sheet("hang", kSize), setup.settings(0.01)};
  for (double& m : trial.scene.masses) m = mass;
  trial.steps = setup.steps(200, 60);
  const double whole = mass * kSize * kSize;  // kg
  return strain_outcome(trial, whole * energy_of_the_catch(kSize, 0.01, trial.dt));
}

}  // namespace

std::vector<Case> mass_cases() {
  std::vector<Case> cases = chain_cases();
  for (const Case& drop : drop_cases()) cases.push_back(drop);
  for (const double mass : {1e-9, 1e9}) {
    Case uniform;
    uniform.name = fmt::format("masses_{:.0e}_kg", mass);
    uniform.measures = "max strain";
    uniform.bound = 0.01;
    uniform.run = [mass](const Setup& setup) { return run_uniform(setup, mass); };
    cases.push_back(uniform);
  }
  return cases;
}

}  // namespace weft::tools::hard
