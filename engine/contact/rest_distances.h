/// The distances that features of a cloth keep from each other. It is the thickness, or most of the
/// distance at rest for features that are nearer there. A mesh finer than the thickness would push
/// itself apart otherwise.
///
/// The shape at rest follows from lengths at rest: the neighbours of each triangle are laid into
/// its plane, one beside the other, and so are those that seams join to them. Points that are sewn
/// together, or will be, have a distance of zero there. Threads may have any angle to each other
/// and to the cloth that they are tied to: their distance is the length of the path along edges.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/contact/features.h"
#include "engine/contact/sewn_points.h"
#include "engine/model/model.h"

namespace weft {

class RestDistances {
 public:
  RestDistances() = default;
  RestDistances(const Model& model, double thickness, const SewnPoints& sewn);

  bool empty() const { return thickness_ == 0; }
  /// m
  double of(const Pair& pair) const;
  /// The number of pairs that are nearer than the thickness at rest.
  std::size_t count() const { return nearer_.size(); }
  std::size_t bytes() const { return nearer_.capacity() * sizeof(Nearer); }

 private:
  struct Nearer {
    std::uint64_t key = 0;  // of both features; the kind is its lowest bit
    double distance = 0;    // m
  };
  static std::uint64_t key_of(PairKind kind, std::uint32_t first, std::uint32_t second);

  double thickness_ = 0;
  std::vector<Nearer> nearer_;  // by their keys
};

}  // namespace weft
