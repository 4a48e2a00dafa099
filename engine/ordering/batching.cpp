#include "engine/ordering/batching.h"

#include <algorithm>
#include <utility>

namespace weft {
namespace {

using kernels::kLanes;

constexpr std::uint32_t kLargestGap = kLanes;

/// A vector of a run costs about as much as this many gathered constraints, so that a run must have
/// at least as many links for each of its vectors.
constexpr std::size_t kLeastLinksPerVector = 6;

bool is_padding(const Joint& joint) { return joint.link == kNoIndex; }

bool by_offset(const Joint& x, const Joint& y) {
  return std::pair(x.b - x.a, x.a) < std::pair(y.b - y.a, y.a);
}

}  // namespace

Batcher::Batcher(std::vector<std::uint32_t>& particle_at)
    : particle_at_(particle_at), used_(particle_at.size()) {
  for (std::uint32_t slot = 0; slot < particle_at.size(); ++slot) {
    if (particle_at[slot] == kNoIndex) padding_slots_.push_back(slot);
  }
}

PlannedBatch Batcher::plan(Joints joints, bool with_runs) {
  batch_ = {};
  singles_.clear();
  next_spare_ = 0;
  for (const Joint& joint : joints) used_[joint.a] = used_[joint.b] = true;
  if (with_runs) {
    std::sort(joints.begin(), joints.end(), by_offset);
    find_runs(joints);
  } else {
    singles_ = std::move(joints);
  }
  add_singles();
  for (const Joint& joint : batch_.joints) used_[joint.a] = used_[joint.b] = false;
  return std::move(batch_);
}

void Batcher::find_runs(const Joints& joints) {
  for (std::size_t next = 0; next < joints.size();) {
    next = extend(joints, next);
    fill_lanes();
    finish_run();
  }
}

/// Makes run_ the longest run that begins with the joint `first`. Returns the first joint beyond
/// it.
std::size_t Batcher::extend(const Joints& joints, std::size_t first) {
  run_.assign(1, joints[first]);
  std::size_t next = first + 1;
  while (next < joints.size() && fill_gap(joints[next - 1], joints[next])) {
    run_.push_back(joints[next++]);
  }
  return next;
}

bool Batcher::fill_gap(const Joint& from, const Joint& to) {
  if (to.b - to.a != from.b - from.a || to.a - from.a > kLargestGap + 1) return false;
  const std::size_t before = run_.size();
  for (std::uint32_t k = 1; k < to.a - from.a; ++k) {
    if (claim(from.a + k, from.b + k)) {
      run_.push_back({from.a + k, from.b + k, kNoIndex});
      continue;
    }
    while (run_.size() > before) {
      release(run_.back());
      run_.pop_back();
    }
    return false;
  }
  return true;
}

/// Pads the run to whole lanes, behind it or before it. If no slots are free for that, the joints
/// that do not fill the lanes are cut off.
void Batcher::fill_lanes() {
  const std::size_t wanted = kernels::round_up(run_.size(), kLanes);
  while (run_.size() < wanted && claim(run_.back().a + 1, run_.back().b + 1)) {
    run_.push_back({run_.back().a + 1, run_.back().b + 1, kNoIndex});
  }
  std::size_t before = 0;
  while (run_.size() + before < wanted) {
    const std::uint32_t k = static_cast<std::uint32_t>(before) + 1;
    if (run_.front().a < k || !claim(run_.front().a - k, run_.front().b - k)) break;
    ++before;
  }
  const Joint front = run_.front();
  std::vector<Joint> padding;
  for (std::uint32_t k = static_cast<std::uint32_t>(before); k > 0; --k) {
    padding.push_back({front.a - k, front.b - k, kNoIndex});
  }
  run_.insert(run_.begin(), padding.begin(), padding.end());
  cut_lanes();
}

void Batcher::cut_lanes() {
  while (run_.size() % kLanes != 0) {
    if (is_padding(run_.back())) {
      release(run_.back());
    } else {
      singles_.push_back(run_.back());
    }
    run_.pop_back();
  }
}

/// Adds the run to the batch. A run with too few links is taken apart into singles.
void Batcher::finish_run() {
  const auto padding =
      static_cast<std::size_t>(std::count_if(run_.begin(), run_.end(), is_padding));
  const std::size_t links = run_.size() - padding;
  if (run_.empty()) return;
  if (links * kLanes < kLeastLinksPerVector * run_.size()) {
    for (const Joint& joint : run_) {
      if (is_padding(joint)) {
        release(joint);
      } else {
        singles_.push_back(joint);
      }
    }
    return;
  }
  batch_.runs.push_back({run_.front().a, run_.front().b,
                         static_cast<std::uint32_t>(batch_.joints.size()),
                         static_cast<std::uint32_t>(run_.size())});
  batch_.joints.insert(batch_.joints.end(), run_.begin(), run_.end());
  batch_.links_in_runs += links;
}

void Batcher::add_singles() {
  batch_.singles = static_cast<std::uint32_t>(batch_.joints.size());
  std::sort(singles_.begin(), singles_.end(),
            [](const Joint& x, const Joint& y) { return x.a < y.a; });
  batch_.joints.insert(batch_.joints.end(), singles_.begin(), singles_.end());
  while (batch_.joints.size() % kLanes != 0) {
    const std::uint32_t a = spare_slot();
    batch_.joints.push_back({a, spare_slot(), kNoIndex});
  }
}

/// Marks two slots as used by padding, if both are free.
bool Batcher::claim(std::uint32_t a, std::uint32_t b) {
  if (a >= used_.size() || b >= used_.size() || used_[a] || used_[b]) return false;
  used_[a] = used_[b] = true;
  return true;
}

void Batcher::release(const Joint& padding) { used_[padding.a] = used_[padding.b] = false; }

std::uint32_t Batcher::spare_slot() {
  while (next_spare_ < padding_slots_.size() && used_[padding_slots_[next_spare_]]) ++next_spare_;
  if (next_spare_ == padding_slots_.size()) {
    padding_slots_.push_back(static_cast<std::uint32_t>(particle_at_.size()));
    particle_at_.push_back(kNoIndex);
    used_.push_back(false);
  }
  const std::uint32_t slot = padding_slots_[next_spare_++];
  used_[slot] = true;
  return slot;
}

}  // namespace weft
