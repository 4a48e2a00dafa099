#include "engine/solvers/small_steps/reference_bodies.h"

#include <algorithm>

#include "engine/solvers/small_steps/body_touches.h"

namespace weft {

using kernels::Vector;

void ReferenceBodies::begin(std::span<const TravellingBody> bodies, double h, int substeps,
                            bool stands, const Touching& before, ContactStart start,
                            const Misplaced& misplaced, const ContactMemory* contacts) {
  clock_.begin(bodies, h, substeps, stands);
  meshes_.begin(clock_, start, misplaced, contacts);
  on_.clear();
  if (empty()) return;
  on_.assign(model_.slots(), false);
  if (before.size() == on_.size()) on_ = before;
  impulses_.begin(bodies);
  shares_.begin(model_.slots());
  among_forms_.begin(model_.slots());
}

void ReferenceBodies::advance(double part, ContactParticles& particles, Team& team) {
  if (empty()) return;
  momentum_share_ = 1 / part;
  if (clock_.is_interval_over()) clock_.begin_interval(meshes_.interval_for(particles, clock_));
  meshes_.predict(particles, clock_, team);
  clock_.advance();
  shares_.begin_substep();
  meshes_.advance(particles, clock_, team);
  contact_sums_.assign(model_.slots() * clock_.bodies().size(), {});
  before_.swap(on_);
  on_.assign(model_.slots(), false);
  share_room(particles);
}

/// To particles that touched a body when the last substep ended. Where one has its share no body
/// pushes it: it touches them all the same.
void ReferenceBodies::share_room(ContactParticles& particles) {
  share_among_forms(particles, before_, SubstepMoment::start);
  for (const ThicknessShares* shares : {&shares_, &among_forms_}) {
    for (const ThicknessShares::Entry& entry : shares->entries()) {
      reference::Thinning& thinning =
          contact_sums_[entry.slot * clock_.bodies().size() + entry.body].thinning;
      if (entry.thinning.by > thinning.by) thinning = entry.thinning;
      if (clock_.bodies()[entry.body].mesh == nullptr) on_[entry.slot] = true;
    }
  }
}

void ReferenceBodies::share_among_forms(ContactParticles& particles, const Touching& touching,
                                        SubstepMoment when) {
  among_forms_.begin_substep();
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
    if (!touching[slot]) continue;
    const Vector x =
        when == SubstepMoment::start ? particles.start(slot) : particles.position(slot);
    clearances_.clear();
    for (std::size_t body = 0; body < clock_.bodies().size(); ++body) {
      if (clock_.bodies()[body].mesh == nullptr)
        clearances_.push_back(clearance_of(clock_, body, x, radius(slot), when));
    }
    among_forms_.share(clearances_, clock_.dt_substep(), slot);
  }
}

double ReferenceBodies::spared_by(std::size_t body, std::uint32_t slot) const {
  const auto id = static_cast<std::uint32_t>(body);
  const double thinned = std::max(shares_.of(slot, id).by, among_forms_.of(slot, id).by);
  return std::min(clock_.motions()[body].thickness + radius(slot), thinned);
}

/// They move by any way: nobody knows how far.
void ReferenceBodies::find_standing(ContactParticles& particles, Team& team) {
  if (!clock_.stands()) return;
  meshes_.predict(particles, clock_, team);
  meshes_.advance(particles, clock_, team);
}

double ReferenceBodies::clear_of(std::uint32_t slot, Vector start, Vector x) const {
  double clear = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < clock_.bodies().size(); ++i) {
    if (clock_.bodies()[i].mesh == nullptr)
      clear = std::min(clear, reference::clear_of(clock_.motions()[i], start, x, radius(slot)));
  }
  return clear;
}

