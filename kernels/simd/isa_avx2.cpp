#include "kernels/simd/make_table.h"
constinit const weft::simd::Table weft::simd::kAvx2Table = weft::simd::make_table();
