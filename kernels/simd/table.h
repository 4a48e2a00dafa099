/// The vector kernels, one function pointer per stage, one table per instruction set. Their data
/// stand in sweep_data.h, yarn_data.h, front_data.h, small_step_data.h, bending_data.h,
/// contact_data.h, limit_data.h and nearness_data.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/impulse_energy.h"
#include "kernels/simd/bending_data.h"
#include "kernels/simd/front_data.h"
#include "kernels/simd/isa.h"
#include "kernels/simd/limit_data.h"
#include "kernels/simd/nearness_data.h"
#include "kernels/simd/small_step_data.h"
#include "kernels/simd/sweep_data.h"
#include "kernels/simd/yarn_data.h"
#include "kernels/vectors.h"

namespace weft::simd {

/// The kernels of contact_data.h; a source of its own for each instruction set. A library has those
/// of its processor (on_x86_64.cpp, on_aarch64.cpp).
struct ContactKernels;
extern const ContactKernels kSse2Contacts, kAvx2Contacts, kAvx512Contacts, kNeonContacts;

/// Conjugate gradients on the linear system of bending (bending_system.h), in float or in double.
template <class Real>
struct BendingKernels {
  /// q = A p, of groups of rows first ... last - 1; returns p . q.
  double (*multiply)(const BendingMatrix<Real>&, const Real* p, Real* q, std::size_t first,
                     std::size_t last);
  /// For slots first ... last - 1: r -= inertia M guess and p = r / diagonal.
  BendingNorms (*begin)(const BendingGradients<Real>&, const Real* mass, Real inertia,
                        std::size_t first, std::size_t last);
  /// Likewise: change += alpha p, or = alpha p, and r -= alpha A p; returns r . r / diagonal.
  double (*step)(const BendingGradients<Real>&, Real alpha, bool is_first, std::size_t first,
                 std::size_t last);
  /// Likewise: p = r / diagonal + beta p.
  void (*turn)(const BendingGradients<Real>&, Real beta, std::size_t first, std::size_t last);
};

/// Ranges of slots are multiples of kLanes; runs and singles likewise. Kernels for runs take planar
/// displacements.
struct Table {
  /// solved = p + h v + h^2/2 a (paper eq. 2).
  void (*predict)(const Motion&, double h, std::size_t first, std::size_t last);
  /// next_velocity = v + h a + (solved - predicted) / h, predicted formed as in predict. Returns
  /// whether solved and next_velocity are finite.
  bool (*commit)(const Motion&, double h, std::size_t first, std::size_t last);
  /// The same, and the impulses of the range while those of the velocity loop are still 0.
  bool (*commit_watched)(const Motion&, double h, std::size_t first, std::size_t last,
                         kernels::ImpulseEnergy& impulses);
  /// Once velocities are corrected. Both sum in an order that depends on nothing but the range.
  kernels::ImpulseEnergy (*measure_impulses)(const Motion&, double h, std::size_t first,
                                             std::size_t last);
  /// x += u, u = 0.
  void (*apply_displacements)(kernels::VectorsView x, Displacements u, std::size_t first,
                              std::size_t last);