template <class SolveBy, class Look>
TouchedSurface ReferenceBodies::solve_with(std::uint32_t slot, ContactParticle& at,
                                           SolveBy&& solve_by, Look&& look) {
  TouchedSurface surface;
  if (model_.inverse_mass[slot] == 0) return surface;
  for (std::size_t i = 0; i < clock_.bodies().size(); ++i) {
    if (clock_.bodies()[i].mesh != nullptr) continue;
    const reference::BodyMotion& body = clock_.motions()[i];
    reference::ContactSums& sums = contact_sums_[slot * clock_.bodies().size() + i];
    const reference::Touch touch = look(body, at.start, at.x, radius(slot));
    const reference::ContactResult result =
        solve_by(body, touch, at.start, at.x, at.v, radius(slot), sums);
    if (!result.is_touching) continue;
    surface = {static_cast<std::uint32_t>(i), body.velocity_at(result.x)};
    const double momentum = model_.mass[slot] * momentum_share_;
    impulses_.add(i, body.to.centre, result.x, momentum * (result.v - at.v), surface.velocity);
    impulses_.friction += 0.5 * momentum * result.friction;
    at = {result.start, result.x, result.v};
  }
  return surface;
}

TouchedSurface ReferenceBodies::hold(std::uint32_t slot, ContactParticle& at) {
  return solve_with(slot, at, reference::solve_contact, reference::find_touch);
}
TouchedSurface ReferenceBodies::follow(std::uint32_t slot, ContactParticle& at) {
  return solve_with(slot, at, reference::follow, reference::find_touch_or_gap);
}

Vector ReferenceBodies::kept_out(std::uint32_t slot, Vector start, Vector by) const {
  for (std::size_t i = 0; i < clock_.bodies().size(); ++i) {
    if (clock_.bodies()[i].mesh == nullptr)
      by = reference::kept_out(clock_.motions()[i], start, by, radius(slot));
  }
  return by;
}

std::pair<TouchedSurface, Vector> ReferenceBodies::nearest_surface(std::uint32_t, Vector x) const {
  NearestForm nearest;
  for (std::uint32_t body = 0; body < clock_.bodies().size(); ++body) {
    if (clock_.bodies()[body].mesh == nullptr) nearest.consider(clock_, body, x);
  }
  return nearest.surface(clock_, x);
}

void ReferenceBodies::arrive(const TouchedSurface& surface, Vector x, Vector v, Vector impulse) {
  add_arrival(impulses_, clock_, surface, x, v, impulse);
}

bool ReferenceBodies::begins_to_touch(std::uint32_t slot) {
  const bool begins = !on_[slot] && !before_[slot];
  on_[slot] = true;
  return begins;
}

double ReferenceBodies::deepest(const kernels::Vectors& start, const kernels::Vectors& x,
                                ContactParticles& particles, Team& team) {
  double deepest = meshes_.deepest(particles, clock_, team);
  if (clock_.bodies().size() > 1) share_among_forms(particles, on_, SubstepMoment::end);
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
    if (model_.inverse_mass[slot] == 0) continue;
    for (std::size_t i = 0; i < clock_.bodies().size(); ++i) {
      if (clock_.bodies()[i].mesh != nullptr) continue;
      const reference::BodyMotion& body = clock_.motions()[i];
      const double depth = depth_of(body, start[slot], x[slot], radius(slot));
      if (depth > 0) deepest = std::max(deepest, depth - spared_by(i, slot));
    }
  }
  return deepest;
}

void ReferenceBodies::sum(BodyReport& report) const {
  report.clear();
  if (empty()) return;
  for (const BodyImpulse& body : impulses_.of_body) report.impulses.push_back({.id = body.id});
  add(impulses_, clock_, report);
  report.contacts = static_cast<int>(std::ranges::count_if(
      contact_sums_, [](const reference::ContactSums& sums) { return sums.pushed > 0; }));
  add_report(meshes_, clock_, report);
}

void ReferenceBodies::read_contacts(const ContactParticles& particles,
                                    std::vector<BodyTouch>& contacts) const {
  const std::size_t count = clock_.bodies().size();
  for (std::size_t i = 0; i < contact_sums_.size(); ++i) {
    if (!(contact_sums_[i].pushed > 0)) continue;
    const auto slot = static_cast<std::uint32_t>(i / count);
    contacts.push_back(
        touch_of(clock_, i % count, slot, particles.position(slot), contact_sums_[i].pushed));
  }
  meshes_.read_touching(particles, clock_, contacts);
}

}  // namespace weft
