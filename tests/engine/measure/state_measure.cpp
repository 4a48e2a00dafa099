/// describe(), strain(), max_penetration(), bytes(): what is measured outside of steps.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <cmath>
#include <memory>

#include "engine/measure/measure.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "kernels/simd/isa.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_measure_state_measure {
namespace {

TEST_CASE("a model describes what it holds") {
  SceneDescription scene = scene_of("hang_sphere", 5);
  scene.constraints.push_back({24, 4, 3.0, ConstraintKind::rope});
  scene.constraints.push_back({0, 4, 1.0});
  const ModelInfo info = describe(*model_of(scene));
  CHECK(info.particles == 26);
  CHECK(info.constraints == 37);
  CHECK(info.inert_constraints == 1);
  CHECK(info.ropes == 1);
  CHECK(info.spheres == 1);
  CHECK(info.bytes > 26 * 10 * sizeof(double));
}

TEST_CASE("at a hub ropes are told from other constraints") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}};
  for (std::uint32_t k = 1; k <= 70; ++k) {
    scene.positions.push_back({std::cos(k), std::sin(k), 0});
    scene.constraints.push_back({0, k, 1});
  }
  scene.constraints[3].kind = ConstraintKind::rope;
  scene.masses.assign(scene.positions.size(), 1);
  const ModelInfo info = describe(*model_of(scene));
  CHECK(info.constraints == 70);
  CHECK(info.ropes == 1);
}

TEST_CASE("an inert constraint is neither solved nor part of the strain, and a step tells it") {
  const Backend backend = each_backend();
  SceneDescription scene = scene_of("hang", 5);
  scene.constraints.insert(scene.constraints.begin(), {0, 4, 7.0});
  Cloth cloth = cloth_of(scene, on(backend));
  CHECK(cloth.strain().max < 1e-12);
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::infeasible);
  CHECK(report.held_apart == 1);
  CHECK(report.worst_held == 0);
  CHECK(report.max_strain <= 0.01);
}

TEST_CASE("the worst constraint is named by its number in the description") {
  const Backend backend = each_backend();
  SceneDescription scene = scene_of("hang", 5);
  scene.constraints.insert(scene.constraints.begin(), {0, 24, 5.0, ConstraintKind::rope});
  scene.constraints.insert(scene.constraints.begin() + 1, {0, 4, 7.0});
  scene.constraints[20].rest_length *= 2;
  CHECK(cloth_of(scene, on(backend)).strain().worst_constraint == 20);
  CHECK(cloth_of(scene, on(backend)).strain().max == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE(
    "the energy of springs is the same in lanes, of rigid constraints, ropes and hubs beside") {
  SceneDescription scene = scene_of("hang", 12);
  Random random(5);
  const auto particles = static_cast<std::uint32_t>(scene.positions.size());
  for (std::uint32_t k = 1; k <= 80; ++k)
    scene.constraints.push_back({0, particles - k, 0.5, ConstraintKind::rope});
  for (Constraint& c : scene.constraints) {
    if (random.below(4) > 0) c.compliance = random.between(1e-6, 1e-3);
  }
  for (Vec3& x : scene.positions) x = x + random.in_box(0.02);
  const auto model = model_of(scene);
  const simd::Table& table = simd::table(simd::best_isa());
  kernels::Vectors x = model->initial_position;
  Team team;
  Measure lanes(*model, on(Backend::simd), table), plain(*model, on(Backend::reference), table);
  for (const double give : {0., 1e-6, 1e-3}) {
    const double energy = plain.spring_energy(x.view(), give, team);
    CHECK(energy > 0);
    CHECK(lanes.spring_energy(x.view(), give, team) == doctest::Approx(energy).epsilon(1e-12));
  }
}

TEST_CASE("penetration is measured over all sphere pairs") {
  const Backend backend = each_backend();
  SceneDescription scene = scene_of("hang_sphere", 5);
  scene.positions[12] = {0.5, -0.4, 0.5};
  scene.radii[12] = 0.01;
  CHECK(cloth_of(scene, on(backend)).max_penetration() == doctest::Approx(0.06).epsilon(1e-12));
  CHECK(max_penetration(scene, scene.positions) == doctest::Approx(0.06).epsilon(1e-12));
  CHECK(cloth_of(scene_of("hang", 5), on(backend)).max_penetration() == 0);
}

TEST_CASE("a cloth holds memory only for what it runs") {
  const Backend backend = each_backend();
  const SceneDescription scene = scene_of("hang", 20);
  Settings lean = on(backend);
  lean.measuring.anticipate = lean.measuring.skip = false;
  Settings full = on(backend);
  full.velocity_correction = true;
  const std::size_t little = cloth_of(scene, lean).bytes();
  CHECK(little > 400 * 2 * 3 * sizeof(double));
  CHECK(little < cloth_of(scene, full).bytes());
}

/// Bytes per particle of a small sheet of cotton.
double bytes_per_particle(const std::shared_ptr<const Model>& model, int threads) {
  Cloth cloth = Cloth::create(model, {.threads = threads}).value();
  run(cloth, 0.01, 20);
  return static_cast<double>(cloth.bytes()) / static_cast<double>(cloth.particle_count());
}

TEST_CASE("a small cloth holds neither what its model knows nor room for threads") {
  MeshDescription mesh = quads(20);
  mesh.material = find_material("cotton").value();
  mesh.pins = {0, 19};
  const auto model = model_of(made(mesh).scene);
  const double bytes = bytes_per_particle(model, 1);
  CHECK(bytes < 1050);  // 125 of them are vectors of bending, 70 arms of damped elements
  CHECK(bytes_per_particle(model, 0) == bytes);
  CHECK(bytes_per_particle(model, kMaxThreads) == bytes);
}

}  // namespace
}  // namespace weft::test::engine_measure_state_measure
