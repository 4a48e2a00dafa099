/// How a thread rounds and treats denormal numbers.
#pragma once

#include "engine/parallel/processor.h"

namespace weft {

/// Lets this thread round as another one does, and restores in the end how it did before.
class Rounding {
 public:
  static FloatControl of_this_thread() { return float_control(); }

  explicit Rounding(FloatControl of_the_other) { set_float_control(of_the_other); }
  ~Rounding() { set_float_control(before_); }
  Rounding(const Rounding&) = delete;
  Rounding& operator=(const Rounding&) = delete;

 private:
  FloatControl before_ = float_control();
};

}  // namespace weft
