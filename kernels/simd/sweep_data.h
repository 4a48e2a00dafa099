/// Data of the kernels of Gauss-Seidel sweeps: constraints, and displacements of their
/// particles.
///
/// Precision. Positions and velocities are double. Inside the loop everything is float: the
/// displacement u of each slot since the directions were last renewed, and for each constraint
///
///     e = e0 + n . (u_a - u_b)
///
/// with n and e0 computed in double at the renewal and rounded once. Renewing folds u into the
/// positions: iterative refinement, which is what lets float lanes reach 0.001 % and far below.
///
/// Scale. Errors are in tolerances: n and e0 are divided by the constraint's tolerance tau, so that
/// |e| <= 1 is satisfied and no tolerance is loaded. A correction moves the ends by
///
///     u_a += gain_a e n,   u_b += gain_b e n
///     gain_a = -tau^2 w_a / (w_a + w_b),   gain_b = tau^2 w_b / (w_a + w_b)
///
/// Padding constraints have n = 0, e0 = 0 and gains 0: they are satisfied and move nothing.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/runs.h"
#include "kernels/vectors.h"

namespace weft::simd {

using kernels::Run;

/// Displacements of the slots, in one of two layouts; axis k of slot i is x[i * step + k * stride].
///
///     planar, for runs:              | x x x ... | y y y ... | z z z ... |     step 1
///     quads, where all are singles:  | x y z - | x y z - | x y z - | ...       step 4, stride 1
///
/// Quads take 1.0 ns per constraint where planar singles take 2.5; runs take 0.3 (perf/tried.md).
/// Quads are 16-byte aligned.
struct Displacements {
  float* x = nullptr;
  std::size_t stride = 0;
  std::size_t step = 1;

  float* y() const { return x + stride; }
  float* z() const { return x + 2 * stride; }
  bool in_quads() const { return step == 4; }
};

/// Constraints in blocks of kLanes, so that a pass over them is one stream of memory:
///
///     | n.x | n.y | n.z | e0 | gain_a | gain_b |    each kLanes floats, one cache line
///
/// Constraint c is lane c % kLanes of block c / kLanes; runs, and ranges of singles, are whole
/// blocks.
struct alignas(64) ConstraintBlock {
  float nx[kernels::kLanes], ny[kernels::kLanes], nz[kernels::kLanes];  // in 1 / tau
  float e0[kernels::kLanes];                                            // in tau
  float gain_a[kernels::kLanes], gain_b[kernels::kLanes];               // tau^2
};

/// The data that relaxing a constraint reads and writes.
struct BlockRelaxation {
  Displacements u;
  ConstraintBlock* blocks = nullptr;
  float* impulse = nullptr;                 // ropes, contacts: sum of corrections, >= 0 and <= 0;
                                            // springs: since directions were renewed
  const float* compliance_share = nullptr;  // springs (relax_springs.h), per constraint
  const float* held = nullptr;              // springs: sum of corrections before that
  const std::uint32_t* a = nullptr;         // constraint -> slot, for singles
  const std::uint32_t* b = nullptr;
  std::uint64_t* mask = nullptr;  // skipping by masks: per slot, bit = colour
  float threshold = 1;            // 0: correct whatever the error
  bool from_memory = false;       // the blocks do not fit the caches: fetch them ahead
};

/// Memory of the anticipating form (anticipate.h), for Settings::anticipate_products: it is slower
/// in lanes than forming errors from displacements (perf/tried.md). Constraint slots as elsewhere;
/// pulls of block i are first_pull[i] ... first_pull[i + 1] - 1, each kLanes products.
struct Anticipation {
  float* error = nullptr;                      // per constraint
  float* change = nullptr;                     // per constraint: its last correction
  float* sum = nullptr;                        // per constraint: of its corrections
  const std::uint32_t* first_pull = nullptr;   // per block of kLanes constraints
  const std::int32_t* from_run = nullptr;      // per pull: neighbour of lane 0; lane k has + k
  const std::int32_t* from_singles = nullptr;  // per pull and lane
  const float* weight = nullptr;               // per pull and lane
  float* product = nullptr;                    // per pull and lane
  float threshold = 1;
};

/// The data that renewing directions and measuring strain read.
struct Geometry {
  kernels::VectorsView x;                  // per slot: positions
  const double* rest_length = nullptr;     // per constraint; padding: 1
  const double* inverse_square = nullptr;  // per constraint: 1 / rest^2; padding: 0
  const double* scale = nullptr;           // per constraint: 1 / tau; padding: 0
  const std::uint32_t* a = nullptr;        // constraint -> slot, for singles
  const std::uint32_t* b = nullptr;
};

/// The springs among the constraints of a Geometry, for their energy.
struct SpringStiffness {
  const double* compliance = nullptr;      // m/N; of what is no spring, and of padding: infinite
  const double* inverse_masses = nullptr;  // 1/kg, w_a + w_b
  double give = 0;                         // s^2: it adds give (w_a + w_b) to each compliance
};

/// The particles of a step, per slot; padding slots have inverse mass 0.
struct Motion {
  const double* inverse_mass = nullptr;
  const double* mass = nullptr;
  kernels::Vector gravity{};
  kernels::VectorsView force{};  // x == nullptr: none besides gravity
  kernels::VectorsView position{}, velocity{};
  kernels::VectorsView solved{};
  kernels::VectorsView next_velocity{};
};

/// Sums over a run, in an order that depends on nothing but the run.
struct StrainSums {
  double largest = 0;
  double squares = 0;
};

/// The range of (length / rest)^2; most is infinite where one is not finite.
struct StretchRange {
  double least = 1;
  double most = 1;
};

}  // namespace weft::simd
