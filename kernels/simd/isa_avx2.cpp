#include "kernels/simd/make_table.h"
// By its namespace: flags for another instruction set do not compile.
constinit const weft::simd::Table weft::simd::kAvx2Table =
    weft::simd::avx2::make_table(&weft::simd::kAvx2Contacts);
