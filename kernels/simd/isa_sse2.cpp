#include "kernels/simd/make_table.h"
// By its namespace: flags for another instruction set do not compile.
constinit const weft::simd::Table weft::simd::kSse2Table =
    weft::simd::sse2::make_table(&weft::simd::kSse2Contacts);
