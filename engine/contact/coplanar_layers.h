/// Layers of a cloth that begin exactly in one plane: sheets over each other at one height, and
/// cloth that was folded flat. They are on no side of each other. So their particles are first
/// moved apart by a micrometre, in an order that depends on numbers and on normals alone.
///
/// A piece is a connected part of the cloth; a layer of it ends where it is folded back by more
/// than a right angle. Each piece moves to its front, which is that of its first triangle and goes
/// on behind folds, and the later pieces go farther. The layers of a piece move apart likewise,
/// each to its own front.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/triangles/box_tree.h"
#include "kernels/simd/table.h"
#include "kernels/vectors.h"

namespace weft {

class CoplanarLayers {
 public:
  /// Returns whether some lie in one plane at x, over each other or nearer than the thickness.
  bool find(const Model& model, const simd::Table& table, const kernels::Vectors& x);
  /// Moves apart the particles that were found. Held ones stay.
  void part(const Model& model, kernels::Vectors& x);
  std::size_t bytes() const;

 private:
  /// The place of a triangle. Numbers are those of the first triangles.
  struct Place {
    std::uint32_t piece = 0, layer = 0;
    bool is_turned = false;  // its front is behind that of its piece
  };
  /// The later of two pieces, or of two layers of one, and the earlier one.
  using Over = std::array<std::uint32_t, 2>;

  void find_places(const TriangleSurface& cloth, const kernels::Vectors& x);
  template <class Takes, class Joined>
  void flood(const TriangleSurface& cloth, std::uint32_t first, Takes&& takes, Joined&& joined);
  void rank_all(std::size_t triangles);
  static void rank(std::vector<Over>& over, std::vector<std::uint32_t>& ranks);

  BoxTree tree_;
  std::vector<Over> met_;                               // triangles
  std::vector<Place> of_;                               // per triangle
  std::vector<std::uint32_t> to_visit_;                 // scratch
  std::vector<Over> pieces_, layers_;                   // scratch
  std::vector<std::uint32_t> piece_rank_, layer_rank_;  // by first triangles
  std::vector<kernels::Vector> ways_;                   // per slot; scratch
};

}  // namespace weft
