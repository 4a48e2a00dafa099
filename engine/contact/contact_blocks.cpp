/// Near pairs become contacts in blocks of lanes, by colours, and keep their places for a frame.
#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "engine/contact/contacts.h"
#include "kernels/reference/contacts.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

constexpr std::uint64_t kNoKey = std::numeric_limits<std::uint64_t>::max();

bool is_edges(const NearContact& contact) { return contact.pair.kind == PairKind::edges; }

bool has_thread(const TriangleSurface& surface, const Pair& pair) {
  if (!surface.has_threads) return false;
  if (pair.kind == PairKind::edges)
    return surface.is_thread_edge(pair.first) || surface.is_thread_edge(pair.second);
  return surface.is_thread(pair.second) ||
         std::ranges::any_of(surface.triangles_at[pair.first],
                             [&](std::uint32_t t) { return surface.is_thread(t); });
}

/// Third corners of the faces beside the features (simd::ContactBlock::beside).
std::array<std::uint32_t, 4> beside(const TriangleSurface& surface, const NearContact& contact) {
  const auto& four = contact.points;
  if (is_edges(contact)) {
    const auto& of_first = surface.opposite[contact.pair.first];
    const auto& of_second = surface.opposite[contact.pair.second];
    std::array thirds{of_first[0], of_first[1], of_second[0], of_second[1]};
    for (std::size_t k = 0; k < 4; ++k)
      if (thirds[k] == kNoIndex) thirds[k] = four[k < 2 ? 0 : 2];
    return thirds;
  }
  const auto& triangle = surface.triangles[contact.pair.second];
  // Nothing leans over the ends of a thread.
  if (surface.is_thread(contact.pair.second)) return {four[3], four[3], four[3], four[3]};
  std::array<std::uint32_t, 4> thirds{four[3], four[1], four[2], four[1]};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t edge = surface.edges_of[contact.pair.second][k];
    if (edge == kNoIndex) continue;  // a point alone
    for (const std::uint32_t third : surface.opposite[edge]) {
      const bool is_own = third == triangle[0] || third == triangle[1] || third == triangle[2];
      if (third != kNoIndex && !is_own) thirds[k] = third;
    }
  }
  return thirds;
}

}  // namespace

/// From the blocks, or where there are none from what the last frame has left.
void Contacts::gather_known() {
  known_.begin();
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (keys_[i] == kNoKey) continue;
    const Multiplier m = are_saved_ ? saved_[i] : multiplier(i);
    if (m[0] > 0) known_.add(keys_[i], m);
  }
  for (std::size_t i = 0; i < memory_.keys.size(); ++i) {
    Multiplier m;
    std::copy_n(&memory_.multipliers[m.size() * i], m.size(), m.begin());
    known_.add(memory_.keys[i], m);
  }
}

/// Its multiplier is known to what is found now.
void Contacts::retire(std::size_t contact) {
  const Multiplier m = multiplier(contact);
  if (m[0] > 0) known_.add(keys_[contact], m);
  keys_[contact] = kNoKey;
  set_multiplier(contact, {});
  leave_free(contact / kLanes, contact % kLanes);
}

void Contacts::find(const ContactPoints& points, const NearContacts& near) {
  restore_multipliers();
  if (near.anew) {
    gather_known();
    clear();
  } else {
    known_.begin();
    for (const std::uint32_t name : near.gone) retire(place_of_[name]);
    for (const auto& [name, normal] : near.touching) set_normal(place_of_[name], normal);
  }
  known_.end();
  memory_.clear();  // pairs that are far have come apart
  if (near.found.empty()) return;
  find_known(near.found);
  const std::size_t edges = put_in_order(near.found);
  know_points(points, near.found);
  const std::size_t first = place_of_.size();
  place_of_.resize(first + near.found.size());
  colour(points, near.found, 0, edges, false);
  colour(points, near.found, edges, near.found.size(), true);
  active_.resize(blocks_.size(), kMayAllBeActive);  // their multipliers may push
  are_linked_ = false;
}

/// In a loop of its own: memory is waited for once for several of them.
void Contacts::find_known(std::span<const NearContact> near) {
  known_at_.clear();
  for (const NearContact& contact : near) known_at_.push_back(known_.find(contact.pair.key()));
}

