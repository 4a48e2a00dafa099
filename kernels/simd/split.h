/// Double positions as two floats, in quads or rows (yarn_places.h): base is the position rounded,
/// u what that lost. Where base is rounded to cells, its differences are small whole numbers of
/// them.
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
[[gnu::always_inline]] inline Component load_component(const float* x) {
  return {load_as_double(x), load_as_double(x + kDoubles)};
}
[[gnu::always_inline]] inline Component widen(Floats f) {
  return {widen_first(f), widen_second(f)};
}
[[gnu::always_inline]] inline Component to_float_and_back(const Component& c) {
  return {to_float_and_back(c.first), to_float_and_back(c.second)};
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

struct Split {
  Floats base, u;
};
[[gnu::always_inline]] inline Split split(const Component& x, Doubles far) {
  const Component base = in_cells(x, far);
  return {narrow(base), narrow(x - to_float_and_back(base))};
}

void split_quads(kernels::VectorsView x, std::size_t first, std::size_t last, double cell,
                 float* base, float* u) {
  QuadsInRow at;
  const Doubles far(0x1.8p52 * cell);
  for (std::size_t i = first; i < last; i += kFloats) {
    const Split sx = split(load_component(x.x + i), far), sy = split(load_component(x.y + i), far);
    const Split sz = split(load_component(x.z + i), far);
    at.put(base + 4 * i, {sx.base, sy.base, sz.base});
    at.put(u + 4 * i, {sx.u, sy.u, sz.u});
  }
}

/// x moved to base + u: it keeps the bits that two floats cannot hold, and all of them where u has
/// not changed.
[[gnu::always_inline]] inline Component moved(const Component& x, const Component& base,
                                              const Component& u) {
  const Component by = u - to_float_and_back(x - base);
  return {x.first + by.first, x.second + by.second};
}
[[gnu::always_inline]] inline void move(double* x, Floats base, Floats u) {
  const Component after = moved(load_component(x), widen(base), widen(u));
  after.first.store_unaligned(x);
  after.second.store_unaligned(x + kDoubles);
}

void join_quads(kernels::VectorsView x, std::size_t first, std::size_t last, const float* base,
                const float* u) {
  QuadsInRow at;
  for (std::size_t i = first; i < last; i += kFloats) {
    FloatVector from = at.get(base + 4 * i);
    FloatVector by = at.get(u + 4 * i);
    move(x.x + i, from.x, by.x);
    move(x.y + i, from.y, by.y);
    move(x.z + i, from.z, by.z);
  }
}

/// Fours of a row, kFloats lanes in all. Lanes of no particle are 0, and lanes beside a row are not
/// touched: they may be another thread's.
struct Fours {
  const WovenRow& row;
  std::uint32_t first;

#if defined(__AVX512F__)
  [[gnu::always_inline]] Component get(const double* x) const {
    return {
        Doubles(_mm512_insertf64x4(_mm512_castpd256_pd512(get(x, first)), get(x, first + 1), 1)),
        Doubles(
            _mm512_insertf64x4(_mm512_castpd256_pd512(get(x, first + 2)), get(x, first + 3), 1))};
  }
  [[gnu::always_inline]] void put(double* x, const Component& c) const {
    put(x, first, _mm512_castpd512_pd256(c.first));
    put(x, first + 1, _mm512_extractf64x4_pd(c.first, 1));
    put(x, first + 2, _mm512_castpd512_pd256(c.second));
    put(x, first + 3, _mm512_extractf64x4_pd(c.second, 1));
  }
#elif defined(__AVX2__)
  [[gnu::always_inline]] Component get(const double* x) const {
    return {Doubles(get(x, first)), Doubles(get(x, first + 1))};
  }
  [[gnu::always_inline]] void put(double* x, const Component& c) const {
    put(x, first, c.first);
    put(x, first + 1, c.second);
  }
#else
  [[gnu::always_inline]] Component get(const double* x) const {
    if (row.count[first] == 4) return load_component(x + row.four[first]);
    alignas(64) double lanes[4]{};
    for (std::uint32_t k = 0; k < row.count[first]; ++k) lanes[k] = x[row.four[first] + k];
    return load_component(lanes);
  }
  [[gnu::always_inline]] void put(double* x, const Component& c) const {
    alignas(64) double lanes[4];
    c.first.store_aligned(lanes);
    c.second.store_aligned(lanes + kDoubles);
    for (std::uint32_t k = 0; k < row.count[first]; ++k) x[row.four[first] + k] = lanes[k];
  }
#endif

#if defined(__AVX2__)
 private:
  [[gnu::always_inline]] __m256d get(const double* x, std::uint32_t i) const {
    alignas(64) static constexpr std::int64_t kOwn[8] = {-1, -1, -1, -1, 0, 0, 0, 0};
    const __m256i own =
        _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kOwn + 4 - row.count[i]));
    return _mm256_maskload_pd(x + row.four[i], own);
  }
  [[gnu::always_inline]] void put(double* x, std::uint32_t i, __m256d v) const {
    if (row.count[i] == 4) return _mm256_storeu_pd(x + row.four[i], v);
    alignas(64) double lanes[4];
    _mm256_store_pd(lanes, v);
    for (std::uint32_t k = 0; k < row.count[i]; ++k) x[row.four[i] + k] = lanes[k];
  }
#endif
};

/// kFloats lanes of a row whose slots are all in a row.
struct InARow {
  std::size_t first;

