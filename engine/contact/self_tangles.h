/// Pairs of triangles of a cloth that cross each other: the cloth was made or placed so, or
/// features could not be kept apart. They may come apart. Until then their features do not collide,
/// and are not verified. Triangles that cross may go on to cross their neighbours; all others are
/// kept apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/contact/points.h"

namespace weft {

class SelfTangles {
 public:
  explicit SelfTangles(const simd::Table& table) : table_(table) {}

  /// A frame begins with the pairs that the frame before left. A pair is its first triangle and, in
  /// the lower half, its second one, which is the later; pairs ascend.
  void begin(const TriangleSurface& cloth, const std::vector<std::uint64_t>& pairs);
  /// An interval begins: pairs that cross now are left out until it is over, for where features
  /// begin on the wrong sides no verification tells what they do. The end of an interval may be
  /// looked at more than once: pairs that came apart the first time may cross again the second.
  void begin_interval();
  /// Finds anew what crosses when an interval begins, or when it ends. Where nothing had to be
  /// stopped in it only triangles of pairs, and those beside these, may cross each other. Once in a
  /// frame all are looked at: rounding may lead on what has just come apart.
  void find_at_start(const ContactPoints& points);
  void find_at_end(const ContactPoints& points, bool has_failed);
  bool leaves_out(const Pair& pair) const { return !pairs_.empty() && has_features_of(pair); }
  /// Whether faces beside the features cross each other: there a contact has no side.
  bool cross_beside(const Pair& pair, const std::array<std::uint32_t, 4>& points) const;
  /// Pairs that cross, as they were last found.
  const std::vector<std::uint64_t>& crossing() const { return crossing_; }
  std::size_t bytes() const;

 private:
  template <class At>
  void find(const ContactPoints& points, bool everywhere, At&& at);
  bool has_features_of(const Pair& pair) const;
  bool has(std::uint32_t a, std::uint32_t b) const;
  bool has_one_at_edge(std::uint32_t edge, std::uint32_t triangle) const;
  void mark_ones();
  void mark_beside(const std::vector<std::uint64_t>& pairs);

  const simd::Table& table_;
  const TriangleSurface* cloth_ = nullptr;
  std::vector<std::uint64_t> pairs_;     // that crossed when the interval began
  std::vector<std::uint64_t> crossing_;  // as last found
  std::vector<std::uint8_t> is_one_;     // per triangle: it is of pairs_
  /// Per triangle: it has a corner in common with one of a pair, or of what was one since all were
  /// looked at.
  std::vector<std::uint8_t> may_cross_;
  bool has_looked_ = false;  // everywhere, in this frame
};

}  // namespace weft
