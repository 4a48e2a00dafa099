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

/// Yarns have nothing to solve exactly where all is ropes.
bool is_a_net_of_ropes(const ConstraintStore& constraints) {
  constexpr std::size_t kRopesEach = 9;  // to a distance constraint
  const std::size_t ropes = constraints.size() - constraints.bilateral;
  return ropes > kRopesEach * constraints.bilateral;
}

}  // namespace

/// Measured (perf/README.md): yarns are the fastest at every size and tolerance, by either scheme,
/// on sheets that hang, are stretched between corners, or carry spheres. (With rattle a sphere of 1
/// kg on 20 x 20 particles takes 0.37 ms a frame, by the direct solver 3.1; one of 10 kg, caught by
/// a taut sheet, 8.6 and 260.) Of nets of ropes sweeps are: 40 x 40, 1 %, 0.26 ms a frame, by
/// yarns 2.9; 0.1 % 1.4 and 2.5; by rattle 0.4 and 19. The reference backend, and a count of
/// iterations in place of a tolerance, are about the paper's loop.
void choose_solver(const Model& model, Settings& settings) {
  const bool paper = settings.backend == Backend::reference || settings.iterations > 0;
  if (settings.solver == Solver::automatic) {
    if (paper)
      settings.solver = Solver::gauss_seidel;
    else if (has_uneven_masses(model))
      settings.solver = Solver::direct;
    else
      settings.solver = is_a_net_of_ropes(model.constraints) ? Solver::gauss_seidel : Solver::yarn;
  }
  if (paper && settings.substeps == kAutomaticSubsteps) settings.substeps = 1;
}

}  // namespace weft
