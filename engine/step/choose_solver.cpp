#include "engine/step/choose_solver.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "engine/model/chains.h"
#include "engine/model/model.h"
#include "engine/solvers/direct/direct_bodies.h"
#include "engine/solvers/small_steps/linkage_layout.h"
#include "engine/step/sphere_paths.h"
#include "engine/tuning.h"

namespace weft {
namespace {

bool has_ropes(const ConstraintStore& constraints) {
  return constraints.size() > constraints.bilateral;
}

/// A sphere that touches nothing changes nothing.
std::vector<std::uint32_t> free_spheres_that_matter(const Model& model) {
  std::vector<std::uint32_t> spheres;
  std::ranges::copy_if(model.spheres, std::back_inserter(spheres), [&](std::uint32_t slot) {
    return model.inverse_mass[slot] > 0 && may_come_to_cloth(model, slot);
  });
  return spheres;
}

bool are_light(const Model& model, const std::vector<std::uint32_t>& spheres) {
  const double most = tuning::kLightSphere / model.uneven.lightness;
  return std::ranges::all_of(spheres, [&](std::uint32_t s) { return model.mass[s] <= most; });
}

/// Sweeps crawl where masses are unequal, and under heavy spheres. Tighter tolerances take more
/// substeps than an exact solution costs. But a linkage is solved at once.
bool takes_small_steps(const Model& model, const Settings& settings,
                       const std::vector<std::uint32_t>& spheres) {
  if (settings.scheme != Scheme::automatic || settings.velocity_correction) return false;
  if (!are_light(model, spheres)) return false;
  if (closes_few_loops(model) && is_held_twice(model)) return false;
  return is_linkage(model) ||
         (model.constraints.size() > 0 && settings.tolerance >= tuning::kLeastTolerance &&
          model.uneven.ratio <= tuning::kNearlyEqualMasses);
}

/// Sweeps leave a rope too long by up to the tolerance, and so do yarns, to which ropes are single
/// constraints; the direct solver has all lengths of a chain right at once. Its bodies are few.
Solver solver_for(const Model& model, const Settings& settings) {
  const std::vector<std::uint32_t> spheres = free_spheres_that_matter(model);
  if (takes_small_steps(model, settings, spheres)) return Solver::small_steps;
  const bool few_bodies = spheres.size() <= tuning::kMostBodies;
  const bool ropes = closes_few_loops(model) && has_ropes(model.constraints);
  return ropes && few_bodies ? Solver::direct : Solver::yarn;
}

/// Small steps alone solve triangles of fabric, bending, anchors, seams and sliders, and are chosen
/// for springs unless another scheme is asked for.
bool is_for_small_steps(const Model& model, const Settings& settings) {
  const bool springs = model.constraints.has_springs() && settings.scheme == Scheme::automatic;
  return springs || model.may_tear || model.self_contact.on || !model.pressures.empty() ||
         model.membrane.size() > 0 || model.bending.size() > 0 || model.anchors.size() > 0 ||
         model.seams.size() > 0 || model.sliders.size() > 0 || is_of_small_steps(settings.scheme);
}

}  // namespace

bool is_of_small_steps(Scheme scheme) {
  return scheme == Scheme::implicit || scheme == Scheme::bdf2;
}

Scheme scheme_of(const Settings& settings) {
  if (settings.scheme != Scheme::automatic) return settings.scheme;
  return settings.solver == Solver::small_steps ? Scheme::bdf2 : Scheme::paper;
}

/// The reference backend, and a count of iterations in place of a tolerance, are about the paper's
/// loop. The motion is held by small steps alone, at any tolerance.
void choose_solver(const Model& model, Settings& settings) {
  const bool fixed = settings.iterations > 0;
  const bool paper = settings.backend == Backend::reference || fixed;
  if (settings.solver == Solver::automatic) {
    if (is_for_small_steps(model, settings) || settings.motion_tolerance > 0)
      settings.solver = Solver::small_steps;
    else
      settings.solver = paper ? Solver::gauss_seidel : solver_for(model, settings);
  }
  const bool one = fixed || (paper && settings.solver != Solver::small_steps);
  if (settings.substeps == kAutomaticSubsteps && one) settings.substeps = 1;
}

}  // namespace weft
