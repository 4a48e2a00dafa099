#include "engine/step/seams.h"

#include <algorithm>

namespace weft {

namespace {

double gap(const Model& model, std::size_t i, const kernels::Vectors& x) {
  return length(x[model.seams.a[i]] - x[model.seams.b[i]]);
}

}  // namespace

void Seams::begin(const Model& model, const kernels::Vectors& x, double tolerance) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double way = gap(model, i, x);
    states_[i] = {way / model.seams.time[i], way <= tolerance};
  }
}

SeamGaps measure_seams(const Model& model, std::span<const SeamState> states,
                       const kernels::Vectors& x) {
  SeamGaps gaps;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].is_closed)
      gaps.largest = std::max(gaps.largest, gap(model, i, x));
    else
      ++gaps.open;
  }
  return gaps;
}

}  // namespace weft
