/// The places of particles in the arrays of the yarn solver, in one of two layouts
/// (kernels/simd/yarn_places.h), and the conversion from slots and back.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/simd/table.h"

namespace weft {

class Model;
struct YarnLayout;

struct YarnPlaces {
  /// A particle that is in no WovenRow.
  struct Loose {
    std::uint32_t slot = 0, place = 0;
  };
  std::vector<std::uint32_t> place;       // per slot: the index of x; empty for quads
  std::size_t stride = 1;                 // from x to y and from y to z
  std::size_t floats = 0, padding = 0;    // of an array: its size; where padding begins
  std::vector<simd::WovenRow> rows;       // in the order of their slots
  std::vector<Loose> loose;               // in the order of their slots
  std::vector<std::uint32_t> loose_rows;  // places of rows of memory with loose particles

  bool woven() const { return !place.empty(); }
  std::uint32_t of(std::uint32_t slot) const { return place.empty() ? 4 * slot : place[slot]; }
  /// Splits positions into two floats each (kernels/simd/split.h), and joins them again, in either
  /// layout. The range of slots begins and ends at multiples of kLanes; a woven row belongs to the
  /// range of its first slot.
  void split(const simd::Table& table, kernels::VectorsView x, double cell, std::size_t first,
             std::size_t last, float* base, float* u) const;
  void join(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
            const float* base, const float* u) const;
  /// Likewise: offset sets u = x - base, narrow rounds x to float, and widen converts back.
  void offset(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
              const float* base, float* u) const;
  void narrow(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
              float* to) const;
  void widen(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
             const float* from) const;
  /// Clears the elements without a particle, which split() does not write: a step that left the
  /// range of numbers may have written to them.
  void clear(float* u) const;
  std::size_t bytes() const;

 private:
  /// Calls by_rows(rows, count) for the woven rows of the range, and one_by_one(component of x, its
  /// place) for each loose particle.
  template <class ByRows, class OneByOne>
  void visit(kernels::VectorsView x, std::size_t first, std::size_t last, ByRows&& by_rows,
             OneByOne&& one_by_one) const;
};

/// Weaves a layout whose blocks are in quads, if nearly all of it can be woven. Blocks then find
/// their particles in place and in patches, and the layout has no slots any more. Rows of memory
/// stay within tiles.
void weave(const Model& model, YarnLayout& layout);

}  // namespace weft
