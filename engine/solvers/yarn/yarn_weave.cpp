// Weaving a layout: one family of yarns is in place, the others are in patches.

#include <utility>
#include <vector>

#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/solvers/yarn/yarn_memory_rows.h"
#include "engine/solvers/yarn/yarn_patches.h"
#include "engine/solvers/yarn/yarn_places.h"
#include "engine/tuning.h"

namespace weft {
void weave(const Model& model, YarnLayout& layout) {
  const SlotRows slots{model, layout};
  auto home = find_home(slots);
  if (!home) return;
  YarnPatches patches(slots, *home);
  std::vector<simd::YarnBlock> blocks = layout.blocks;
  for (std::size_t f = 0; f < layout.families(); ++f) {
    const std::size_t first = layout.family_begin[f], last = layout.family_begin[f + 1];
    for (std::size_t i = first; i < last; ++i) {
      if (f == home->family) {
        blocks[i].access = simd::YarnAccess::in_place;
        blocks[i].place = home->places.place[slots.of(blocks[i].first)[0]];
      } else {
        blocks[i] = patches.cut(blocks[i]);
        if (i > first) blocks[i - 1].patches_ahead = blocks[i].last_patch - blocks[i].first_patch;
      }
    }
  }
  if (patches.share_whole() < tuning::kLeastWoven) return;
  home->places.floats = patches.rows_of_memory() * simd::kRowFloats;
  layout.blocks = std::move(blocks);
  layout.patches = std::move(patches).patches();
  layout.places = std::move(home->places);
  layout.slot = std::vector<std::uint32_t>();
}

}  // namespace weft
