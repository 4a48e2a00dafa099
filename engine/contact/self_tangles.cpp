#include "engine/contact/self_tangles.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/leads_through.h"

namespace weft {

using kernels::Vector;

namespace {

std::uint64_t pair_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

std::size_t count_shared(const TriangleSurface::Triangle& a, const TriangleSurface::Triangle& b) {
  return static_cast<std::size_t>(std::ranges::count_if(
      a, [&](std::uint32_t p) { return std::ranges::find(b, p) != b.end(); }));
}

/// An edge of one that has no corner of the other leads through that. Corners that are sewn
/// together are one. beyond: as leads_through has it.
template <class At>
bool edge_leads_through(const TriangleSurface::Triangle& a, const TriangleSurface::Triangle& b,
                        const SewnPoints& sewn, double beyond, At&& at) {
  const Corners corners{at(b[0]), at(b[1]), at(b[2])};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t p = a[k], q = a[(k + 1) % 3];
    const auto is_end = [&](std::uint32_t corner) {
      return sewn.is_one(corner, p) || sewn.is_one(corner, q);
    };
    if (std::ranges::any_of(b, is_end)) continue;
    if (leads_through(at(p), at(q), corners, beyond)) return true;
  }
  return false;
}

}  // namespace

void SelfTangles::begin(const TriangleSurface& cloth, const std::vector<std::uint64_t>& pairs) {
  cloth_ = &cloth;
  crossing_ = pairs;
  const std::size_t triangles = cloth.triangles.size();
  std::erase_if(crossing_, [&](std::uint64_t pair) { return (pair & 0xffffffffu) >= triangles; });
  has_looked_ = false;
  may_cross_.assign(triangles, 0);
  mark_beside(crossing_);
  pairs_ = crossing_;
  mark_ones();
}

void SelfTangles::begin_interval() {
  if (pairs_ == crossing_) return;
  pairs_ = crossing_;
  mark_ones();
}

void SelfTangles::mark_ones() {
  is_one_.assign(pairs_.empty() ? 0 : cloth_->triangles.size(), 0);
  for (const std::uint64_t pair : pairs_) {
    is_one_[static_cast<std::size_t>(pair >> 32)] = 1;
    is_one_[static_cast<std::size_t>(pair & 0xffffffffu)] = 1;
  }
}

void SelfTangles::mark_beside(const std::vector<std::uint64_t>& pairs) {
  for (const std::uint64_t pair : pairs) {
    for (const std::uint64_t one : {pair >> 32, pair & 0xffffffffu}) {
      for (const std::uint32_t corner : cloth_->triangles[static_cast<std::size_t>(one)])
        for (const std::uint32_t near : cloth_->triangles_at[corner]) may_cross_[near] = 1;
    }
  }
}

