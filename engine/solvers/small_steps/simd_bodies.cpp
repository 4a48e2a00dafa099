#include "engine/solvers/small_steps/simd_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/solvers/small_steps/body_touches.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "engine/tuning.h"
#include "kernels/simd/fields.h"

namespace weft {

using kernels::kLanes;
using kernels::Vector;
using reference::BodyMotion;

void SimdBodies::make_room() {
  if (!layout_.blocks.empty()) return;
  layout_ = make_body_layout(model_, model_.small_steps().places(), far_);
  const std::size_t count = layout_.blocks.size();
  for (Touching* bits : {&on_, &before_, &held_, &arrived_}) bits->assign(count, 0);
}

void SimdBodies::begin(std::span<const TravellingBody> bodies, double h, int substeps, bool stands,
                       std::span<const std::uint16_t> before, ContactStart start,
                       const Misplaced& misplaced, const ContactMemory* contacts) {
  clock_.begin(bodies, h, substeps, stands);
  meshes_.begin(clock_, start, misplaced, contacts);
  pairs_.clear();
  first_pair_.clear();
  on_.clear();
  if (empty()) return;
  make_room();
  h_ = h;
  on_.assign(layout_.blocks.size(), 0);
  if (before.size() == on_.size()) std::ranges::copy(before, on_.begin());
  impulses_.begin(bodies);
  shares_.begin(model_.slots());
  among_forms_.begin(model_.slots());
}

void SimdBodies::advance(const simd::Flight& flight, const float* base, double part,
                         ContactParticles& particles, Team& team) {
  if (empty()) return;
  momentum_share_ = 1 / part;
  if (clock_.is_interval_over()) {
    clock_.begin_interval(meshes_.interval_for(particles, clock_));
    search(flight, base);
  }
  meshes_.predict(particles, clock_, team);
  clock_.advance();
  shares_.begin_substep();
  meshes_.advance(particles, clock_, team);
  write_frames();
  before_.swap(on_);
  std::ranges::fill(on_, std::uint16_t{0});
  for (simd::BodyContactSums& sums : contact_sums_) {
    for (float* lanes : {sums.pushed, sums.held, sums.stopped, sums.slowed, sums.came_out,
                         sums.thinned_by, sums.retreat})
      std::fill_n(lanes, kLanes, 0.f);
  }
  for (auto* bits : {&touching_, &moved_, &quick_}) std::ranges::fill(*bits, std::uint16_t{0});
  share_room(particles);
}

/// To particles that touched a body when the last substep ended. Thinnings of bodies of a closed
/// form to any particle are for lanes, too. Where it has its share no body pushes it: it touches
/// them all the same, and has its share in the next substep.
void SimdBodies::share_room(ContactParticles& particles) {
  share_among_forms(particles, before_, SubstepMoment::start);
  if (pairs_.empty()) return;
  for (const ThicknessShares* shares : {&shares_, &among_forms_}) {
    for (const ThicknessShares::Entry& entry : shares->entries()) {
      const std::uint32_t place = layout_.place_of[entry.slot];
      if (place == kNoIndex) continue;
      const std::size_t block = place / kLanes, lane = place % kLanes;
      for (std::size_t i = pairs_of_[block]; i < pairs_of_[block + 1]; ++i) {
        if (pairs_[i].body != entry.body) continue;
        on_[block] = static_cast<std::uint16_t>(on_[block] | 1u << lane);
        if (!(static_cast<float>(entry.thinning.by) > contact_sums_[i].thinned_by[lane])) continue;
        contact_sums_[i].thinned_by[lane] = static_cast<float>(entry.thinning.by);
        contact_sums_[i].retreat[lane] = static_cast<float>(entry.thinning.retreat);
      }
    }
  }
}

void SimdBodies::share_among_forms(ContactParticles& particles, const Touching& touching,
                                   SubstepMoment when) {
  among_forms_.begin_substep();
  for (std::size_t active = 0; active + 1 < first_pair_.size(); ++active) {
    const std::size_t first = first_pair_[active], last = first_pair_[active + 1];
    if (last - first < 2) continue;
    const std::uint32_t block = pairs_[first].block;
    for (std::uint32_t bits = touching[block]; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      const std::uint32_t slot = layout_.slot_at[block * kLanes + lane];
      const auto radius = static_cast<double>(layout_.blocks[block].radius[lane]);
      const Vector x =
          when == SubstepMoment::start ? particles.start(slot) : particles.position(slot);
      clearances_.clear();
      for (std::size_t i = first; i < last; ++i)
        clearances_.push_back(clearance_of(clock_, pairs_[i].body, x, radius, when));
      among_forms_.share(clearances_, clock_.dt_substep(), slot);
    }
  }
}

/// They move by any way: nobody knows how far.
void SimdBodies::find_standing(ContactParticles& particles, Team& team) {
  if (!clock_.stands()) return;
  meshes_.predict(particles, clock_, team);
  meshes_.advance(particles, clock_, team);
}

simd::BodySolve SimdBodies::solve_data_of(const simd::Flight& flight, const float* base,
                                          float rate) const {
  return {.flight = flight,
          .base = base,
          .blocks = layout_.blocks.data(),
          .pairs = pairs_.data(),
          .frames = frames_.data(),
          .woven = model_.small_steps().places().woven(),
          .rate = rate,
          .momentum_share = static_cast<float>(momentum_share_),
          .h = static_cast<float>(clock_.dt_substep())};
}

void SimdBodies::hold(const simd::Flight& flight, const float* base, float rate, Team& team) {
  if (pairs_.empty()) return;
  simd::BodySolve hold = solve_data_of(flight, base, rate);
  hold.sums = contact_sums_.data();
  std::vector<std::uint16_t>& now = now_;
  now.assign(pairs_.size(), 0);
  hold.touching = now.data();
  hold.moved = moved_.data();
  hold.quick = quick_.data();
  team.for_each_share(first_pair_.size() - 1, [&](std::size_t first, std::size_t last) {
    table_.solve_body_contacts(hold, first_pair_[first], first_pair_[last]);
  });
  std::ranges::fill(held_, std::uint16_t{0});
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::size_t block = pairs_[i].block;
    touching_[i] = static_cast<std::uint16_t>(touching_[i] | now[i]);
    held_[block] = static_cast<std::uint16_t>(held_[block] | now[i]);
  }
  for (std::size_t active = 0; active + 1 < first_pair_.size(); ++active) {
    const std::size_t block = pairs_[first_pair_[active]].block;
    const std::uint32_t known = on_[block] | std::uint32_t{before_[block]};
    arrived_[block] = static_cast<std::uint16_t>(held_[block] & ~known);
    on_[block] = static_cast<std::uint16_t>(on_[block] | held_[block]);
  }
}

