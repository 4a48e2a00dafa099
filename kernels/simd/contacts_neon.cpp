#include "kernels/simd/contacts.h"
#include "kernels/simd/table.h"
// By its namespace: flags for another instruction set do not compile.
constinit const weft::simd::ContactKernels weft::simd::kNeonContacts =
    weft::simd::neon::contact_kernels();
