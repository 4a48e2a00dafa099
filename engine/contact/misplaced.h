/// Particles inside a mesh body, and triangles that cross one. They are a part of the state of a
/// cloth, since they do not follow from positions.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/saving/archive.h"

namespace weft {

/// Slots, ascending.
struct Misplaced {
  std::vector<std::uint32_t> inside;    // on the wrong side of a one-sided body
  std::vector<std::uint32_t> crossing;  // corners of triangles that cross a body

  std::vector<std::uint64_t> tangled;  // pairs of triangles of the cloth (SelfTangles::begin)

  bool is_inside(std::uint32_t slot) const { return std::ranges::binary_search(inside, slot); }
  void clear() {
    inside.clear();
    crossing.clear();
    tangled.clear();
  }
  /// Adds the marks of another cloth's slot to this one's.
  void take_over(const Misplaced& other, std::uint32_t its_slot, std::uint32_t slot) {
    if (other.is_inside(its_slot)) inside.push_back(slot);
    if (std::ranges::binary_search(other.crossing, its_slot)) crossing.push_back(slot);
  }
  void sort() {
    std::ranges::sort(inside);
    std::ranges::sort(crossing);
  }

  std::size_t bytes() const { return bytes_of(inside) + bytes_of(crossing) + bytes_of(tangled); }

  friend void visit_fields(Is<Misplaced> auto& misplaced, auto& archive) {
    auto& [inside, crossing, tangled] = misplaced;
    archive(inside, crossing, tangled);
  }
};

}  // namespace weft
