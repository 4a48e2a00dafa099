/// How much an impulse loop may do.
#pragma once

#include <weft/weft.h>

#include "kernels/loop.h"

namespace weft {

inline kernels::LoopLimits limits_of(const Settings& settings) {
  return {.fixed_iterations = settings.iterations,
          .max_iterations = settings.max_iterations,
          .renew_after = settings.renew_after};
}

}  // namespace weft
