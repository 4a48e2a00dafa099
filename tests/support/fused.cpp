#include "tests/support/fused.h"

namespace weft::test {

float fused(float x, float y, float z) { return __builtin_fmaf(x, y, z); }
double fused(double x, double y, double z) { return __builtin_fma(x, y, z); }

}  // namespace weft::test
