#include "engine/contact/contacts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/tuning.h"
#include "kernels/reference/contacts.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

constexpr std::uint64_t kNoKey = std::numeric_limits<std::uint64_t>::max();

bool is_edges(const NearContact& contact) { return contact.pair.kind == PairKind::edges; }

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
  std::array<std::uint32_t, 4> thirds{four[3], four[1], four[2], four[1]};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t edge = surface.edges_of[contact.pair.second][k];
    for (const std::uint32_t third : surface.opposite[edge]) {
      const bool is_own = third == triangle[0] || third == triangle[1] || third == triangle[2];
      if (third != kNoIndex && !is_own) thirds[k] = third;
    }
  }
  return thirds;
}

}  // namespace

void Contacts::begin(const ContactMemory* memory) {
  memory_.clear();
  if (memory != nullptr) memory_ = *memory;
  give_ = memory_.give;
  clear();
}

void Contacts::clear() {
  blocks_.clear();
  keys_.clear();
  colours_.clear();
  active_blocks_.clear();
  active_colours_.clear();
  is_begun_ = is_aside_ = false;
}

Multiplier Contacts::multiplier(std::size_t contact) const {
  const simd::ContactBlock& block = blocks_[contact / kLanes];
  const std::size_t lane = contact % kLanes;
  return {block.push[lane], block.hold.x[lane], block.hold.y[lane], block.hold.z[lane],
          block.before[lane]};
}

void Contacts::set_multiplier(std::size_t contact, const Multiplier& to) {
  simd::ContactBlock& block = blocks_[contact / kLanes];
  const std::size_t lane = contact % kLanes;
  block.push[lane] = to[0];
  block.hold.x[lane] = to[1];
  block.hold.y[lane] = to[2];
  block.hold.z[lane] = to[3];
  block.before[lane] = to[4];
}

void Contacts::remember(ContactMemory& memory) {
  if (blocks_.empty()) {
    memory = memory_;
    return;
  }
  memory.clear();
  memory.give = give_;
  gather_known();
  std::ranges::sort(known_.all(), {}, &KnownMultipliers::Known::key);
  for (const auto& [key, m] : known_.all()) {
    memory.keys.push_back(key);
    memory.multipliers.insert(memory.multipliers.end(), m.begin(), m.end());
  }
}

/// From the blocks, or where there are none from what the last frame has left.
void Contacts::gather_known() {
  known_.begin();
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (keys_[i] == kNoKey) continue;
    const Multiplier m = is_aside_ ? aside_[i] : multiplier(i);
    if (m[0] > 0) known_.add(keys_[i], m);
  }
  for (std::size_t i = 0; i < memory_.keys.size(); ++i) {
    Multiplier m;
    std::copy_n(&memory_.multipliers[m.size() * i], m.size(), m.begin());
    known_.add(memory_.keys[i], m);
  }
}

void Contacts::number_points(const ContactPoints& points, std::span<NearContact> near) {
  for (const std::uint32_t point : points_) number_of_[point] = kNoIndex;
  points_.clear();
  const auto add = [&](std::uint32_t point) {
    if (point >= number_of_.size()) number_of_.resize(point + 1, kNoIndex);
    if (number_of_[point] != kNoIndex) return;
    number_of_[point] = static_cast<std::uint32_t>(points_.size());
    points_.push_back(point);
  };
  for (const NearContact& contact : near)
    for (const std::uint32_t point : contact.points) add(point);
  moving_ = points_.size();
  for (NearContact& contact : near) {
    contact.beside = beside(points.cloth(), contact);
    for (const std::uint32_t point : contact.beside) add(point);
  }
  const std::size_t quads = points_.size() + kLanes;  // of lanes that are not used, too
  places_.assign(4 * quads, 0);
  moves_.assign(4 * (moving_ + kLanes), 0);
  from_.resize(points_.size());
  is_beside_body_.assign(moving_, 0);
}

