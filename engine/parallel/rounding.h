/// How a thread rounds and treats denormal numbers.
#pragma once

#include <xmmintrin.h>

#include <cstdint>

namespace weft {

/// Lets this thread round as another one does, and restores in the end how it did before.
class Rounding {
 public:
  static std::uint32_t of_this_thread() { return _mm_getcsr(); }

  explicit Rounding(std::uint32_t of_the_other) { _mm_setcsr(of_the_other); }
  ~Rounding() { _mm_setcsr(before_); }
  Rounding(const Rounding&) = delete;
  Rounding& operator=(const Rounding&) = delete;

 private:
  std::uint32_t before_ = _mm_getcsr();
};

}  // namespace weft
