/// How this thread rounds. std::fegetround says nothing of vector units on some systems.
#pragma once

#include <cfenv>

namespace weft::test {

/// FE_UPWARD, FE_DOWNWARD (or toward zero) or FE_TONEAREST, as sums of doubles come out.
inline int rounding() {
  const volatile double one = 1, little = 1e-30;
  if (one + little > 1) return FE_UPWARD;
  return one - little < 1 ? FE_DOWNWARD : FE_TONEAREST;
}

}  // namespace weft::test