  /// n = (x_a - x_b) / l / tau, e0 = (l - rest) / tau (paper 4.2).
  void (*renew_run)(const Geometry&, const BlockRelaxation&, const Run&);
  void (*renew_singles)(const Geometry&, const BlockRelaxation&, std::uint32_t first,
                        std::uint32_t last);
  /// The same with n at other positions: those at the start of the step (scheme rattle).
  void (*renew_from_start_run)(const Geometry&, kernels::VectorsView start, const BlockRelaxation&,
                               const Run&);
  void (*renew_from_start_singles)(const Geometry&, kernels::VectorsView start,
                                   const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  /// n as above with tau in m/s, e0 = n . (v_a - v_b) (paper 3.3).
  void (*renew_velocity_run)(const Geometry&, kernels::VectorsView v, const BlockRelaxation&,
                             const Run&);
  void (*renew_velocity_singles)(const Geometry&, kernels::VectorsView v, const BlockRelaxation&,
                                 std::uint32_t first, std::uint32_t last);

  /// One pass over constraints of one colour; returns how many were corrected.
  std::uint32_t (*relax_run)(const BlockRelaxation&, const Run&);
  /// The same for many runs, those with wanted[i] == 0 left out (null: none), so that a short run
  /// costs no call. corrections[i] is set for every run.
  void (*relax_runs)(const BlockRelaxation&, const Run* runs, std::size_t count,
                     const std::uint8_t* wanted, std::uint32_t* corrections);
  std::uint32_t (*relax_singles)(const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  std::uint32_t (*relax_rope_run)(const BlockRelaxation&, const Run&);
  std::uint32_t (*relax_rope_singles)(const BlockRelaxation&, std::uint32_t first,
                                      std::uint32_t last);
  /// Constraints that share slots (hubs), one after the other.
  std::uint32_t (*relax_serial)(const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  std::uint32_t (*relax_rope_serial)(const BlockRelaxation&, std::uint32_t first,
                                     std::uint32_t last);
  /// All of these where constraints may be springs.
  std::uint32_t (*relax_spring_run)(const BlockRelaxation&, const Run&, bool rope);
  std::uint32_t (*relax_spring_singles)(const BlockRelaxation&, std::uint32_t first,
                                        std::uint32_t last, bool rope);
  std::uint32_t (*relax_spring_serial)(const BlockRelaxation&, std::uint32_t first,
                                       std::uint32_t last, bool rope);
  /// Contacts of one sphere, the slot a[first]; see spheres.h for their gains.
  std::uint32_t (*relax_contacts)(const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  /// The same with the paper's masks (4.3): lanes whose bit is clear at both ends are passed over,
  /// whole vectors at once. `visits` counts the lanes looked at.
  std::uint32_t (*relax_masked_run)(const BlockRelaxation&, const Run&, std::uint64_t bit,
                                    std::uint64_t& visits);

  /// The anticipating form. renew_products starts afresh: error = e0, no changes.
  void (*renew_products_run)(const Anticipation&, const BlockRelaxation&, const Run&);
  void (*renew_products_singles)(const Anticipation&, const BlockRelaxation&, std::uint32_t first,
                                 std::uint32_t last);
  std::uint32_t (*relax_anticipated_run)(const Anticipation&, const Run&);
  std::uint32_t (*relax_anticipated_singles)(const Anticipation&, std::uint32_t first,
                                             std::uint32_t last);
  /// u_a += gain_a sum n, u_b += gain_b sum n, sum = 0.
  void (*apply_sums_run)(const Anticipation&, const BlockRelaxation&, const Run&);
  void (*apply_sums_singles)(const Anticipation&, const BlockRelaxation&, std::uint32_t first,
                             std::uint32_t last);
  /// error = e0 + n . (u_a - u_b), change = 0.
  void (*refresh_errors_run)(const Anticipation&, const BlockRelaxation&, const Run&);
  void (*refresh_errors_singles)(const Anticipation&, const BlockRelaxation&, std::uint32_t first,
                                 std::uint32_t last);

  /// base = x in whole cells, a power of two (0: none), rounded to float, u = x - base; and x moved
  /// to base + u. For slots first ... last - 1, in quads.
  void (*split_quads)(kernels::VectorsView x, std::size_t first, std::size_t last, double cell,
                      float* base, float* u);
  void (*join_quads)(kernels::VectorsView x, std::size_t first, std::size_t last, const float* base,
                     const float* u);
  /// The same of woven rows.
  void (*split_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count, double cell,
                     float* base, float* u);
  void (*join_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count,
                    const float* base, const float* u);
  /// u = x - base.
  void (*offset_quads)(kernels::VectorsView x, std::size_t first, std::size_t last,
                       const float* base, float* u);
  void (*offset_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count,
                      const float* base, float* u);
  /// to = x, rounded to float; and x = from.
  void (*narrow_quads)(kernels::VectorsView x, std::size_t first, std::size_t last, float* to);
  void (*narrow_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count, float* to);
  void (*widen_quads)(kernels::VectorsView x, std::size_t first, std::size_t last,
                      const float* from);
  void (*widen_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count,
                     const float* from);
  // For yarns. scratch: one row more than the block has; for patches twice that (scratch_rows()).
  /// start = the directions at base + u.
  void (*yarn_keep_start)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  /// Solves the yarns of a block.
  void (*yarn_sweep)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  /// The same along present directions, unless all lengths are far within the share `enough`; and
  /// again until they are within it, at most `most` times.
  Swept (*yarn_sweep_watched)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                              float enough, std::uint32_t most);
  /// Conjugate gradients (yarn_system.h) over all yarns, or all but those of the first family,
  /// which is eliminated; what writes t goes family by family.
  void (*yarn_linearise)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  /// The velocities base + u become the right side; returns the largest.
  float (*yarn_read)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  YarnProducts (*yarn_precondition)(const Yarns&, const YarnBlock&, float alpha);
  void (*yarn_push_first)(const Yarns&, const YarnBlock&, float beta, float* t,
                          YarnScratch* scratch);
  void (*yarn_push)(const Yarns&, const YarnBlock&, float beta, float* t, YarnScratch* scratch);
  /// The block's impulses take what t changes its lengths by out of t again; with errors, those
  /// too.
  void (*yarn_eliminate)(const Yarns&, const YarnBlock&, float* t, YarnElimination,
                         YarnScratch* scratch);
  float (*yarn_pull)(const Yarns&, const YarnBlock&, float* t, YarnScratch* scratch);
  void (*yarn_finish)(const Yarns&, const YarnBlock&, float* t, YarnScratch* scratch);
  /// u += t, of the floats first ... last - 1, multiples of kLanes.
  void (*yarn_add)(float* u, const float* t, std::size_t first, std::size_t last);

  // Small steps (small_steps.h), of the floats first ... last - 1, multiples of kLanes.
  void (*advance)(const Flight&, const SubstepWeights&, std::size_t first, std::size_t last);
  /// Returns the largest component of the departure of the last substep (reference::departure()).
  float (*advance_measured)(const Flight&, const SubstepWeights&, std::size_t first,
                            std::size_t last);
  /// v becomes the velocity, predicted u; returns the same.
  float (*settle)(const Flight&, const LastSubstep&, std::size_t first, std::size_t last);
  /// The largest |u - u_before|.
  float (*largest_move)(const Flight&, std::size_t first, std::size_t last);
  /// Begins a frame at u with the velocities v, which need not be the past's; h: of its last
  /// substep.
  void (*resume)(const Flight&, const Past&, float h, std::size_t first, std::size_t last);
  void (*keep_past)(const Flight&, const Past&, std::size_t first, std::size_t last);
  /// Gain and energy alone of the impulses, of a frame from position and velocity to solved and
  /// next_velocity; of slots first ... last - 1.
  kernels::ImpulseEnergy (*measure_energy_change)(const Motion&, std::size_t first,
                                                  std::size_t last);
  void (*renew_base)(const Flight&, float* base, float cell, std::size_t first, std::size_t last);
  // For blocks first ... last - 1.
  void (*measure_edges)(const EdgeBlock*, EdgeSpans*, const float* base, std::size_t first,
                        std::size_t last);
  void (*relax_distances)(const EdgeRelaxation&, std::size_t first, std::size_t last);
  void (*relax_ropes)(const EdgeRelaxation&, std::size_t first, std::size_t last);
  void (*relax_springs)(const SpringRelaxation&, bool rope, std::size_t first, std::size_t last);
  /// Sets `out` to the constraints that break their laws by more than the tolerance.
  void (*judge_springs)(const SpringRelaxation&, bool rope, std::size_t first, std::size_t last);
  void (*measure_bending)(const BendingBlock*, const BendingSpans&, const float* base, bool four,
                          std::size_t first, std::size_t last);
  /// Adds the pulls of elements that share no particle to quads.
  void (*pull_bending)(const Bending&, float* to, bool four, std::size_t first, std::size_t last);
  /// J, of each block.
  void (*bending_energy)(const Bending&, double* energy, bool four, std::size_t first,
                         std::size_t last);
  void (*measure_membrane)(const MembraneBlock*, MembraneSpans*, const float* base,
                           std::size_t first, std::size_t last);
  /// continues: from the multipliers, else from none.
  void (*relax_membrane)(const Membrane&, float omega, bool continues, bool rope, std::size_t first,
                         std::size_t last);
  /// out: per block, a bit per lane: whether a law is broken by more than `strain`.
  void (*judge_membrane)(const Membrane&, float strain, std::uint16_t* out, bool rope,
                         std::size_t first, std::size_t last);
  void (*hold_anchors)(const AnchorSolve&, std::size_t first, std::size_t last);
  /// For pairs first ... last - 1.
  void (*solve_body_contacts)(const BodySolve&, std::size_t first, std::size_t last);
  /// m, by which the deepest is under a surface; at least 0.
  float (*deepest_in_bodies)(const BodySolve&, std::size_t first, std::size_t last);
  /// For blocks first ... last - 1. edges: pairs of edges, else of a point and a triangle.
  void (*measure_pairs)(const PairMeasure&, bool edges, std::size_t first, std::size_t last);
  void (*touch_pairs)(const PairTouch&, bool edges, std::size_t first, std::size_t last);
  void (*find_moved_pairs)(const PairMoves&, bool edges, std::size_t first, std::size_t last);
  /// For blocks first ... last - 1, a bit per lane: which of `of` are at most `limit`.
  void (*find_small)(const float (*of)[kernels::kLanes], float limit, std::uint16_t* small,
                     std::size_t first, std::size_t last);
  const ContactKernels* contacts = nullptr;
  /// Which of the boxes the one from low to high meets, a bit each.
  std::uint32_t (*find_met)(const BoxCluster&, const float* low, const float* high);
  /// tubes: of its corners.
  void (*reaches_of_triangle)(const ReachAxes&, const PointTube* const* tubes, TriangleReaches&);
  /// Meets `count` other triangles.
  void (*meet_triangles)(const TriangleMeeting&, std::size_t count);
  /// Scratch as above.
  void (*relax_yarns)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                      const YarnRelaxation&);
  void (*relax_spring_yarns)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                             const YarnSpringRelaxation&);
  /// As judge_springs.
  void (*judge_spring_yarns)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                             const YarnSpringRelaxation&);

