#include "engine/contact/sewn_points.h"

#include "engine/bytes_of.h"
#include "engine/partition.h"

namespace weft {

SewnPoints::SewnPoints(const Model& model) {
  const SeamStore& seams = model.seams;
  if (seams.size() == 0) return;
  Partition joined(model.slots());
  for (std::size_t i = 0; i < seams.size(); ++i) joined.join(seams.a[i], seams.b[i]);
  first_.resize(model.slots());
  for (std::uint32_t point = 0; point < first_.size(); ++point) first_[point] = joined.first(point);
  const TriangleSurface& cloth = model.touched_surface();
  triangles_at_ = make_lists(first_.size(), [&](auto&& add) {
    for (std::uint32_t t = 0; t < cloth.triangles.size(); ++t) {
      if (cloth.is_point(t)) continue;
      const auto [a, b, c] = cloth.triangles[t];
      add(first_[a], t);
      add(first_[b], t);
      if (c != b) add(first_[c], t);
    }
  });
}

bool SewnPoints::have_one_in_common(PairKind kind,
                                    const std::array<std::uint32_t, 4>& points) const {
  const std::size_t firsts = kind == PairKind::edges ? 2 : 1;
  for (std::size_t i = 0; i < firsts; ++i) {
    for (std::size_t j = firsts; j < 4; ++j) {
      if (is_one(points[i], points[j])) return true;
    }
  }
  return false;
}

std::size_t SewnPoints::bytes() const { return bytes_of(first_) + triangles_at_.bytes(); }

}  // namespace weft
