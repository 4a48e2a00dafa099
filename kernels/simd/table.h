/// The vector kernels, one function pointer per stage, one table per instruction set.
///
/// Precision. Positions and velocities are double. Inside the loop everything is float: what each
/// slot was displaced by since the directions were last renewed, u, and for each constraint
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
#include "kernels/simd/isa.h"
#include "kernels/vectors.h"

namespace weft::simd {

using kernels::Run;

struct FloatsView {
  float *x = nullptr, *y = nullptr, *z = nullptr;
};

/// What relaxing a constraint reads and writes.
struct Relaxation {
  FloatsView u;                   // per slot
  FloatsView n;                   // per constraint, in 1 / tau
  float* e0 = nullptr;            // per constraint, in tau
  const float* gain_a = nullptr;  // per constraint, tau^2
  const float* gain_b = nullptr;
  float* impulse = nullptr;          // ropes: accumulated corrections, >= 0
  const std::uint32_t* a = nullptr;  // constraint -> slot, for singles
  const std::uint32_t* b = nullptr;
  std::uint64_t* mask = nullptr;  // skipping by masks: per slot, bit = colour
  float threshold = 1;            // 0: correct whatever the error
};

/// What renewing directions and measuring strain read.
struct Geometry {
  kernels::VectorsView x;               // per slot: positions
  const double* rest_length = nullptr;  // per constraint; padding: 1
  const double* scale = nullptr;        // per constraint: 1 / tau; padding: 0
  const std::uint32_t* a = nullptr;     // constraint -> slot, for singles
  const std::uint32_t* b = nullptr;
};

/// The particles of a step, per slot; padding slots have inverse mass 0.
struct Motion {
  const double* inverse_mass = nullptr;
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

/// Ranges of slots are multiples of kLanes; runs and singles likewise.
struct Table {
  /// solved = p + h v + h^2/2 a (paper eq. 2).
  void (*predict)(const Motion&, double h, std::size_t first, std::size_t last);
  /// next_velocity = v + h a + (solved - predicted) / h, predicted formed as in predict.
  void (*commit)(const Motion&, double h, std::size_t first, std::size_t last);
  /// x += u, u = 0.
  void (*apply_displacements)(kernels::VectorsView x, FloatsView u, std::size_t first,
                              std::size_t last);

  /// n = (x_a - x_b) / l / tau, e0 = (l - rest) / tau (paper 4.2).
  void (*renew_run)(const Geometry&, const Relaxation&, const Run&);
  void (*renew_singles)(const Geometry&, const Relaxation&, std::uint32_t first,
                        std::uint32_t last);
  /// n as above with tau in m/s, e0 = n . (v_a - v_b) (paper 3.3).
  void (*renew_velocity_run)(const Geometry&, kernels::VectorsView v, const Relaxation&,
                             const Run&);
  void (*renew_velocity_singles)(const Geometry&, kernels::VectorsView v, const Relaxation&,
                                 std::uint32_t first, std::uint32_t last);

  /// One pass over constraints of one colour; returns how many were corrected.
  std::uint32_t (*relax_run)(const Relaxation&, const Run&);
  std::uint32_t (*relax_singles)(const Relaxation&, std::uint32_t first, std::uint32_t last);
  std::uint32_t (*relax_rope_run)(const Relaxation&, const Run&);
  std::uint32_t (*relax_rope_singles)(const Relaxation&, std::uint32_t first, std::uint32_t last);
  /// Constraints that share slots (hubs), one after the other.
  std::uint32_t (*relax_serial)(const Relaxation&, std::uint32_t first, std::uint32_t last);
  std::uint32_t (*relax_rope_serial)(const Relaxation&, std::uint32_t first, std::uint32_t last);
  /// Contacts of one sphere, the slot a[first]; see contacts.h for their gains.
  std::uint32_t (*relax_contacts)(const Relaxation&, std::uint32_t first, std::uint32_t last);
  /// The same with the paper's masks (4.3): lanes whose bit is clear at both ends are passed over,
  /// whole vectors at once. `visits` counts the lanes looked at.
  std::uint32_t (*relax_masked_run)(const Relaxation&, const Run&, std::uint64_t bit,
                                    std::uint64_t& visits);

  StrainSums (*strain_run)(const Geometry&, const Run&, bool rope);
  StrainSums (*strain_singles)(const Geometry&, std::uint32_t first, std::uint32_t last, bool rope);

  /// Slots in [first, last) nearer to the centre than reach[slot] + extra; writes their indices,
  /// returns how many.
  std::size_t (*find_near)(kernels::VectorsView x, const double* reach, kernels::Vector centre,
                           double extra, std::size_t first, std::size_t last, std::uint32_t* out);
};

/// The isa must be supported.
const Table& table(Isa isa);

extern const Table kSse2Table, kAvx2Table, kAvx512Table;

}  // namespace weft::simd
