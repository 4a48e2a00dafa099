/// Particles beside bodies, one by one: each is held against all bodies in every substep.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/bodies/body_clock.h"
#include "engine/contact/interval.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/body_report.h"

namespace weft {

class ReferenceBodies {
 public:
  ReferenceBodies(const Model& model, const simd::Table& table)
      : model_(model), meshes_(model, table, shares_) {}

  using Touching = std::vector<bool>;  // per slot

  bool empty() const { return clock_.bodies().empty() && meshes_.empty(); }
  /// before: particles that touched a body when the last frame ended; empty: that is not known.
  /// misplaced: likewise, by meshes; start: whether it is to be found anew.
  void begin(std::span<const TravellingBody> bodies, double h, int substeps, bool stands,
             const Touching& before, ContactStart start, const Misplaced& misplaced,
             const ContactMemory* contacts);
  /// part: of h, by the scheme.
  void advance(double part, ContactParticles& particles, Team& team);
  bool has_meshes() const { return !meshes_.empty(); }
  double take_visits() { return meshes_.take_visits(); }
  SurfaceContacts& meshes() { return meshes_; }
  const SurfaceContacts& meshes() const { return meshes_; }
  void remember(ContactMemory& memory) { meshes_.remember(memory); }
  void end_substep(ContactParticles& particles, Team& team) {
    meshes_.end_substep(particles, team);
  }
  /// Whether a body of a closed form may touch it in this substep.
  bool is_beside(std::uint32_t slot, kernels::Vector start, kernels::Vector x) const {
    return clear_of(slot, start, x) < meshes_.largest_thickness();
  }
  const BodyClock& clock() const { return clock_; }
  /// Finds what may touch, where positions are put right and bodies stand.
  void find_standing(ContactParticles& particles, Team& team);
  /// After the particles were held one by one, by meshes. moved(slot, by): by how much (m).
  template <class Moved>
  void hold_by_meshes(ContactParticles& particles, Team& team, Moved&& moved) {
    meshes_.sweep(particles, clock_, team, moved);
  }
  /// Before the next substep, or after the last. Returns whether particles had to be moved.
  bool end_interval(ContactParticles& particles, Team& team) {
    return meshes_.end_interval(particles, clock_, team);
  }
  /// As ContactParticles::momentum_share().
  double momentum_share() const { return momentum_share_; }
  /// m, by which one particle, and its start, may be moved before it can touch one.
  double clear_of(std::uint32_t slot, kernels::Vector start, kernels::Vector x) const;
  /// Moves a particle in a substep; v is settled. Returns the surface
  /// that it touches, the last of several, if there is one.
  TouchedSurface hold(std::uint32_t slot, ContactParticle& particle);
  /// The same of one that contacts within the cloth have moved (reference::follow).
  TouchedSurface follow(std::uint32_t slot, ContactParticle& particle);
  /// A particle that began there is moved by `by`, without speed: no deeper into bodies.
  kernels::Vector kept_out(std::uint32_t slot, kernels::Vector start, kernels::Vector by) const;
  /// After that: whether it did not in this substep before, and not when the last one ended.
  bool begins_to_touch(std::uint32_t slot);
  /// Whether it has touched one in this substep.
  bool touches(std::uint32_t slot) const { return on_[slot]; }
  void load_of_mesh(const TouchedSurface& surface, kernels::Vector x, kernels::Vector impulse) {
    meshes_.load(surface, clock_, x, impulse);
  }
  /// The surface and the normal of the nearest body of a closed form beside the particle.
  std::pair<TouchedSurface, kernels::Vector> nearest_surface(std::uint32_t slot,
                                                             kernels::Vector x) const;
  /// impulse: as add_arrival (body_touches.h) has it.
  void arrive(const TouchedSurface& surface, kernels::Vector x, kernels::Vector v,
              kernels::Vector impulse);
  const Touching& touching() const { return on_; }
  double deepest(const kernels::Vectors& start, const kernels::Vectors& x,
                 ContactParticles& particles, Team& team);
  void sum(BodyReport& report) const;
  void read_contacts(const ContactParticles& particles, std::vector<BodyTouch>& contacts) const;

 private:
  template <class SolveBy, class Look>
  TouchedSurface solve_with(std::uint32_t slot, ContactParticle& particle, SolveBy&& solve_by,
                            Look&& look);
  void share_room(ContactParticles& particles);
  void share_among_forms(ContactParticles& particles, const Touching& touching, SubstepMoment when);
  /// m, of its distance from the particle: what there is to share when the substep ends. Beside a
  /// mesh that is not known, and is what there was when it began.
  double spared_by(std::size_t body, std::uint32_t slot) const;
  double radius(std::uint32_t slot) const { return model_.has_spheres() ? model_.radius[slot] : 0; }

  const Model& model_;
  BodyClock clock_;
  ThicknessShares shares_;       // beside meshes
  ThicknessShares among_forms_;  // of bodies of a closed form among themselves
  SurfaceContacts meshes_;
  double momentum_share_ = 1;
  std::vector<reference::ContactSums> contact_sums_;  // per slot and body
  Touching on_, before_;
  std::vector<BodyClearance> clearances_;  // scratch
  ContactImpulses impulses_;               // but for those that meshes have given
};

}  // namespace weft
