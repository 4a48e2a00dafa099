#include "kernels/simd/contacts.h"
#include "kernels/simd/table.h"
// By its namespace: flags for another instruction set do not compile.
constinit const weft::simd::ContactKernels weft::simd::kAvx2Contacts =
    weft::simd::avx2::contact_kernels();
