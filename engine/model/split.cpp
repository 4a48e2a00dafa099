#include "engine/model/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "engine/partition.h"
#include "engine/tuning.h"

namespace weft {
namespace splitting {
namespace {

using kernels::Vector;
using Corners = std::array<std::uint32_t, 3>;
using Ends = std::array<std::uint32_t, 2>;

Ends sorted(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }
Corners sorted(Corners corners) {
  std::ranges::sort(corners);
  return corners;
}
bool has(const auto& corners, std::uint32_t particle) {
  return std::ranges::find(corners, particle) != corners.end();
}
Vector unit(Vector v) {
  const double l = length(v);
  return l > 0 ? (1 / l) * v : v;
}

/// The triangles of a sheet around a particle.
class Star {
 public:
  struct Spoke {
    std::uint32_t end = 0;
    std::vector<std::uint32_t> triangles{};  // numbers in the star
    bool is_cuttable = false;
    bool is_border() const { return triangles.size() == 1; }
  };

  Star(const SceneDescription& d, std::span<const Vector> x, std::uint32_t centre)
      : x_(x), centre_(centre) {
    collect(d);
    find_spokes();
    find_joins(d);
    find_cells(d);
    for (Spoke& spoke : spokes_)
      spoke.is_cuttable = spoke.triangles.size() == 2 && !is_diagonal(spoke);
  }

  bool empty() const { return triangles_.empty(); }
  bool is_open() const { return std::ranges::any_of(spokes_, &Spoke::is_border); }
  const std::vector<Corners>& triangles() const { return triangles_; }
  /// m^2, twice, of each triangle.
  double area(std::size_t i) const {
    const auto [a, b] = others(i);
    return length(cross(x_[a] - x_[centre_], x_[b] - x_[centre_]));
  }
  /// From the centre.
  Vector way_to(std::uint32_t particle) const { return x_[particle] - x_[centre_]; }
  Vector middle_of(std::size_t i) const {
    const auto [a, b] = others(i);
    return (1.0 / 3) * (way_to(a) + way_to(b));
  }
  /// All particles of a triangle's cell, but for the centre.
  std::vector<std::uint32_t> members_of(std::size_t i) const {
    const auto [a, b] = others(i);
    std::vector<std::uint32_t> members{a, b};
    if (const auto at = across_.find(i); at != across_.end()) members.push_back(at->second);
    return members;
  }

  /// Per triangle: the number of its part after cuts along these spokes.
  std::vector<std::uint32_t> parts(std::span<const std::uint32_t> cut) const {
    Partition joined(triangles_.size());
    for (const Spoke& spoke : spokes_) {
      if (has(cut, spoke.end)) continue;
      for (const std::uint32_t i : spoke.triangles) joined.join(i, spoke.triangles.front());
    }
    std::vector<std::uint32_t> parts(triangles_.size());
    for (std::uint32_t i = 0; i < parts.size(); ++i) parts[i] = joined.first(i);
    return parts;
  }

  /// Spokes to cut along, none where that is not possible.
  std::vector<std::uint32_t> cut_across(Vector along) const {
    const Vector across = unit(cross(normal(), along));
    const Vector out = is_open() ? opening() : Vector{};
    const double lean = dot(across, out);
    const std::uint32_t ahead = best([&](Vector to) { return dot(to, across); });
    const std::uint32_t behind = best([&](Vector to) { return -dot(to, across); });
    if (ahead == kNoIndex) return {};
    if (!is_open())
      return ahead == behind ? std::vector<std::uint32_t>{} : std::vector{ahead, behind};
    if (std::abs(lean) > tuning::kLeastOpening) return {lean < 0 ? ahead : behind};
    return {best([&](Vector to) { return std::abs(dot(to, across)); })};
  }
  /// Out of the fabric, where it does not go all around the centre.
  Vector opening() const {
    Vector sum{};
    for (std::size_t i = 0; i < triangles_.size(); ++i) sum = sum - area(i) * unit(middle_of(i));
    sum = unit(sum);
    for (const Spoke& spoke : spokes_)
      if (spoke.is_border()) sum = sum + unit(way_to(spoke.end));
    return unit(sum);
  }

