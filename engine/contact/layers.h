/// What keeps layers of cloth apart in a substep. The pair was nearer than its thickness when it
/// began: then layers lie on each other, and the push is a force as those of springs are, of which
/// friction holds its part. Or they meet in it: then that is a blow, which takes the speed at which
/// they came together.
///
/// Layers that lie on each other may be a little nearer than the thickness: within that they keep
/// the distance that they have, so that what rests is not pushed to and fro. What is deeper comes
/// out by and by, without speed.
///
/// A particle on a body of a closed form goes no further: the others take its way, too.
///
/// A push may be more than is needed once others have moved the same points. Until the substep ends
/// so much of it is taken back (projected Gauss-Seidel): if not, what lies over a border is lifted,
/// and falls, for ever.
#pragma once

#include "engine/contact/encounter.h"
#include "engine/contact/near_pairs.h"

namespace weft::layers {

/// A pair that is nearer than its thickness. Returns whether it was pushed apart.
bool resist(const ContactScene& scene, Encounter& e, NearState& state);
/// One that is farther apart than its pushes were to bring it. Returns whether points were moved.
/// Those that touch a body stay: it would not follow them.
bool take_back(const ContactScene& scene, Encounter& e, NearState& state);

}  // namespace weft::layers
