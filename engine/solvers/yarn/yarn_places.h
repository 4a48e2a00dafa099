/// Where the particles of the yarn solver stand, in one of two layouts
/// (kernels/simd/yarn_places.h), and the way there from slots and back.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/simd/table.h"

namespace weft {

class Model;
struct YarnLayout;

struct YarnPlaces {
  /// Of a particle that is in no WovenRow.
  struct Loose {
    std::uint32_t slot = 0, place = 0;
  };
  std::vector<std::uint32_t> place;       // per slot: of its x; empty: quads
  std::size_t stride = 1;                 // from x to y, from y to z
  std::size_t floats = 0, padding = 0;    // of an array; the first behind all particles'
  std::vector<simd::WovenRow> rows;       // in the order of their slots
  std::vector<Loose> loose;               // likewise
  std::vector<std::uint32_t> loose_rows;  // places of rows of memory of which some are loose

  bool woven() const { return !place.empty(); }
  std::uint32_t of(std::uint32_t slot) const { return place.empty() ? 4 * slot : place[slot]; }
  /// Positions as two floats (kernels/simd/split.h), and back, in either layout. Slots between
  /// multiples of kLanes; a row goes with its first.
  void split(const simd::Table& table, kernels::VectorsView x, double cell, std::size_t first,
             std::size_t last, float* base, float* u) const;
  void join(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
            const float* base, const float* u) const;
  /// u = x - base; to = x, rounded; x = from. Likewise.
  void offset(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
              const float* base, float* u) const;
  void narrow(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
              float* to) const;
  void widen(const simd::Table& table, kernels::VectorsView x, std::size_t first, std::size_t last,
             const float* from) const;
  /// Clears what split() does not write, all that is nobody's: a step that left the range of
  /// numbers may have reached it.
  void clear(float* u) const;
  std::size_t bytes() const;

 private:
  /// by_rows(rows, how many) of woven rows, one_by_one(a component of x, where it stands) of what
  /// is in none.
  template <class ByRows, class OneByOne>
  void visit(kernels::VectorsView x, std::size_t first, std::size_t last, ByRows&& by_rows,
             OneByOne&& one_by_one) const;
};

/// Weaves a layout whose blocks are in quads, if nearly all of it can be woven: its blocks find
/// their particles in place and in patches from then on, and it has no slots any more. Rows stay
/// within tiles.
void weave(const Model& model, YarnLayout& layout);

}  // namespace weft
