#include "engine/contact/near.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/contact/look.h"
#include "engine/tuning.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

using Four = std::array<std::uint32_t, 4>;

/// Candidates are those of wide boxes. So that what is near depends on the state alone, and not on
/// when candidates were looked for, boxes of this interval are to meet.
bool may_meet(const ContactPoints& points, PairKind kind, const Four& four) {
  const std::size_t firsts = kind == PairKind::edges ? 2 : 1;
  Box first = points.box(four[0]), second = points.box(four[3]);
  for (std::size_t k = 1; k < 3; ++k) (k < firsts ? first : second).add(points.box(four[k]));
  return first.meets(second);
}

/// m, by which two features come nearer to each other along n at most, if their points go on as
/// expected, but for their reach.
double closing(const ContactPoints& points, PairKind kind, const Four& four, Vector n) {
  const auto by = [&](std::size_t k) { return dot(n, points.way(four[k])); };
  const bool edges = kind == PairKind::edges;
  const double first = edges ? std::min(by(0), by(1)) : by(0);
  const double second = edges ? std::max(by(2), by(3)) : std::max({by(1), by(2), by(3)});
  const auto reach = [&](std::size_t from, std::size_t to) {
    double most = 0;
    for (std::size_t k = from; k < to; ++k) most = std::max(most, points.reach(four[k]));
    return most;
  };
  const std::size_t firsts = edges ? 2 : 1;
  return std::max(0.0, second - first) + (reach(0, firsts) + reach(firsts, 4));
}

/// Whether a neighbour is nearer where the interval begins.
bool is_ghost_by(const ContactPoints& points, const Pair& pair, const FourPoints& x,
                 const reference::Nearest& nearest, Vector normal, double lean) {
  return is_ghost(points.surfaces(), pair, x, nearest, normal, lean,
                  [&](std::uint32_t point) { return points.start(point); });
}

/// A pair that looks like this where the interval begins.
SeenPair see(const ContactPoints& points, const Pair& pair, const Four& four, const FourPoints& x,
             const Look& look, bool is_inside) {
  const ContactSurface& later = points.later(pair);
  if (look.distance - closing(points, pair.kind, four, look.normal) > points.thickness_of(pair))
    return {};
  const Vector passes = points.way(four[0]) - points.way(four[3]);
  const bool stays = length(passes) < tuning::kContactPassing * look.distance;
  const bool is_placed = stays && is_in_place(pair.kind, look.nearest);
  if (!is_inside && is_placed &&
      is_ghost_by(points, pair, x, look.nearest, look.normal, tuning::kContactLean))
    return {};
  const bool is_where_seen = later.two_sided || (later.is_open && !is_inside);
  return {.sight = is_where_seen ? Sight::in_front : Sight::asks_side,
          .is_inside = is_inside,
          .is_placed = is_placed,
          .look = look};
}

/// Threads may do so at a time: the normals of a surface, which are computed when they are asked
/// for, are left to `settle`.
SeenPair see(const ContactPoints& points, const Tangles& tangles, const Pair& pair,
             const Four& four) {
  const bool is_inside = tangles.is_inside(four);
  // Faces and edges between particles that are inside follow these.
  const bool is_of_particle = pair.kind == PairKind::point_triangle && !pair.is_turned();
  if ((is_inside && !is_of_particle) || tangles.leaves_out(pair)) return {};
  if (!(points.largest_inverse_mass(four) > 0) || !may_meet(points, pair.kind, four)) return {};
  const FourPoints x = points.starts_of(four);
  const Look look = look_apart(pair, x);
  if (!look.is_apart()) return {.sight = Sight::touches, .is_inside = is_inside, .look = look};
  return see(points, pair, four, x, look, is_inside);
}

/// Whether a near pair within the cloth may be a contact.
bool may_be_contact(const ContactPoints& points, const Tangles& tangles, const Pair& pair,
                    const Four& four) {
  return points.largest_inverse_mass(four) > 0 && !tangles.leaves_out(pair) &&
         !tangles.cross_beside(pair, four);
}

/// Settles whether a pair is in front of a surface, behind it, or far.
void settle(ContactPoints& points, const Pair& pair, const Four& four, SeenPair& seen) {
  ContactSurface& later = points.later(pair);
  if (seen.sight == Sight::touches) {
    const FourPoints x = points.starts_of(four);
    seen = see(points, pair, four, x, look(later, pair, x), seen.is_inside);
  }
  if (seen.sight != Sight::asks_side) return;
  seen.sight = Sight::in_front;
  if (!is_behind(later, pair, seen.look.nearest)) return;
  if (seen.is_inside) {
    seen.sight = Sight::behind;
  } else if (seen.is_placed && !is_ghost_by(points, pair, points.starts_of(four), seen.look.nearest,
                                            seen.look.normal, 0)) {
    // Behind what is not the nearest of its surface the cloth may be beside it.
    seen.sight = Sight::far;
  }
}

}  // namespace

