#include "engine/contact/contacts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/tuning.h"
#include "kernels/reference/contacts.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;

namespace {

constexpr double kAlone = -1;  // Contacts::moved_by_: no round moves it

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
  of_threads_.clear();
  colours_.clear();
  place_of_.clear();
  for (const std::uint32_t slot : points_) known_as_[slot] = Known::no;
  for (const std::uint32_t slot : beside_) known_as_[slot] = Known::no;
  points_.clear();
  beside_.clear();
  active_.clear();
  active_blocks_.clear();
  active_colours_.clear();
  is_begun_ = are_saved_ = false;
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

/// x: from the origin.
void Contacts::place(const ContactPoints& points, Vector x, std::uint32_t slot) {
  places_[4 * slot] = static_cast<float>(x.x);
  places_[4 * slot + 1] = static_cast<float>(x.y);
  places_[4 * slot + 2] = static_cast<float>(x.z);
  places_[4 * slot + 3] = static_cast<float>(points.inverse_mass(slot));
}

void Contacts::begin_substep(const ContactPoints& points, ContactParticles& particles, double h,
                             bool stands, Team& team) {
  if (empty()) return;
  const Vector origin = points.origin();
  double farthest = 0;
  for (const auto* slots : {&points_, &beside_}) {
    for (const std::uint32_t slot : *slots) {
      from_[slot] = stands ? particles.position(slot) : particles.start(slot);
      const Vector x = from_[slot] - origin;
      farthest = std::max({farthest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
      place(points, x, slot);
    }
  }
  for (const std::uint32_t slot : points_) {
    moves_[4 * slot + 3] = places_[4 * slot + 3];
    is_beside_body_[slot] = particles.is_beside_body(slot) ? 1 : 0;
  }
  if (is_begun_) std::ranges::fill(active_, kMayAllBeActive);
  const double bh = h / particles.momentum_share(), before = std::exchange(give_, bh * bh);
  const float warm = stands || before == 0 ? 0.f : static_cast<float>(give_ / before);
  const simd::ContactFreeze freeze{
      .blocks = blocks_.data(),
      .places = places_.data(),
      .rounding = 0x1p-20f * static_cast<float>(farthest),
      .warm = warm,
      .recovery = stands ? 1.f : static_cast<float>(tuning::kContactRecovery)};
  for (std::size_t c = 0, next = 0; c < colours_.size(); c = next) {  // all of a kind at once
    const bool are_edges = colours_[c].are_edges;
    while (next < colours_.size() && colours_[next].are_edges == are_edges) ++next;
    const std::size_t begin = colours_[c].first, end = colours_[next - 1].last;
    team.for_each_share(end - begin, [&](std::size_t first, std::size_t last) {
      kernels_.freeze(freeze, are_edges, begin + first, begin + last);
    });
  }
  offset_slack_of_threads();
  is_begun_ = true;
  are_saved_ = false;
  if (warm == 0) return;
  read_moves(particles);
  find_active(Active::push, team);
  if (active_blocks_.empty()) return;
  start_active();
  write_moves(particles);
}

/// The load of a thread may be a hundred times as heavy as the link that carries it. A contact
/// gives way by its slack times its load, anew in each substep, so such a link would sink in. Slack
/// of threads counts only the push beyond the warm start.
void Contacts::offset_slack_of_threads() {
  for (const std::uint32_t i : of_threads_) {
    simd::ContactBlock& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    block.gap[lane] -= block.slack[lane] * block.push[lane];
  }
}

void Contacts::start_active() {
  for (const Colour& colour : active_colours_)
    kernels_.start(solving(), active_blocks_.data() + colour.first, colour.last - colour.first);
}

void Contacts::read_moves(const ContactParticles& particles) {
  for (const std::uint32_t slot : points_) set_move(slot, particles.position(slot) - from_[slot]);
}

void Contacts::write_moves(ContactParticles& particles) {
  for (const std::uint32_t slot : points_) {
    if (weight(slot) > 0) particles.move_to(slot, from_[slot] + move(slot));
  }
}

/// Finds the contacts that push; for `touch` also those that are nearer than their targets. Only
/// blocks with a contact that was active before have one that pushes.
void Contacts::find_active(Active which, Team& team) {
  const bool pushing = which == Active::push;
  team.for_each_share(blocks_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t next = first; first < last; first = next) {
      const bool are_passed_over = pushing && active_[first] == 0;
      while (next < last && (pushing && active_[next] == 0) == are_passed_over) ++next;
      if (!are_passed_over) kernels_.find_active(solving(), pushing, active_.data(), first, next);
    }
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

/// From the last colour to the first: a visit undoes some of what those before it have done, and
/// what is nearest comes last.
void Contacts::visit_active(Team& team) {
  constexpr std::uint32_t kFewBlocks = 32;  // a thread alone is as fast
  const simd::ContactSolve solve = solving();
  for (std::size_t c = active_colours_.size(); c-- > 0;) {
    const Colour& colour = active_colours_[c];
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

/// Rounds leave alone what no active block moves and no body holds. Its place is rounded once, as
/// lanes round those of the others.
void Contacts::begin_rounds(ContactParticles& particles, Team& team) {
  if (particles.is_mended()) save_multipliers();
  read_moves(particles);
  find_active(Active::touch, team);
  for (const std::uint32_t slot : points_)
    moved_by_[slot] = is_beside_body_[slot] != 0 ? 0 : kAlone;
  if (active_blocks_.empty()) return;
  for (const std::uint32_t block : active_blocks_) {
    for (const auto& of : blocks_[block].point) {
      for (const std::uint32_t slot : of)
        if (slot < moved_by_.size()) moved_by_[slot] = 0;
    }
  }
  for (const std::uint32_t slot : points_) {
    if (moved_by_[slot] == 0 || !(weight(slot) > 0)) continue;
    const Vector x = particles.position(slot);
    particles.move_to(slot, from_[slot] + move(slot));
    const double by = length(particles.position(slot) - x);
    if (by > 0) moved_by_[slot] = by;
  }
}

/// Bodies of a closed form hold what contacts have moved.
void Contacts::round(ContactParticles& particles, Team& team) {
  if (active_blocks_.empty()) return;
  for (const std::uint32_t slot : points_)
    if (moved_by_[slot] != kAlone) set_move(slot, particles.position(slot) - from_[slot]);
  visit_active(team);
  for (const std::uint32_t slot : points_) {
    if (moved_by_[slot] == kAlone || !(weight(slot) > 0)) continue;
    const Vector x = particles.position(slot), to = from_[slot] + move(slot);
    if (is_beside_body_[slot] != 0)
      particles.move_beside_bodies(slot, to);
    else
      particles.move_to(slot, to);
    moved_by_[slot] += length(particles.position(slot) - x);
  }
}

void Contacts::save_multipliers() {
  if (std::exchange(are_saved_, true)) return;
  saved_.resize(keys_.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    saved_[i] = multiplier(i);
  }
}

void Contacts::restore_multipliers() {
  if (!std::exchange(are_saved_, false)) return;
  std::ranges::fill(active_, kMayAllBeActive);
  for (std::size_t i = 0; i < keys_.size(); ++i) set_multiplier(i, saved_[i]);
}

void Contacts::link_active() {
  for (const Link& link : links_) first_link_[link.slot] = kNoIndex;
  links_.clear();
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

bool Contacts::solve_at(ContactParticles& particles, std::uint32_t slot) {
  if (active_blocks_.empty() || known_as_[slot] != Known::of_contact) return false;
  if (particles.is_mended()) save_multipliers();
  if (!are_linked_) link_active();
  bool is_pushed = false;
  for (std::uint32_t i = first_link_[slot]; i != kNoIndex; i = links_[i].next)
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
    const std::uint32_t slot = block.point[k][lane];
    contact.weight[k] = double{block.weight[k][lane]};
    contact.inverse_mass[k] = weight(slot);
    x[k] = particles.position(slot) - from_[slot];
  }
  visits_ += tuning::kVisitsOfLook;
  const std::array<Vector, 4> before = x;
  contact.visit(x);
  if (x == before) return false;
  set_multiplier(i, {static_cast<float>(contact.push), static_cast<float>(contact.hold.x),
                     static_cast<float>(contact.hold.y), static_cast<float>(contact.hold.z),
                     block.before[lane]});
  // A thread has its second end twice, the later one without weight.
  for (std::size_t k = 4; k-- > 0;) {
    const std::uint32_t slot = block.point[k][lane];
    if (!(contact.inverse_mass[k] > 0)) continue;
    const Vector to = from_[slot] + x[k];
    if (is_beside_body_[slot] != 0)
      particles.move_beside_bodies(slot, to);
    else
      particles.move_to(slot, to);
  }
  return true;
}

/// The past of what contacts have pushed is changed as its velocity was: a contact acts at first
/// order. (BDF2 damps what multipliers that act again make of a stack 20 times less.)
void Contacts::end_substep(ContactParticles& particles, Team& team) {
  if (!std::exchange(is_begun_, false)) return;
  restore_multipliers();
  for (const std::uint32_t slot : points_) set_move(slot, {});
  find_active(Active::push, team);
  start_active();
  const double rate = 1 / std::sqrt(give_);
  for (const std::uint32_t slot : points_) {
    const Vector by = rate * move(slot);
    if (!(by == Vector{})) particles.jump_velocity(slot, by);
  }
}

int Contacts::count_touching() const {
  int count = 0;
  for (const simd::ContactBlock& block : blocks_)
    for (const float push : block.push) count += push > 0 ? 1 : 0;
  return count;
}

std::size_t Contacts::bytes() const {
  return bytes_of(blocks_) + bytes_of(keys_) + bytes_of(of_threads_) + bytes_of(colours_) +
         bytes_of(place_of_) + bytes_of(points_) + bytes_of(beside_) + bytes_of(known_as_) +
         bytes_of(from_) + bytes_of(places_) + bytes_of(moves_) + bytes_of(moved_by_) +
         bytes_of(is_beside_body_) + bytes_of(first_link_) + bytes_of(active_) +
         bytes_of(active_blocks_) + bytes_of(active_colours_) + bytes_of(links_) + memory_.bytes() +
         known_.bytes() + bytes_of(saved_) + bytes_of(known_at_) + bytes_of(bins_) +
         bytes_of(order_) + bytes_of(taken_) + bytes_of(waiting_) + bytes_of(by_colour_) +
         bytes_of(colour_of_);
}

}  // namespace weft
