/// The volume of solids, where it is, and how it is spread.
#pragma once

#include <array>
#include <span>

#include "kernels/reference/forms.h"

namespace weft {

/// Sums over the parts of a solid of density 1 about the origin: of volume, x and products.
struct BodyMoments {
  double volume = 0;
  kernels::Vector first{};
  std::array<double, 6> second{};  // xx, yy, zz, yz, zx, xy

  void add(double part, kernels::Vector at) {
    volume += part;
    first = first + part * at;
    const double products[] = {at.x * at.x, at.y * at.y, at.z * at.z,
                               at.y * at.z, at.z * at.x, at.x * at.y};
    for (std::size_t i = 0; i < 6; ++i) second[i] += part * products[i];
  }
};

BodyMoments moments_of_hull(std::span<const kernels::Vector> points);
BodyMoments moments_of_round(const reference::Round& round);

}  // namespace weft