  StrainSums (*strain_run)(const Geometry&, const Run&, bool rope);
  StrainSums (*strain_singles)(const Geometry&, std::uint32_t first, std::uint32_t last, bool rope);
  /// J, of the springs of a run or of singles.
  double (*spring_energy_run)(const Geometry&, const SpringStiffness&, const Run&, bool rope);
  double (*spring_energy_singles)(const Geometry&, const SpringStiffness&, std::uint32_t first,
                                  std::uint32_t last, bool rope);
  StretchRange (*stretch_runs)(const Geometry&, const Run*, std::size_t count, bool rope);
  StretchRange (*stretch_singles)(const Geometry&, std::uint32_t first, std::uint32_t last,
                                  bool rope);

  /// Eliminates a front's columns; reciprocal, scratch and update are written too.
  void (*eliminate_front)(const Front&);
  /// Substitutions with one front, z having its rows; panel and reciprocal are read.
  void (*solve_front_forward)(const Front&, double* z);
  void (*solve_front_backward)(const Front&, double* z);

  // The linear system of bending (bending_system.h).
  BendingKernels<float> bend_floats;
  BendingKernels<double> bend_doubles;
  /// For slots first ... last - 1: p = z + beta p; a . b.
  void (*turn_gradients_to)(double* p, const double* z, double beta, std::size_t first,
                            std::size_t last);
  double (*dot_vectors)(const double* a, const double* b, std::size_t first, std::size_t last);
  /// Substitutions with one front, of three right sides.
  void (*solve_vectors_forward)(const Front&, const FrontVectors&, std::size_t columns,
                                std::size_t rows);
  void (*solve_vectors_backward)(const Front&, const FrontVectors&, std::size_t columns,
                                 std::size_t rows);

