/// Double positions as two floats in quads (quads.h): base is the position rounded, u what that
/// lost. Where base is rounded to cells, its differences are small whole numbers of them.
#pragma once

#include "kernels/simd/quads.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// A component of kFloats slots, in double.
struct Component {
  Doubles first, second;
};
[[gnu::always_inline]] inline Component load_component(const double* x) {
  return {load(x), load(x + kDoubles)};
}
[[gnu::always_inline]] inline Component widen(Floats f) {
  return {widen_first(f), widen_second(f)};
}
[[gnu::always_inline]] inline Component operator-(const Component& a, const Component& b) {
  return {a.first - b.first, a.second - b.second};
}
[[gnu::always_inline]] inline Floats narrow(const Component& c) {
  return narrow(c.first, c.second);
}

/// To a multiple of the cell: at 1.5 * 2^52 cells the next number is a cell away.
[[gnu::always_inline]] inline Component in_cells(const Component& c, Doubles far) {
  return {(c.first + far) - far, (c.second + far) - far};
}

void split_positions(kernels::VectorsView x, Displacements base, Displacements u, double cell,
                     std::size_t first, std::size_t last) {
  QuadsInRow at;
  const Doubles far(0x1.8p52 * cell);
  for (std::size_t i = first; i < last; i += kFloats) {
    const Component px = load_component(x.x + i), py = load_component(x.y + i);
    const Component pz = load_component(x.z + i);
    const FloatVector rounded{narrow(in_cells(px, far)), narrow(in_cells(py, far)),
                              narrow(in_cells(pz, far))};
    at.put(base.x + 4 * i, rounded);
    at.put(u.x + 4 * i, {narrow(px - widen(rounded.x)), narrow(py - widen(rounded.y)),
                         narrow(pz - widen(rounded.z))});
  }
}

/// x keeps the bits that two floats cannot hold, and all of them where u has not changed.
[[gnu::always_inline]] inline void move(double* x, Floats base, Floats u) {
  const Component before = load_component(x), after = widen(u);
  const Component known = widen(narrow(before - widen(base)));
  (before.first + (after.first - known.first)).store_unaligned(x);
  (before.second + (after.second - known.second)).store_unaligned(x + kDoubles);
}

void join_positions(kernels::VectorsView x, Displacements base, Displacements u, std::size_t first,
                    std::size_t last) {
  QuadsInRow at;
  for (std::size_t i = first; i < last; i += kFloats) {
    const FloatVector from = at.get(base.x + 4 * i);
    const FloatVector by = at.get(u.x + 4 * i);
    move(x.x + i, from.x, by.x);
    move(x.y + i, from.y, by.y);
    move(x.z + i, from.z, by.z);
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
