/// Something for the vector kernels to work on, and plain scalar code to expect the same bits from.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/simd/table.h"
#include "kernels/vectors.h"
#include "tests/support/fused.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test {

using kernels::kLanes;
using kernels::Run;

/// x y + z as an instruction set rounds it: once where it can fuse, else twice.
struct Rounding {
  bool fuses = false;
  explicit Rounding(simd::Isa isa) : fuses(isa != simd::Isa::sse2) {}

  template <class T>
  T fused(T x, T y, T z) const {
    return fuses ? test::fused(x, y, z) : x * y + z;
  }
  double dot(kernels::Vector a, kernels::Vector b) const {
    return fused(a.x, b.x, fused(a.y, b.y, a.z * b.z));
  }
};

/// One constraint, copied out of its block, and the displacements of its ends.
struct Lane {
  float nx, ny, nz, e0, gain_a, gain_b;
};

/// Particles and the constraints of one batch: a run that starts at odd slots, and singles between
/// the same slots in random pairs. Some constraints are padding.
struct KernelData {
  KernelData(std::uint32_t length, std::uint32_t seed);

  std::uint32_t first, last;  // constraints: the second block is the first that is used
  Run run;
  std::size_t slots;
  kernels::Vectors position, velocity, force, solved, next_velocity;
  kernels::AlignedVector<double> inverse_mass, mass, rest_length, inverse_square, scale, reach;
  kernels::AlignedVector<float> u, impulse;  // u: planar
  kernels::AlignedVector<float> compliance_share,
      held;  // of springs; every third constraint is none
  kernels::AlignedVector<simd::ConstraintBlock> blocks;
  std::vector<std::uint32_t> a, b;  // of the singles
  std::vector<std::uint64_t> mask;

  std::size_t stride() const { return u.size() / 3; }
  bool is_padding(std::uint32_t c) const { return scale[c] == 0; }
  void make_padding(std::uint32_t c);

  simd::BlockRelaxation relaxation(float threshold);
  simd::Geometry geometry();
  simd::Motion motion(bool forces);

  Lane lane(std::uint32_t c) const;
  /// n . (u_a - u_b) + e0 of constraint c between two slots.
  float error(const Rounding& rounding, std::uint32_t c, std::uint32_t at_a,
              std::uint32_t at_b) const;
  /// u[slot] += factor n.
  void move(const Rounding& rounding, std::uint32_t slot, float factor, const Lane& lane);
};

/// The same bits in everything that kernels write.
bool same(const KernelData& one, const KernelData& other);

inline constexpr std::uint32_t kLengths[]{16, 32, 48, 64, 112, 128, 272};

}  // namespace weft::test
