#include "kernels/simd/make_table.h"
// By its namespace: flags for another instruction set do not compile.
constinit const weft::simd::Table weft::simd::kNeonTable =
    weft::simd::neon::make_table(&weft::simd::kNeonContacts);
