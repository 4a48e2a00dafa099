#include "engine/contact/contours.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/leads_through.h"
#include "engine/erase_repeated.h"
#include "kernels/reference/distances.h"

namespace weft {

using kernels::Vector;

namespace {

std::uint32_t first_half(std::uint64_t pair) { return static_cast<std::uint32_t>(pair >> 32); }
std::uint32_t second_half(std::uint64_t pair) {
  return static_cast<std::uint32_t>(pair & 0xffffffffu);
}

bool has_an_end_of(const SewnPoints& sewn, const TriangleSurface::Triangle& triangle,
                   std::uint32_t p, std::uint32_t q) {
  return std::ranges::any_of(triangle, [&](std::uint32_t corner) {
    return sewn.is_one(corner, p) || sewn.is_one(corner, q);
  });
}

}  // namespace

std::uint32_t Contours::root_of(std::uint32_t pair) {
  while (parent_[pair] != pair) pair = parent_[pair] = parent_[parent_[pair]];
  return pair;
}

/// Edges of one that pierce the other.
void Contours::add(const ContactPoints& points, std::uint32_t one, std::uint32_t other,
                   std::uint32_t pair) {
  const TriangleSurface& cloth = points.cloth();
  const TriangleSurface::Triangle& t = cloth.triangles[other];
  const Corners corners{points.start(t[0]), points.start(t[1]), points.start(t[2])};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t edge = cloth.edges_of[one][k];
    const auto [p, q] = cloth.edges[edge];
    if (has_an_end_of(points.sewn(), t, p, q)) continue;
    const Vector from = points.start(p), to = points.start(q);
    if (!leads_through(from, to, corners, -tuning::kStaysApart)) continue;
    const double side = -volume_of(corners[0], corners[1], corners[2], from),
                 end = -volume_of(corners[0], corners[1], corners[2], to);
    Piercing piercing{.edge = edge,
                      .triangle = other,
                      .contour = pair,
                      .points = {p, q, t[0], t[1], t[2]},
                      .side = {side, end}};
    const double nearer = std::abs(side) < std::abs(end) ? 0 : 1;
    const double share = piercing.is_through() ? side / (side - end) : nearer;
    const reference::Nearest there = reference::nearest_in_triangle(
        from + share * (to - from), corners[0], corners[1], corners[2]);
    piercing.weight = {1 - share, share, there.weight[1], there.weight[2], there.weight[3]};
    piercings_.push_back(piercing);
  }
}

void Contours::find(const ContactPoints& points, const std::vector<std::uint64_t>& crossing) {
  piercings_.clear();
  parent_.resize(crossing.size());
  std::iota(parent_.begin(), parent_.end(), 0u);
  for (std::uint32_t i = 0; i < crossing.size(); ++i) {
    add(points, first_half(crossing[i]), second_half(crossing[i]), i);
    add(points, second_half(crossing[i]), first_half(crossing[i]), i);
  }
  const auto key = [](const Piercing& p) { return std::tuple(p.edge, p.triangle, p.contour); };
  const auto same = [](const Piercing& p) { return std::pair(p.edge, p.triangle); };
  std::ranges::sort(piercings_, {}, key);
  for (std::size_t i = 1; i < piercings_.size(); ++i) {
    if (same(piercings_[i]) != same(piercings_[i - 1])) continue;
    const auto [low, high] =
        std::minmax({root_of(piercings_[i].contour), root_of(piercings_[i - 1].contour)});
    parent_[high] = low;
  }
  erase_repeated(piercings_, same);
  for (Piercing& piercing : piercings_) piercing.contour = root_of(piercing.contour);
  std::ranges::sort(piercings_, {},
                    [](const Piercing& p) { return std::tuple(p.contour, p.edge, p.triangle); });
}

std::size_t Contours::bytes() const { return bytes_of(piercings_) + bytes_of(parent_); }

// ------------------------------------------------------------------------------------------------

std::uint32_t WrongPart::root_of(std::uint32_t region) const {
  while (parent_[region] != region) region = parent_[region];
  return region;
}

