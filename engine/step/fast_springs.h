/// Springs and triangles of fabric that swing too fast to be seen. A caller who writes positions
/// means places, and not the energy that the fabric would have there. So a projection corrects
/// these as it corrects rigid edges (project.h).
///
/// A spring between inverse masses w_a and w_b swings by itself with the angular frequency
/// sqrt((w_a + w_b) / compliance). It is fast if it swings by more than a radian within the longest
/// substep (tuning::kLongestSubstep). Edges of woven fabrics are, by factors of ten and more. A
/// slower spring is one whose swings are wanted: its stretch is left as it is.
#pragma once

#include "engine/model/model.h"
#include "kernels/vectors.h"

namespace weft {

/// m/N, the compliance of the softest fast spring; the least that there is if only triangles of
/// fabric are fast; 0: nothing is.
double softest_of_fast(const Model& model);

/// The largest change of a fast spring's or triangle's strain between two places.
double largest_change_of_fast(const Model& model, const kernels::Vectors& from,
                              const kernels::Vectors& to);

/// Whether the rest of a fast spring or triangle differs between two related models, by more than
/// the strain.
bool fast_rest_differs(const Model& a, const Model& b, double strain);

}  // namespace weft
