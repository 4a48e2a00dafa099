/// What a state violates and keeps, recomputed from the description's own numbers: nothing here
/// asks the cloth what it thinks of itself.
#pragma once

#include <weft/weft.h>

#include <vector>

namespace weft::tools::hard {

std::vector<bool> fixed_particles(const SceneDescription& scene);

struct Snapshot {
  std::vector<Vec3> positions, velocities;
};
Snapshot snapshot(const Cloth& cloth);

bool all_finite(const Snapshot& state);
/// Largest | |a-b| - rest | / rest, a slack rope's being 0; without constraints between two fixed
/// particles.
/// Springs may be strained: they are left out here.
double max_rigid_strain(const SceneDescription& scene, const Snapshot& state);
/// The same with springs, and with warp and weft of triangles of fabric.
double max_strain(const SceneDescription& scene, const Snapshot& state);
/// m, the deepest overlap of a sphere with anything that it may touch.
double max_penetration(const SceneDescription& scene, const Snapshot& state);
/// Whether any particle went from one side of the sphere to the other between two states, through
/// its inner nine tenths: where it was outside of it both times.
bool went_through(const SceneDescription& scene, const Snapshot& before, const Snapshot& after,
                  std::uint32_t sphere);
/// J, kinetic and gravitational, of the particles that are not fixed.
double energy(const SceneDescription& scene, const Snapshot& state);
double kinetic_energy(const SceneDescription& scene, const Snapshot& state);
/// Of all particles; angular about `centre`.
Vec3 momentum(const SceneDescription& scene, const Snapshot& state);
Vec3 angular_momentum(const SceneDescription& scene, const Snapshot& state, Vec3 centre);

Vec3 operator+(Vec3 a, Vec3 b);
Vec3 operator-(Vec3 a, Vec3 b);
Vec3 operator*(double s, Vec3 v);
Vec3 cross(Vec3 a, Vec3 b);
double dot(Vec3 a, Vec3 b);
double length(Vec3 v);

}  // namespace weft::tools::hard