double SimdBodies::clear_of(std::uint32_t slot, Vector start, Vector x) const {
  const std::uint32_t place = layout_.place_of[slot];
  double clear = std::numeric_limits<double>::infinity();
  if (place == kNoIndex || pairs_.empty()) return clear;
  const std::size_t block = place / kLanes;
  const auto radius = static_cast<double>(layout_.blocks[block].radius[place % kLanes]);
  for (std::size_t i = pairs_of_[block]; i < pairs_of_[block + 1]; ++i)
    clear =
        std::min(clear, reference::clear_of(clock_.motions()[pairs_[i].body], start, x, radius));
  return clear;
}

template <class SolveBy, class Look>
TouchedSurface SimdBodies::solve_with(std::uint32_t slot, ContactParticle& particle,
                                      SolveBy&& solve_by, Look&& look) {
  const std::uint32_t place = layout_.place_of[slot];
  TouchedSurface surface;
  if (place == kNoIndex || pairs_.empty()) return surface;
  const std::size_t block = place / kLanes, lane = place % kLanes;
  for (std::size_t i = pairs_of_[block]; i < pairs_of_[block + 1]; ++i) {
    const BodyMotion& body = clock_.motions()[pairs_[i].body];
    const auto radius = static_cast<double>(layout_.blocks[block].radius[lane]);
    const reference::Touch touch = look(body, particle.start, particle.x, radius);
    if (!touch.is_near) continue;
    reference::ContactSums sums = simd::sums_at(contact_sums_[i], lane);
    const reference::ContactResult result =
        solve_by(body, touch, particle.start, particle.x, particle.v, radius, sums);
    if (!result.is_touching) continue;
    simd::put_sums(contact_sums_[i], lane, sums, body, result, particle.v,
                   model_.mass[slot] * momentum_share_);
    const auto bit = static_cast<std::uint16_t>(1u << lane);
    touching_[i] = static_cast<std::uint16_t>(touching_[i] | bit);
    particle = {result.start, result.x, result.v};
    surface = {pairs_[i].body, body.velocity_at(result.x)};
  }
  return surface;
}

