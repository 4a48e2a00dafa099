#include "engine/step/rest.h"

#include "engine/tuning.h"

namespace weft {
namespace {

constexpr double kLookTime = tuning::kRestTime / 4;

/// m, of all constraints and sides of triangles of fabric; 0 without any.
double mean_length(const Model& model) {
  double sum = 0, count = 0;
  const auto add = [&](double length) {
    sum += length;
    ++count;
  };
  for (const double length : model.constraints.rest_length) add(length);
  model.membrane.for_each_side([&](std::uint32_t, std::uint32_t, double length) { add(length); });
  return count > 0 ? sum / count : 0;
}

}  // namespace

Rest::Rest(const Model& model)
    : reach_(tuning::kRestShare * mean_length(model)), from_(model.slots()) {}

void Rest::wake() {
  is_asleep_ = is_watching_ = false;
  time_ = 0;
}

bool Rest::has_moved(const kernels::Vectors& position, std::size_t slot) const {
  return length(position[slot] - from_[slot]) > reach_;
}

bool Rest::has_moved(const kernels::Vectors& position) {
  if (has_moved(position, restless_)) return true;
  for (std::size_t slot = 0; slot < position.size(); ++slot) {
    if (!has_moved(position, slot)) continue;
    restless_ = slot;
    return true;
  }
  return false;
}

/// Positions of moving cloth are not copied in every step.
bool Rest::watch(const kernels::Vectors& position, double dt) {
  time_ += dt;
  if (dt > kLookTime || (is_watching_ && has_moved(position))) {
    wake();
  } else if (is_watching_) {
    is_asleep_ = time_ >= tuning::kRestTime;
  } else if (time_ >= kLookTime) {
    from_ = position;
    is_watching_ = true;
    time_ = 0;
  }
  return is_asleep_;
}

}  // namespace weft
