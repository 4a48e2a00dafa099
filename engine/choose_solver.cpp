#include "engine/choose_solver.h"

namespace weft {

/// Measured (perf/README.md): yarns are the fastest at every size and tolerance, on sheets that
/// hang, are stretched between corners, or carry spheres. The reference backend, and a count of
/// iterations in place of a tolerance, are about the paper's loop. Yarns know no directions but the
/// present ones: scheme rattle wants the direct solver.
void choose_solver(Settings& settings) {
  const bool paper = settings.backend == Backend::reference || settings.iterations > 0;
  if (settings.solver == Solver::automatic) {
    const Solver exact = settings.scheme == Scheme::rattle ? Solver::direct : Solver::yarn;
    settings.solver = paper ? Solver::gauss_seidel : exact;
  }
  if (paper && settings.substeps == kAutomaticSubsteps) settings.substeps = 1;
}

}  // namespace weft