TouchedSurface SimdBodies::hold(std::uint32_t slot, ContactParticle& particle) {
  return solve_with(slot, particle, reference::solve_contact, reference::find_touch);
}
TouchedSurface SimdBodies::follow(std::uint32_t slot, ContactParticle& particle) {
  return solve_with(slot, particle, reference::follow, reference::find_touch_or_gap);
}

Vector SimdBodies::kept_out(std::uint32_t slot, Vector start, Vector by) const {
  const std::uint32_t place = layout_.place_of[slot];
  if (place == kNoIndex || pairs_.empty()) return by;
  const std::size_t block = place / kLanes;
  const auto radius = static_cast<double>(layout_.blocks[block].radius[place % kLanes]);
  for (std::size_t i = pairs_of_[block]; i < pairs_of_[block + 1]; ++i)
    by = reference::kept_out(clock_.motions()[pairs_[i].body], start, by, radius);
  return by;
}

TouchedSurface SimdBodies::touched_by(std::uint32_t slot, Vector x) const {
  const std::uint32_t place = layout_.place_of[slot];
  const std::size_t block = place / kLanes, lane = place % kLanes;
  std::size_t i = pairs_of_[block];
  while ((touching_[i] >> lane & 1) == 0) ++i;
  return {pairs_[i].body, clock_.motions()[pairs_[i].body].velocity_at(x)};
}

std::pair<TouchedSurface, Vector> SimdBodies::nearest_surface(std::uint32_t slot, Vector x) const {
  const std::uint32_t place = layout_.place_of[slot];
  NearestForm nearest;
  if (place == kNoIndex || pairs_.empty()) return nearest.surface(clock_, x);
  const std::size_t block = place / kLanes;
  for (std::size_t i = pairs_of_[block]; i < pairs_of_[block + 1]; ++i)
    nearest.consider(clock_, pairs_[i].body, x);
  return nearest.surface(clock_, x);
}

void SimdBodies::arrive(const TouchedSurface& surface, Vector x, Vector v, Vector impulse) {
  add_arrival(impulses_, clock_, surface, x, v, impulse);
}

bool SimdBodies::begins_to_touch(std::uint32_t slot) {
  const std::uint32_t place = layout_.place_of[slot];
  const std::size_t block = place / kLanes;
  const auto bit = static_cast<std::uint16_t>(1u << place % kLanes);
  const bool begins = ((on_[block] | before_[block]) & bit) == 0;
  on_[block] = static_cast<std::uint16_t>(on_[block] | bit);
  return begins;
}

std::array<float, kLanes> SimdBodies::spared_by(std::size_t block, std::uint32_t body) const {
  std::array<float, kLanes> spared{};
  if (!shares_.any() && !among_forms_.any()) return spared;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t slot = layout_.slot_at[block * kLanes + lane];
    if (slot == kNoIndex) continue;
    const double most =
        clock_.motions()[body].thickness + static_cast<double>(layout_.blocks[block].radius[lane]);
    const double thinned = std::max(shares_.of(slot, body).by, among_forms_.of(slot, body).by);
    spared[lane] = static_cast<float>(std::min(most, thinned));
  }
  return spared;
}

