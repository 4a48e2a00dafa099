/// The length of a substep, in closed form.
///
/// A relaxed sweep is a spring: of one that hangs under the tension T it leaves the strain
///
///     h^2 T (w_a + w_b) / (omega L)
///
/// of each constraint that does not stand in a block with what it carries. At the bottom of a swing
/// T is three times the weight. With H particles of inverse mass w on one, T = 3 g H / w, it is
/// within the share epsilon for
///
///     h = sqrt(omega epsilon L / (6 g H)).
///
/// H: what hangs on the blocks at pins, by particle of theirs, and no less than the number of
/// blocks on the way from the farthest particle to its nearest pin; less one, for of what a block
/// carries of itself a sweep leaves no more than (1 - omega) / omega of one particle's. Where
/// single constraints are blocks, beside yarns too, the load may run through them one by one: then
/// the way is counted in constraints. A yarn between two pins whose length exceeds their distance
/// by the share s sags with the slope sqrt(6 s), and its tension is the load divided by that.
#pragma once

#include "engine/solvers/small_steps_layout.h"
#include "kernels/vectors.h"

namespace weft {

SmallStepsLoad find_load(const Model& model, const SmallStepsLayout& layout);

/// s; infinite where nothing hangs on a pin.
double substep_length(const SmallStepsLoad& load, kernels::VectorsView x, double acceleration,
                      double tolerance);

}  // namespace weft
