/// Particles of a cloth as contacts with meshes see them: in double, one by one, whatever solver
/// holds them.
#pragma once

#include <cstdint>

#include "kernels/vectors.h"

namespace weft {

struct ContactParticle {
  kernels::Vector start{};  // where the substep began
  kernels::Vector x{};      // where it is
  kernels::Vector v{};      // its velocity there
};

class ContactParticles {
 public:
  virtual ~ContactParticles() = default;
  virtual kernels::Vector position(std::uint32_t slot) const = 0;
  virtual kernels::Vector start(std::uint32_t slot) const = 0;
  virtual ContactParticle read(std::uint32_t slot) const = 0;
  /// What has stopped it is no motion: it is predicted to be there.
  virtual void write(std::uint32_t slot, const ContactParticle& particle) = 0;
  /// It touches a body in this substep. Returns by how much a change of its velocity counts as
  /// momentum: that of a particle that stays in contact acts in a part of the substep alone.
  virtual double touch(std::uint32_t slot) = 0;
  /// It was put elsewhere when the substep was over: from there it goes on at first order.
  virtual void stop(std::uint32_t slot) = 0;
};

}  // namespace weft
