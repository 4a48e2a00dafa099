/// How much an impulse loop may do before it is looked at.
#pragma once

#include <weft/weft.h>

namespace weft {

struct LoopBudget {
  int iterations = 1;
  int renew_after = 0;  ///< as in Settings
};

inline LoopBudget whole_budget(const Settings& settings) {
  return {settings.max_iterations, settings.renew_after};
}

}  // namespace weft