/// Points beside triangles, then edges; of either kind what is nearest first, so that blocks are
/// all near or all far.
void Contacts::put_in_order(std::vector<NearContact>& near) {
  constexpr std::size_t kBins = 16;
  const auto bin_of = [](const NearContact& contact) {
    const double quarters = 4 * contact.distance;  // of thicknesses, which may be 0
    const bool is_far = !(quarters < (kBins - 1) * contact.thickness);
    const std::size_t bin =
        is_far ? kBins - 1 : static_cast<std::size_t>(quarters / contact.thickness);
    return (is_edges(contact) ? kBins : 0) + bin;
  };
  std::array<std::size_t, 2 * kBins + 1> first{};
  for (const NearContact& contact : near) ++first[bin_of(contact) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  in_order_.resize(near.size());
  for (const NearContact& contact : near) in_order_[first[bin_of(contact)]++] = contact;
  near.swap(in_order_);
}

void Contacts::find(const ContactPoints& points, std::vector<NearContact>& near) {
  gather_known();
  known_.end();
  memory_.clear();  // pairs that are far have come apart
  clear();
  put_in_order(near);
  number_points(points, near);
  const auto first_edges = std::ranges::partition_point(near, std::not_fn(is_edges));
  const auto points_count = static_cast<std::size_t>(first_edges - near.begin());
  colour(points, std::span(near).first(points_count));
  edges_from_ = blocks_.size();
  colour(points, std::span(near).subspan(points_count));
  active_.assign(blocks_.size(), 0);
  links_.clear();
  first_link_.assign(moving_, kNoIndex);
  are_linked_ = false;
}

/// A colour is the lowest one that none of the points has. A contact that finds none among 64 has
/// one of the next 64.
void Contacts::colour(const ContactPoints& points, std::span<const NearContact> near) {
  waiting_.resize(near.size());
  std::iota(waiting_.begin(), waiting_.end(), 0u);
  while (!waiting_.empty()) {
    taken_.assign(moving_, 0);
    colour_of_.clear();
    std::array<std::uint32_t, kColours + 2> first{};
    for (const std::uint32_t i : waiting_) {
      std::uint64_t taken = 0;
      for (const std::uint32_t point : near[i].points) taken |= taken_[number_of_[point]];
      const auto lowest = static_cast<std::uint8_t>(std::countr_one(taken));
      colour_of_.push_back(lowest);
      ++first[lowest + 1u];
      if (lowest == kColours) continue;
      for (const std::uint32_t point : near[i].points)
        taken_[number_of_[point]] |= std::uint64_t{1} << lowest;
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    by_colour_.resize(waiting_.size());
    std::array<std::uint32_t, kColours + 2> next = first;
    for (std::size_t k = 0; k < waiting_.size(); ++k)
      by_colour_[next[colour_of_[k]]++] = waiting_[k];
    for (std::size_t c = 0; c < kColours; ++c)
      put_blocks(points, near, std::span(by_colour_).subspan(first[c], first[c + 1] - first[c]));
    waiting_.assign(by_colour_.begin() + first[kColours], by_colour_.end());
  }
}

/// Of one colour.
void Contacts::put_blocks(const ContactPoints& points, std::span<const NearContact> near,
                          std::span<const std::uint32_t> contacts) {
  if (contacts.empty()) return;
  const auto first = static_cast<std::uint32_t>(blocks_.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (k % kLanes == 0) {
      blocks_.emplace_back();
      keys_.resize(kLanes * blocks_.size(), kNoKey);
    }
    put(points, near[contacts[k]], blocks_.size() - 1, k % kLanes);
  }
  for (std::size_t lane = contacts.size() % kLanes; lane != 0 && lane < kLanes; ++lane) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto nobody = static_cast<std::uint32_t>(moving_ + lane);
      blocks_.back().point[k][lane] = blocks_.back().beside[k][lane] = nobody;
    }
  }
  colours_.push_back({first, static_cast<std::uint32_t>(blocks_.size())});
}

void Contacts::put(const ContactPoints& points, const NearContact& contact, std::size_t block,
                   std::size_t lane) {
  simd::ContactBlock& to = blocks_[block];
  for (std::size_t k = 0; k < 4; ++k) {
    to.point[k][lane] = number_of_[contact.points[k]];
    to.beside[k][lane] = number_of_[contact.beside[k]];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_border = contact.beside[k] == contact.points[k == 0 ? 3 : k];
    to.towards[k][lane] = is_border ? -1.f : 1.f;
  }
  to.thickness[lane] = static_cast<float>(contact.thickness);
  to.friction[lane] = static_cast<float>(points.later(contact.pair).friction);
  to.normal.x[lane] = static_cast<float>(contact.normal.x);
  to.normal.y[lane] = static_cast<float>(contact.normal.y);
  to.normal.z[lane] = static_cast<float>(contact.normal.z);
  const std::uint64_t key = contact.pair.key();
  keys_[kLanes * block + lane] = key;
  if (const Multiplier* known = known_.find(key)) set_multiplier(kLanes * block + lane, *known);
}