 private:
  Ends others(std::size_t i) const {
    const Corners& t = triangles_[i];
    const std::size_t k = static_cast<std::size_t>(std::ranges::find(t, centre_) - t.begin());
    return {t[(k + 1) % 3], t[(k + 2) % 3]};
  }
  Vector normal() const {
    Vector sum{};
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const auto [a, b] = others(i);
      sum = sum + cross(way_to(a), way_to(b));
    }
    return unit(sum);
  }
  template <class Score>
  std::uint32_t best(Score&& score) const {
    std::uint32_t end = kNoIndex;
    double most = 0;
    for (const Spoke& spoke : spokes_) {
      if (!spoke.is_cuttable) continue;
      const double its = score(unit(way_to(spoke.end)));
      if (end != kNoIndex && its <= most) continue;
      most = its;
      end = spoke.end;
    }
    return end;
  }

  /// Those of `surface`; of fabric where no surface is described.
  void collect(const SceneDescription& d) {
    for (const Corners& t : d.surface)
      if (has(t, centre_)) triangles_.push_back(t);
    for (const MembraneElement& e : d.membrane) {
      if (!has(e.particles, centre_)) continue;
      fabric_.insert(sorted(e.particles));
      if (d.surface.empty()) triangles_.push_back(e.particles);
    }
  }
  void find_spokes() {
    std::map<std::uint32_t, std::size_t> at;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      for (const std::uint32_t end : others(i)) {
        const auto [found, is_new] = at.try_emplace(end, spokes_.size());
        if (is_new) spokes_.push_back({end});
        spokes_[found->second].triangles.push_back(i);
      }
    }
  }
  /// Constraints between particles around the centre, and with it.
  void find_joins(const SceneDescription& d) {
    for (const Constraint& c : d.constraints)
      if (c.strength > 0 && (c.a == centre_ || c.b == centre_ || is_near(c.a) || is_near(c.b)))
        joins_.insert(sorted(c.a, c.b));
  }
  bool is_near(std::uint32_t particle) const {
    return std::ranges::any_of(spokes_, [&](const Spoke& s) { return s.end == particle; });
  }
  /// The fourth corners of cells whose diagonal is opposite to the centre.
  void find_cells(const SceneDescription& d) {
    std::map<Ends, std::size_t> opposite;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const auto [a, b] = others(i);
      opposite[sorted(a, b)] = i;
    }
    for (const Corners& t : d.surface) {
      if (has(t, centre_)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto found = opposite.find(sorted(t[k], t[(k + 1) % 3]));
        if (found == opposite.end()) continue;
        const std::uint32_t fourth = t[(k + 2) % 3];
        const bool is_fabric = fabric_.contains(sorted(triangles_[found->second]));
        if (!is_fabric && (is_joined(centre_, fourth) || !is_joined(t[k], t[(k + 1) % 3])))
          across_[found->second] = fourth;
      }
    }
  }
  bool is_joined(std::uint32_t a, std::uint32_t b) const { return joins_.contains(sorted(a, b)); }
  /// Whether it is that of a four-sided cell.
  bool is_diagonal(const Spoke& spoke) const {
    const auto third = [&](std::size_t i) {
      const auto [a, b] = others(i);
      return a == spoke.end ? b : a;
    };
    const auto is_fabric = [&](std::size_t i) { return fabric_.contains(sorted(triangles_[i])); };
    const std::size_t i = spoke.triangles[0], j = spoke.triangles[1];
    if (is_fabric(i) && is_fabric(j)) return false;
    return is_joined(third(i), third(j)) || !is_joined(centre_, spoke.end);
  }

  std::span<const Vector> x_;
  std::uint32_t centre_;
  std::vector<Corners> triangles_;
  std::vector<Spoke> spokes_;
  std::set<Corners> fabric_;  // triangles of fabric at the centre, sorted
  std::set<Ends> joins_;
  std::map<std::size_t, std::uint32_t> across_;  // per triangle: the fourth corner of its cell
};

/// Which side of a cut particles and elements are on.
enum class Side : std::uint8_t { stays, goes, both };