std::uint32_t WrongPart::region_at(const ContactPoints& points, std::uint32_t point) const {
  const std::uint32_t region = region_of_[points.sewn().first_of(point)];
  return region == kNoIndex ? kNoIndex : root_of(region);
}

bool WrongPart::has(const ContactPoints& points, std::uint32_t point) const {
  return any() && region_at(points, point) == wrong_;
}

bool WrongPart::is_cut(std::uint32_t a, std::uint32_t b) const {
  return std::ranges::binary_search(cuts_, std::array{std::min(a, b), std::max(a, b)});
}

/// An edge that is pierced twice has both ends on one side of the contour.
void WrongPart::cut(std::span<const Piercing> contour) {
  cuts_.clear();
  for (std::size_t i = 0, next = 0; i < contour.size(); i = next) {
    bool is_odd = false;
    for (next = i; next < contour.size() && contour[next].edge == contour[i].edge; ++next)
      is_odd = is_odd != contour[next].is_through();
    const auto [low, high] = std::minmax({contour[i].points[0], contour[i].points[1]});
    if (is_odd) cuts_.push_back({low, high});
  }
  std::ranges::sort(cuts_);
}

void WrongPart::clear() {
  for (const std::uint32_t point : reached_) region_of_[point] = kNoIndex;
  reached_.clear();
  regions_.clear();
  parent_.clear();
  waiting_.clear();
  wrong_ = kNoIndex;
}

void WrongPart::reach(std::uint32_t region, std::uint32_t point) {
  region_of_[point] = region;
  reached_.push_back(point);
  const auto at = static_cast<std::uint32_t>(waiting_.size());
  waiting_.push_back({point});
  Region& r = regions_[region];
  (r.is_whole() ? r.first : waiting_[r.last].next) = at;
  r.last = at;
}

void WrongPart::begin_regions(const ContactPoints& points) {
  for (const auto& cut : cuts_) {
    for (const std::uint32_t end : cut) {
      const std::uint32_t point = points.sewn().first_of(end);
      if (region_of_[point] != kNoIndex || is_wall(points, point)) continue;
      parent_.push_back(static_cast<std::uint32_t>(regions_.size()));
      regions_.emplace_back();
      reach(parent_.back(), point);
    }
  }
}

void WrongPart::unite(std::uint32_t into, std::uint32_t other) {
  Region &a = regions_[into], &b = regions_[other];
  parent_[other] = into;
  if (!b.is_whole()) {
    (a.is_whole() ? a.first : waiting_[a.last].next) = b.first;
    a.last = b.last;
  }
  a.mass += b.mass;
  a.has_border = a.has_border || b.has_border;
  a.held += b.held;
}

/// The other corners of its triangles, ascending: a neighbour once for each triangle that has both.
void WrongPart::find_around(const ContactPoints& points, std::uint32_t point,
                            std::vector<std::uint32_t>& around) {
  const SewnPoints& sewn = points.sewn();
  around.clear();
  for (const std::uint32_t t : sewn.triangles_at(points.cloth(), point)) {
    for (const std::uint32_t corner : sewn.first_of(points.cloth().triangles[t]))
      if (corner != point) around.push_back(corner);
  }
  std::ranges::sort(around);
}

/// Whether several sheets meet there.
bool WrongPart::is_wall(const ContactPoints& points, std::uint32_t point) {
  find_around(points, point, beside_);
  for (std::size_t i = 2; i < beside_.size(); ++i)
    if (beside_[i] == beside_[i - 2]) return true;
  return false;
}

