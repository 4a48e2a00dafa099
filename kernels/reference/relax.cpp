/// The loop around all methods. One iteration is one sweep; the directions are renewed
///   each:   before every iteration (paper 3.2, 4.1),
///   frozen: when an iteration found nothing left to correct along them (paper 4.4).
/// Either way the loop ends when an iteration along fresh directions corrects nothing: then every
/// true error is within tolerance, because n points along the connecting line.
#include "kernels/reference/relax.h"

#include "kernels/reference/anticipated.h"
#include "kernels/reference/direct.h"
#include "kernels/reference/masked.h"

namespace weft::reference {
namespace {

enum class Directions { each, frozen, constant };

void count(LoopResult& result, const Sweep& sweep) {
  ++result.iterations;
  result.visits += sweep.visits;
  result.corrections += sweep.corrections;
}

template <class Loop>
LoopResult iterate_to_tolerance(Loop& loop, Directions directions, int max_iterations) {
  LoopResult result;
  loop.renew();
  ++result.direction_updates;
  bool fresh = true;
  while (result.iterations < max_iterations) {
    const Sweep sweep = loop.sweep();
    count(result, sweep);
    const bool satisfied = sweep.corrections == 0;
    if (satisfied && (fresh || directions == Directions::constant)) {
      result.converged = true;
      break;
    }
    fresh = satisfied || directions == Directions::each;
    if (!fresh) continue;
    loop.renew();
    ++result.direction_updates;
  }
  loop.finish();
  return result;
}

template <class Loop>
LoopResult iterate_fixed(Loop& loop, Directions directions, int iterations) {
  LoopResult result;
  while (result.iterations < iterations) {
    if (result.iterations == 0 || directions == Directions::each) {
      loop.renew();
      ++result.direction_updates;
    }
    count(result, loop.sweep());
  }
  loop.finish();
  return result;
}

template <class Loop>
LoopResult run(Loop&& loop, Directions directions, const Method& method) {
  if (method.fixed_iterations > 0) {
    return iterate_fixed(loop, directions, method.fixed_iterations);
  }
  return iterate_to_tolerance(loop, directions, method.max_iterations);
}

template <bool kConstant>
LoopResult relax(const Relaxation& r, const Topology& t, const ContactLists& c, const Workspace& w,
                 const Method& method, Directions directions) {
  const bool skip = method.skip && method.fixed_iterations == 0;
  if (method.anticipate) {
    const auto scope = directions == Directions::each ? Push::later : Push::all;
    if (skip) return run(AnticipatedLoop<true, kConstant>(r, t, c, w, scope), directions, method);
    return run(AnticipatedLoop<false, kConstant>(r, t, c, w, scope), directions, method);
  }
  if (skip) return run(MaskedLoop<kConstant>(r, t, w), directions, method);
  return run(DirectLoop<kConstant>(r), directions, method);
}

}  // namespace

LoopResult relax_positions(const Relaxation& r, const Topology& t, const ContactLists& c,
                           const Workspace& w, const Method& method) {
  const auto directions = method.frozen_directions ? Directions::frozen : Directions::each;
  return relax<false>(r, t, c, w, method, directions);
}

LoopResult relax_velocities(const Relaxation& r, const Topology& t, const ContactLists& c,
                            const Workspace& w, const Method& method) {
  return relax<true>(r, t, c, w, method, Directions::constant);
}

void renew_all_directions(const Relaxation& r, VectorsView positions) {
  Relaxation at_positions = r;
  at_positions.x = positions;
  for (std::size_t c = 0; c < r.count; ++c) renew_direction(at_positions, c);
}

}  // namespace weft::reference
