#include <cmath>
#include <span>

#include "engine/model/validate.h"
#include "engine/validation.h"

namespace weft {
namespace {

/// So that places of particles, padding and all, have 32 bits, and so have places in lists of who
/// is whose neighbour.
constexpr std::size_t kMostParticles = std::size_t{1} << 28;

Result<void> validate_index_list(const FieldName& field, std::span<const std::uint32_t> list,
                                 std::size_t particles) {
  std::vector<bool> seen(particles);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (auto r = validate_particle(field.at(i), list[i], particles); !r) return r;
    if (seen[list[i]]) {
      return refuse(field.at(i), "particle is listed twice", std::to_string(list[i]));
    }
    seen[list[i]] = true;
  }
  return {};
}

Result<void> validate_contacts(const SceneDescription& d) {
  if (d.spheres.empty() && d.radii.empty()) return {};
  if (d.spheres.empty()) {
    return refuse("radii", "given without spheres, nothing would collide",
                  std::to_string(d.radii.size()));
  }
  if (auto r = validate_size("radii", d.radii.size(), d.positions.size()); !r) return r;
  for (std::size_t i = 0; i < d.radii.size(); ++i) {
    if (!std::isfinite(d.radii[i]) || d.radii[i] < 0) {
      return refuse(element("radii", i), "must be finite and at least 0", number(d.radii[i]));
    }
    if (d.radii[i] > kMostSquared) {
      return refuse(element("radii", i), "must be at most " + number(kMostSquared),
                    number(d.radii[i]));
    }
  }
  if (auto r = validate_index_list("spheres", d.spheres, d.positions.size()); !r) return r;
  for (std::size_t i = 0; i < d.spheres.size(); ++i) {
    if (d.radii[d.spheres[i]] <= 0) {
      return refuse(element("radii", d.spheres[i]), "a sphere needs a radius greater than 0",
                    number(d.radii[d.spheres[i]]));
    }
  }
  return {};
}

}  // namespace

Result<void> validate_size(std::string_view field, std::size_t size, std::size_t expected) {
  if (size == expected) return {};
  return refuse(field, "needs " + std::to_string(expected) + " elements", std::to_string(size));
}

Result<void> validate_floats(std::string_view field, const FloatVectors& floats,
                             std::size_t expected) {
  const std::size_t stride = floats.stride, size = floats.floats.size();
  if (stride < 3) return refuse(field, "needs a stride of 3 at least", std::to_string(stride));
  // Whole strides, and a part of one that holds a vector. No sum here can overflow.
  const std::size_t vectors = size / stride + (size % stride >= 3);
  if (vectors == expected) return {};
  return refuse(field,
                "needs " + std::to_string(expected) + " vectors of stride " +
                    std::to_string(stride) + ", and is of the floats",
                std::to_string(size));
}

Result<void> validate_origin(Vec3 origin) {
  if (finite(origin)) return {};
  return refuse("origin", "must be finite", text(origin));
}

Result<void> validate_vector(std::string_view field, std::size_t index, Vec3 vector) {
  if (finite(vector)) return {};
  return refuse(element(field, index), "must be finite", text(vector));
}

Result<void> validate_vectors(std::string_view field, std::span<const Vec3> vectors,
                              std::size_t particles) {
  if (auto r = validate_size(field, vectors.size(), particles); !r) return r;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (auto r = validate_vector(field, i, vectors[i]); !r) return r;
  }
  return {};
}

Result<void> validate_gravity(Vec3 gravity) {
  if (finite(gravity)) return {};
  return refuse("gravity", "must be finite", text(gravity));
}

Result<void> validate_motion(const RigidMotion& motion, double share) {
  for (const auto& [field, vector] :
       {std::pair{"motion.translation", motion.translation},
        std::pair{"motion.rotation", motion.rotation}, std::pair{"motion.about", motion.about}}) {
    if (!finite(vector)) return refuse(field, "must be finite", text(vector));
  }
  if (share >= 0 && share <= 1) return {};
  return refuse("share", "must be from 0 to 1", number(share));
}

Result<void> validate_time_step(double dt) {
  if (auto r = validate_positive("dt", dt); !r) return r;
  if (!std::isfinite(1 / dt)) return refuse("dt", "is too small to be inverted", number(dt));
  return {};
}

Result<void> validate(const SceneDescription& d) {
  const std::size_t particles = d.positions.size();
  if (particles == 0) return refuse("positions", "a scene needs at least one particle", "0");
  if (particles > kMostParticles) {
    return refuse("positions", "at most " + std::to_string(kMostParticles),
                  std::to_string(particles));
  }
  if (auto r = validate_vectors("positions", d.positions, particles); !r) return r;
  if (!d.velocities.empty()) {
    if (auto r = validate_vectors("velocities", d.velocities, particles); !r) return r;
  }
  if (auto r = validate_size("masses", d.masses.size(), particles); !r) return r;
  const FieldName masses("masses");
  for (std::size_t i = 0; i < particles; ++i) {
    if (auto r = validate_number(Values::squared, masses.at(i), d.masses[i]); !r) return r;
  }
  if (auto r = validate_index_list("fixed", d.fixed, particles); !r) return r;
  if (auto r = validate_elements(d); !r) return r;
  if (auto r = validate_material(d); !r) return r;
  return validate_contacts(d);
}

}  // namespace weft
