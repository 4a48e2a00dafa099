/// From which constraints each constraint pulls: from all that share a slot with it, and what other
/// threads write is not read.
#include "engine/solvers/sweeps/pull_layout.h"

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <utility>

#include "engine/model/model.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"

namespace weft::test::engine_solvers_sweeps_pull_layout {
namespace {

using Meeting = PullLayout::Meeting;

/// Constraint slots of distance constraints.
std::set<std::uint32_t> pulling(const Ordering& ordering) {
  std::set<std::uint32_t> all;
  for (const Batch& batch : ordering.batches) {
    if (batch.kind != ConstraintKind::distance) continue;
    for (std::uint32_t c = batch.first; c < batch.last; ++c) {
      if (ordering.link_at[c] != kNoIndex) all.insert(c);
    }
  }
  return all;
}

/// (c, j) -> how they meet.
std::map<std::pair<std::uint32_t, std::uint32_t>, Meeting> expected_pulls(const Ordering& o) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> at;
  const auto all = pulling(o);
  for (const std::uint32_t c : all) {
    at[o.a[c]].push_back(c);
    at[o.b[c]].push_back(c);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, Meeting> pulls;
  for (const std::uint32_t c : all) {
    for (const std::uint32_t j : at[o.a[c]]) {
      if (j != c) pulls[{c, j}] = o.a[j] == o.a[c] ? Meeting::a_a : Meeting::a_b;
    }
    for (const std::uint32_t j : at[o.b[c]]) {
      if (j != c) pulls[{c, j}] = o.a[j] == o.b[c] ? Meeting::b_a : Meeting::b_b;
    }
  }
  return pulls;
}

std::uint32_t tile_of(const Ordering& o, std::uint32_t constraint) {
  for (std::uint32_t t = 0; t < o.tiles.size(); ++t) {
    for (std::uint32_t i = o.tiles[t].first_batch; i < o.tiles[t].last_batch; ++i) {
      if (constraint >= o.batches[i].first && constraint < o.batches[i].last) return t;
    }
  }
  return kNoIndex;
}

/// Whether a constraint of the block is of the tile, or has an end in it.
bool touches(const Ordering& o, std::size_t block, std::uint32_t tile) {
  const auto first = static_cast<std::uint32_t>(block * kLanes);
  if (const std::uint32_t own = tile_of(o, first); own != kNoIndex) return own == tile;
  for (std::uint32_t c = first; c < first + kLanes; ++c) {
    if (o.link_at[c] == kNoIndex) continue;
    for (const std::uint32_t slot : {o.a[c], o.b[c]}) {
      if (slot >= o.tiles[tile].first_slot && slot < o.tiles[tile].last_slot) return true;
    }
  }
  return false;
}

void check(const SceneDescription& scene) {
  const auto model = model_of(scene);
  const Ordering& ordering = model->ordering;
  const PullLayout& layout = model->pulls();
  auto expected = expected_pulls(ordering);
  REQUIRE(layout.blocks() == ordering.constraint_slots() / kLanes);
  for (std::size_t block = 0; block < layout.blocks(); ++block) {
    for (std::size_t pull = layout.first_pull[block]; pull < layout.first_pull[block + 1]; ++pull) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t k = pull * kLanes + lane;
        const auto c = static_cast<std::uint32_t>(block * kLanes + lane);
        const std::int32_t from = layout.scattered[block]
                                      ? layout.from_singles[k]
                                      : layout.from_run[pull] + static_cast<std::int32_t>(lane);
        REQUIRE(from >= 0);
        const auto j = static_cast<std::uint32_t>(from);
        REQUIRE(j < ordering.constraint_slots());
        if (layout.meetings[k] != Meeting::none) {
          const auto found = expected.find({c, j});
          REQUIRE(found != expected.end());  // and not twice
          REQUIRE(found->second == layout.meetings[k]);
          expected.erase(found);
        } else if (layout.scattered[block]) {
          REQUIRE(j / kLanes == block);
        } else {
          REQUIRE(touches(ordering, block, tile_of(ordering, j)));
        }
      }
    }
  }
  CHECK(expected.empty());
}

TEST_CASE("every constraint pulls once from each that shares a slot with it") {
  for (const char* name : {"hang", "corners", "chain"}) {
    for (const int size : {3, 9, 33}) {
      CAPTURE(std::string(name));
      CAPTURE(size);
      check(scene_of(name, size));
    }
  }
  check(roped_sheet(16));
  check(random_sheet(15, 4));
  check(hub_sheet(12));
}

TEST_CASE("over several tiles, too") {
  check(scene_of("hang", 90));
  check(roped_sheet(70));
  check(random_sheet(75, 6));
}

TEST_CASE("a grid is read side by side, but for a few blocks") {
  for (const int size : {40, 130}) {
    const auto model = model_of(scene_of("hang", size));
    const PullLayout& layout = model->pulls();
    std::size_t scattered = 0;
    for (const std::uint8_t block : layout.scattered) scattered += block;
    CAPTURE(layout.blocks());
    CAPTURE(scattered);
    CHECK(10 * scattered < layout.blocks());
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_sweeps_pull_layout
