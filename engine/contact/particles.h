/// Particles of a cloth as contacts with meshes see them: in double, one by one, whatever solver
/// holds them.
#pragma once

#include <weft/scene.h>

#include <cstdint>

#include "kernels/vectors.h"

namespace weft {

struct ContactParticle {
  kernels::Vector start{};  // where the substep began
  kernels::Vector x{};      // where it is
  kernels::Vector v{};      // its velocity there
};

/// A surface where a particle touches it.
struct TouchedSurface {
  std::uint32_t body = kNoIndex;  // of the clock
  kernels::Vector velocity{};

  bool is_there() const { return body != kNoIndex; }
};

class ContactParticles {
 public:
  virtual ~ContactParticles() = default;
  virtual kernels::Vector position(std::uint32_t slot) const = 0;
  virtual kernels::Vector start(std::uint32_t slot) const = 0;
  virtual ContactParticle read(std::uint32_t slot) const = 0;
  /// A stop by contacts is no motion: it is predicted to be there.
  virtual void write(std::uint32_t slot, const ContactParticle& particle) = 0;
  /// It touches a body in this substep.
  virtual void touch(std::uint32_t slot, const TouchedSurface& surface) = 0;
  /// Whether it has touched one in this substep.
  virtual bool is_on_body(std::uint32_t slot) const = 0;
  /// It was moved after the end of the substep: from there it goes on at first order.
  virtual void stop(std::uint32_t slot, const TouchedSurface& surface) = 0;
  /// Its velocity has jumped by `by`: its past changes alike, so that two particles that act on
  /// each other keep their momentum.
  virtual void jump_velocity(std::uint32_t slot, kernels::Vector by) = 0;
  /// A push by other particles of the cloth: `by` is a motion, `comes_out` is none. A particle that
  /// begins under a body of a closed form is pushed no deeper into it, and no other ends in one.
  virtual void push(std::uint32_t slot, kernels::Vector by, kernels::Vector comes_out) = 0;
  /// Whether a body of a closed form may touch it.
  virtual bool is_beside_body(std::uint32_t slot) const = 0;
  /// Contacts have moved it to x: bodies of a closed form hold it, or it follows them.
  virtual void move_beside_bodies(std::uint32_t slot, kernels::Vector x) = 0;
  /// Moves it to x, as a force of the substep would.
  virtual void move_to(std::uint32_t slot, kernels::Vector x) = 0;
  /// Moves of a particle from now on, until the substep ends, make it no faster.
  virtual bool is_mended() const = 0;
  /// A change of velocity in this substep counts as so many times its momentum: 1 / b, since forces
  /// act in the part b of a substep alone (kernels/simd/small_steps.h).
  virtual double momentum_share() const = 0;
};

}  // namespace weft
