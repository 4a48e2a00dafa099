/// xsimd batches under the names of this project, for the instruction set of the translation unit.
///
/// Everything in the kernels' headers has internal linkage: each instruction set compiles them
/// anew, and a function shared between two of them could be linked from the wrong one.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "kernels/runs.h"
#include "kernels/simd/table.h"

// The namespace of these kernels, so that profiles tell the instruction sets apart.
#if defined(__AVX512F__)
#define WEFT_LANES avx512
#elif defined(__AVX2__)
#define WEFT_LANES avx2
#elif defined(__SSE2__)
#define WEFT_LANES sse2
#else
#define WEFT_LANES neon
#endif

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

#if defined(__AVX512F__)
using Arch = xsimd::avx512f;
#elif defined(__AVX2__)
using Arch = xsimd::fma3<xsimd::avx2>;
#elif defined(__SSE2__)
using Arch = xsimd::sse2;
#else
using Arch = xsimd::neon64;
#endif

using Floats = xsimd::batch<float, Arch>;
using Doubles = xsimd::batch<double, Arch>;
using Ints = xsimd::batch<std::int32_t, Arch>;
using FloatMask = Floats::batch_bool_type;
using DoubleMask = Doubles::batch_bool_type;

constexpr std::uint32_t kFloats = Floats::size;
constexpr std::uint32_t kDoubles = Doubles::size;
static_assert(kernels::kLanes % kFloats == 0);

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