namespace {

/// Boxes around all triangles, and so wide that those which do not meet are apart. The tree's hold
/// what triangles may come to until the step ends.
template <class At>
std::vector<Box> boxes_around(const ContactPoints& points, At&& at) {
  const double beyond = tuning::kStaysApart + static_cast<double>(points.rounding_of_cloth());
  const Vector wide{beyond, beyond, beyond};
  std::vector<Box> boxes;
  boxes.reserve(points.cloth().triangles.size());
  for (const TriangleSurface::Triangle& triangle : points.cloth().triangles) {
    Box box = Box::none();
    for (const std::uint32_t corner : triangle) {
      const Vector x = at(corner) - points.origin();
      box.add(Box::at(x - wide));
      box.add(Box::at(x + wide));
    }
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

template <class At>
void SelfTangles::find(const ContactPoints& points, bool everywhere, At&& at) {
  crossing_.clear();
  const ContactSurface& cloth = points.surfaces()[kClothSurface];
  const SewnPoints& sewn = points.sewn();
  const std::vector<Box> boxes = boxes_around(points, at);
  BoxTree::meet_itself(table_, cloth.tree(), [&](std::uint32_t a, std::uint32_t b) {
    if (!boxes[a].meets(boxes[b])) return;
    if (cloth_->is_point(a) || cloth_->is_point(b)) return;
    const bool are_faces = cloth_->is_face(a) && cloth_->is_face(b);
    if (!cloth_->is_face(a) && !cloth_->is_face(b)) return;
    if (!everywhere && (may_cross_[a] & may_cross_[b]) == 0) return;
    const TriangleSurface::Triangle &one = cloth_->triangles[a], &other = cloth_->triangles[b];
    const std::size_t shared = count_shared(sewn.first_of(one), sewn.first_of(other));
    if (shared > (are_faces ? 1 : 0)) return;
    const Corners its{at(one[0]), at(one[1]), at(one[2])},
        others{at(other[0]), at(other[1]), at(other[2])};
    // Pairs that crossed before are apart where they will be known to stay so.
    const bool has_crossed = std::ranges::binary_search(pairs_, pair_of(a, b));
    const double apart = has_crossed ? tuning::kStaysApart : tuning::kTouching;
    if (shared == 0 && (are_beside(its, others, apart) || are_beside(others, its, apart))) return;
    const double beyond = has_crossed ? -apart : apart;
    if (edge_leads_through(one, other, sewn, beyond, at) ||
        edge_leads_through(other, one, sewn, beyond, at))
      crossing_.push_back(pair_of(a, b));
  });
  std::ranges::sort(crossing_);
  if (everywhere) may_cross_.assign(cloth_->triangles.size(), 0);
  mark_beside(pairs_);
  mark_beside(crossing_);
}

void SelfTangles::find_at_start(const ContactPoints& points) {
  find(points, true, [&](std::uint32_t point) { return points.start(point); });
  begin_interval();
}

void SelfTangles::find_at_end(const ContactPoints& points, bool has_failed) {
  if (pairs_.empty() && crossing_.empty() && !has_failed) return;
  const bool everywhere = has_failed || !std::exchange(has_looked_, true);
  find(points, everywhere, [&](std::uint32_t point) { return points.end(point); });
}

bool SelfTangles::has(std::uint32_t a, std::uint32_t b) const {
  return is_one_[a] != 0 && is_one_[b] != 0 && std::ranges::binary_search(pairs_, pair_of(a, b));
}

bool SelfTangles::has_one_at_edge(std::uint32_t edge, std::uint32_t triangle) const {
  const std::uint32_t p = cloth_->edges[edge][0], q = cloth_->edges[edge][1];
  return std::ranges::any_of(cloth_->triangles_at[p], [&](std::uint32_t at_edge) {
    const TriangleSurface::Triangle& t = cloth_->triangles[at_edge];
    return std::ranges::find(t, q) != t.end() && has(at_edge, triangle);
  });
}

bool SelfTangles::cross_beside(const Pair& pair, const std::array<std::uint32_t, 4>& points) const {
  if (pairs_.empty()) return false;
  const std::size_t firsts = pair.kind == PairKind::edges ? 2 : 1;
  for (std::size_t i = 0; i < firsts; ++i) {
    for (const std::uint32_t a : cloth_->triangles_at[points[i]]) {
      if (is_one_[a] == 0) continue;
      for (std::size_t k = firsts; k < 4; ++k) {
        for (const std::uint32_t b : cloth_->triangles_at[points[k]]) {
          if (is_one_[b] != 0 && has(a, b)) return true;
        }
      }
    }
  }
  return false;
}

bool SelfTangles::has_features_of(const Pair& pair) const {
  if (pair.kind == PairKind::point_triangle) {
    return is_one_[pair.second] != 0 &&
           std::ranges::any_of(cloth_->triangles_at[pair.first],
                               [&](std::uint32_t t) { return has(t, pair.second); });
  }
  const std::uint32_t p = cloth_->edges[pair.second][0], q = cloth_->edges[pair.second][1];
  return std::ranges::any_of(cloth_->triangles_at[p], [&](std::uint32_t at_edge) {
    const TriangleSurface::Triangle& t = cloth_->triangles[at_edge];
    return is_one_[at_edge] != 0 && std::ranges::find(t, q) != t.end() &&
           has_one_at_edge(pair.first, at_edge);
  });
}

std::size_t SelfTangles::bytes() const {
  return bytes_of(pairs_) + bytes_of(crossing_) + bytes_of(is_one_) + bytes_of(may_cross_);
}

}  // namespace weft