double SimdBodies::deepest(const simd::Flight& flight, const float* base,
                           ContactParticles& particles, Team& team) {
  double deepest = meshes_.deepest(particles, clock_, team);
  share_among_forms(particles, on_, SubstepMoment::end);
  simd::BodySolve hold = solve_data_of(flight, base, 0);
  std::array<simd::BodyPair, 64> pairs;
  std::array<std::array<float, kLanes>, 64> spared;
  hold.pairs = pairs.data();
  hold.spared = spared[0].data();
  std::size_t count = 0;
  const auto measure = [&] {
    const float depth = table_.deepest_in_bodies(hold, 0, std::exchange(count, 0));
    deepest = std::max(deepest, static_cast<double>(depth));
  };
  boxes_.clear();
  for (std::size_t body = 0; body < clock_.bodies().size(); ++body)
    boxes_.push_back(clock_.box(body, 0));
  for (std::uint32_t block = 0; block < layout_.blocks.size(); ++block) {
    const Extent extent = extent_of(block, 1, flight, base);
    for (std::uint32_t body = 0; body < boxes_.size(); ++body) {
      if (!may_touch(extent, body, boxes_[body], 0)) continue;
      if (count == pairs.size()) measure();
      spared[count] = spared_by(block, body);
      pairs[count++] = {block, body};
    }
  }
  measure();
  return deepest;
}

void SimdBodies::read_contacts(const ContactParticles& particles,
                               std::vector<BodyTouch>& contacts) const {
  for_each_contact([&](std::uint32_t slot, std::size_t body, double push) {
    contacts.push_back(touch_of(clock_, body, slot, particles.position(slot), push));
  });
  meshes_.read_touching(particles, clock_, contacts);
}

void SimdBodies::collect_impulses() {
  const auto take = [](simd::LaneVectors& lanes) {
    Vector sum{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sum = sum + Vector{static_cast<double>(lanes.x[lane]), static_cast<double>(lanes.y[lane]),
                         static_cast<double>(lanes.z[lane])};
    }
    lanes = {};
    return sum;
  };
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    simd::BodyContactSums& sums = contact_sums_[i];
    const BodyMotion& motion = clock_.motions()[pairs_[i].body];
    const Vector linear = take(sums.linear), angular = take(sums.angular);
    BodyImpulse& sum = impulses_.of_body[pairs_[i].body];
    sum.linear = sum.linear + linear;
    sum.angular = sum.angular + angular;
    impulses_.work += dot(linear, motion.velocity) + dot(angular, motion.spin);
    for (float& lost : sums.friction)
      impulses_.friction += 0.5 * static_cast<double>(std::exchange(lost, 0.f));
  }
}

void SimdBodies::sum(BodyReport& report) {
  report.clear();
  if (empty()) return;
  collect_impulses();
  for (const BodyImpulse& body : impulses_.of_body) report.impulses.push_back({.id = body.id});
  add(impulses_, clock_, report);
  add_report(meshes_, clock_, report);
  for (const std::uint16_t bits : touching_) report.contacts += std::popcount(bits);
}

std::size_t SimdBodies::bytes() const {
  return clock_.bytes() + meshes_.bytes() + layout_.bytes() + bytes_of(frames_) + bytes_of(faces_) +
         bytes_of(pairs_) + bytes_of(first_pair_) + bytes_of(pairs_of_) + bytes_of(contact_sums_) +
         bytes_of(touching_) + bytes_of(moved_) + bytes_of(quick_) + bytes_of(on_) +
         bytes_of(before_) + bytes_of(held_) + bytes_of(arrived_) + bytes_of(impulses_.of_body) +
         bytes_of(boxes_) + bytes_of(extents_) + bytes_of(now_) + bytes_of(clearances_) +
         shares_.bytes() + among_forms_.bytes();
}

}  // namespace weft
