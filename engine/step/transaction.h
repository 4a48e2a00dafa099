/// A step as a transaction.
#pragma once

#include <utility>

#include "engine/step/state.h"

namespace weft {

/// accept() makes a transaction of one substep; a step that changes the state before it has done
/// all must remember where it began, and returns there whatever the reason.
class Transaction {
 public:
  explicit Transaction(State& s) : s_(s) {}
  ~Transaction() {
    if (!begun_ || complete_) return;
    std::swap(s_.position, s_.start_position);
    std::swap(s_.velocity, s_.start_velocity);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  /// The state is about to change.
  void begin() {
    if (begun_) return;
    s_.start_position = s_.position;
    s_.start_velocity = s_.velocity;
    begun_ = true;
  }

  /// The substep becomes the state.
  void accept() {
    std::swap(s_.position, s_.solved);
    std::swap(s_.velocity, s_.next_velocity);
  }
  void complete() { complete_ = true; }

 private:
  State& s_;
  bool begun_ = false, complete_ = false;
};

}  // namespace weft
