#include "kernels/simd/make_table.h"
constinit const weft::simd::Table weft::simd::kAvx512Table = weft::simd::make_table();