  [[gnu::always_inline]] Component get(const double* x) const { return load_component(x + first); }
  [[gnu::always_inline]] void put(double* x, const Component& c) const {
    c.first.store_unaligned(x + first);
    c.second.store_unaligned(x + first + kDoubles);
  }
};

/// work(lanes of the row, where they stand), kFloats at a time
template <class Work>
[[gnu::always_inline]] inline void for_lanes(const WovenRow& row, Work&& work) {
  for (std::uint32_t lane = 0; lane < kernels::kLanes; lane += kFloats) {
    const std::size_t place = row.place + lane;
    if (row.in_a_row) {
      work(InARow{std::size_t{row.four[0]} + lane}, place);
    } else {
      work(Fours{row, lane / 4}, place);
    }
  }
}

/// Rows are in the order of their slots: in memory they are far from each other.
[[gnu::always_inline]] inline void fetch_ahead(const WovenRow* row, const WovenRow* last,
                                               const float* base, const float* u) {
  constexpr std::ptrdiff_t kAhead = 8;
  if (last - row <= kAhead) return;
  for (std::size_t axis = 0; axis < kRowFloats; axis += kernels::kLanes) {
    __builtin_prefetch(base + row[kAhead].place + axis, 1);
    __builtin_prefetch(u + row[kAhead].place + axis, 1);
  }
}

void split_rows(kernels::VectorsView x, const WovenRow* rows, std::size_t count, double cell,
                float* base, float* u) {
  const Doubles far(0x1.8p52 * cell);
  for (const WovenRow* row = rows; row < rows + count; ++row) {
    fetch_ahead(row, rows + count, base, u);
    for_lanes(
        *row, [&](const auto& lanes, std::size_t place) __attribute__((always_inline)) {
          for (const double* axis : {x.x, x.y, x.z}) {
            const Split s = split(lanes.get(axis), far);
            s.base.store_unaligned(base + place);
            s.u.store_unaligned(u + place);
            place += kernels::kLanes;
          }
        });
  }
}

void join_rows(kernels::VectorsView x, const WovenRow* rows, std::size_t count, const float* base,
               const float* u) {
  for (const WovenRow* row = rows; row < rows + count; ++row) {
    fetch_ahead(row, rows + count, base, u);
    for_lanes(
        *row, [&](const auto& lanes, std::size_t place) __attribute__((always_inline)) {
          for (double* axis : {x.x, x.y, x.z}) {
            lanes.put(axis, moved(lanes.get(axis), load_component(base + place),
                                  load_component(u + place)));
            place += kernels::kLanes;
          }
        });
  }
}

/// u = x - base, where base is near enough to stay.
void offset_quads(kernels::VectorsView x, std::size_t first, std::size_t last, const float* base,
                  float* u) {
  QuadsInRow at;
  const auto offset = [](const double* from, Floats b) {
    return narrow(load_component(from) - widen(b));
  };
  for (std::size_t i = first; i < last; i += kFloats) {
    FloatVector b = at.get(base + 4 * i);
    at.put(u + 4 * i, {offset(x.x + i, b.x), offset(x.y + i, b.y), offset(x.z + i, b.z)});
  }
}

void offset_rows(kernels::VectorsView x, const WovenRow* rows, std::size_t count, const float* base,
                 float* u) {
  for (const WovenRow* row = rows; row < rows + count; ++row) {
    for_lanes(
        *row, [&](const auto& lanes, std::size_t place) __attribute__((always_inline)) {
          for (const double* axis : {x.x, x.y, x.z}) {
            narrow(lanes.get(axis) - load_component(base + place)).store_unaligned(u + place);
            place += kernels::kLanes;
          }
        });
  }
}

void narrow_quads(kernels::VectorsView x, std::size_t first, std::size_t last, float* to) {
  QuadsInRow at;
  for (std::size_t i = first; i < last; i += kFloats) {
    at.put(to + 4 * i, {narrow(load_component(x.x + i)), narrow(load_component(x.y + i)),
                        narrow(load_component(x.z + i))});
  }
}

void narrow_rows(kernels::VectorsView x, const WovenRow* rows, std::size_t count, float* to) {
  for (const WovenRow* row = rows; row < rows + count; ++row) {
    for_lanes(
        *row, [&](const auto& lanes, std::size_t place) __attribute__((always_inline)) {
          for (const double* axis : {x.x, x.y, x.z}) {
            narrow(lanes.get(axis)).store_unaligned(to + place);
            place += kernels::kLanes;
          }
        });
  }
}

void widen_quads(kernels::VectorsView x, std::size_t first, std::size_t last, const float* from) {
  QuadsInRow at;
  const auto put = [](double* to, Floats f) {
    widen_first(f).store_unaligned(to);
    widen_second(f).store_unaligned(to + kDoubles);
  };
  for (std::size_t i = first; i < last; i += kFloats) {
    FloatVector v = at.get(from + 4 * i);
    put(x.x + i, v.x);
    put(x.y + i, v.y);
    put(x.z + i, v.z);
  }
}

void widen_rows(kernels::VectorsView x, const WovenRow* rows, std::size_t count,
                const float* from) {
  for (const WovenRow* row = rows; row < rows + count; ++row) {
    for_lanes(
        *row, [&](const auto& lanes, std::size_t place) __attribute__((always_inline)) {
          for (double* axis : {x.x, x.y, x.z}) {
            lanes.put(axis, load_component(from + place));
            place += kernels::kLanes;
          }
        });
  }
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
