#include "kernels/simd/isa.h"
#include "kernels/simd/table.h"

namespace weft::simd {

bool supported(Isa isa) { return isa == Isa::sse2; }

Isa best_isa() { return Isa::sse2; }

const Table& table(Isa) { return kSse2Table; }

}  // namespace weft::simd
