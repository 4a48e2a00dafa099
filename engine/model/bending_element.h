/// A bending element of a model, as kernels in double have it.
#pragma once

#include "engine/model/model.h"
#include "kernels/reference/bending.h"

namespace weft {

/// Without the particle beside (bending_arms.h).
inline reference::BendingElement element_of(const BendingStore& s, std::size_t i) {
  return {s.slots[i], s.weights[i], s.rest[i], s.compliance[i], {}, s.fold[i]};
}

}  // namespace weft
