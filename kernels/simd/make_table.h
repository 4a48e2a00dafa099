/// All vector kernels of one instruction set: that of the translation unit which includes this.
#pragma once

#include "kernels/simd/anchors.h"
#include "kernels/simd/anticipate.h"
#include "kernels/simd/bending.h"
#include "kernels/simd/bending_system.h"
#include "kernels/simd/bodies.h"
#include "kernels/simd/directions.h"
#include "kernels/simd/distances.h"
#include "kernels/simd/fronts.h"
#include "kernels/simd/integrate.h"
#include "kernels/simd/masks.h"
#include "kernels/simd/measure.h"
#include "kernels/simd/membrane.h"
#include "kernels/simd/reaches.h"
#include "kernels/simd/relax.h"
#include "kernels/simd/relax_springs.h"
#include "kernels/simd/small_step_springs.h"
#include "kernels/simd/small_step_yarns.h"
#include "kernels/simd/small_steps.h"
#include "kernels/simd/spheres.h"
#include "kernels/simd/split.h"
#include "kernels/simd/yarn_system.h"
#include "kernels/simd/yarns.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

#if defined(__AVX512F__)
/// Kernels on a block of yarns: where no more than half of the lanes have one, half a vector is
/// enough, which takes less time, and gives the same bits.
template <auto kKernel, auto kSame, class Result, class... Arguments>
constexpr auto as_wide_as(Result (*)(const Yarns&, const YarnBlock&, Arguments...)) {
  return +[](const Yarns& y, const YarnBlock& block, Arguments... arguments) -> Result {
    if (2 * block.lanes <= kFloats) return (kAvx2Table.*kSame)(y, block, arguments...);
    return kKernel(y, block, arguments...);
  };
}
template <auto kKernel, auto kSame>
constexpr auto as_wide_as_block() {
  return as_wide_as<kKernel, kSame>(kKernel);
}
#else
template <auto kKernel, auto kSame>
constexpr auto as_wide_as_block() {
  return kKernel;
}
#endif

constexpr Table make_table(const ContactKernels* contacts) {
  return {.predict = predict,
          .commit = commit,
          .commit_watched = commit_watched,
          .measure_impulses = measure_impulses,
          .apply_displacements = apply_displacements,
          .renew_run = renew_run,
          .renew_singles = renew_singles,
          .renew_from_start_run = renew_from_start_run,
          .renew_from_start_singles = renew_from_start_singles,
          .renew_velocity_run = renew_velocity_run,
          .renew_velocity_singles = renew_velocity_singles,
          .relax_run = relax_run,
          .relax_runs = relax_runs,
          .relax_singles = relax_singles,
          .relax_rope_run = relax_rope_run,
          .relax_rope_singles = relax_rope_singles,
          .relax_serial = relax_serial,
          .relax_rope_serial = relax_rope_serial,
          .relax_spring_run = relax_spring_run,
          .relax_spring_singles = relax_spring_singles,
          .relax_spring_serial = relax_spring_serial,
          .relax_contacts = relax_contacts,
          .relax_masked_run = relax_masked_run,
          .renew_products_run = renew_products_run,
          .renew_products_singles = renew_products_singles,
          .relax_anticipated_run = relax_anticipated_run,
          .relax_anticipated_singles = relax_anticipated_singles,
          .apply_sums_run = apply_sums_run,
          .apply_sums_singles = apply_sums_singles,
          .refresh_errors_run = refresh_errors_run,
          .refresh_errors_singles = refresh_errors_singles,
          .split_quads = split_quads,
          .join_quads = join_quads,
          .split_rows = split_rows,
          .join_rows = join_rows,
          .offset_quads = offset_quads,
          .offset_rows = offset_rows,
          .narrow_quads = narrow_quads,
          .narrow_rows = narrow_rows,
          .widen_quads = widen_quads,
          .widen_rows = widen_rows,
          .yarn_keep_start = as_wide_as_block<yarn_keep_start, &Table::yarn_keep_start>(),
          .yarn_sweep = as_wide_as_block<yarn_sweep, &Table::yarn_sweep>(),
          .yarn_sweep_watched = as_wide_as_block<yarn_sweep_watched, &Table::yarn_sweep_watched>(),
          .yarn_linearise = as_wide_as_block<yarn_linearise, &Table::yarn_linearise>(),
          .yarn_read = as_wide_as_block<yarn_read, &Table::yarn_read>(),
          .yarn_precondition = as_wide_as_block<yarn_precondition, &Table::yarn_precondition>(),
          .yarn_push_first = as_wide_as_block<yarn_push_first, &Table::yarn_push_first>(),
          .yarn_push = as_wide_as_block<yarn_push, &Table::yarn_push>(),
          .yarn_eliminate = as_wide_as_block<yarn_eliminate, &Table::yarn_eliminate>(),
          .yarn_pull = as_wide_as_block<yarn_pull, &Table::yarn_pull>(),
          .yarn_finish = as_wide_as_block<yarn_finish, &Table::yarn_finish>(),
          .yarn_add = yarn_add,
          .advance = advance,
          .advance_measured = advance_measured,
          .settle = settle,
          .largest_move = largest_move,
          .resume = resume,
          .keep_past = keep_past,
          .measure_energy_change = measure_energy_change,
          .renew_base = renew_base,
          .measure_edges = measure_edges,
          .relax_distances = relax_distances,
          .relax_ropes = relax_ropes,
          .relax_springs = relax_springs,
          .judge_springs = judge_springs,
          .measure_bending = measure_bending,
          .pull_bending = pull_bending,
          .bending_energy = bending_energy,
          .measure_membrane = measure_membrane,
          .relax_membrane = relax_membrane,
          .judge_membrane = judge_membrane,
          .hold_anchors = hold_anchors,
          .solve_body_contacts = solve_body_contacts,
          .deepest_in_bodies = deepest_in_bodies,
          .measure_pairs = measure_pairs,
          .touch_pairs = touch_pairs,
          .find_moved_pairs = find_moved_pairs,
          .find_small = find_small,
          .contacts = contacts,
          .find_met = find_met,
          .reaches_of_triangle = reaches_of_triangle,
          .meet_triangles = meet_triangles,
          .relax_yarns = as_wide_as_block<relax_yarns, &Table::relax_yarns>(),
          .relax_spring_yarns = as_wide_as_block<relax_spring_yarns, &Table::relax_spring_yarns>(),
          .judge_spring_yarns = as_wide_as_block<judge_spring_yarns, &Table::judge_spring_yarns>(),
          .strain_run = strain_run,
          .strain_singles = strain_singles,
          .spring_energy_run = spring_energy_run,
          .spring_energy_singles = spring_energy_singles,
          .stretch_runs = stretch_runs,
          .stretch_singles = stretch_singles,
          .eliminate_front = eliminate_front,
          .solve_front_forward = solve_front_forward,
          .solve_front_backward = solve_front_backward,
          .bend_floats = bending_kernels<float>(),
          .bend_doubles = bending_kernels<double>(),
          .turn_gradients_to = turn_gradients_to,
          .dot_vectors = dot_vectors,
          .solve_vectors_forward = solve_vectors_forward,
          .solve_vectors_backward = solve_vectors_backward,
          .bound = bound,
          .find_boxes = find_boxes,
          .find_near = find_near,
          .find_moved = find_moved};
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
