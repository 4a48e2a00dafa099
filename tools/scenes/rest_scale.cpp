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
  if (scale.times.empty()) return;
  scene_ = description_of(*cloth.model());
  tears_ = cloth.model()->tears;
}

Result<void> GrowingRest::grow(Cloth& cloth, double time) {
  const double now = scale_at(scale_, time);
  const double before = std::exchange(last_, now);
  if (before == now) return {};
  if (cloth.model()->tears != tears_) take_scene(cloth, before);
  return cloth.set_rest_shape(scene_, now / scale_of_scene_);
}

void GrowingRest::go_on_torn(const Cloth& cloth, double time) {
  last_ = scale_at(scale_, time);
  if (!scale_.times.empty()) take_scene(cloth, last_);
}

void GrowingRest::take_scene(const Cloth& cloth, double scale) {
  scene_ = description_of(*cloth.model());
  scale_of_scene_ = scale;
  tears_ = cloth.model()->tears;
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

RestScale scale_over(RestScale scale, double now) {
  for (double& each : scale.scales) each /= now;
  return scale;
}

}  // namespace weft::tools
