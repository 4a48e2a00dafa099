/// How much masses differ among particles that constraints join.
#pragma once

#include <cstdint>
#include <span>

namespace weft {

/// A part is all free particles that constraints between free ones join, directly or not.
struct Unevenness {
  double ratio = 1;      // of the heaviest particle of a part to its lightest, the largest of all
  double per_metre = 0;  // that ratio over the mean rest length of the part, the largest of all

  // For loads that no constraint joins: of the lightest particle of a part, the largest of all.
  double lightness = 0;            // 1/kg
  double lightness_per_metre = 0;  // that over the mean rest length of the part
};

/// inverse_mass: per particle, 0 where it is fixed. Constraint c joins a[c] to b[c].
Unevenness find_unevenness(std::span<const double> inverse_mass, std::span<const std::uint32_t> a,
                           std::span<const std::uint32_t> b, std::span<const double> rest_length);

}  // namespace weft
