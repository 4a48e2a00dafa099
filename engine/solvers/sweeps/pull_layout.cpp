#include "engine/solvers/sweeps/pull_layout.h"

#include <algorithm>
#include <map>

#include "engine/bytes_of.h"
#include "engine/lists.h"
#include "engine/model/model.h"

namespace weft {
namespace {

using Meeting = PullLayout::Meeting;

struct Neighbour {
  std::uint32_t constraint;
  Meeting meeting;
};

class PullBuilder {
 public:
  explicit PullBuilder(const Ordering& ordering);
  PullLayout build();

 private:
  void note_batch(std::uint32_t index);
  void find_neighbours(std::uint32_t block);
  bool may_read_side_by_side(std::uint32_t block) const;
  bool has_neighbour(std::uint32_t lane, std::uint32_t constraint) const;
  bool touches_tile(std::uint32_t block, std::uint32_t tile) const;
  void add_side_by_side(std::uint32_t block);
  void add_scattered(std::uint32_t block);

  const Ordering& ordering_;
  std::vector<std::uint8_t> pulls_, singles_;  // per block
  std::vector<std::uint32_t> tile_;            // per block: whose batch it is in, or kNoIndex
  Lists at_;                                   // slot -> constraints that pull
  std::vector<Neighbour> neighbours_[kLanes];  // of the present block
  PullLayout layout_;
};

PullBuilder::PullBuilder(const Ordering& ordering) : ordering_(ordering) {
  const std::size_t blocks = ordering.constraint_slots() / kLanes;
  pulls_.resize(blocks);
  singles_.resize(blocks);
  tile_.assign(blocks, kNoIndex);
  for (std::uint32_t i = 0; i < ordering.batches.size(); ++i) note_batch(i);
  for (std::uint32_t t = 0; t < ordering.tiles.size(); ++t) {
    const Tile& tile = ordering.tiles[t];
    for (std::uint32_t i = tile.first_batch; i < tile.last_batch; ++i) {
      const Batch& batch = ordering.batches[i];
      std::fill(tile_.begin() + batch.first / kLanes, tile_.begin() + batch.last / kLanes, t);
    }
  }
  at_ = make_lists(ordering.slots(), [&](auto&& add) {
    for (std::uint32_t c = 0; c < ordering.constraint_slots(); ++c) {
      if (!pulls_[c / kLanes] || ordering.link_at[c] == kNoIndex) continue;
      add(ordering.a[c], c);
      add(ordering.b[c], c);
    }
  });
}

void PullBuilder::note_batch(std::uint32_t index) {
  const Batch& batch = ordering_.batches[index];
  if (batch.kind != ConstraintKind::distance) return;
  for (std::uint32_t c = batch.first; c < batch.last; c += kLanes) {
    pulls_[c / kLanes] = 1;
    singles_[c / kLanes] = c >= batch.singles;
  }
}

PullLayout PullBuilder::build() {
  const auto blocks = static_cast<std::uint32_t>(pulls_.size());
  layout_.scattered.resize(blocks);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    layout_.first_pull.push_back(static_cast<std::uint32_t>(layout_.pulls()));
    if (!pulls_[block]) continue;
    find_neighbours(block);
    layout_.scattered[block] = singles_[block] || !may_read_side_by_side(block);
    layout_.scattered[block] ? add_scattered(block) : add_side_by_side(block);
  }
  layout_.first_pull.push_back(static_cast<std::uint32_t>(layout_.pulls()));
  if (std::ranges::find(layout_.scattered, 1) == layout_.scattered.end()) layout_.from_singles = {};
  return std::move(layout_);
}

void PullBuilder::find_neighbours(std::uint32_t block) {
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t c = block * kLanes + lane;
    neighbours_[lane].clear();
    if (ordering_.link_at[c] == kNoIndex) continue;
    for (const bool by_a : {true, false}) {
      const std::uint32_t p = by_a ? ordering_.a[c] : ordering_.b[c];
      for (const std::uint32_t j : at_[p]) {
        if (j == c) continue;
        const bool its_a = ordering_.a[j] == p;
        const Meeting meeting =
            by_a ? (its_a ? Meeting::a_a : Meeting::a_b) : (its_a ? Meeting::b_a : Meeting::b_b);
        neighbours_[lane].push_back({j, meeting});
      }
    }
  }
}

bool PullBuilder::has_neighbour(std::uint32_t lane, std::uint32_t constraint) const {
  return std::ranges::any_of(neighbours_[lane],
                             [&](const Neighbour& j) { return j.constraint == constraint; });
}

bool PullBuilder::touches_tile(std::uint32_t block, std::uint32_t tile) const {
  if (tile_[block] != kNoIndex) return tile_[block] == tile;
  const Tile& range = ordering_.tiles[tile];
  const auto is_inside = [&](std::uint32_t slot) {
    return slot >= range.first_slot && slot < range.last_slot;
  };
  for (std::uint32_t c = block * kLanes; c < (block + 1) * kLanes; ++c) {
    if (ordering_.link_at[c] == kNoIndex) continue;
    if (is_inside(ordering_.a[c]) || is_inside(ordering_.b[c])) return true;
  }
  return false;
}

