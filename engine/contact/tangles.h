/// Triangles of the cloth that cross a body which is a mesh: one was put there, positions were
/// written, or more came together than could be kept apart. Which way they would come apart cannot
/// be told from where they are, so their edges and faces are no contacts until they have. Their
/// particles are kept out as all others are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/contact/features.h"
#include "engine/contact/points.h"

namespace weft {

class Tangles {
 public:
  explicit Tangles(const simd::Table& table) : table_(table) {}

  /// Of a frame. slots: those of the frame before, when it was over.
  void begin(const TriangleSurface& cloth, std::span<const std::uint32_t> slots);
  enum class Moment { start, end };
  /// Among all triangles, where an interval begins or ends.
  void find(const ContactPoints& points, Moment moment);

  int count() const { return static_cast<int>(triangles_.size()); }
  /// Whether the pair is left alone.
  bool leaves_out(const Pair& pair) const {
    if (triangles_.empty() || pair.kind == PairKind::particle_triangle) return false;
    return pair.kind == PairKind::edges ? has_edge_[pair.of_cloth] : has_triangle_[pair.of_cloth];
  }
  /// Corners of triangles that cross, ascending.
  const std::vector<std::uint32_t>& slots() const { return slots_; }
  std::size_t bytes() const;

 private:
  template <class At>
  bool crosses(const ContactPoints& points, std::uint32_t triangle, At&& at) const;
  void forget();
  void add(std::uint32_t triangle);
  void gather_slots();

  const simd::Table& table_;
  const TriangleSurface* cloth_ = nullptr;
  std::vector<std::uint32_t> triangles_, slots_;
  std::vector<bool> has_triangle_, has_edge_;  // empty until the first one crosses
};

}  // namespace weft