simd::PairMeasure NearSearch::measure_of(const ContactPoints& points, const PairList& pairs,
                                         Distances& distances) const {
  return {.pairs = pairs.blocks.data(),
          .points = points.starts(),
          .ways = points.ways(),
          .reach = static_cast<float>(points.largest_thickness()) + 4 * points.rounding(),
          .beyond = static_cast<float>(tuning::kContactBeyond),
          .distance = distances.lanes(),
          .near = distances.near.data()};
}

/// Pairs of several blocks that are awake, side by side.
class NearSearch::Gathered {
 public:
  Gathered(const simd::Table& table, const simd::PairMeasure& measure, bool edges, float travelled)
      : table_(table), measure_(measure), edges_(edges), travelled_(travelled) {
    measure_.pairs = &block_;
    measure_.distance = &distance_;
    measure_.near = &near_;
  }
  void add(std::size_t pair, const simd::PairBlock& block, Distances& to) {
    for (std::size_t k = 0; k < 4; ++k) block_.point[k][count_] = block.point[k][pair % kLanes];
    at_[count_++] = pair;
    if (count_ == kLanes) finish(to);
  }
  void finish(Distances& to) {
    if (count_ == 0) return;
    for (std::size_t lane = count_; lane < kLanes; ++lane) {
      for (auto& points : block_.point) points[lane] = points[0];
    }
    table_.measure_pairs(measure_, edges_, 0, 1);
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t block = at_[i] / kLanes, lane = at_[i] % kLanes;
      to.distance[block][lane] = distance_[i] + travelled_;
      to.near[block] = static_cast<std::uint16_t>(to.near[block] | (near_ >> i & 1u) << lane);
    }
    count_ = 0;
  }

 private:
  const simd::Table& table_;
  simd::PairMeasure measure_;
  const bool edges_;
  const float travelled_;
  simd::PairBlock block_{};
  float distance_[kLanes]{};
  std::uint16_t near_ = 0;
  std::array<std::size_t, kLanes> at_{};
  std::size_t count_ = 0;
};

void NearSearch::measure_blocks(const simd::PairMeasure& measure, std::size_t list,
                                const PairList& pairs, std::size_t first, std::size_t last) {
  Distances& d = distances_[list];
  table_.measure_pairs(measure, has_edges(list), first, last);
  for (std::size_t block = first; block < last; ++block) {
    d.awake[block] = pairs.used[block];
    d.near[block] = static_cast<std::uint16_t>(d.near[block] & pairs.used[block]);
    for (float& distance : d.distance[block]) distance += travelled_ / simd::kSurelyApart;
  }
}

/// Measures blocks that are known.
void NearSearch::measure_awake(const simd::PairMeasure& measure, std::size_t list,
                               const PairList& pairs, std::size_t first, std::size_t last) {
  Distances& d = distances_[list];
  Gathered gathered(table_, measure, has_edges(list), travelled_ / simd::kSurelyApart);
  for (std::size_t block = first; block < last; ++block) {
    std::uint32_t bits = d.awake[block] =
        static_cast<std::uint16_t>(d.awake[block] & pairs.used[block]);
    if (std::popcount(bits) >= tuning::kAwakeAtOnce) {
      measure_blocks(measure, list, pairs, block, block + 1);
      continue;
    }
    d.near[block] = 0;
    for (; bits != 0; bits &= bits - 1) {
      gathered.add(block * kLanes + static_cast<std::size_t>(std::countr_zero(bits)),
                   pairs.blocks[block], d);
    }
  }
  gathered.finish(d);
}

void NearSearch::measure(const ContactPoints& points, const Candidates& candidates, bool have_moved,
                         Team& team) {
  travelled_ = have_moved ? 0 : travelled_ + (1 + 0x1p-20f) * points.travelled();
  const auto reach =
      static_cast<float>(points.largest_thickness() + points.largest_reach_of_pair());
  const float near = travelled_ + reach + points.largest_way() + 8 * points.rounding();
  for (std::size_t list = 0; list < kPairLists; ++list) {
    const PairList& pairs = candidates[list];
    Distances& d = distances_[list];
    d.resize(pairs.blocks.size());
    const simd::PairMeasure measure = measure_of(points, pairs, d);
    const std::size_t known = have_moved ? 0 : d.count / kLanes;
    team.for_each_share(pairs.blocks.size(), [&](std::size_t first, std::size_t last) {
      const std::size_t until = std::clamp(known, first, last);
      table_.find_small(d.lanes(), near / simd::kSurelyApart, d.awake.data(), first, until);
      measure_awake(measure, list, pairs, first, until);
      measure_blocks(measure, list, pairs, until, last);
    });
    d.count = pairs.size();
  }
}

