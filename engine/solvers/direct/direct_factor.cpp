#include "engine/solvers/direct/direct_factor.h"

namespace weft {

DirectFactor::DirectFactor(const DirectLayout& layout, const simd::Table& kernels)
    : layout_(layout), factor_(layout.fronts, kernels) {
  for (const DirectFront& front : layout.fronts.fronts) {
    for (std::size_t c = 0; c < front.count; ++c)
      factor_.least(front, c) = kLeastPivot * layout.diagonal[front.first + c];
  }
}

}  // namespace weft
