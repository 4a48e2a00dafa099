/// Displacements in quads, | x y z - |, one slot each (sweep_data.h): a scattered slot is one load
/// of 16 bytes, and four of them make vectors by a transpose of 4 x 4. In vectors of more than four
/// lanes that happens in each 128 bits on their own, so the register that holds lane 0 also holds
/// lanes 4, 8 and 12:
///
///     q0 = | slot 0 | slot 4 | ...        x = | x0 x1 x2 x3 | x4 x5 x6 x7 | ...
///     q1 = | slot 1 | slot 5 | ...   ->   y = | y0 y1 y2 y3 | y4 y5 y6 y7 | ...
///     q2 = | slot 2 | slot 6 | ...        z = | z0 z1 z2 z3 | z4 z5 z6 z7 | ...
///     q3 = | slot 3 | slot 7 | ...
#pragma once

#include "kernels/simd/lanes.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

/// Where quads stand, in floats: of slots, or of places, which are slots times four.
struct QuadSlots {
  const std::uint32_t* slot;
  [[gnu::always_inline]] std::size_t operator[](std::size_t k) const {
    return 4 * std::size_t{slot[k]};
  }
};
struct QuadPlaces {
  const std::uint32_t* place;
  [[gnu::always_inline]] std::size_t operator[](std::size_t k) const { return place[k]; }
};

template <class At>
[[gnu::always_inline]] inline void subtract_quads(float* u, At at, Floats q) {
  store_quads(u, at, load_quads(u, at) - q);
}

/// Four vectors of quads and the vectors of their components: a transpose of 4 x 4 in each 128
/// bits.
struct Quads {
  Floats q0, q1, q2, q3;
};
[[gnu::always_inline]] inline FloatVector transposed(Floats q0, Floats q1, Floats q2, Floats q3) {
  const Floats xy01 = unpack_low(q0, q1), xy23 = unpack_low(q2, q3);
  const Floats z01 = unpack_high(q0, q1), z23 = unpack_high(q2, q3);
  return {low_pairs(xy01, xy23), high_pairs(xy01, xy23), low_pairs(z01, z23)};
}
[[gnu::always_inline]] inline Quads transposed(const FloatVector& v) {
  const Floats none(0.f);
  const Floats xy01 = unpack_low(v.x, v.y), xy23 = unpack_high(v.x, v.y);
  const Floats z01 = unpack_low(v.z, none), z23 = unpack_high(v.z, none);
  return {low_pairs(xy01, z01), high_pairs(xy01, z01), low_pairs(xy23, z23), high_pairs(xy23, z23)};
}

/// Scattered slots.
struct QuadLanes {
  [[gnu::always_inline]] FloatVector get(const Displacements& u, const std::uint32_t* slot) const {
    return get(u.x, slot);
  }
  [[gnu::always_inline]] FloatVector get(const float* u, const std::uint32_t* slot) const {
    return transposed(load_quads(u, QuadSlots{slot}), load_quads(u, QuadSlots{slot + 1}),
                      load_quads(u, QuadSlots{slot + 2}), load_quads(u, QuadSlots{slot + 3}));
  }
  /// Their spare floats.
  [[gnu::always_inline]] Floats fourth(const float* u, const std::uint32_t* slot) const {
    const Floats zw01 =
        unpack_high(load_quads(u, QuadSlots{slot}), load_quads(u, QuadSlots{slot + 1}));
    const Floats zw23 =
        unpack_high(load_quads(u, QuadSlots{slot + 2}), load_quads(u, QuadSlots{slot + 3}));
    return high_pairs(zw01, zw23);
  }
  [[gnu::always_inline]] void put(const Displacements& u, const std::uint32_t* slot,
                                  const FloatVector& v) const {
    put(u.x, slot, v);
  }
  [[gnu::always_inline]] void put(float* u, const std::uint32_t* slot, const FloatVector& v) const {
    Quads q = transposed(v);
    store_quads(u, QuadSlots{slot}, q.q0);
    store_quads(u, QuadSlots{slot + 1}, q.q1);
    store_quads(u, QuadSlots{slot + 2}, q.q2);
    store_quads(u, QuadSlots{slot + 3}, q.q3);
  }
};

/// Quads of kFloats slots in a row.
struct QuadsInRow {
  [[gnu::always_inline]] FloatVector get(const float* u) const {
    FloatVector v =
        transposed(load(u), load(u + kFloats), load(u + 2 * kFloats), load(u + 3 * kFloats));
    return {in_order(v.x), in_order(v.y), in_order(v.z)};
  }
  [[gnu::always_inline]] void put(float* u, const FloatVector& v) const {
    Quads q = transposed({out_of_order(v.x), out_of_order(v.y), out_of_order(v.z)});
    q.q0.store_unaligned(u);
    q.q1.store_unaligned(u + kFloats);
    q.q2.store_unaligned(u + 2 * kFloats);
    q.q3.store_unaligned(u + 3 * kFloats);
  }
};

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
