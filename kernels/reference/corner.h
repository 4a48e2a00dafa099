/// The sides of a hollow that a particle is pressed onto at once.
///
/// Out of one side it is pushed into another. The second push leads along the first side, and a
/// third one along the edge between two, so that no push leads into a side again. Three sides hold
/// a particle. A push along a side, or an edge, is a sum of pushes out of the sides that it is
/// pressed onto, none of which is negative; friction has the forces of all of them.
#pragma once

#include <array>
#include <cstddef>

#include "kernels/vectors.h"

namespace weft::reference {

class Corner {
 public:
  static constexpr int kSides = 3;
  struct Push {
    kernels::Vector along{};  // a unit vector
    double sine = 1;          // of the depth that it removes, over its length
    double forces = 1;        // on all sides, over that along it
  };

  /// The push out of one more side. The sides that it leads away from are left.
  Push add(kernels::Vector normal) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      if (dot(normal, normals_[i]) < 0) normals_[kept++] = normals_[i];
    }
    count_ = 0;
    for (std::size_t i = 0; i < kept; ++i) extend(normals_[i]);
    if (!extend(normal)) {  // it is opposite to the others: there is no room between them
      count_ = 0;
      extend(normal);
    }
    return pushes_[count_ - 1];
  }
  /// The part of a vector along all sides.
  kernels::Vector free_part(kernels::Vector v) const {
    for (std::size_t i = 0; i < count_; ++i) v = v - dot(v, pushes_[i].along) * pushes_[i].along;
    return v;
  }

 private:
  bool extend(kernels::Vector normal) {
    constexpr double kOpposite = 1e-6;
    Push push{normal};
    if (count_ > 0) {
      kernels::Vector rest = normal;
      for (std::size_t i = 0; i < count_; ++i) {
        const double cosine = dot(normal, pushes_[i].along);
        rest = rest - cosine * pushes_[i].along;
        push.forces -= cosine * pushes_[i].forces;
      }
      push.sine = length(rest);
      if (!(push.sine > kOpposite)) return false;
      push.along = (1 / push.sine) * rest;
      push.forces /= push.sine;
    }
    normals_[count_] = normal;
    pushes_[count_++] = push;
    return true;
  }

  std::array<kernels::Vector, kSides> normals_{};
  std::array<Push, kSides> pushes_{};  // at right angles
  std::size_t count_ = 0;
};

}  // namespace weft::reference
