#include "kernels/simd/isa.h"
#include "kernels/simd/table.h"

namespace weft::simd {

// The compiler's own detection: it checks XGETBV, which xsimd 8.1 does not.
bool supported(Isa isa) {
  __builtin_cpu_init();
  switch (isa) {
    case Isa::sse2:
      return true;
    case Isa::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case Isa::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512vl") && supported(Isa::avx2);
    case Isa::neon:
      break;
  }
  return false;
}

Isa best_isa() {
  if (supported(Isa::avx512)) return Isa::avx512;
  return supported(Isa::avx2) ? Isa::avx2 : Isa::sse2;
}

const Table& table(Isa isa) {
  if (isa == Isa::avx512) return kAvx512Table;
  return isa == Isa::avx2 ? kAvx2Table : kSse2Table;
}

}  // namespace weft::simd
