/// The length of a substep for hinges that are folded at rest (kernels/reference/bending.h).
///
/// The matrix of bending has the stiffness of d, and does not know that the normal turns with the
/// faces. If a substep does not resolve the swing of the hinge, of the angular frequency w, its
/// solution unfolds the hinge along a chord: the faces become longer, and the sweep after it turns
/// them back. The sharper the fold is at rest, the larger is this motion along the faces. So
///
///     h = kFoldTurn / (w s^2),
///
/// where s is the sine of half the angle at rest.
#pragma once

#include <span>

#include "engine/model/bending_element.h"
#include "engine/model/model.h"
#include "kernels/vectors.h"

namespace weft {

/// s; infinite without folds. creases: as they are now, of all elements of the description. x:
/// where particles are, by their slots.
double substep_length_for_folds(const Model& model, std::span<const Crease> creases,
                                kernels::VectorsView x);

}  // namespace weft
