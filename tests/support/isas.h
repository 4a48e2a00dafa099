/// Every instruction set that kernels can be tested on here.
#pragma once

#include <vector>

#include "kernels/simd/isa.h"

namespace weft::test {

inline std::vector<simd::Isa> supported_isas() {
  std::vector<simd::Isa> isas;
  for (const simd::Isa isa : {simd::Isa::sse2, simd::Isa::avx2, simd::Isa::avx512}) {
    if (simd::supported(isa)) isas.push_back(isa);
  }
  return isas;
}

}  // namespace weft::test