/// The order of contacts: points beside triangles, then edges; of either kind what is nearest
/// first, so that blocks are all near or all far. Returns where edges begin.
std::size_t Contacts::put_in_order(std::span<const NearContact> near) {
  constexpr std::size_t kBins = 16;
  const auto bin_of = [](const NearContact& contact) {
    const double quarters = 4 * contact.distance;  // of thicknesses, which may be 0
    const bool is_far = !(quarters < (kBins - 1) * contact.thickness);
    const std::size_t bin =
        is_far ? kBins - 1 : static_cast<std::size_t>(quarters / contact.thickness);
    return (is_edges(contact) ? kBins : 0) + bin;
  };
  std::array<std::uint32_t, 2 * kBins + 1> first{};
  bins_.clear();
  for (const NearContact& contact : near) {
    bins_.push_back(static_cast<std::uint8_t>(bin_of(contact)));
    ++first[bins_.back() + 1u];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  const std::size_t edges = first[kBins];
  order_.resize(near.size());
  for (std::uint32_t i = 0; i < near.size(); ++i) order_[first[bins_[i]]++] = i;
  return edges;
}

void Contacts::know(std::uint32_t slot, Known as) {
  Known& known = known_as_[slot];
  if (known >= as) return;
  known = as;
  (as == Known::of_contact ? points_ : beside_).push_back(slot);
}

void Contacts::know_points(const ContactPoints& points, std::span<const NearContact> near) {
  const std::size_t slots = points.slots();
  known_as_.resize(slots);
  from_.resize(slots);
  places_.resize(4 * (slots + kLanes));
  moves_.resize(4 * (slots + kLanes));
  moved_by_.resize(slots);
  is_beside_body_.resize(slots);
  first_link_.resize(slots, kNoIndex);
  for (const std::uint32_t i : order_)
    for (const std::uint32_t slot : near[i].points) know(slot, Known::of_contact);
}

/// Colours contacts first ... last - 1 of the order. A colour is the lowest one that none of the
/// points has. A contact that finds none among 64 has one of the next 64.
void Contacts::colour(const ContactPoints& points, std::span<const NearContact> near,
                      std::size_t first_of_order, std::size_t last_of_order, bool are_edges) {
  waiting_.assign(order_.begin() + static_cast<std::ptrdiff_t>(first_of_order),
                  order_.begin() + static_cast<std::ptrdiff_t>(last_of_order));
  while (!waiting_.empty()) {
    taken_.assign(points.slots(), 0);
    colour_of_.clear();
    std::array<std::uint32_t, kColours + 2> first{};
    for (const std::uint32_t i : waiting_) {
      std::uint64_t taken = 0;
      for (const std::uint32_t slot : near[i].points) taken |= taken_[slot];
      const auto lowest = static_cast<std::uint8_t>(std::countr_one(taken));
      colour_of_.push_back(lowest);
      ++first[lowest + 1u];
      if (lowest == kColours) continue;
      for (const std::uint32_t slot : near[i].points) taken_[slot] |= std::uint64_t{1} << lowest;
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    by_colour_.resize(waiting_.size());
    std::array<std::uint32_t, kColours + 2> next = first;
    for (std::size_t k = 0; k < waiting_.size(); ++k)
      by_colour_[next[colour_of_[k]]++] = waiting_[k];
    for (std::size_t c = 0; c < kColours; ++c)
      put_blocks(points, near, std::span(by_colour_).subspan(first[c], first[c + 1] - first[c]),
                 are_edges);
    waiting_.assign(by_colour_.begin() + first[kColours], by_colour_.end());
  }
}

/// Puts blocks of one colour.
void Contacts::put_blocks(const ContactPoints& points, std::span<const NearContact> near,
                          std::span<const std::uint32_t> contacts, bool are_edges) {
  if (contacts.empty()) return;
  const std::size_t first = blocks_.size(), names = place_of_.size() - near.size();
  blocks_.resize(first + (contacts.size() + kLanes - 1) / kLanes);
  keys_.resize(kLanes * blocks_.size(), kNoKey);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const std::uint32_t i = contacts[k];
    const std::size_t at = kLanes * first + k;
    put(points, near[i], at / kLanes, at % kLanes);
    place_of_[names + i] = static_cast<std::uint32_t>(at);
    keys_[at] = near[i].pair.key();
    if (const Multiplier* known = known_at_[i]) set_multiplier(at, *known);
  }
  for (std::size_t lane = contacts.size() % kLanes; lane != 0 && lane < kLanes; ++lane)
    leave_free(blocks_.size() - 1, lane);
  colours_.push_back(
      {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(blocks_.size()), are_edges});
}

void Contacts::put(const ContactPoints& points, const NearContact& contact, std::size_t block,
                   std::size_t lane) {
  simd::ContactBlock& to = blocks_[block];
  const std::array<std::uint32_t, 4> thirds = beside(points.cloth(), contact);
  for (std::size_t k = 0; k < 4; ++k) {
    to.point[k][lane] = contact.points[k];
    to.beside[k][lane] = thirds[k];
    know(thirds[k], Known::beside);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_border = thirds[k] == contact.points[k == 0 ? 3 : k];
    to.towards[k][lane] = is_border ? -1.f : 1.f;
  }
  const bool is_of_thread = has_thread(points.cloth(), contact.pair);
  if (is_of_thread) of_threads_.push_back(static_cast<std::uint32_t>(kLanes * block + lane));
  // A thread that lies just over a corner of faces touches all edges there (OwnedFeatures).
  constexpr auto kOffEnds = static_cast<float>(reference::kLeastWithin);
  if (is_edges(contact)) to.towards[0][lane] = is_of_thread ? -kOffEnds : kOffEnds;
  to.thickness[lane] = static_cast<float>(contact.thickness);
  to.friction[lane] = static_cast<float>(points.later(contact.pair).friction);
  set_normal(kLanes * block + lane, contact.normal);
}

void Contacts::set_normal(std::size_t contact, Vector normal) {
  simd::LaneVectors& to = blocks_[contact / kLanes].normal;
  to.x[contact % kLanes] = static_cast<float>(normal.x);
  to.y[contact % kLanes] = static_cast<float>(normal.y);
  to.z[contact % kLanes] = static_cast<float>(normal.z);
}

/// Its points belong to no surface, and have no mass. Kernels know it by its thickness.
void Contacts::leave_free(std::size_t block, std::size_t lane) {
  const auto nobody = static_cast<std::uint32_t>(known_as_.size() + lane);
  for (std::size_t k = 0; k < 4; ++k)
    blocks_[block].point[k][lane] = blocks_[block].beside[k][lane] = nobody;
  blocks_[block].thickness[lane] = -1;
  blocks_[block].give[lane] = 0;
}

}  // namespace weft