void NearSearch::measure_new(const ContactPoints& points, const Candidates& candidates,
                             Team& team) {
  for (std::size_t list = 0; list < kPairLists; ++list) {
    const PairList& pairs = candidates[list];
    Distances& d = distances_[list];
    if (d.count == pairs.size()) continue;
    d.resize(pairs.blocks.size());
    const simd::PairMeasure measure = measure_of(points, pairs, d);
    const std::size_t known = d.count / kLanes;
    team.for_each_share(pairs.blocks.size() - known, [&](std::size_t first, std::size_t last) {
      measure_blocks(measure, list, pairs, known + first, known + last);
    });
    d.count = pairs.size();
  }
}

void NearSearch::find(ContactPoints& points, const Candidates& candidates, const Tangles& tangles,
                      Near& near, Team& team) {
  for (std::size_t list = 0; list < kBodyLists; ++list) {
    near[list].clear();
    const PairList& pairs = candidates[list];
    looked_at_.clear();
    for (std::size_t block = 0; block < distances_[list].near.size(); ++block) {
      for (std::uint32_t bits = distances_[list].near[block]; bits != 0; bits &= bits - 1)
        looked_at_.push_back(block * kLanes + static_cast<std::size_t>(std::countr_zero(bits)));
    }
    if (seen_.size() < looked_at_.size()) seen_.resize(looked_at_.size());
    team.for_each(looked_at_.size(), [&](std::size_t k) {
      const std::size_t i = looked_at_[k];
      seen_[k] = see(points, tangles, pairs.pairs[i], pairs.points(i));
    });
    for (std::size_t k = 0; k < looked_at_.size(); ++k) {
      SeenPair& seen = seen_[k];
      if (seen.sight == Sight::far) continue;
      const std::size_t i = looked_at_[k];
      const Pair& pair = pairs.pairs[i];
      const Four four = pairs.points(i);
      settle(points, pair, four, seen);
      if (seen.sight == Sight::far) continue;
      const bool is_under = seen.sight == Sight::behind;
      near[list].add(pair, four, (is_under ? -1.0 : 1.0) * seen.look.normal,
                     points.thickness_of(pair), is_under);
    }
  }
}

/// Space for the names of pairs. Those of contacts that are no candidates any more go.
void NearSearch::give_names(const Candidates& candidates, NearContacts& layers) {
  layers.clear();
  if (layers.anew) names_ = 0;
  for (std::size_t list = kBodyLists; list < kPairLists; ++list) {
    Distances& d = distances_[list];
    if (layers.anew) d.contacts.clear();
    d.contacts.resize(d.near.size());
    d.names.resize(kLanes * d.near.size());
    for (std::size_t block = 0; block < d.contacts.size(); ++block) {
      const auto used =
          static_cast<std::uint16_t>(d.contacts[block] & candidates[list].used[block]);
      std::uint32_t gone = std::exchange(d.contacts[block], used) & ~std::uint32_t{used};
      for (; gone != 0; gone &= gone - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(gone));
        layers.gone.push_back(d.names[kLanes * block + lane]);
      }
    }
  }
}

void NearSearch::find_layers(ContactPoints& points, const Candidates& candidates,
                             const Tangles& tangles, NearContacts& layers) {
  give_names(candidates, layers);
  const double touching = 8 * static_cast<double>(points.rounding());
  for (std::size_t list = kBodyLists; list < kPairLists; ++list) {
    Distances& d = distances_[list];
    for (std::size_t block = 0; block < d.near.size(); ++block) {
      for (std::uint32_t bits = d.near[block]; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        const std::size_t i = block * kLanes + lane;
        const bool is_known = (d.contacts[block] >> lane & 1) != 0;
        const double distance =
            static_cast<double>(d.distance[block][lane] - travelled_ / simd::kSurelyApart);
        if (is_known && distance > touching) continue;
        const Pair& pair = candidates[list].pairs[i];
        const Four four = candidates[list].points(i);
        if (!is_known && !may_be_contact(points, tangles, pair, four)) continue;
        // Contacts find their normals themselves where features are apart.
        const Vector normal = distance > touching
                                  ? Vector{}
                                  : look(points.later(pair), pair, points.starts_of(four)).normal;
        if (is_known) {
          layers.touching.push_back({d.names[i], normal});
          continue;
        }
        d.contacts[block] = static_cast<std::uint16_t>(d.contacts[block] | 1u << lane);
        d.names[i] = names_++;
        layers.found.push_back({pair, four, normal, points.thickness_of(pair), distance});
      }
    }
  }
}

std::size_t NearSearch::bytes() const {
  std::size_t bytes = bytes_of(looked_at_) + bytes_of(seen_);
  for (const Distances& d : distances_)
    bytes += bytes_of(d.distance) + bytes_of(d.near) + bytes_of(d.awake) + bytes_of(d.contacts) +
             bytes_of(d.names);
  return bytes;
}

}  // namespace weft
