#include "engine/step/choose_solver.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/direct/direct_bodies.h"

namespace weft {
namespace {

/// Ropes to a distance constraint; without any of these infinite.
double rope_share(const ConstraintStore& constraints) {
  const auto edges = static_cast<double>(constraints.bilateral);
  return static_cast<double>(constraints.size()) / edges - 1;
}

/// Those that an active constraint joins to another: what decides is about them alone.
std::size_t joined_particles(const Model& model) {
  std::vector<std::uint8_t> joined(model.slots());
  for (const auto* ends : {&model.constraints.a, &model.constraints.b}) {
    for (const std::uint32_t slot : *ends) joined[slot] = 1;
  }
  return static_cast<std::size_t>(std::ranges::count(joined, 1));
}

/// Few loops: chains, trees, bridges (of whose constraints a third close one; of a grid half do).
bool closes_few_loops(const Model& model) {
  constexpr double kMostLoops = 0.4;
  const auto all = static_cast<double>(model.constraints.size());
  return all - static_cast<double>(joined_particles(model)) <= kMostLoops * all;
}

/// Cords: ropes, and what they hold, that close few loops. Sweeps leave a rope too long, by up to
/// the tolerance, and what that is comes back as speed when it is corrected: 1.2 m/s of a rope of 2
/// m, at 1 % and 60 Hz. Where it may be more than kMost, which is what a particle falls in 1/140 s,
/// or where a load hangs on them, the direct solver has all lengths right at once, and takes as
/// long. (1 %, swings of 17 degrees, 3 s: 1 kg on 2 m gains by sweeps 0.5 J at 60 Hz and 10 J at
/// 240, by the direct solver 0.003 and 0.0002, of 0.9; 40 links under 80 kg 43 J in 7.8 ms a frame,
/// and 0.3 J in 0.4. Fine strands are for sweeps: 100 of 30 links of 1 cm 1.2 ms, 3.3 by the direct
/// solver.)
bool are_cords(const Model& model, const Settings& settings) {
  constexpr double kRopesEach = 1. / 3, kMost = 0.25e-3, kUnevenCords = 100;
  const ConstraintStore& constraints = model.constraints;
  if (rope_share(constraints) <= kRopesEach || !closes_few_loops(model)) return false;
  const double longest =
      constraints.size() > 0 ? *std::ranges::max_element(constraints.rest_length) : 0;
  return settings.tolerance * longest > kMost || model.uneven.ratio > kUnevenCords;
}

/// Free spheres that hang on cords are bodies beside the direct solver's matrix. Where it has too
/// many of them sweeps answer in each step, and the energy that these gain is taken out: 17 balls
/// on ropes of 2 m lose all of their swing in 5 s, a third of it by yarns.
bool are_too_many_bodies(const Model& model) {
  const auto is_free = [&](std::uint32_t slot) { return model.inverse_mass[slot] > 0; };
  const auto free = std::ranges::count_if(model.spheres, is_free);
  return static_cast<std::size_t>(free) > DirectBodies::kMostBodies;
}

/// Yarns have nothing to solve exactly where all is ropes. Where a seventh is edges sweeps may
/// still be ten times as fast (a net with every fourth row of edges), or sixteen times as slow (a
/// sheet that hangs, its diagonals and bending edges ropes, 4.8 to each edge): what decides is what
/// carries, not how many there are.
bool is_a_net_of_ropes(const Model& model) { return rope_share(model.constraints) > 9; }

/// Cloth, at a tolerance that small steps reach at less than it takes to solve exactly. What is not
/// for them: chains and bridges, where nothing is left to solve beside a yarn; spheres that fly,
/// and other masses that differ so much that sweeps crawl.
bool takes_small_steps(const Model& model, const Settings& settings) {
  constexpr double kLeastTolerance = 1e-3, kMostUneven = 100;
  if (is_of_small_steps(settings.scheme)) return true;
  return settings.scheme == Scheme::automatic && settings.backend == Backend::simd &&
         settings.iterations == 0 && !settings.velocity_correction &&
         settings.tolerance >= kLeastTolerance && model.uneven.ratio <= kMostUneven &&
         model.heaviest_sphere == 0 && !closes_few_loops(model);
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
  if (are_cords(model, settings)) return are_too_many_bodies(model) ? Solver::yarn : Solver::direct;
  const bool net = is_a_net_of_ropes(model);
  if (model.uneven.ratio <= kUneven) return net ? Solver::gauss_seidel : Solver::yarn;
  const bool may_follow = settings.substeps == kAutomaticSubsteps && !net;
  return may_follow && model.uneven.ratio < kMostUneven ? Solver::yarn : Solver::direct;
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
/// loop.
void choose_solver(const Model& model, Settings& settings) {
  const bool paper = settings.backend == Backend::reference || settings.iterations > 0;
  if (settings.solver == Solver::automatic) {
    if (takes_small_steps(model, settings))
      settings.solver = Solver::small_steps;
    else
      settings.solver = paper ? Solver::gauss_seidel : solver_for(model, settings);
  }
  const bool one = paper && settings.solver != Solver::small_steps;
  if (settings.substeps == kAutomaticSubsteps && (one || settings.iterations > 0))
    settings.substeps = 1;
}

}  // namespace weft
