#include "kernels/simd/isa.h"
#include "kernels/simd/table.h"

namespace weft::simd {

bool supported(Isa isa) { return isa == Isa::neon; }

Isa best_isa() { return Isa::neon; }

const Table& table(Isa) { return kNeonTable; }

}  // namespace weft::simd
