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
    const double time = model.seams.time[i];
    const bool is_closed = way <= tolerance && !model.seams.is_broken(i);
    states_[i] = {way / time, time, is_closed, states_[i].is_released};
  }
}

void Seams::tear(const Model& model) {
  states_.resize(model.seams.size());
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (model.seams.is_broken(i)) states_[i].is_closed = false;
  }
}

bool Seams::close(std::uint32_t seam, const Model& model, const kernels::Vectors& x,
                  double tolerance) {
  if (!states_[seam].is_released) return false;
  const double way = gap(model, seam, x);
  const double time = model.seams.time[seam];
  const bool is_closed = way <= tolerance && !model.seams.is_broken(seam);
  states_[seam] = {way / time, time, is_closed, false};
  return true;
}

SeamGaps measure_seams(const Model& model, std::span<const SeamState> states,
                       const kernels::Vectors& x) {
  SeamGaps gaps;
  double widest = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].is_released || model.seams.is_broken(i)) continue;
    if (states[i].is_closed) {
      gaps.largest = std::max(gaps.largest, gap(model, i, x));
      continue;
    }
    ++gaps.open;
    if (!states[i].is_late()) continue;
    ++gaps.late;
    const double way = gap(model, i, x);
    if (gaps.late == 1 || way > widest) gaps.worst_late = static_cast<std::uint32_t>(i);
    widest = std::max(widest, way);
  }
  return gaps;
}

}  // namespace weft
