/// The loop around all methods. One iteration is one sweep. However often directions are renewed,
/// the loop ends when an iteration along fresh directions corrects nothing: then every true error
/// is within tolerance, because n points along the connecting line.
#include "kernels/reference/relax.h"

#include "kernels/reference/anticipated.h"
#include "kernels/reference/direct.h"
#include "kernels/reference/masked.h"

namespace weft::reference {
namespace {

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

template <Directions kDirections, class Loop>
LoopResult run(Loop&& loop, const Method& method) {
  if (method.fixed_iterations > 0) return iterate_fixed(loop, kDirections, method.fixed_iterations);
  return iterate_to_tolerance(loop, kDirections, method.max_iterations);
}

template <Directions kDirections>
LoopResult relax(const Relaxation& r, const Topology& t, const ContactLists& c, const Workspace& w,
                 const Method& method) {
  const bool skip = method.skip && method.fixed_iterations == 0;
  if (method.anticipate && skip) {
    return run<kDirections>(AnticipatedLoop<true, kDirections>(r, t, c, w), method);
  }
  if (method.anticipate) {
    return run<kDirections>(AnticipatedLoop<false, kDirections>(r, t, c, w), method);
  }
  if (skip) return run<kDirections>(MaskedLoop<kDirections>(r, t, w), method);
  return run<kDirections>(DirectLoop<kDirections>(r), method);
}

}  // namespace

LoopResult relax_positions(const Relaxation& r, const Topology& t, const ContactLists& c,
                           const Workspace& w, const Method& method) {
  if (method.frozen_directions) return relax<Directions::frozen>(r, t, c, w, method);
  return relax<Directions::each>(r, t, c, w, method);
}

LoopResult relax_velocities(const Relaxation& r, const Topology& t, const ContactLists& c,
                            const Workspace& w, const Method& method) {
  return relax<Directions::constant>(r, t, c, w, method);
}

void renew_all_directions(const Relaxation& r, VectorsView positions) {
  Relaxation at_positions = r;
  at_positions.x = positions;
  for (std::size_t c = 0; c < r.count; ++c) renew_direction(at_positions, c);
}

}  // namespace weft::reference
