/// Particles against forms that lanes have no formulas of (kernels/reference/forms.h): of a pair
/// one particle after the other, in double, and compiled once, so that all instruction sets have
/// the same bits.
#pragma once

#include <cstddef>

#include "kernels/reference/bodies.h"
#include "kernels/simd/limit_data.h"

namespace weft::simd {

/// They are sums of the present substep.
reference::ContactSums sums_at(const BodyContactSums& lanes, std::size_t lane);
/// After a contact that changed the velocity v to that of the result. momentum: kg, by which a
/// change of velocity counts.
void put_sums(BodyContactSums& lanes, std::size_t lane, const reference::ContactSums& sums,
              const reference::BodyMotion& body, const reference::ContactResult& result,
              kernels::Vector v, double momentum);

void solve_field_pair(const BodySolve& h, std::size_t pair);
/// m, by which a particle is under the surface, besides what is spared.
float depth_of_field_pair(const BodySolve& h, std::size_t pair);

}  // namespace weft::simd
