#include "kernels/reference/relax.h"

#include "kernels/reference/anticipated.h"
#include "kernels/reference/masked.h"
#include "kernels/reference/original.h"
#include "kernels/reference/previewed.h"

namespace weft::reference {
namespace {

template <Directions kDirections, class Loop>
LoopResult run(Loop&& loop, const Method& method) {
  return kernels::iterate(loop, kDirections, method.limits);
}

template <bool kSkip, Directions kDirections>
LoopResult anticipate(const Relaxation& r, const Topology& t, const ContactLists& c,
                      const Workspace& w, const Method& method) {
  if (c.first != nullptr) {
    return run<kDirections>(AnticipatedLoop<kSkip, kDirections, true>(r, t, c, w), method);
  }
  return run<kDirections>(AnticipatedLoop<kSkip, kDirections, false>(r, t, c, w), method);
}

template <Directions kDirections>
LoopResult relax(const Relaxation& r, const Topology& t, const ContactLists& c, const Workspace& w,
                 const Method& method) {
  const bool skip = method.skip && method.limits.fixed_iterations == 0;
  if (method.anticipate && skip) return anticipate<true, kDirections>(r, t, c, w, method);
  if (method.anticipate) return anticipate<false, kDirections>(r, t, c, w, method);
  if (skip) return run<kDirections>(MaskedLoop<kDirections>(r, t, w), method);
  return run<kDirections>(OriginalLoop<kDirections>(r), method);
}

}  // namespace

LoopResult relax_positions(const Relaxation& r, const Topology& t, const ContactLists& c,
                           const Workspace& w, const Method& method) {
  if (method.frozen_directions) return relax<Directions::frozen>(r, t, c, w, method);
  return relax<Directions::each>(r, t, c, w, method);
}

LoopResult relax_previewed_positions(const Relaxation& r, const Motion& motion, double h,
                                     const Method& method) {
  if (method.frozen_directions) {
    return run<Directions::frozen>(PreviewedLoop<Directions::frozen>(r, motion, h), method);
  }
  return run<Directions::each>(PreviewedLoop<Directions::each>(r, motion, h), method);
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
