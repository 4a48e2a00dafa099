#include "kernels/simd/table.h"

namespace weft::simd {

const Table& table(Isa isa) {
  switch (isa) {
    case Isa::avx512:
      return kAvx512Table;
    case Isa::avx2:
      return kAvx2Table;
    case Isa::sse2:
      break;
  }
  return kSse2Table;
}

}  // namespace weft::simd