void Contacts::begin_substep(const ContactPoints& points, ContactParticles& particles, double h,
                             bool stands, Team& team) {
  if (empty()) return;
  const Vector origin = points.origin();
  double farthest = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::uint32_t slot = points_[i];
    from_[i] = stands ? particles.position(slot) : particles.start(slot);
    const Vector x = from_[i] - origin;
    farthest = std::max({farthest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    places_[4 * i] = static_cast<float>(x.x);
    places_[4 * i + 1] = static_cast<float>(x.y);
    places_[4 * i + 2] = static_cast<float>(x.z);
    places_[4 * i + 3] = static_cast<float>(points.inverse_mass(slot));
    if (i >= moving_) continue;
    moves_[4 * i + 3] = places_[4 * i + 3];
    is_beside_body_[i] = particles.is_beside_body(slot) ? 1 : 0;
  }
  const double bh = h / particles.momentum_share(), before = std::exchange(give_, bh * bh);
  const float warm = stands || before == 0 ? 0.f : static_cast<float>(give_ / before);
  const simd::ContactFreeze freeze{
      .blocks = blocks_.data(),
      .places = places_.data(),
      .rounding = 0x1p-20f * static_cast<float>(farthest),
      .warm = warm,
      .recovery = stands ? 1.f : static_cast<float>(tuning::kContactRecovery)};
  team.for_each_share(edges_from_, [&](std::size_t first, std::size_t last) {
    kernels_.freeze(freeze, false, first, last);
  });
  team.for_each_share(blocks_.size() - edges_from_, [&](std::size_t first, std::size_t last) {
    kernels_.freeze(freeze, true, edges_from_ + first, edges_from_ + last);
  });
  is_begun_ = true;
  is_aside_ = false;
  if (warm == 0) return;
  read_moves(particles);
  find_active(Active::push, team);
  if (active_blocks_.empty()) return;
  start_active();
  write_moves(particles);
}

void Contacts::start_active() {
  for (const Colour& colour : active_colours_)
    kernels_.start(solving(), active_blocks_.data() + colour.first, colour.last - colour.first);
}

void Contacts::read_moves(const ContactParticles& particles) {
  for (std::size_t i = 0; i < moving_; ++i) set_move(i, particles.position(points_[i]) - from_[i]);
}

void Contacts::write_moves(ContactParticles& particles) {
  for (std::size_t i = 0; i < moving_; ++i) {
    if (moves_[4 * i + 3] > 0) particles.move_to(points_[i], from_[i] + move(i));
  }
}

/// Finds the contacts that push; for `touch` also those that are nearer than their targets.
void Contacts::find_active(Active which, Team& team) {
  team.for_each_share(blocks_.size(), [&](std::size_t first, std::size_t last) {
    kernels_.find_active(solving(), which == Active::push, active_.data(), first, last);
  });
  active_blocks_.clear();
  active_colours_.clear();
  active_count_ = 0;
  are_linked_ = false;
  for (const std::uint16_t bits : active_) active_count_ += std::popcount(bits);
  for (const Colour& colour : colours_) {
    const auto begin = static_cast<std::uint32_t>(active_blocks_.size());
    for (std::uint32_t block = colour.first; block < colour.last; ++block)
      if (active_[block] != 0) active_blocks_.push_back(block);
    const auto end = static_cast<std::uint32_t>(active_blocks_.size());
    if (end > begin) active_colours_.push_back({begin, end});
  }
}

void Contacts::visit_active(Team& team) {
  constexpr std::uint32_t kFewBlocks = 32;  // a thread alone is as fast
  const simd::ContactSolve solve = solving();
  for (const Colour& colour : active_colours_) {
    const std::uint32_t* blocks = active_blocks_.data() + colour.first;
    const std::uint32_t count = colour.last - colour.first;
    if (count < kFewBlocks) {
      kernels_.visit(solve, blocks, count);
    } else {
      team.for_each_share(count, [&](std::size_t first, std::size_t last) {
        kernels_.visit(solve, blocks + first, last - first);
      });
    }
  }
  visits_ += tuning::kVisitsOfLook * active_count_;
}

void Contacts::begin_rounds(ContactParticles& particles, Team& team) {
  if (particles.is_mended()) set_aside();
  read_moves(particles);
  moved_by_.assign(moving_, 0);
  find_active(Active::touch, team);
}

/// Bodies of a closed form hold what contacts have moved.
void Contacts::round(ContactParticles& particles, Team& team) {
  if (active_blocks_.empty()) return;
  read_moves(particles);
  visit_active(team);
  for (std::size_t i = 0; i < moving_; ++i) {
    if (!(moves_[4 * i + 3] > 0)) continue;
    const std::uint32_t slot = points_[i];
    const Vector x = particles.position(slot), to = from_[i] + move(i);
    if (is_beside_body_[i] != 0)
      particles.move_beside_bodies(slot, to);
    else
      particles.move_to(slot, to);
    moved_by_[i] += length(particles.position(slot) - x);
  }
}

void Contacts::set_aside() {
  if (std::exchange(is_aside_, true)) return;
  aside_.resize(keys_.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    aside_[i] = multiplier(i);
  }
}

void Contacts::link_active() {
  for (const Link& link : links_) first_link_[link.point] = kNoIndex;
  links_.clear();
  first_link_.resize(moving_, kNoIndex);
  for (const std::uint32_t block : active_blocks_) {
    for (std::uint32_t bits = active_[block]; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      const auto contact = static_cast<std::uint32_t>(kLanes * block + lane);
      for (const auto& of : blocks_[block].point) {
        links_.push_back({of[lane], contact, first_link_[of[lane]]});
        first_link_[of[lane]] = static_cast<std::uint32_t>(links_.size() - 1);
      }
    }
  }
  are_linked_ = true;
}

bool Contacts::hold(ContactParticles& particles, std::uint32_t slot) {
  if (active_blocks_.empty() || slot >= number_of_.size()) return false;
  const std::uint32_t number = number_of_[slot];
  if (number >= moving_) return false;
  if (particles.is_mended()) set_aside();
  if (!are_linked_) link_active();
  bool is_pushed = false;
  for (std::uint32_t i = first_link_[number]; i != kNoIndex; i = links_[i].next)
    is_pushed = visit(particles, links_[i].contact) || is_pushed;
  return is_pushed;
}

/// By itself, in double.
bool Contacts::visit(ContactParticles& particles, std::size_t i) {
  simd::ContactBlock& block = blocks_[i / kLanes];
  const std::size_t lane = i % kLanes;
  const auto vector = [lane](const simd::LaneVectors& of) {
    return Vector{double{of.x[lane]}, double{of.y[lane]}, double{of.z[lane]}};
  };
  reference::Contact contact{.normal = vector(block.normal),
                             .gap = double{block.gap[lane]},
                             .slack = double{block.slack[lane]},
                             .give = double{block.give[lane]},
                             .friction = double{block.friction[lane]},
                             .push = double{block.push[lane]},
                             .hold = vector(block.hold)};
  std::array<Vector, 4> x;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t number = block.point[k][lane];
    contact.weight[k] = double{block.weight[k][lane]};
    contact.inverse_mass[k] = double{moves_[4 * number + 3]};
    x[k] = particles.position(points_[number]) - from_[number];
  }
  visits_ += tuning::kVisitsOfLook;
  const std::array<Vector, 4> before = x;
  contact.visit(x);
  if (x == before) return false;
  set_multiplier(i, {static_cast<float>(contact.push), static_cast<float>(contact.hold.x),
                     static_cast<float>(contact.hold.y), static_cast<float>(contact.hold.z),
                     block.before[lane]});
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t number = block.point[k][lane];
    if (!(contact.inverse_mass[k] > 0)) continue;
    const Vector to = from_[number] + x[k];
    if (is_beside_body_[number] != 0)
      particles.move_beside_bodies(points_[number], to);
    else
      particles.move_to(points_[number], to);
  }
  return true;
}

