#include "kernels/simd/isa.h"
#include "kernels/simd/table.h"

namespace weft::simd {
namespace {

/// Null where the library is built without it (WEFT_ISAS in ../CMakeLists.txt).
const Table* built(Isa isa) {
  switch (isa) {
#ifdef WEFT_WITH_SSE2
    case Isa::sse2:
      return &kSse2Table;
#endif
#ifdef WEFT_WITH_AVX2
    case Isa::avx2:
      return &kAvx2Table;
#endif
#ifdef WEFT_WITH_AVX512
    case Isa::avx512:
      return &kAvx512Table;
#endif
    default:
      return nullptr;
  }
}

/// The compiler's own detection: it checks XGETBV, which xsimd 8.1 does not.
bool machine_has(Isa isa) {
  __builtin_cpu_init();
  switch (isa) {
    case Isa::sse2:
      return true;
    case Isa::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case Isa::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512vl") && machine_has(Isa::avx2);
    case Isa::neon:
      break;
  }
  return false;
}

}  // namespace

bool supported(Isa isa) { return built(isa) != nullptr && machine_has(isa); }

Isa best_isa() {
  if (supported(Isa::avx512)) return Isa::avx512;
  return supported(Isa::avx2) ? Isa::avx2 : Isa::sse2;
}

const Table& table(Isa isa) { return *built(isa); }

}  // namespace weft::simd
