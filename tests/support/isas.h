/// Every instruction set that kernels can be tested on here.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "kernels/simd/isa.h"

namespace weft::test {

inline constexpr simd::Isa kIsas[]{simd::Isa::sse2, simd::Isa::avx2, simd::Isa::avx512,
                                   simd::Isa::neon};

inline std::string text(simd::Isa isa) {
  constexpr const char* kNames[] = {"sse2", "avx2", "avx512", "neon"};
  return kNames[static_cast<int>(isa)];
}

/// Says which it leaves out.
inline std::vector<simd::Isa> supported_isas() {
  std::vector<simd::Isa> isas;
  for (const simd::Isa isa : kIsas) {
    if (simd::supported(isa)) {
      isas.push_back(isa);
    } else {
      MESSAGE("this machine lacks ", text(isa), ": not tested");
    }
  }
  return isas;
}

}  // namespace weft::test
