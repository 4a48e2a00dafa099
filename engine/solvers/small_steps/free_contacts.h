/// Contacts of particles with bodies that move by themselves, in double, one after the other.
///
/// A contact is that of kernels/reference/bodies.h between two masses. With n the normal out of the
/// body, w the inverse mass of the particle, and W(d) that of the body at the point along d,
///
///     W(d) = 1 / M + (r x d) . I^-1 (r x d),    r from its centre of mass to the particle,
///
/// a push P (kg m) moves the particle by w P n, and the body by -P n / M and -I^-1 (r x n) P; a
/// stop J (kg m/s) changes velocities alike. P corrects the gap, and J the speed into the body, by
/// Gauss-Seidel over all contacts, whose normals and points are frozen during a sweep. Both are
/// sums over the substep that stay at or above 0, and bound the friction: friction of positions is
/// bounded by the part of P that is no recovery. A depth from the beginning of the substep is
/// removed without speed: the starts of both are moved.
///
/// A particle that rests on a body that the caller moves is supported by it: a push moves the
/// particle only along that surface. It is pushed into the surface all the same, and that body
/// pushes it back, so that body carries the push. If a later sweep reduces a push, the particle
/// stays on its support, which then carries less.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/bodies/body_mass.h"
#include "engine/contact/particles.h"
#include "kernels/reference/bodies.h"

namespace weft {

/// A body in a substep.
struct FreeBodyNow {
  double inverse_mass = 0;  // 0: it stands
  SymmetricTensor inverse_inertia{};
  kernels::Vector centre{};      // of mass
  reference::BodyMotion motion;  // its velocity: of the centre of mass
  double dt_substep = 0;         // s, also while it stands
  // What contacts have done to it in a sweep.
  kernels::Vector moved{}, turned{}, recovered{}, turned_back{};  // m, rad; of these without speed
  kernels::Vector faster{}, gained{};                             // m/s; kg m^2/s

  /// 1/kg, at a point so far from the centre.
  double give(kernels::Vector r, kernels::Vector along) const {
    const kernels::Vector arm = cross(r, along);
    return inverse_mass + dot(arm, inverse_inertia * arm);
  }
  kernels::Vector way_at(kernels::Vector r) const { return moved + cross(turned, r); }
  kernels::Vector change_at(kernels::Vector r) const {
    return faster + cross(inverse_inertia * gained, r);
  }
};

/// Where a particle of a radius touches a body. One that slides along a face of a hull is beside
/// that face, although its way leads through another one: under a glass that stands on cloth each
/// particle comes in by the side, at the height of the bottom. So a shallow depth counts where the
/// particle is, and a deep one where it came in.
reference::Touch touch_of_free(const reference::BodyMotion& body, kernels::Vector start,
                               kernels::Vector x, double radius);

/// The contact of a particle with a body, in a substep.
struct FreeContact {
  std::uint32_t slot = 0, body = 0;
  bool touched_before = false;  // when the last substep ended
  bool touches = false;
  double push = 0, stop = 0;           // kg m; kg m/s
  double came_out = 0;                 // m
  kernels::Vector hold{}, slow{};      // kg m; kg m/s
  kernels::Vector normal{}, slides{};  // slides: m, what is left of its way along the surface

  void begin_substep() { *this = {.slot = slot, .body = body, .touched_before = touches}; }
};

/// The store of the particles, as the sweep sees it.
class FreeContactHost {
 public:
  virtual ~FreeContactHost() = default;
  virtual ContactParticles& particles() = 0;
  /// The normal of the surface under a particle that rests on a body that the caller moves; else 0.
  virtual kernels::Vector support(std::uint32_t slot, kernels::Vector x) = 0;
  /// The support bears less: by what makes the particle so much slower (m/s).
  virtual void relieve(std::uint32_t slot, kernels::Vector x, kernels::Vector slower) = 0;
  /// The particle was moved by contacts.
  virtual void moved(std::uint32_t slot, kernels::Vector by) = 0;
  virtual double inverse_mass(std::uint32_t slot) const = 0;
  virtual double radius(std::uint32_t slot) const = 0;
};

/// Momentum that a sweep has given to the cloth at a point.
struct FreeImpulse {
  std::uint32_t body = 0;
  kernels::Vector at{}, impulse{};  // m, kg m/s
};

class FreeContactSweep {
 public:
  /// contacts: by slots, then by bodies. share: of a particle's momentum, as SubstepFormula::share.
  void run(std::span<FreeContact> contacts, std::span<FreeBodyNow> bodies, FreeContactHost& host);
  std::span<const FreeImpulse> impulses() const { return impulses_; }
  std::size_t bytes() const;

 private:
  struct Particle {
    std::uint32_t slot = 0;
    ContactParticle at{};
    double inverse_mass = 0;
    kernels::Vector support{};
    kernels::Vector moved{}, pushed{};    // m: as far as it gives way, and by all pushes
    kernels::Vector faster{}, stopped{};  // m/s, likewise
    kernels::Vector recovered{};          // m
  };
  struct Row {
    FreeContact* contact = nullptr;
    std::size_t particle = 0;
    kernels::Vector r{}, slip{}, velocity{};
    kernels::Vector support{};  // of the particle, where the contact presses it there; else 0
    double gap = 0, target = 0, approach = 0;
    double give = 0;  // 1/kg, along the normal
    double push = 0, stop = 0;
    kernels::Vector hold{}, slow{};
  };
  kernels::Vector give(const Row& row, kernels::Vector impulse) const;
  bool add(FreeContact& contact, const FreeBodyNow& body, FreeContactHost& host);
  double visit(Row& row, std::span<FreeBodyNow> bodies);
  void push(Row& row, FreeBodyNow& body, kernels::Vector impulse);
  void stop(Row& row, FreeBodyNow& body, kernels::Vector impulse);
  void end(Row& row, std::span<FreeBodyNow> bodies);
  void write(const Particle& particle, FreeContactHost& host) const;

  std::vector<Particle> particles_;
  std::vector<Row> rows_;
  std::vector<FreeImpulse> impulses_;
};

}  // namespace weft