class Cut {
 public:
  /// goes: per triangle of the star.
  Cut(const Star& star, const std::vector<bool>& goes) {
    for (std::size_t i = 0; i < goes.size(); ++i) {
      auto& members = goes[i] ? goes_ : stays_;
      for (const std::uint32_t member : star.members_of(i)) members.insert(member);
      const double area = star.area(i);
      (goes[i] ? area_of_goes_ : area_of_stays_) += area;
      across_ = across_ + (goes[i] ? area : -area) * star.middle_of(i);
      if (goes[i])
        triangles_.insert(sorted(star.triangles()[i]));
      else
        others_.insert(sorted(star.triangles()[i]));
    }
  }

  /// The share of the mass of the particle.
  double share_of_goes() const { return area_of_goes_ / (area_of_goes_ + area_of_stays_); }
  /// way: from the centre to it.
  Side side_of(std::uint32_t particle, Vector way) const {
    if (stays_.empty()) return Side::goes;
    const bool goes = goes_.contains(particle), stays = stays_.contains(particle);
    if (goes && stays) return Side::both;
    if (goes || stays) return goes ? Side::goes : Side::stays;
    return dot(way, across_) > 0 ? Side::goes : Side::stays;
  }
  std::optional<Side> side_of_triangle(const Corners& triangle) const {
    if (triangles_.contains(sorted(triangle))) return Side::goes;
    if (others_.contains(sorted(triangle))) return Side::stays;
    return {};
  }
  bool goes_with(Vector way) const { return stays_.empty() || dot(way, across_) > 0; }

 private:
  std::set<std::uint32_t> goes_, stays_;
  std::set<Corners> triangles_, others_;
  double area_of_goes_ = 0, area_of_stays_ = 0;
  Vector across_{};  // to the side that goes
};

/// Takes the elements of a cut particle to the new one.
class Rewiring {
 public:
  Rewiring(SceneDescription& d, std::span<const Vector> x, const Cut& cut, std::uint32_t old,
           std::uint32_t added)
      : d_(d), x_(x), cut_(cut), old_(old), added_(added) {}

  void run() {
    for (auto& triangle : d_.surface) take_triangle(triangle);
    for (auto& triangle : d_.air.triangles) take_triangle(triangle);
    for (MembraneElement& element : d_.membrane) take_triangle(element.particles);
    take_constraints();
    take_bending();
    for (Seam& seam : d_.seams) {
      if (seam.strength == 0) continue;
      if (seam.a == old_ && side_of(seam.b) == Side::goes) seam.a = added_;
      if (seam.b == old_ && side_of(seam.a) == Side::goes) seam.b = added_;
    }
  }

 private:
  Vector way_to(std::uint32_t particle) const { return x_[particle] - x_[old_]; }
  Side side_of(std::uint32_t particle) const { return cut_.side_of(particle, way_to(particle)); }

  void take_triangle(Corners& triangle) {
    const auto at = std::ranges::find(triangle, old_);
    if (at == triangle.end()) return;
    if (goes(triangle)) *at = added_;
  }
  bool goes(const Corners& triangle) const {
    if (const auto side = cut_.side_of_triangle(triangle)) return *side == Side::goes;
    Vector sum{};
    for (const std::uint32_t corner : triangle) sum = sum + way_to(corner);
    return cut_.goes_with(sum);
  }

  void take_constraints() {
    std::vector<Constraint> copies;
    for (Constraint& c : d_.constraints) {
      if (c.strength == 0 || (c.a != old_ && c.b != old_)) continue;
      std::uint32_t& end = c.a == old_ ? c.a : c.b;
      const Side side = side_of(c.a == old_ ? c.b : c.a);
      if (side == Side::stays) continue;
      if (side == Side::goes) {
        end = added_;
        continue;
      }
      c.compliance *= 2;
      c.strength /= 2;
      copies.push_back(c);
      (copies.back().a == old_ ? copies.back().a : copies.back().b) = added_;
    }
    d_.constraints.insert(d_.constraints.end(), copies.begin(), copies.end());
  }

