/// x y + z, rounded once by the processor's own instruction, which x86-64 has where it has AVX2.
/// (The C library of MinGW-w64 rounds twice.)
#pragma once

namespace weft::test {

float fused(float x, float y, float z);
double fused(double x, double y, double z);

}  // namespace weft::test
