#include "tools/studies/hard/body_trial.h"

#include <weft/mesh.h>

#include <cmath>
#include <utility>

namespace weft::tools::hard {
namespace {

void add_square(int size, double width, Vec3 middle, MeshDescription& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const double cell = width / (size - 1);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j)
      mesh.positions.push_back(middle + Vec3{cell * i - width / 2, 0, cell * j - width / 2});
  }
  const auto n = static_cast<std::uint32_t>(size);
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t a = first + i * n + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + 1, a + n + 1, a + n});
      mesh.face_sizes.push_back(4);
    }
  }
}

}  // namespace

bool takes_bodies(const Method& method) {
  return method.solver == Solver::small_steps || label(method) == "auto";
}

SceneDescription cottons(int size, double width, const std::vector<Vec3>& middles) {
  MeshDescription mesh;
  for (const Vec3 middle : middles) add_square(size, width, middle, mesh);
  mesh.material = find_material("cotton").value();
  return std::move(cloth_from_mesh(mesh).value().scene);
}

SceneDescription cotton(int size, double width, Vec3 middle) {
  return cottons(size, width, {middle});
}

std::function<Pose(double)> stays(Vec3 at) {
  return [at](double) { return Pose{.position = at}; };
}

Rotation turned_about_z(double angle) { return {0, 0, std::sin(angle / 2), std::cos(angle / 2)}; }

Trial trial_of(const Setup& setup, SceneDescription scene, std::vector<TrialBody> bodies) {
  Trial trial{std::move(scene), setup.settings(kLaw)};
  trial.dt = 1.0 / 60;
  trial.bodies = std::move(bodies);
  return trial;
}

double energy_allowed(const Observed& o) { return 1e-3 * (o.most_kinetic + std::abs(o.body_work)); }

Outcome depth_outcome(const Observed& o) {
  Outcome result = strain_outcome(o, energy_allowed(o));
  result.figure = o.max_penetration;
  return result;
}

}  // namespace weft::tools::hard
