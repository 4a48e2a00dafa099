/// The particles of small steps, as contacts with bodies that move by themselves see them.
#pragma once

#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/free_contacts.h"
#include "engine/solvers/small_steps/point_particles.h"
#include "engine/solvers/small_steps/substep.h"

namespace weft {

/// Store: LaneStore, or ReferenceStore. far: m, per slot, as far as it may be moved without its
/// constraints being looked at.
template <class Store>
class FreeHost final : public FreeContactHost {
 public:
  FreeHost(Store& store, Substep& now, const std::vector<double>& far)
      : store_(store), now_(now), far_(far), points_(store.points(true)), particles_(points_) {}

  ContactParticles& particles() override { return particles_; }
  kernels::Vector support(std::uint32_t slot, kernels::Vector x) override {
    return surface_under(slot, x).second;
  }
  void relieve(std::uint32_t slot, kernels::Vector x, kernels::Vector slower) override {
    auto& bodies = store_.bodies();
    const TouchedSurface surface = surface_under(slot, x).first;
    const kernels::Vector impulse = (-bodies.momentum_share() * now_.model.mass[slot]) * slower;
    if (bodies.has_meshes() && bodies.meshes().touched_by(slot).first.is_there())
      bodies.load_of_mesh(surface, x, impulse);
    else
      bodies.arrive(surface, x, surface.velocity, impulse);
  }
  /// Limits of anchors and bodies that the caller moves hold it.
  void moved(std::uint32_t slot, kernels::Vector by) override {
    points_.move(slot, {});
    if (dot(by, by) > far_[slot] * far_[slot]) now_.passes.look_at(slot);
  }
  double inverse_mass(std::uint32_t slot) const override { return now_.model.inverse_mass[slot]; }
  double radius(std::uint32_t slot) const override {
    return now_.model.has_spheres() ? now_.model.radius[slot] : 0;
  }

 private:
  using Points = typename Store::Points;
  /// On which it rests, and its normal.
  std::pair<TouchedSurface, kernels::Vector> surface_under(std::uint32_t slot,
                                                           kernels::Vector x) const {
    const auto& bodies = store_.bodies();
    if (bodies.empty() || !now_.is_free(slot)) return {};
    if (bodies.has_meshes()) {
      const auto on_mesh = bodies.meshes().touched_by(slot);
      if (on_mesh.first.is_there()) return on_mesh;
    }
    return bodies.touches(slot) ? bodies.nearest_surface(slot, x)
                                : std::pair<TouchedSurface, kernels::Vector>{};
  }
  Store& store_;
  Substep& now_;
  const std::vector<double>& far_;
  const Points points_;
  PointParticles<Points> particles_;
};

}  // namespace weft
