#include "kernels/simd/make_table.h"
constinit const weft::simd::Table weft::simd::kSse2Table = weft::simd::make_table();
