/// A bending element of a model, as kernels in double have it.
#pragma once

#include <cstddef>
#include <span>

#include "engine/model/model.h"
#include "kernels/reference/bending.h"

namespace weft {

/// Without the particle beside (bending_arms.h).
inline reference::BendingElement element_of(const BendingStore& s, std::size_t i) {
  return {s.slots[i], s.weights[i], s.rest[i], s.compliance[i], {}, s.fold[i], s.yields(i)};
}

/// How a hinge that yields rests now.
struct Crease {
  double angle = 0;   // rad, between its faces
  double worked = 0;  // the sum of all that it has yielded by, in yields
};

/// creases: of all elements of the description; none where no element yields.
inline reference::BendingElement element_of(const BendingStore& s, std::size_t i,
                                            std::span<const Crease> creases) {
  reference::BendingElement e = element_of(s, i);
  if (e.yields) e.fold = reference::fold_of(s.yielding[i].arm, creases[s.described[i]].angle);
  return e;
}

}  // namespace weft
