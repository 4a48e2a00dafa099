/// The instruction sets that the vector kernels are built for, and which of them this machine has.
#pragma once

#include <cstdint>

namespace weft::simd {

/// sse2: every x86-64. avx2: with FMA. avx512: F, CD, DQ, BW, VL. neon: every aarch64.
/// avx2, avx512 and neon give the same bits; sse2 rounds twice where they fuse.
enum class Isa : std::uint8_t { sse2, avx2, avx512, neon };

/// Whether this library has kernels for it, and the processor and, on x86-64, the operating system
/// (XGETBV) support it.
bool supported(Isa isa);
Isa best_isa();

}  // namespace weft::simd
