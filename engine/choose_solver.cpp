#include "engine/choose_solver.h"

#include <algorithm>
#include <limits>

#include "engine/model.h"

namespace weft {
namespace {

/// Between free particles with constraints, joined or not; beyond it the float lanes of the yarns
/// lose sight of light ones (a chain under 10^4 times its particles' mass converges, under 10^5 it
/// does not).
constexpr double kMostUneven = 1e4;

bool has_uneven_masses(const Model& model) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const auto* ends : {&model.constraints.a, &model.constraints.b}) {
    for (const std::uint32_t slot : *ends) {
      const double w = model.inverse_mass[slot];
      if (w == 0) continue;
      least = std::min(least, w);
      most = std::max(most, w);
    }
  }
  return most > kMostUneven * least;
}

}  // namespace

/// Measured (perf/README.md): yarns are the fastest at every size and tolerance, by either scheme,
/// on sheets that hang, are stretched between corners, or carry spheres. A heavy sphere that a taut
/// sheet catches in a rattle step is one impact too many for their velocities (weft hard,
/// sphere_drop_10_kg_taut). The reference backend, and a count of iterations in place of a
/// tolerance, are about the paper's loop.
void choose_solver(const Model& model, Settings& settings) {
  const bool paper = settings.backend == Backend::reference || settings.iterations > 0;
  if (settings.solver == Solver::automatic) {
    const bool impacts = settings.scheme == Scheme::rattle && model.has_contacts();
    const bool exact = impacts || has_uneven_masses(model);
    settings.solver = paper ? Solver::gauss_seidel : exact ? Solver::direct : Solver::yarn;
  }
  if (paper && settings.substeps == kAutomaticSubsteps) settings.substeps = 1;
}

}  // namespace weft
