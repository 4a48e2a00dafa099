/// The instruction set of a cloth.
#pragma once

#include <weft/weft.h>

#include "kernels/simd/isa.h"

namespace weft {

/// automatic: WEFT_ISA of the environment, else the best of the machine. An instruction set that
/// the machine or the library (WEFT_ISAS) lacks, or a name that is none, is an error.
Result<Isa> resolve(Isa wanted);

/// A resolved one.
simd::Isa to_kernel(Isa isa);

}  // namespace weft
