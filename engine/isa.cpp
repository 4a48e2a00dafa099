#include "engine/isa.h"

#include <cstdlib>

namespace weft {
namespace {

Isa public_isa(simd::Isa isa) {
  switch (isa) {
    case simd::Isa::avx512:
      return Isa::avx512;
    case simd::Isa::avx2:
      return Isa::avx2;
    case simd::Isa::neon:
      return Isa::neon;
    case simd::Isa::sse2:
      break;
  }
  return Isa::sse2;
}

Result<Isa> from_environment() {
  const char* wanted = std::getenv("WEFT_ISA");
  if (wanted == nullptr || *wanted == '\0') return Isa::automatic;
  for (const Isa isa : {Isa::automatic, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
    if (name(isa) == wanted) return isa;
  }
  return Error{"WEFT_ISA: must be auto, sse2, avx2, avx512 or neon (" + std::string(wanted) + ")"};
}

}  // namespace

Result<Isa> resolve(Isa wanted) {
  std::string source = "isa";
  if (wanted == Isa::automatic) {
    auto named = from_environment();
    if (!named) return named;
    wanted = named.value();
    source = "WEFT_ISA";
  }
  if (wanted == Isa::automatic) {
    if (simd::supported(simd::best_isa())) return public_isa(simd::best_isa());
    return Error{"isa: this machine has none of those that this library is built for"};
  }
  if (wanted > Isa::neon) {
    return Error{"isa: unknown choice (" + std::to_string(static_cast<int>(wanted)) + ")"};
  }
  if (!simd::supported(to_kernel(wanted))) {
    return Error{source + ": this machine or this library lacks it (" + std::string(name(wanted)) +
                 ")"};
  }
  return wanted;
}

simd::Isa to_kernel(Isa isa) {
  switch (isa) {
    case Isa::avx512:
      return simd::Isa::avx512;
    case Isa::avx2:
      return simd::Isa::avx2;
    case Isa::neon:
      return simd::Isa::neon;
    default:
      return simd::Isa::sse2;
  }
}

}  // namespace weft
