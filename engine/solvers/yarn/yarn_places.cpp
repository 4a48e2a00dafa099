#include "engine/solvers/yarn/yarn_places.h"

#include <algorithm>
#include <span>

#include "engine/bytes_of.h"

namespace weft {
namespace {

/// The part of a list, sorted by slots, whose slots are in [first, last).
template <class T, class SlotOf>
std::span<const T> between(const std::vector<T>& list, SlotOf slot_of, std::size_t first,
                           std::size_t last) {
  const auto begin = std::ranges::lower_bound(list, first, {}, slot_of);
  const auto end = std::ranges::lower_bound(begin, list.end(), last, {}, slot_of);
  return {list.data() + (begin - list.begin()), static_cast<std::size_t>(end - begin)};
}
std::size_t slot_of_row(const simd::WovenRow& row) { return row.four[0]; }
std::size_t slot_of_loose(const YarnPlaces::Loose& loose) { return loose.slot; }

/// The operations of kernels/simd/split.h for one number.
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

template <class ByRows, class OneByOne>
void YarnPlaces::visit(kernels::VectorsView x, std::size_t first, std::size_t last,
                       ByRows&& by_rows, OneByOne&& one_by_one) const {
  const auto woven = between(rows, slot_of_row, first, last);
  by_rows(woven.data(), woven.size());
  for (const Loose& one : between(loose, slot_of_loose, first, last)) {
    std::size_t at = one.place;
    for (double* axis : {x.x, x.y, x.z}) {
      one_by_one(axis[one.slot], at);
      at += stride;
    }
  }
}

void YarnPlaces::split(const simd::Table& table, kernels::VectorsView x, double cell,
                       std::size_t first, std::size_t last, float* base, float* u) const {
  if (!woven()) return table.split_quads(x, first, last, cell, base, u);
  visit(
      x, first, last,
      [&](const auto* of, std::size_t n) { table.split_rows(x, of, n, cell, base, u); },
      [&](double from, std::size_t at) { weft::split(from, cell, base[at], u[at]); });
}

void YarnPlaces::join(const simd::Table& table, kernels::VectorsView x, std::size_t first,
                      std::size_t last, const float* base, const float* u) const {
  if (!woven()) return table.join_quads(x, first, last, base, u);
  visit(
      x, first, last, [&](const auto* of, std::size_t n) { table.join_rows(x, of, n, base, u); },
      [&](double& to, std::size_t at) { weft::join(to, base[at], u[at]); });
}

void YarnPlaces::offset(const simd::Table& table, kernels::VectorsView x, std::size_t first,
                        std::size_t last, const float* base, float* u) const {
  if (!woven()) return table.offset_quads(x, first, last, base, u);
  visit(
      x, first, last, [&](const auto* of, std::size_t n) { table.offset_rows(x, of, n, base, u); },
      [&](double from, std::size_t at) {
        u[at] = static_cast<float>(from - static_cast<double>(base[at]));
      });
}

void YarnPlaces::narrow(const simd::Table& table, kernels::VectorsView x, std::size_t first,
                        std::size_t last, float* to) const {
  if (!woven()) return table.narrow_quads(x, first, last, to);
  visit(
      x, first, last, [&](const auto* of, std::size_t n) { table.narrow_rows(x, of, n, to); },
      [&](double from, std::size_t at) { to[at] = static_cast<float>(from); });
}

void YarnPlaces::widen(const simd::Table& table, kernels::VectorsView x, std::size_t first,
                       std::size_t last, const float* from) const {
  if (!woven()) return table.widen_quads(x, first, last, from);
  visit(
      x, first, last, [&](const auto* of, std::size_t n) { table.widen_rows(x, of, n, from); },
      [&](double& to, std::size_t at) { to = static_cast<double>(from[at]); });
}

void YarnPlaces::clear(float* u) const {
  for (const std::uint32_t row : loose_rows) std::fill_n(u + row, simd::kRowFloats, 0.f);
  std::fill(u + padding, u + floats, 0.f);
}

std::size_t YarnPlaces::bytes() const {
  return bytes_of(place) + bytes_of(rows) + bytes_of(loose) + bytes_of(loose_rows);
}

}  // namespace weft
