#include "engine/solvers/small_steps/local_passes.h"

#include <algorithm>

#include "engine/bytes_of.h"

namespace weft {

LocalPasses::LocalPasses(const Model& model)
    : model_(model),
      constraints_(static_cast<std::uint32_t>(model.constraints.size())),
      now_(model.slots()),
      next_(model.slots()) {
  const ConstraintStore& s = model.constraints;
  ends_.reserve(2 * s.size() + 3 * model.membrane.size());
  for (std::uint32_t c = 0; c < s.size(); ++c) {
    ends_.push_back({s.a[c]});
    ends_.push_back({s.b[c]});
  }
  for (const auto& corners : model.membrane.slots) {
    for (const std::uint32_t slot : corners) ends_.push_back({slot});
  }
  const auto items = item_of_element(static_cast<std::uint32_t>(model.membrane.size()));
  at_ = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t item = 0; item < items; ++item) {
      for (const End& end : ends(item)) add(end.slot, item);
    }
  });
  const auto bit_of = [&](const End& end, std::uint32_t item) {
    const auto list = at_[end.slot];
    if (list.size() > 64) return kNoBit;
    return static_cast<std::uint32_t>(std::ranges::find(list, item) - list.begin());
  };
  for (std::uint32_t item = 0; item < items; ++item) {
    const std::size_t first = static_cast<std::size_t>(ends(item).data() - ends_.data());
    bool has_bit = false;
    for (std::size_t k = first; k < first + ends(item).size(); ++k) {
      ends_[k].bit = bit_of(ends_[k], item);
      has_bit = has_bit || ends_[k].bit != kNoBit;
    }
    if (!has_bit) always_.push_back(item);
  }
  present_.reserve(model.slots());
  waiting_.reserve(model.slots());
}

void LocalPasses::look_at(std::uint32_t slot) {
  if (model_.inverse_mass[slot] == 0) return;
  const auto list = at_[slot];
  if (list.size() <= 64) {
    if (next_[slot] == 0 && !list.empty()) waiting_.push_back(slot);
    next_[slot] = list.size() == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << list.size()) - 1;
    return;
  }
  for (const std::uint32_t item : list) {
    for (const End& end : ends(item)) {
      if (end.bit == kNoBit) continue;
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

/// What was asked for is done now; now_ is empty.
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
  return bytes_of(ends_) + at_.bytes() + bytes_of(always_) + bytes_of(now_) + bytes_of(next_) +
         bytes_of(present_) + bytes_of(waiting_);
}

}  // namespace weft
