#include "perf/pull_layout.h"

#include <algorithm>
#include <map>

namespace weft::perf {
namespace {

/// Real constraints at each slot.
std::vector<std::vector<std::uint32_t>> constraints_at(const Ordering& ordering) {
  std::vector<std::vector<std::uint32_t>> at(ordering.slots());
  for (std::uint32_t c = 0; c < ordering.constraint_slots(); ++c) {
    if (ordering.link_at[c] == kNoIndex) continue;
    at[ordering.a[c]].push_back(c);
    at[ordering.b[c]].push_back(c);
  }
  return at;
}

/// Which blocks hold singles.
std::vector<bool> singles_blocks(const Ordering& ordering) {
  std::vector<bool> singles(ordering.constraint_slots() / kLanes);
  for (const Batch& batch : ordering.batches) {
    for (std::uint32_t c = batch.singles; c < batch.last; c += kLanes) singles[c / kLanes] = true;
  }
  return singles;
}

}  // namespace

PullLayout::PullLayout(const Ordering& ordering, std::span<const simd::ConstraintBlock> blocks)
    : neighbours_(ordering.constraint_slots()) {
  const auto at = constraints_at(ordering);
  for (std::uint32_t c = 0; c < neighbours_.size(); ++c) {
    if (ordering.link_at[c] == kNoIndex) continue;
    for (const std::uint32_t p : {ordering.a[c], ordering.b[c]}) {
      const float sign = p == ordering.a[c] ? 1.f : -1.f;
      for (const std::uint32_t j : at[p]) {
        if (j == c) continue;
        const simd::ConstraintBlock& block = blocks[j / kLanes];
        const float* gain = p == ordering.a[j] ? block.gain_a : block.gain_b;
        neighbours_[c].push_back({j, sign * gain[j % kLanes]});
      }
    }
  }
  const auto singles = singles_blocks(ordering);
  has_singles_ = std::ranges::find(singles, true) != singles.end();
  for (std::uint32_t block = 0; block < neighbours_.size(); block += kLanes) {
    first_pull_.push_back(static_cast<std::uint32_t>(from_run_.size()));
    singles[block / kLanes] ? add_singles_block(block) : add_run_block(block);
  }
  first_pull_.push_back(static_cast<std::uint32_t>(from_run_.size()));
  neighbours_ = {};
  product_.resize(weight_.size());
  const std::size_t padded = ordering.constraint_slots() + 2 * kLanes;
  for (auto* v : {&error_, &change_, &sum_}) v->resize(padded);
}

void PullLayout::add_run_block(std::uint32_t block) {
  std::map<std::int32_t, std::size_t> pull_of;  // by distance
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    for (const Neighbour& j : neighbours_[block + lane]) {
      const auto distance = static_cast<std::int32_t>(j.constraint - (block + lane));
      const auto [pull, is_new] = pull_of.try_emplace(distance, from_run_.size());
      if (is_new) {
        from_run_.push_back(static_cast<std::int32_t>(block) + distance);
        weight_.resize(weight_.size() + kLanes);
        if (has_singles_) from_singles_.resize(weight_.size());
      }
      weight_[pull->second * kLanes + lane] = j.weight;
    }
  }
}

void PullLayout::add_singles_block(std::uint32_t block) {
  const std::size_t first = from_run_.size();
  std::size_t most = 0;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    most = std::max(most, neighbours_[block + lane].size());
  }
  from_run_.resize(first + most);
  weight_.resize((first + most) * kLanes);
  from_singles_.resize(weight_.size(), static_cast<std::int32_t>(block));
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    std::size_t k = first * kLanes + lane;
    for (const Neighbour& j : neighbours_[block + lane]) {
      from_singles_[k] = static_cast<std::int32_t>(j.constraint);
      weight_[k] = j.weight;
      k += kLanes;
    }
  }
}

simd::Anticipation PullLayout::anticipation(float threshold) {
  simd::Anticipation p;
  p.error = error_.data() + kLanes;
  p.change = change_.data() + kLanes;
  p.sum = sum_.data() + kLanes;
  p.first_pull = first_pull_.data();
  p.from_run = from_run_.data();
  p.from_singles = from_singles_.data();
  p.product = product_.data();
  p.weight = weight_.data();
  p.threshold = threshold;
  return p;
}

}  // namespace weft::perf
