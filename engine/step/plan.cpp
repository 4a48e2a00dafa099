#include "engine/step/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/measure/state_measure.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/solvers/yarn/yarn_solver.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/step/air.h"
#include "engine/step/motion.h"
#include "engine/step/reporting.h"
#include "engine/tuning.h"

namespace weft {
namespace {

/// The largest strain of rigid constraints, and by which springs become longer or shorter: these
/// need not have their lengths of rest.
double largest_change(const State& s) {
  const ConstraintStore& store = s.model->constraints;
  double most = 0;
  for (std::size_t c = 0; c < store.size(); ++c) {
    const auto length_in = [&](const kernels::Vectors& x) {
      return length(x[store.a[c]] - x[store.b[c]]) / store.rest_length[c];
    };
    const double change = store.compliance[c] == 0
                              ? strain_of(*s.model, s.solved, c)
                              : std::abs(length_in(s.solved) - length_in(s.position));
    most = std::max(most, change);
  }
  return most;
}

/// The strain after a step without constraints grows with the square of the step, so that the
/// motion wants
///
///     sqrt( strain / min(most, longest / n) )     n: particles of the constraint's yarn
///
/// substeps, the largest of all constraints. The turn of an edge swings all edges behind it on its
/// yarn: a yarn of many edges wants less.
double bend_after_motion(State& s, Team& team) {
  const tuning::Bend& may =
      s.settings.scheme == Scheme::rattle ? tuning::kRattleBend : tuning::kUsualBend;
  const auto share = [&](double strain, std::size_t particles_of_yarn) {
    return std::max(strain / may.most,
                    strain * static_cast<double>(particles_of_yarn) / may.longest);
  };
  if (s.laws) return share(largest_change(s), s.yarn ? s.yarn->longest() : 0);
  const auto x = s.solved.view();
  const std::size_t longest = s.yarn ? s.yarn->longest() : 0;
  const double most = share(s.measure->max_strain(x, team), longest);
  if (!s.yarn || s.yarn->longest_at().empty() || most <= 1) return most;
  const auto strains = s.measure->lanes().strains_of_chunks(x, team);
  double finer = share(s.measure->lanes().max_hub_strain(x), 0);
  for (std::size_t i = 0; i < strains.size(); ++i) {
    finer = std::max(finer, share(strains[i].largest, s.yarn->longest_at()[i]));
  }
  return finer;
}

/// The mass of free spheres that touch something where the step would lead; kg.
double heaviest_sphere(State& s) {
  const Model& model = *s.model;
  find_contacts(model, *s.kernels, s.solved.view(), s.contacts);
  double least = std::numeric_limits<double>::infinity();  // inverse mass
  const auto weigh = [&](std::uint32_t slot) {
    const double w = model.inverse_mass[slot];
    if (w > 0 && model.is_sphere[slot]) least = std::min(least, w);
  };
  for (std::uint32_t k = 0; k < s.contacts.count(); ++k) {
    weigh(s.contacts.sphere[k]);
    weigh(s.contacts.particle[k]);
  }
  return 1 / least;
}

/// The load over the length of what holds it, 1/m. With scheme rattle a sphere is none: its
/// substeps are as short already.
double load_per_metre(State& s) {
  const Unevenness& uneven = s.model->uneven;
  double most = uneven.ratio < tuning::kLeastLoad ? 0 : uneven.per_metre;
  const bool spheres_count = s.settings.scheme == Scheme::paper;
  if (spheres_count && s.model->heaviest_sphere * uneven.lightness >= tuning::kLeastLoad) {
    const double mass = heaviest_sphere(s);
    if (mass * uneven.lightness >= tuning::kLeastLoad)
      most = std::max(most, mass * uneven.lightness_per_metre);
  }
  return most;
}

/// A load that is `ratio` times as heavy as the lightest particles of what holds it pulls at these
/// with `ratio` times their weight. Across the pull they swing with the frequency w,
///
///     w^2 = ratio g / l,    l: the length of their constraints
///
/// and what turns a constraint in a substep moves them (w h)^2 times as far: beyond a few neither
/// Newton's method nor yarns find their way. So w h is to be 1 / kLoad at most. (The direct solver
/// keeps to the motion's substeps.)
double substeps_for_load(State& s, double dt) {
  if (!s.yarn) return 1;
  return tuning::kLoad * dt * std::sqrt(length(s.gravity) * load_per_metre(s));
}

/// A substep by yarns costs as much as some iterations besides its own: with fewer of them to each,
/// max_iterations would not bound the time of a step.
int most_substeps(const State& s) {
  if (!s.yarn) return tuning::kMostSubsteps;
  return std::clamp(s.settings.max_iterations / tuning::kLeastIterations, 1, tuning::kMostSubsteps);
}

int substeps_wanted(State& s, double dt, Team& team) {
  if (has_velocity_forces(*s.model)) find_velocity_forces(s, s.model->damping.motion, dt, team);
  predict(s, dt, team);
  const double bend = bend_after_motion(s, team);
  const double wanted = std::ceil(std::max(std::sqrt(bend), substeps_for_load(s, dt)));
  const int most = most_substeps(s);
  return wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
}

/// Whether that is known of the places that pins come to in this step.
bool is_in_vain(const State& s, double dt) {
  if (!s.small_steps || s.settings.iterations > 0) return false;
  return are_pins_too_far_apart(
      s.model->small_steps().load, s.settings.tolerance,
      [&](std::uint32_t slot) { return s.position[slot] + dt * s.velocity[slot]; });
}

void add(Plan& plan, const Attempt& attempt) { plan.attempts[plan.count++] = attempt; }

/// Nobody knows whether cloth at a pin that was put down pulls (keep_length, frame_plan.cpp).
void list_small_steps(const State& s, bool in_vain, Plan& plan) {
  const Settings& settings = s.settings;
  const bool chooses = settings.substeps == kAutomaticSubsteps && settings.iterations == 0;
  const bool can_tell = (s.placed || !s.displaced) && !in_vain;
  const int most = chooses && can_tell && s.model->has_laws() ? tuning::kMostDoublings : 0;
  for (int i = 0; i <= most; ++i) {
    add(plan, {.method = Method::by_small_steps,
               .scheme = settings.scheme,
               .doublings = i,
               .saves = false,
               .in_vain = in_vain});
  }
}

void list_attempts(const State& s, double dt, Plan& plan) {
  const Settings& settings = s.settings;
  const bool in_vain = is_in_vain(s, dt);
  if (settings.solver == Solver::small_steps) {
    list_small_steps(s, in_vain, plan);
  } else {
    const bool fixed = settings.iterations > 0;
    if (settings.scheme == Scheme::rattle) add(plan, {.scheme = Scheme::rattle});
    if (settings.solver == Solver::gauss_seidel || fixed) {
      if (plan.count == 0 || !fixed) add(plan, {});
    } else {
      const auto first = static_cast<int>(std::lround(s.refinement));
      for (int i = first; i <= tuning::kMostDoublings; ++i) add(plan, {.parts = 1 << i});
      if (s.stand_in != nullptr) add(plan, {.method = Method::by_stand_in});
      if (!in_vain) add(plan, {.method = Method::by_small_steps});
      add(plan, {.method = Method::by_sweeps});
    }
  }
  Attempt& last = plan.attempts[plan.count - 1];
  last.is_last = true;
  last.saves = false;
}

}  // namespace

Plan plan_for(State& s, double dt, StepReport& report, Team& team) {
  Plan plan;
  list_attempts(s, dt, plan);
  if (s.settings.solver == Solver::small_steps) return plan;
  if (s.settings.substeps != kAutomaticSubsteps) {
    plan.substeps = s.settings.substeps;
  } else {
    timed(report, Stage::predict, [&] { plan.substeps = substeps_wanted(s, dt, team); });
    plan.is_predicted = plan.substeps == 1;
  }
  return plan;
}

}  // namespace weft
