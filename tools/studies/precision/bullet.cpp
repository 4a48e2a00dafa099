#include "tools/studies/precision/bullet.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "tools/program/measure/cpu_time.h"
#include "tools/program/text/wording.h"
#include "tools/studies/precision/meter.h"

namespace weft::tools::precision {
namespace {

btVector3 to_bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}

Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// No air, and no bound on how far a node may move in a step.
void fill_in(btSoftBodyWorldInfo& world, const Vec3& gravity) {
  world.m_gravity = to_bullet(gravity);
  world.air_density = 0;
  world.water_density = 0;
  world.m_maxDisplacement = 1e6;
  world.m_sparsesdf.Initialize();
}

/// The scene as a soft body: the same particles, pins, edges and rest lengths.
class SoftBody {
 public:
  SoftBody(const SceneDescription& scene, int iterations)
      : body_(&world_, static_cast<int>(scene.positions.size()), places(scene).data(),
              masses(scene).data()) {
    fill_in(world_, scene.gravity);
    configure(iterations);
    for (const Constraint& c : scene.constraints) {
      body_.appendLink(static_cast<int>(c.a), static_cast<int>(c.b));
      auto& link = body_.m_links[body_.m_links.size() - 1];
      link.m_rl = static_cast<btScalar>(c.rest_length);
      link.m_c1 = link.m_rl * link.m_rl;
    }
    // Links that share no node follow each other: the result stays as it is, and a pass takes half
    // of the time. (Random order: the same time, twice the strain.)
    btSoftBodyHelpers::ReoptimizeLinkOrder(&body_);
  }

  void step(double dt) {
    body_.predictMotion(static_cast<btScalar>(dt));
    body_.solveConstraints();
  }

  void read(std::vector<Vec3>& positions, std::vector<Vec3>& velocities) const {
    positions.clear();
    velocities.clear();
    for (int i = 0; i < body_.m_nodes.size(); ++i) {
      positions.push_back(from_bullet(body_.m_nodes[i].m_x));
      velocities.push_back(from_bullet(body_.m_nodes[i].m_v));
    }
  }

 private:
  /// Full stiffness, no damping or drag, no collisions. The collision margin has no part in the
  /// motion, and a wide one spares Bullet from rebuilding its tree of nodes in every step: of the
  /// settings tried here it is the cheapest by far. Iterations on velocities (viterations) cost
  /// more than they gain, those on drift (diterations) cost and do what position iterations do.
  void configure(int iterations) {
    body_.m_materials[0]->m_kLST = 1;
    body_.m_materials[0]->m_flags = 0;
    auto& config = body_.m_cfg;
    config.kVCF = 1;
    config.kDP = config.kDG = config.kLF = config.kPR = config.kVC = 0;
    config.collisions = 0;
    config.piterations = iterations;
    config.viterations = config.diterations = config.citerations = 0;
    config.m_psequence.clear();
    config.m_psequence.push_back(btSoftBody::ePSolver::Linear);
    body_.setSelfCollision(false);
    body_.getCollisionShape()->setMargin(1);
  }

  static std::vector<btVector3> places(const SceneDescription& scene) {
    std::vector<btVector3> places;
    for (const Vec3& position : scene.positions) places.push_back(to_bullet(position));
    return places;
  }

  static std::vector<btScalar> masses(const SceneDescription& scene) {
    std::vector<btScalar> masses(scene.masses.begin(), scene.masses.end());
    for (const std::uint32_t fixed : scene.fixed) masses[fixed] = 0;  // Bullet's way to pin
    return masses;
  }

  btSoftBodyWorldInfo world_;
  btSoftBody body_;
};

Outcome run_once(const Task& task, const Knobs& knobs, double seconds_limit) {
  SoftBody body(task.description, knobs.iterations);
  Meter meter(task);
  std::vector<Vec3> positions, velocities;
  std::string status = "fixed_iterations";
  for (int frame = 0; frame < task.frames && status == "fixed_iterations"; ++frame) {
    const double start = cpu_seconds();
    for (int k = 0; k < knobs.substeps; ++k) body.step(kFrame / knobs.substeps);
    const double elapsed = cpu_seconds() - start;
    body.read(positions, velocities);
    if (!meter.add_frame(positions, velocities, elapsed)) status = "non_finite";
    if (meter.seconds() > seconds_limit) status = "out_of_time";
  }
  Outcome outcome = meter.outcome();
  outcome.status = status;
  return outcome;
}

Outcome best_of(const Task& task, const Knobs& knobs, const Effort& effort) {
  Outcome best = run_once(task, knobs, effort.seconds_limit);
  const auto seconds = [](const Outcome& o) { return o.ms_per_frame * o.frames / 1000; };
  double total = seconds(best);
  for (int i = 1; i < effort.repeat && total < effort.enough_seconds; ++i) {
    const Outcome next = run_once(task, knobs, effort.seconds_limit);
    total += seconds(next);
    if (next.ms_per_frame < best.ms_per_frame) best = next;
  }
  return best;
}

}  // namespace

std::string bullet_version() {
  return fmt::format("{}.{} {}", btGetVersion() / 100, btGetVersion() % 100,
                     sizeof(btScalar) == sizeof(double) ? "double" : "float");
}

std::vector<Point> sweep_bullet(const Task& task, const Effort& effort, bool quick,
                                const std::function<void(const std::string&)>& watch) {
  constexpr double kLoosest = 0.1;
  constexpr int kMostIterations = 2000;
  const std::vector<int> substeps =
      quick ? std::vector{5, 20} : std::vector{5, 10, 20, 50, 100, 200};
  std::vector<Point> points;
  for (const int parts : substeps) {
    for (double iterations = 1; iterations < kMostIterations; iterations *= quick ? 4 : 1.5) {
      const Knobs knobs{parts, {}, static_cast<int>(std::lround(iterations))};
      watch(
          fmt::format("{}, {}", counted(parts, "substep"), counted(knobs.iterations, "iteration")));
      const Outcome outcome = best_of(task, knobs, effort);
      if (outcome.max_strain > kLoosest && outcome.status == "fixed_iterations") continue;
      points.push_back({"bullet", "", "", knobs, outcome});
      if (outcome.status != "fixed_iterations" || outcome.max_strain < kBulletTightest) break;
    }
  }
  return points;
}

}  // namespace weft::tools::precision