/// On a border a neighbour is in one triangle alone.
void WrongPart::visit(const ContactPoints& points, std::uint32_t& region, std::uint32_t point) {
  const SewnPoints& sewn = points.sewn();
  const TriangleSurface& cloth = points.cloth();
  bool is_held = false;
  for (const std::uint32_t t : sewn.triangles_at(cloth, point)) {
    const TriangleSurface::Triangle& corners = cloth.triangles[t];
    const std::uint32_t own = *std::ranges::find_if(
        corners, [&](std::uint32_t corner) { return sewn.is_one(corner, point); });
    is_held = is_held || points.inverse_mass(own) == 0;
    for (const std::uint32_t corner : corners) {
      const std::uint32_t to = sewn.first_of(corner);
      if (to == point || is_cut(own, corner)) continue;
      if (region_of_[to] == kNoIndex) {
        const bool is_end = is_wall(points, to);
        if (!is_end) reach(region, to);
        regions_[region].has_border = regions_[region].has_border || is_end;
      } else if (const std::uint32_t met = root_of(region_of_[to]); met != region) {
        unite(std::min(met, region), std::max(met, region));
        region = std::min(met, region);
      }
    }
  }
  find_around(points, point, around_);
  for (std::size_t i = 0, next = 0; i < around_.size(); i = next) {
    for (next = i; next < around_.size() && around_[next] == around_[i];) ++next;
    if (next - i == 1) regions_[region].has_border = true;
  }
  regions_[region].held += is_held ? 1 : 0;
  regions_[region].mass += points.model().mass[point];
}

void WrongPart::grow(const ContactPoints& points, std::uint32_t region, std::size_t steps) {
  for (; steps > 0 && !regions_[region].is_whole(); --steps) {
    Region& r = regions_[region];
    const std::uint32_t point = waiting_[r.first].point;
    r.first = waiting_[r.first].next;
    visit(points, region, point);
  }
}

/// Returns whether there is more to reach.
bool WrongPart::grow_all(const ContactPoints& points, std::size_t steps) {
  bool is_more = false;
  for (std::uint32_t region = 0; region < regions_.size(); ++region) {
    if (parent_[region] != region || regions_[region].is_whole()) continue;
    grow(points, region, steps);
    is_more = is_more || !regions_[root_of(region)].is_whole();
  }
  return is_more;
}

/// Everywhere the smaller side is known, or that both are one.
bool WrongPart::is_settled(const ContactPoints& points) const {
  return std::ranges::all_of(cuts_, [&](const std::array<std::uint32_t, 2>& ends) {
    const std::uint32_t a = region_at(points, ends[0]), b = region_at(points, ends[1]);
    const auto is_known = [&](std::uint32_t region) {
      return region == kNoIndex || regions_[region].is_whole();
    };
    return a == b || is_known(a) || is_known(b);
  });
}

/// free: without held particles.
void WrongPart::choose(const ContactPoints& points, bool free) {
  const auto is_loose = [&](std::uint32_t region) {
    return region != kNoIndex && regions_[region].is_whole() && !regions_[region].has_border;
  };
  bool may_shrink = true;  // to a point, everywhere
  for (const auto& [p, q] : cuts_) {
    const std::uint32_t a = region_at(points, p), b = region_at(points, q);
    if (a == b && a != kNoIndex) regions_[a].is_beside_itself = true;
    may_shrink = may_shrink && (is_loose(a) || is_loose(b));
  }
  for (std::uint32_t i = 0; i < regions_.size(); ++i) {
    const Region& region = regions_[i];
    if (parent_[i] != i || !region.is_whole() || region.is_beside_itself) continue;
    if ((free && region.held > 0) || (!region.has_border && !may_shrink)) continue;
    const auto rank = [](const Region& r) { return std::pair(r.held, r.mass); };
    if (wrong_ == kNoIndex || rank(region) < rank(regions_[wrong_])) wrong_ = i;
  }
}

/// All regions grow alike, until it is known which is the smallest.
void WrongPart::find(const ContactPoints& points, std::span<const Piercing> contour) {
  constexpr std::size_t kFirstSteps = 16;
  region_of_.resize(points.slots(), kNoIndex);
  clear();
  cut(contour);
  if (cuts_.empty()) return;
  begin_regions(points);
  bool is_more = true;
  for (std::size_t steps = kFirstSteps; is_more; steps *= 2) {
    is_more = grow_all(points, steps);
    if (is_more && !is_settled(points)) continue;
    choose(points, is_more);
    if (any()) return;
  }
}

std::size_t WrongPart::bytes() const {
  return bytes_of(cuts_) + bytes_of(region_of_) + bytes_of(reached_) + bytes_of(regions_) +
         bytes_of(parent_) + bytes_of(waiting_) + bytes_of(around_) + bytes_of(beside_);
}

}  // namespace weft
