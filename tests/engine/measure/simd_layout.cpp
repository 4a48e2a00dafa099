/// The seams: what may be done of the batch between tiles before all tiles are done.
#include "engine/measure/simd_layout.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "engine/model/model.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"

namespace weft::test::engine_measure_simd_layout {
namespace {

/// Whether all slots of a chunk, padding included, are in these tiles.
bool within(const SimdLayout& layout, std::uint32_t chunk, const Tile& first, const Tile& last) {
  const kernels::Run& run = layout.chunks[chunk].run;
  for (std::uint32_t c = run.constraint; c < run.constraint + run.length; ++c) {
    for (const std::uint32_t slot : {layout.a[c], layout.b[c]}) {
      if (slot < first.first_slot || slot >= last.last_slot) return false;
    }
  }
  return true;
}

TEST_CASE("seams have every chunk of the first batch between tiles once, behind all its tiles") {
  int near = 0, far = 0;  // seams
  for (const SceneDescription& scene :
       {scene_of("hang", 100), scene_of("corners", 161), random_sheet(120, 8), roped_sheet(101)}) {
    const auto model = model_of(scene);
    const Ordering& ordering = model->ordering;
    const SimdLayout& layout = model->simd();
    const std::size_t tiles = ordering.tiles.size();
    REQUIRE(tiles > 1);
    REQUIRE(ordering.between_tiles < ordering.batches.size());
    CHECK(layout.seams_at.size() == tiles + 2);
    CHECK(layout.seams_at[tiles] > 0);
    std::vector<int> found(layout.chunks.size());
    std::size_t widest = 0;  // seam, in tiles
    for (std::size_t tile = 0; tile <= tiles; ++tile) {
      for (std::size_t i = layout.seams_at[tile]; i < layout.seams_at[tile + 1]; ++i) {
        const TileSeam& seam = layout.seams[i];
        widest = std::max(widest, tile - seam.first_tile);
        for (std::uint32_t k = seam.first_chunk; k < seam.last_chunk; ++k) {
          ++found[k];
          if (tile == tiles) continue;
          CHECK(within(layout, k, ordering.tiles[seam.first_tile], ordering.tiles[tile]));
        }
      }
    }
    CHECK(layout.seams_join_neighbours == (widest <= 1));
    far += widest > 1;
    near += widest <= 1;
    for (std::uint32_t k = 0; k < layout.chunks.size(); ++k) {
      const bool first_between = k >= layout.batch_chunks[ordering.between_tiles] &&
                                 k < layout.batch_chunks[ordering.between_tiles + 1];
      CHECK(found[k] == (first_between ? 1 : 0));
    }
  }
  CHECK(near > 0);
  CHECK(far > 0);
}

}  // namespace
}  // namespace weft::test::engine_measure_simd_layout
