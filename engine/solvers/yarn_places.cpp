#include "engine/solvers/yarn_places.h"

#include <algorithm>
#include <span>

#include "engine/bytes_of.h"

namespace weft {
namespace {

/// Of a list in the order of slots, what begins with slots first ... last - 1.
template <class T, class SlotOf>
std::span<const T> between(const std::vector<T>& list, SlotOf slot_of, std::size_t first,
                           std::size_t last) {
  const auto begin = std::ranges::lower_bound(list, first, {}, slot_of);
  const auto end = std::ranges::lower_bound(begin, list.end(), last, {}, slot_of);
  return {begin, end};
}
std::size_t slot_of_row(const simd::WovenRow& row) { return row.four[0]; }
std::size_t slot_of_loose(const YarnPlaces::Loose& loose) { return loose.slot; }

/// kernels/simd/split.h, one by one.
void split(double x, double cell, float& base, float& u) {
  const double far = 0x1.8p52 * cell;
  base = static_cast<float>((x + far) - far);
  u = static_cast<float>(x - static_cast<double>(base));
}
void join(double& x, float base, float u) {
  const auto known = static_cast<float>(x - static_cast<double>(base));
  x += static_cast<double>(u) - static_cast<double>(known);
}

}  // namespace

void YarnPlaces::split(const simd::Table& table, kernels::VectorsView x, double cell,
                       std::size_t first, std::size_t last, float* base, float* u) const {
  if (!woven()) {
    table.split_quads(x, first, last, cell, base, u);
    return;
  }
  const auto woven = between(rows, slot_of_row, first, last);
  table.split_rows(x, woven.data(), woven.size(), cell, base, u);
  for (const Loose& one : between(loose, slot_of_loose, first, last)) {
    std::size_t at = one.place;
    for (const double* axis : {x.x, x.y, x.z}) {
      weft::split(axis[one.slot], cell, base[at], u[at]);
      at += stride;
    }
  }
}

void YarnPlaces::join(const simd::Table& table, kernels::VectorsView x, std::size_t first,
                      std::size_t last, const float* base, const float* u) const {
  if (!woven()) {
    table.join_quads(x, first, last, base, u);
    return;
  }
  const auto woven = between(rows, slot_of_row, first, last);
  table.join_rows(x, woven.data(), woven.size(), base, u);
  for (const Loose& one : between(loose, slot_of_loose, first, last)) {
    std::size_t at = one.place;
    for (double* axis : {x.x, x.y, x.z}) {
      weft::join(axis[one.slot], base[at], u[at]);
      at += stride;
    }
  }
}

void YarnPlaces::widen(const simd::Table& table, kernels::VectorsView x, std::size_t first,
                       std::size_t last, const float* from) const {
  if (!woven()) return table.widen_quads(x, first, last, from);
  const auto woven = between(rows, slot_of_row, first, last);
  table.widen_rows(x, woven.data(), woven.size(), from);
  for (const Loose& one : between(loose, slot_of_loose, first, last)) {
    std::size_t at = one.place;
    for (double* axis : {x.x, x.y, x.z}) {
      axis[one.slot] = static_cast<double>(from[at]);
      at += stride;
    }
  }
}

void YarnPlaces::clear(float* u) const {
  for (const std::uint32_t row : loose_rows) std::fill_n(u + row, simd::kRowFloats, 0.f);
  std::fill(u + padding, u + floats, 0.f);
}

std::size_t YarnPlaces::bytes() const {
  return bytes_of(place) + bytes_of(rows) + bytes_of(loose) + bytes_of(loose_rows);
}

}  // namespace weft
