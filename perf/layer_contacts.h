/// Contacts and candidates of layers, in the arrays that kernels take.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/simd/contact_data.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"
#include "perf/layers.h"

namespace weft::perf {

/// Near pairs as engine/contact/contacts.cpp puts them in order: points before edges, nearest
/// first; colours by masks; points numbered as they first come.
class LayerContacts {
 public:
  explicit LayerContacts(const Layers& layers);

  /// Where a substep begins that gravity is all of, without multipliers.
  void fall(const simd::Table& table);
  void freeze(const simd::Table& table);
  void find_active(const simd::Table& table);
  /// A round, over what touched in the beginning.
  void visit(const simd::Table& table);

  double near() const { return static_cast<double>(near_); }
  double touching() const { return static_cast<double>(touching_); }
  /// Of all blocks, of those that have what touches, and of moves.
  double bytes() const;
  double active_bytes() const;
  double move_bytes() const;

 private:
  struct Colour {
    std::uint32_t first = 0, last = 0;  // blocks
  };
  void number(std::uint32_t point);
  void colour(const std::vector<LayerPair>& waiting);
  void put(const std::vector<LayerPair>& pairs);
  void put_places(const Layers& layers);
  void gather_active();
  simd::ContactSolve solving() { return {blocks_.data(), moves_.data()}; }

  std::vector<std::uint32_t> numbers_, points_;
  std::size_t moving_ = 0;  // of points_, that contacts have
  kernels::AlignedVector<simd::ContactBlock> blocks_;
  std::size_t edges_from_ = 0;                    // blocks
  kernels::AlignedVector<float> places_, moves_;  // quads
  std::vector<Colour> colours_, active_colours_;
  std::vector<std::uint32_t> active_blocks_;
  std::vector<std::uint16_t> active_;
  std::size_t near_ = 0;
  int touching_ = 0;
};

/// Candidates in the order in which they are found, points before edges, when an interval begins.
class LayerCandidates {
 public:
  explicit LayerCandidates(const Layers& layers);

  void measure(const simd::Table& table);

  double count() const { return static_cast<double>(count_); }
  /// As they were measured last.
  double near() const;
  double bytes() const;

 private:
  using Lanes = std::array<float, kernels::kLanes>;
  void put(const Layers& layers, bool edges);

  kernels::AlignedVector<simd::PairBlock> blocks_;
  std::size_t edges_from_ = 0, count_ = 0;
  kernels::AlignedVector<float> points_, ways_;  // quads
  std::vector<Lanes> distance_;
  std::vector<std::uint16_t> near_;
};

}  // namespace weft::perf
