/// The lines along which triangles of a cloth cross each other, and the parts of the cloth that
/// they cut off: global intersection analysis (Baraff, Witkin and Kass 2003, "Untangling cloth").
///
/// A contour leads from one edge that pierces a triangle to the next one. It vanishes in two ways:
/// it leaves the cloth over a border, or it shrinks to a point in both of the sheets that meet in
/// it. So it cuts off a part that is on the wrong side if that part has a border, or if each sheet
/// along the contour has a part without one. The wrong one of such parts has the fewest held
/// particles, and is the lightest of several. A contour that ends within the cloth cuts off
/// nothing. At an edge of more than two triangles, as where a pocket is sewn on, each of the sheets
/// has a border.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/contact/points.h"

namespace weft {

/// An edge that pierces a triangle.
struct Piercing {
  std::uint32_t edge = 0, triangle = 0;
  std::uint32_t contour = 0;
  std::array<std::uint32_t, 5> points{};  // ends of the edge, corners of the triangle
  std::array<double, 5> weight{};         // of the place on the edge less that on the triangle
  std::array<double, 2> side{};           // six times a volume, of either end beside the triangle
  /// Else the ends are on one side, but not yet so far from the triangle that they stay there.
  bool is_through() const { return (side[0] > 0) != (side[1] > 0); }
};

class Contours {
 public:
  /// When an interval begins. crossing: pairs of triangles (SelfTangles::crossing).
  void find(const ContactPoints& points, const std::vector<std::uint64_t>& crossing);
  /// One contour after the other.
  std::span<const Piercing> piercings() const { return piercings_; }
  void clear() { piercings_.clear(); }
  std::size_t bytes() const;

 private:
  void add(const ContactPoints& points, std::uint32_t one, std::uint32_t other, std::uint32_t pair);
  std::uint32_t root_of(std::uint32_t pair);

  std::vector<Piercing> piercings_;
  std::vector<std::uint32_t> parent_;  // per pair: another one of its contour, or itself
};

/// The part of the cloth that a contour has cut off and that is to come out.
class WrongPart {
 public:
  void find(const ContactPoints& points, std::span<const Piercing> contour);
  bool any() const { return wrong_ != kNoIndex; }
  bool has(const ContactPoints& points, std::uint32_t point) const;
  std::size_t bytes() const;

 private:
  /// Points reached from beside the contour, without crossing it. It grows, and becomes a part of
  /// another one where they meet.
  struct Region {
    std::uint32_t first = kNoIndex, last = kNoIndex;  // of waiting_: points to go on from
    double mass = 0;
    int held = 0;  // points
    bool has_border = false;
    bool is_beside_itself = false;  // across the contour
    bool is_whole() const { return first == kNoIndex; }
  };
  struct Waiting {
    std::uint32_t point = 0, next = kNoIndex;
  };
  void cut(std::span<const Piercing> contour);
  void begin_regions(const ContactPoints& points);
  void clear();
  void reach(std::uint32_t region, std::uint32_t point);
  void grow(const ContactPoints& points, std::uint32_t region, std::size_t steps);
  void visit(const ContactPoints& points, std::uint32_t& region, std::uint32_t point);
  void unite(std::uint32_t into, std::uint32_t other);
  bool grow_all(const ContactPoints& points, std::size_t steps);
  bool is_settled(const ContactPoints& points) const;
  void choose(const ContactPoints& points, bool free);
  std::uint32_t root_of(std::uint32_t region) const;
  std::uint32_t region_at(const ContactPoints& points, std::uint32_t point) const;
  bool is_cut(std::uint32_t a, std::uint32_t b) const;
  static void find_around(const ContactPoints& points, std::uint32_t point,
                          std::vector<std::uint32_t>& around);
  bool is_wall(const ContactPoints& points, std::uint32_t point);

  std::vector<std::array<std::uint32_t, 2>> cuts_;  // edges, ascending
  std::vector<std::uint32_t> region_of_;            // per point, the first of those sewn to it
  std::vector<std::uint32_t> reached_;              // points
  std::vector<Region> regions_;
  std::vector<std::uint32_t> parent_;  // per region
  std::vector<Waiting> waiting_;
  std::vector<std::uint32_t> around_, beside_;  // scratch: of a point
  std::uint32_t wrong_ = kNoIndex;              // region
};

}  // namespace weft
