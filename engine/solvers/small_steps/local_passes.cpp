#include "engine/solvers/small_steps/local_passes.h"

#include "engine/bytes_of.h"

namespace weft {

LocalPasses::LocalPasses(const Model& model)
    : model_(model),
      bit_a_(model.constraints.size(), kNoBit),
      bit_b_(model.constraints.size(), kNoBit),
      now_(model.slots()),
      next_(model.slots()) {
  const ConstraintStore& s = model.constraints;
  at_ = make_lists(model.slots(), [&](auto&& add) {
    for (std::uint32_t c = 0; c < s.size(); ++c) {
      add(s.a[c], c);
      add(s.b[c], c);
    }
  });
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    const auto list = at_[slot];
    if (list.size() > 64) continue;
    for (std::size_t k = 0; k < list.size(); ++k) {
      (s.a[list[k]] == slot ? bit_a_ : bit_b_)[list[k]] = static_cast<std::uint8_t>(k);
    }
  }
  for (std::uint32_t c = 0; c < s.size(); ++c) {
    if (bit_a_[c] == kNoBit && bit_b_[c] == kNoBit) always_.push_back(c);
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
  for (const std::uint32_t c : list) {
    const bool is_a = model_.constraints.a[c] == slot;
    const std::uint8_t there = is_a ? bit_b_[c] : bit_a_[c];
    if (there == kNoBit) continue;
    set({is_a ? model_.constraints.b[c] : model_.constraints.a[c], std::uint64_t{1} << there});
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

std::size_t LocalPasses::bytes() const {
  return at_.bytes() + bytes_of(bit_a_) + bytes_of(bit_b_) + bytes_of(always_) + bytes_of(now_) +
         bytes_of(next_) + bytes_of(present_) + bytes_of(waiting_);
}

}  // namespace weft
