#include "engine/solvers/small_steps/free_contacts.h"

#include <algorithm>
#include <cmath>

#include "engine/bytes_of.h"
#include "engine/tuning.h"

namespace weft {
namespace {

using kernels::Vector;

Vector across(Vector normal, Vector v) { return v - dot(normal, v) * normal; }

Vector shortened(Vector v, double most) {
  const double l = length(v);
  return l > most ? (std::max(0.0, most) / l) * v : v;
}

}  // namespace

/// A particle that is pressed onto a support moves along it.
Vector FreeContactSweep::give(const Row& row, Vector impulse) const {
  const double inverse_mass = particles_[row.particle].inverse_mass;
  return inverse_mass * (impulse - dot(row.support, impulse) * row.support);
}

reference::Touch touch_of_free(const reference::BodyMotion& body, Vector start, Vector x,
                               double radius) {
  const reference::Touch touch = find_touch(body, start, x, radius);
  const reference::Gap gap = gap_of(*body.form, body.thickness + radius, body.to.from_place(x));
  const bool is_shallow = gap.gap < 0 && gap.gap > -body.thickness;
  if (touch.is_near && !is_shallow) return touch;
  return {true, body.to.turned(gap.normal), gap.gap};
}

bool FreeContactSweep::add(FreeContact& contact, const FreeBodyNow& body, FreeContactHost& host) {
  const bool is_same = !particles_.empty() && particles_.back().slot == contact.slot;
  const reference::BodyMotion& motion = body.motion;
  const ContactParticle at = is_same ? particles_.back().at : host.particles().read(contact.slot);
  const reference::Touch touch = touch_of_free(motion, at.start, at.x, host.radius(contact.slot));
  if (touch.gap > 0 && contact.push == 0 && contact.stop == 0) return false;
  if (!is_same) {
    particles_.push_back({.slot = contact.slot,
                          .at = at,
                          .inverse_mass = host.inverse_mass(contact.slot),
                          .support = host.support(contact.slot, at.x)});
  }
  Row row{.contact = &contact, .particle = particles_.size() - 1};
  contact.normal = touch.normal;
  row.r = at.x - body.centre;
  row.gap = touch.gap;
  row.slip = slip_of(motion, at.start, at.x);
  row.velocity = at.v - (motion.velocity + cross(motion.spin, row.r));
  row.approach = -dot(touch.normal, row.slip);
  const double began = row.gap + row.approach - contact.came_out;
  const double recovers =
      motion.h * std::min(reference::kFastestRecovery,
                          reference::kRecovery - began / reference::kRecoveryTime);
  row.target = std::min(0.0, began < 0 ? began + recovers : 0.0);
  const Vector support = particles_.back().support;
  if (dot(support, touch.normal) < 0) row.support = support;
  row.give = dot(touch.normal, give(row, touch.normal)) + body.give(row.r, touch.normal);
  row.push = contact.push;
  row.stop = contact.stop;
  row.hold = contact.hold;
  row.slow = contact.slow;
  if (row.give > 0) rows_.push_back(row);
  return true;
}

void FreeContactSweep::push(Row& row, FreeBodyNow& body, Vector impulse) {
  Particle& particle = particles_[row.particle];
  particle.moved = particle.moved + give(row, impulse);
  particle.pushed = particle.pushed + particle.inverse_mass * impulse;
  body.moved = body.moved - body.inverse_mass * impulse;
  body.turned = body.turned - body.inverse_inertia * cross(row.r, impulse);
}

void FreeContactSweep::stop(Row& row, FreeBodyNow& body, Vector impulse) {
  Particle& particle = particles_[row.particle];
  particle.faster = particle.faster + give(row, impulse);
  particle.stopped = particle.stopped + particle.inverse_mass * impulse;
  body.faster = body.faster - body.inverse_mass * impulse;
  body.gained = body.gained - cross(row.r, impulse);
}

/// Returns how far it has changed what is missing, m.
double FreeContactSweep::visit(Row& row, std::span<FreeBodyNow> bodies) {
  FreeBodyNow& body = bodies[row.contact->body];
  const Particle& particle = particles_[row.particle];
  const Vector n = row.contact->normal;
  const double friction = body.motion.friction;
  const auto way = [&] { return particle.moved - body.way_at(row.r); };
  const auto change = [&] { return particle.faster - body.change_at(row.r); };

  const double missing = row.target - row.gap - dot(n, way());
  const double to = std::max(0.0, row.push + missing / row.give);
  const double more = to - row.push;
  row.push = to;
  push(row, body, more * n);
  double changed = row.give * std::abs(more);

  const double speed = dot(n, row.velocity + change());
  const double stops = row.push > 0 ? -speed / row.give : std::min(0.0, -speed / row.give);
  const double stop_to = std::max(0.0, row.stop + stops);
  stop(row, body, (stop_to - row.stop) * n);
  changed += body.dt_substep * row.give * std::abs(stop_to - row.stop);
  row.stop = stop_to;

  if (friction == 0) return changed;
  const double most = std::max(0.0, row.approach) / row.give + row.contact->push;
  const auto rub = [&](Vector slip, double bound, Vector& sum) {
    const Vector along = across(n, slip);
    const double l = length(along);
    const Vector d = l > 0 ? (1 / l) * along : Vector{};
    const double give = l > 0 ? dot(d, this->give(row, d)) + body.give(row.r, d) : 0;
    const Vector wanted = give > 0 ? across(n, sum) - (1 / give) * along : across(n, sum);
    const Vector next = shortened(wanted, bound), by = next - sum;
    sum = next;
    changed += give * length(by);
    return by;
  };
  push(row, body, rub(row.slip + way(), friction * std::min(row.push, most), row.hold));
  const double before = changed;
  stop(row, body, rub(row.velocity + change(), friction * row.stop, row.slow));
  return before + body.dt_substep * (changed - before);
}

/// Shares its push between what the substep has made and what recovers.
void FreeContactSweep::end(Row& row, std::span<FreeBodyNow> bodies) {
  FreeContact& contact = *row.contact;
  FreeBodyNow& body = bodies[contact.body];
  Particle& particle = particles_[row.particle];
  const Vector n = contact.normal;
  const double pushed = row.give * (row.push - contact.push);
  const double out = std::max(0.0, pushed - std::max(0.0, row.approach));
  const double recovers = out / row.give;
  contact.came_out += out;
  particle.recovered = particle.recovered + give(row, recovers * n);
  body.recovered = body.recovered - (recovers * body.inverse_mass) * n;
  body.turned_back = body.turned_back - body.inverse_inertia * cross(row.r, recovers * n);
  const Vector impulse = (row.stop - contact.stop) * n + (row.slow - contact.slow);
  if (dot(impulse, impulse) > 0)
    impulses_.push_back({contact.body, particle.at.x + particle.moved, impulse});
  contact.push = std::max(0.0, row.push - recovers);
  contact.stop = row.stop;
  contact.hold = row.hold;
  contact.slow = row.slow;
  contact.slides = across(n, row.slip + particle.moved - body.way_at(row.r));
  contact.touches = contact.touches || row.push > 0;
}

void FreeContactSweep::run(std::span<FreeContact> contacts, std::span<FreeBodyNow> bodies,
                           FreeContactHost& host) {
  particles_.clear();
  rows_.clear();
  impulses_.clear();
  for (FreeBodyNow& body : bodies)
    body.moved = body.turned = body.recovered = body.turned_back = body.faster = body.gained = {};
  for (FreeContact& contact : contacts) add(contact, bodies[contact.body], host);
  double first = 0;
  for (int round = 0; round < tuning::kFreeRounds; ++round) {
    double most = 0;
    for (Row& row : rows_) most = std::max(most, visit(row, bodies));
    if (round == 0) first = most;
    if (most <= tuning::kFreeLeft * first) break;
  }
  for (Row& row : rows_) end(row, bodies);
  for (const Particle& particle : particles_) write(particle, host);
}

void FreeContactSweep::write(const Particle& particle, FreeContactHost& host) const {
  const bool is_moved =
      dot(particle.pushed, particle.pushed) > 0 || dot(particle.stopped, particle.stopped) > 0;
  if (!is_moved) return;
  const auto lifts = [&](Vector by, Vector gives_way) {
    return std::max(0.0, dot(particle.support, by - gives_way)) * particle.support;
  };
  const Vector pushed = particle.pushed - lifts(particle.pushed, particle.moved);
  const Vector relieved = lifts(particle.stopped, particle.faster);
  const ContactParticle& at = particle.at;
  host.particles().write(particle.slot, {at.start + particle.recovered, at.x + pushed,
                                         at.v + particle.stopped - relieved});
  if (dot(relieved, relieved) > 0) host.relieve(particle.slot, at.x, relieved);
  host.moved(particle.slot, pushed);
}

std::size_t FreeContactSweep::bytes() const {
  return bytes_of(particles_) + bytes_of(rows_) + bytes_of(impulses_);
}

}  // namespace weft