  /// Boxes grow to hold what has mass.
  void (*bound)(kernels::VectorsView x, const double* mass, std::size_t slots, const Boxes&);
  /// Which boxes may hold something nearer to the box from low to high than reach[box] + extra;
  /// writes their indices, returns how many.
  std::size_t (*find_boxes)(const Boxes&, kernels::Vector low, kernels::Vector high, double extra,
                            std::uint32_t* out);
  /// Likewise those of the slots first ... last - 1 that are nearer to the centre than reach[slot]
  /// + extra.
  std::size_t (*find_near)(kernels::VectorsView x, const double* reach, kernels::Vector centre,
                           double extra, std::size_t first, std::size_t last, std::uint32_t* out);
  /// Likewise those that have moved, beside `along`, by more than part (reach[slot] + extra).
  std::size_t (*find_moved)(kernels::VectorsView before, kernels::VectorsView after,
                            kernels::Vector along, const double* reach, double extra, double part,
                            std::size_t first, std::size_t last, std::uint32_t* out);
};

/// The isa must be supported.
const Table& table(Isa isa);

// A library has those of its processor (on_x86_64.cpp, on_aarch64.cpp).
extern const Table kSse2Table, kAvx2Table, kAvx512Table, kNeonTable;

}  // namespace weft::simd