  /// An element across the cut bends no more; one along it becomes two.
  void take_bending() {
    std::vector<BendingElement> copies;
    for (BendingElement& e : d_.bending) {
      const auto at = std::ranges::find(e.particles, old_);
      if (at == e.particles.end()) continue;
      bool any_goes = false, any_stays = false;
      for (const std::uint32_t p : e.particles) {
        if (p == old_ || p == kNoIndex) continue;
        const Side side = side_of(p);
        any_goes |= side == Side::goes;
        any_stays |= side == Side::stays;
      }
      if (any_goes && any_stays) {
        e.weights = {};
        e.rest = e.fold = 0;
        e.yield = std::numeric_limits<double>::infinity();
      } else if (any_goes) {
        *at = added_;
      } else if (!any_stays) {
        e.compliance *= 2;
        copies.push_back(e);
        *std::ranges::find(copies.back().particles, old_) = added_;
      }
    }
    d_.bending.insert(d_.bending.end(), copies.begin(), copies.end());
  }

  SceneDescription& d_;
  std::span<const Vector> x_;
  const Cut& cut_;
  std::uint32_t old_, added_;
};

/// Per triangle whether it goes to the new particle; empty: the particle cannot be split. A fixed
/// particle on a border loses all that pulls it out of the fabric's opening.
std::vector<bool> find_cut(const Star& star, Vector along, bool is_fixed) {
  const std::size_t count = star.triangles().size();
  if (count == 0) return {};
  const bool is_torn_off =
      is_fixed && star.is_open() && std::abs(dot(star.opening(), along)) > std::sqrt(0.5);
  if (is_torn_off) return std::vector<bool>(count, true);
  std::vector<std::uint32_t> parts = star.parts({});
  const auto are_one = [&] {
    return std::ranges::all_of(parts, [&](std::uint32_t part) { return part == parts[0]; });
  };
  if (are_one()) parts = star.parts(star.cut_across(along));
  if (are_one()) return is_fixed ? std::vector<bool>(count, true) : std::vector<bool>();
  std::map<std::uint32_t, double> pull;
  for (std::size_t i = 0; i < count; ++i)
    pull[parts[i]] += star.area(i) * dot(star.middle_of(i), along);
  const auto most = std::ranges::max_element(
      pull, {}, [](const std::pair<const std::uint32_t, double>& part) { return part.second; });
  std::vector<bool> goes(count);
  for (std::size_t i = 0; i < count; ++i) goes[i] = parts[i] == most->first;
  return goes;
}

}  // namespace
}  // namespace splitting

SheetSplitter::SheetSplitter(SceneDescription& description, std::vector<kernels::Vector>& x)
    : description_(description), x_(x), is_fixed_(x.size()) {
  for (const std::uint32_t i : description.fixed) is_fixed_[i] = true;
}

std::uint32_t SheetSplitter::split(std::uint32_t particle, kernels::Vector along) {
  SceneDescription& d = description_;
  const splitting::Star star(d, x_, particle);
  const std::vector<bool> goes =
      splitting::find_cut(star, splitting::unit(along), is_fixed_[particle]);
  if (goes.empty()) return kNoIndex;
  const splitting::Cut cut(star, goes);
  const auto added = static_cast<std::uint32_t>(x_.size());
  splitting::Rewiring(d, x_, cut, particle, added).run();
  const double mass = d.masses[particle];
  const double its = is_fixed_[particle] ? mass : mass * cut.share_of_goes();
  if (!is_fixed_[particle]) d.masses[particle] = mass - its;
  d.masses.push_back(its);
  d.positions.push_back(d.positions[particle]);
  if (!d.velocities.empty()) d.velocities.push_back(d.velocities[particle]);
  if (!d.radii.empty()) d.radii.push_back(d.radii[particle]);
  d.seams.push_back({.a = particle, .b = added, .strength = 0});
  x_.push_back(x_[particle]);
  is_fixed_.push_back(false);
  return added;
}

std::vector<std::uint32_t> SheetSplitter::ends_of_edge(const Constraint& c) const {
  const auto is_side = [&](const std::array<std::uint32_t, 3>& t) {
    return splitting::has(t, c.a) && splitting::has(t, c.b);
  };
  if (std::ranges::none_of(description_.surface, is_side)) return {};
  const auto rank = [&](std::uint32_t end) {
    return is_fixed_[end] ? 2 : splitting::Star(description_, x_, end).is_open() ? 0 : 1;
  };
  if (rank(c.b) < rank(c.a)) return {c.b, c.a};
  return {c.a, c.b};
}

}  // namespace weft
