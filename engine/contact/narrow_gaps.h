/// Near pairs of particles between two bodies, one of which is a mesh. When each substep begins the
/// bodies share the gap between them (thickness_shares.h).
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/contact/look.h"
#include "engine/contact/near_pairs.h"
#include "engine/contact/scene.h"
#include "engine/contact/tangles.h"

namespace weft {

class NarrowGaps {
 public:
  /// Begins an interval.
  void begin(const ContactScene& scene, const Near& near);
  /// Shares the gaps in a substep.
  void share(const ContactScene& scene, const Near& near);
  /// When an interval is over: takes in particles and triangles inside bodies that overlap.
  void take_in(const ContactScene& scene, const Near& near, Tangles& tangles) const;
  std::size_t bytes() const;

 private:
  /// A triangle, an edge or a vertex of a body.
  struct Feature {
    std::uint32_t body = 0, index = 0;
    PairKind kind = PairKind::edges;
    bool is_vertex = false;

    auto operator<=>(const Feature&) const = default;
  };
  struct Place {
    std::uint32_t list = 0, pair = 0, feature = 0;  // of features_
  };
  /// A pair of a body's feature and one of the cloth, when the substep begins.
  struct Seen {
    std::array<std::uint32_t, 4> points{};
    FourPoints x{};
    std::array<double, 4> weight{};
    kernels::Vector at{};  // of the cloth, where both are nearest
    BodyClearance clearance{};
    double radius = 0;  // m, of the body around its feature
    bool is_in_place = false;
  };
  struct OfSlot {
    std::uint32_t slot = 0, feature = 0, pair = 0;  // of features_ and pairs_

    auto operator<=>(const OfSlot&) const = default;
  };
  static Feature feature_of(const ContactScene& scene, const Pair& pair);
  /// The direction in which a feature of a body faces a particle.
  struct Facing {
    std::uint32_t slot = 0, body = 0;
    kernels::Vector normal{};
  };
  Seen see(const ContactScene& scene, const NearPairs& near, std::size_t i) const;
  /// The clearance of another place beside the feature of a pair's body.
  static BodyClearance clearance_at(const ContactScene& scene, const Seen& of, kernels::Vector at);
  /// The clearance of the particles around a place from a body of a closed form.
  static BodyClearance clearance_of_particles(const ContactScene& scene, std::uint32_t body,
                                              const Seen& here);
  void find_slots(const ContactScene& scene, const Near& near);
  void find_pairs(const Near& near);
  void find_features(const ContactScene& scene, const Near& near);
  void share_at(const ContactScene& scene, std::uint32_t at);
  std::span<const OfSlot> beside(std::uint32_t slot) const;
  void take_nearest(const BodyClearance& clearance);

  std::vector<Place> pairs_;               // of particles between bodies
  std::vector<Feature> features_;          // of bodies in these, ascending
  std::vector<std::uint32_t> slots_;       // their particles, ascending
  std::vector<OfSlot> beside_;             // by slots
  std::vector<Seen> seen_;                 // of pairs_
  std::vector<std::uint32_t> last_;        // of features_: the last pair that asked it
  std::vector<BodyClearance> clearances_;  // scratch
  std::vector<Facing> facing_, at_one_;    // likewise
};

}  // namespace weft
