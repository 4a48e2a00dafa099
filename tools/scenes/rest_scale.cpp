#include "tools/scenes/rest_scale.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/model/change.h"

namespace weft::tools {

double scale_at(const RestScale& scale, double time) {
  if (scale.times.empty()) return 1;
  const auto next = std::ranges::upper_bound(scale.times, time);
  const auto key = static_cast<std::size_t>(next - scale.times.begin());
  if (key == 0) return scale.scales.front();
  if (key == scale.times.size()) return scale.scales.back();
  const double share = (time - scale.times[key - 1]) / (scale.times[key] - scale.times[key - 1]);
  return scale.scales[key - 1] + share * (scale.scales[key] - scale.scales[key - 1]);
}

GrowingRest::GrowingRest(const RestScale& scale, const Cloth& cloth) : scale_(scale) {
  if (!scale.times.empty()) scene_ = description_of(*cloth.model());
}

Result<void> GrowingRest::grow(Cloth& cloth, double time) {
  const double now = scale_at(scale_, time);
  if (std::exchange(last_, now) == now) return {};
  return cloth.set_rest_shape(scene_, now);
}

RestScale present_scale(const RestScale& scale, double elapsed) {
  RestScale present;
  for (std::size_t key = 0; key < scale.times.size(); ++key) {
    const double time = scale.times[key] - elapsed;
    if (!present.times.empty() && !(present.times.back() < time)) {  // they have come to be one
      present.scales.back() = scale.scales[key];
      continue;
    }
    present.times.push_back(time);
    present.scales.push_back(scale.scales[key]);
  }
  return present;
}

}  // namespace weft::tools
