#include "kernels/simd/make_table.h"
// By its namespace: flags for another instruction set do not compile.
constinit const weft::simd::Table weft::simd::kAvx512Table =
    weft::simd::avx512::make_table(&weft::simd::kAvx512Contacts);
