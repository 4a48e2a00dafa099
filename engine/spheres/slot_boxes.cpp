#include "engine/spheres/slot_boxes.h"

#include <limits>

#include "engine/bytes_of.h"
#include "kernels/runs.h"

namespace weft {
namespace {

/// Making boxes costs about what one or two spheres cost without. Three are the first that gain by
/// them, 2 to 10 % of a frame, but lose up to 6 % where they are near to all of a small sheet.
constexpr std::size_t kLeastSpheres = 3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void fill(kernels::Vectors& vectors, double value) {
  for (auto* axis : {&vectors.x, &vectors.y, &vectors.z}) std::ranges::fill(*axis, value);
}

}  // namespace

SlotBoxes::SlotBoxes(const Model& m) {
  if (m.spheres.size() < kLeastSpheres) return;
  const std::size_t groups = kernels::round_up(m.slots(), simd::kBoxed) / simd::kBoxed;
  const std::size_t count = kernels::round_up(groups, kernels::kLanes);
  low_.resize(count);
  high_.resize(count);
  near_.resize(count);
  reach_.resize(count);
  for (std::size_t slot = 0; slot < m.slots(); ++slot) {
    double& reach = reach_[slot / simd::kBoxed];
    reach = std::max(reach, m.radius[slot]);
  }
}

simd::Boxes SlotBoxes::boxes() {
  return {.low = low_.view(), .high = high_.view(), .reach = reach_.data(), .count = near_.size()};
}

void SlotBoxes::enclose(const Model& m, const simd::Table& kernels,
                        std::initializer_list<kernels::VectorsView> places) {
  if (near_.empty()) return;
  fill(low_, kInfinity);
  fill(high_, -kInfinity);
  for (const kernels::VectorsView x : places) {
    kernels.bound(x, m.mass.data(), m.slots(), boxes());
  }
}

std::size_t SlotBoxes::find(const simd::Table& kernels, kernels::Vector from, kernels::Vector to,
                            double extra) {
  const kernels::Vector low{std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z)};
  const kernels::Vector high{std::max(from.x, to.x), std::max(from.y, to.y),
                             std::max(from.z, to.z)};
  return kernels.find_boxes(boxes(), low, high, extra, near_.data());
}

std::size_t SlotBoxes::bytes() const {
  return low_.bytes() + high_.bytes() + bytes_of(reach_) + bytes_of(near_);
}

}  // namespace weft
