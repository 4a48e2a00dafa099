/// All vector kernels of one instruction set: that of the translation unit which includes this.
#pragma once

#include "kernels/simd/anticipate.h"
#include "kernels/simd/contacts.h"
#include "kernels/simd/directions.h"
#include "kernels/simd/fronts.h"
#include "kernels/simd/integrate.h"
#include "kernels/simd/masks.h"
#include "kernels/simd/measure.h"
#include "kernels/simd/relax.h"
#include "kernels/simd/split.h"
#include "kernels/simd/yarn_system.h"

namespace weft::simd {
inline namespace WEFT_LANES {
namespace {

constexpr Table make_table() {
  return {.predict = predict,
          .commit = commit,
          .measure_kicks = measure_kicks,
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
          .relax_contacts = relax_contacts,
          .relax_masked_run = relax_masked_run,
          .renew_products_run = renew_products_run,
          .renew_products_singles = renew_products_singles,
          .relax_anticipated_run = relax_anticipated_run,
          .relax_anticipated_singles = relax_anticipated_singles,
          .apply_sums_run = apply_sums_run,
          .apply_sums_singles = apply_sums_singles,
          .split_quads = split_quads,
          .join_quads = join_quads,
          .split_rows = split_rows,
          .join_rows = join_rows,
          .yarn_keep_start = yarn_keep_start,
          .yarn_sweep = yarn_sweep,
          .yarn_sweep_watched = yarn_sweep_watched,
          .yarn_linearise = yarn_linearise,
          .yarn_read = yarn_read,
          .yarn_precondition = yarn_precondition,
          .yarn_push_first = yarn_push_first,
          .yarn_push = yarn_push,
          .yarn_eliminate = yarn_eliminate,
          .yarn_pull = yarn_pull,
          .yarn_finish = yarn_finish,
          .yarn_add = yarn_add,
          .strain_run = strain_run,
          .strain_singles = strain_singles,
          .stretch_runs = stretch_runs,
          .stretch_singles = stretch_singles,
          .eliminate_front = eliminate_front,
          .solve_front_forward = solve_front_forward,
          .solve_front_backward = solve_front_backward,
          .find_near = find_near,
          .find_moved = find_moved};
}

}  // namespace
}  // namespace WEFT_LANES
}  // namespace weft::simd
