#include "engine/solvers/small_steps/local_passes.h"

#include "engine/bytes_of.h"

namespace weft {

LocalPasses::LocalPasses(const Model& model, const LocalItems& items)
    : model_(model), items_(items), now_(model.slots()), next_(model.slots()) {
  present_.reserve(model.slots());
  waiting_.reserve(model.slots());
}

void LocalPasses::look_at(std::uint32_t slot) {
  if (model_.inverse_mass[slot] == 0) return;
  const auto list = items_.at[slot];
  if (list.size() <= 64) {
    if (next_[slot] == 0 && !list.empty()) waiting_.push_back(slot);
    next_[slot] = list.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << list.size()) - 1;
    return;
  }
  for (const std::uint32_t item : list) {
    for (const End& end : items_.ends(item)) {
      if (end.bit == LocalItems::kNoBit) continue;
      if (next_[end.slot] == 0) waiting_.push_back(end.slot);
      next_[end.slot] |= end.mask();
      break;
    }
  }
}

void LocalPasses::look_everywhere() {
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) look_at(slot);
}

void LocalPasses::forget() {
  for (const std::uint32_t slot : waiting_) next_[slot] = 0;
  waiting_.clear();
}

/// The items that were asked for are done now; now_ is empty.
void LocalPasses::begin_pass() {
  present_.swap(waiting_);
  now_.swap(next_);
  waiting_.clear();
}

/// Within a pass.
void LocalPasses::break_off() {
  for (const std::uint32_t slot : present_) now_[slot] = 0;
}

std::size_t LocalPasses::bytes() const {
  return bytes_of(now_) + bytes_of(next_) + bytes_of(present_) + bytes_of(waiting_);
}

}  // namespace weft
