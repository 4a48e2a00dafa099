#include "engine/choose_solver.h"

#include "engine/model.h"

namespace weft {
namespace {

/// Yarns have nothing to solve exactly where all is ropes. Where a seventh is edges sweeps may
/// still be ten times as fast (a net with every fourth row of edges), or sixteen times as slow (a
/// sheet that hangs, its diagonals and bending edges ropes, 4.8 to each edge): what decides is what
/// carries, not how many there are.
bool is_a_net_of_ropes(const ConstraintStore& constraints) {
  constexpr std::size_t kRopesEach = 9;  // to a distance constraint
  const std::size_t ropes = constraints.size() - constraints.bilateral;
  return ropes > kRopesEach * constraints.bilateral;
}

/// Measured (perf/README.md): yarns are the fastest at every size and tolerance, by either scheme,
/// on sheets that hang, are stretched between corners, or carry spheres. (With rattle a sphere of 1
/// kg on 20 x 20 particles takes 0.37 ms a frame, by the direct solver 3.1; one of 10 kg, caught by
/// a taut sheet, 8.6 and 260.) Of nets of ropes sweeps are: 40 x 40, 1 %, 0.26 ms a frame, by
/// yarns 2.9; 0.1 % 1.4 and 2.5; by rattle 0.4 and 19.
///
/// Loads are for yarns, in automatic substeps (choose_substeps.cpp): 10^4 at a corner of 20 x 20, 1
/// %, 0.1 ms a frame, by the direct solver 63; 10^5 0.9, and hundreds. From kMostUneven on, in
/// substeps of a given number, and on nets of ropes the direct solver is quicker (a chain of 20,
/// 0.1 %, under 10^6 16 ms a frame, yarns 30).
Solver solver_for(const Model& model, const Settings& settings) {
  constexpr double kMostUneven = 1e6;
  const bool net = is_a_net_of_ropes(model.constraints);
  if (model.uneven.ratio <= kUneven) return net ? Solver::gauss_seidel : Solver::yarn;
  const bool may_follow = settings.substeps == kAutomaticSubsteps && !net;
  return may_follow && model.uneven.ratio < kMostUneven ? Solver::yarn : Solver::direct;
}

}  // namespace

/// The reference backend, and a count of iterations in place of a tolerance, are about the paper's
/// loop.
void choose_solver(const Model& model, Settings& settings) {
  const bool paper = settings.backend == Backend::reference || settings.iterations > 0;
  if (settings.solver == Solver::automatic)
    settings.solver = paper ? Solver::gauss_seidel : solver_for(model, settings);
  if (paper && settings.substeps == kAutomaticSubsteps) settings.substeps = 1;
}

}  // namespace weft