/// The past of what contacts have pushed is changed as its velocity was: a contact acts at first
/// order. (BDF2 damps what multipliers that act again make of a stack 20 times less.)
void Contacts::end_substep(ContactParticles& particles, Team& team) {
  if (!std::exchange(is_begun_, false)) return;
  if (std::exchange(is_aside_, false)) {
    for (std::size_t i = 0; i < keys_.size(); ++i) set_multiplier(i, aside_[i]);
  }
  for (std::size_t i = 0; i < 4 * moving_; ++i) {
    if (i % 4 != 3) moves_[i] = 0;
  }
  find_active(Active::push, team);
  start_active();
  const double rate = 1 / std::sqrt(give_);
  for (std::size_t i = 0; i < moving_; ++i) {
    const Vector by = rate * move(i);
    if (!(by == Vector{})) particles.jolt(points_[i], by);
  }
}

int Contacts::count_touching() const {
  int count = 0;
  for (const simd::ContactBlock& block : blocks_)
    for (const float push : block.push) count += push > 0 ? 1 : 0;
  return count;
}

std::size_t Contacts::bytes() const {
  return bytes_of(blocks_) + bytes_of(keys_) + bytes_of(colours_) + bytes_of(points_) +
         bytes_of(number_of_) + bytes_of(from_) + bytes_of(places_) + bytes_of(moves_) +
         bytes_of(moved_by_) + bytes_of(is_beside_body_) + bytes_of(active_) +
         bytes_of(active_blocks_) + bytes_of(active_colours_) + memory_.bytes() + bytes_of(aside_) +
         bytes_of(taken_) + bytes_of(waiting_) + bytes_of(links_) + bytes_of(first_link_) +
         bytes_of(in_order_) + bytes_of(colour_of_) + bytes_of(by_colour_) + known_.bytes();
}

}  // namespace weft