/// At every distance that occurs, lanes without a neighbour read what is in a tile that the block
/// touches.
bool PullBuilder::may_read_side_by_side(std::uint32_t block) const {
  const std::uint32_t size = static_cast<std::uint32_t>(pulls_.size()) * kLanes;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    for (const Neighbour& j : neighbours_[lane]) {
      for (std::uint32_t other = 0; other < kLanes; ++other) {
        // Wraps around below 0, to beyond the size.
        const std::uint32_t read = j.constraint + other - lane;
        if (read < size && has_neighbour(other, read)) continue;
        if (read >= size || tile_[read / kLanes] == kNoIndex ||
            !touches_tile(block, tile_[read / kLanes])) {
          return false;
        }
      }
    }
  }
  return true;
}

void PullBuilder::add_side_by_side(std::uint32_t block) {
  std::map<std::int32_t, std::size_t> pull_of;  // by distance
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    for (const Neighbour& j : neighbours_[lane]) {
      const auto distance = static_cast<std::int32_t>(j.constraint - (block * kLanes + lane));
      const auto [pull, is_new] = pull_of.try_emplace(distance, layout_.pulls());
      if (is_new) {
        layout_.from_run.push_back(static_cast<std::int32_t>(block * kLanes) + distance);
        layout_.meetings.resize(layout_.pulls() * kLanes);
        layout_.from_singles.resize(layout_.pulls() * kLanes);
      }
      layout_.meetings[pull->second * kLanes + lane] = j.meeting;
    }
  }
}

/// Lanes without a neighbour read their own block.
void PullBuilder::add_scattered(std::uint32_t block) {
  const std::size_t first = layout_.pulls();
  std::size_t most = 0;
  for (const auto& neighbours : neighbours_) most = std::max(most, neighbours.size());
  layout_.from_run.resize(first + most);
  layout_.meetings.resize(layout_.pulls() * kLanes);
  layout_.from_singles.resize(layout_.pulls() * kLanes, static_cast<std::int32_t>(block * kLanes));
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    std::size_t k = first * kLanes + lane;
    for (const Neighbour& j : neighbours_[lane]) {
      layout_.from_singles[k] = static_cast<std::int32_t>(j.constraint);
      layout_.meetings[k] = j.meeting;
      k += kLanes;
    }
  }
}

/// The effect of a correction of j by 1 on the error of the constraint that pulls, over n . n.
float weight(Meeting meeting, std::span<const simd::ConstraintBlock> blocks, std::size_t j) {
  const simd::ConstraintBlock& block = blocks[j / kLanes];
  switch (meeting) {
    case Meeting::a_a:
      return block.gain_a[j % kLanes];
    case Meeting::a_b:
      return block.gain_b[j % kLanes];
    case Meeting::b_a:
      return -block.gain_a[j % kLanes];
    case Meeting::b_b:
      return -block.gain_b[j % kLanes];
    case Meeting::none:
      break;
  }
  return 0;
}

}  // namespace

PullLayout make_pull_layout(const Ordering& ordering) { return PullBuilder(ordering).build(); }

kernels::AlignedVector<float> PullLayout::weights(
    std::span<const simd::ConstraintBlock> constraints) const {
  kernels::AlignedVector<float> weights(meetings.size());
  for (std::size_t block = 0; block < blocks(); ++block) {
    for (std::size_t pull = first_pull[block]; pull < first_pull[block + 1]; ++pull) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t k = pull * kLanes + lane;
        if (meetings[k] == Meeting::none) continue;
        const auto from =
            scattered[block] ? from_singles[k] : from_run[pull] + static_cast<std::int32_t>(lane);
        weights[k] = weight(meetings[k], constraints, static_cast<std::size_t>(from));
      }
    }
  }
  return weights;
}

std::size_t PullLayout::bytes() const {
  return bytes_of(first_pull) + bytes_of(from_run) + bytes_of(from_singles) + bytes_of(meetings) +
         bytes_of(scattered);
}

PullMemory::PullMemory(const PullLayout& layout) {
  for (auto* v : {&error, &change, &sum}) v->resize(layout.blocks() * kLanes);
  product.resize(layout.meetings.size());
}

simd::Anticipation PullMemory::view(const PullLayout& layout,
                                    const kernels::AlignedVector<float>& weight, float threshold) {
  simd::Anticipation p;
  p.error = error.data();
  p.change = change.data();
  p.sum = sum.data();
  p.first_pull = layout.first_pull.data();
  p.from_run = layout.from_run.data();
  p.from_singles = layout.from_singles.data();
  p.product = product.data();
  p.weight = weight.data();
  p.threshold = threshold;
  return p;
}

std::size_t PullMemory::bytes() const {
  return bytes_of(error) + bytes_of(change) + bytes_of(sum) + bytes_of(product);
}

const PullLayout& Model::pulls() const {
  return pulls_.get([this] { return make_pull_layout(ordering); });
}

}  // namespace weft
