/// Triangles of fabric in small steps: closed forms, what they conserve, and that how they are
/// computed makes no difference.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "tests/support/clothes.h"
#include "tests/support/membrane.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_membrane {
namespace {

constexpr double kFrame = 0.01;
/// kg/m^2. What a sweep leaves of a law falls with the mass.
constexpr double kHeavy = 10;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAngles[] = {0, 30 * kDegree, 45 * kDegree, 80 * kDegree};

Settings settings_on(Backend backend, int substeps = kAutomaticSubsteps) {
  Settings settings;
  settings.backend = backend;
  settings.substeps = substeps;
  settings.threads = 1;
  return settings;
}

/// Pulls and shears, in the frame of the mesh.
std::vector<Affine> deformations() {
  return {{{1.05, 0, 0}, {0, 1.02, 0}},
          {{1.03, 0.04, 0}, {0.05, 1.03, 0}},
          {{1.04, -0.06, 0}, {0.02, 1.05, 0.03}}};
}

std::vector<Vec3> deformed(const SceneDescription& scene, const Affine& by) {
  std::vector<Vec3> x;
  for (const Vec3& p : scene.positions) x.push_back(by(p));
  return x;
}

// ------------------------------------------------------------------------------------- the model

TEST_CASE("every triangle that can move is in one lane, and batches share no particle") {
  SceneDescription scene = fabric_curtain({}, 12);
  for (std::size_t i = 0; i < scene.membrane.size(); i += 3)
    scene.membrane[i].kind = ConstraintKind::rope;
  for (std::uint32_t i = 13; i < 26; ++i) scene.fixed.push_back(i);  // a row of inert triangles
  const auto model = model_of(scene);
  CHECK(describe(*model).membrane_elements == 2 * 12 * 11);
  const MembraneLayout& layout = model->small_steps().membrane;
  std::vector<int> seen(model->membrane.size());
  for (const MembraneBatch& batch : layout.batches) {
    std::vector<bool> taken(model->slots());
    for (std::uint32_t place = batch.first * kLanes; place < batch.last * kLanes; ++place) {
      const std::uint32_t i = layout.element[place];
      if (i == kNoIndex) continue;
      ++seen[i];
      CHECK(layout.place[i] == place);
      CHECK(model->membrane.element[i].is_rope == batch.rope);
      for (const std::uint32_t slot : model->membrane.slots[i]) {
        CHECK_FALSE(taken[slot]);
        taken[slot] = true;
      }
    }
  }
  CHECK(std::ranges::all_of(seen, [](int count) { return count == 1; }));
  CHECK(layout.batches.size() <= 24);
}

TEST_CASE("particles that triangles alone join are near each other in memory") {
  const auto model = model_of(fabric_patch({}, 40, 1));
  double apart = 0;
  for (const auto& [a, b, c] : model->membrane.slots) {
    const auto [least, most] = std::minmax({a, b, c});
    apart += most - least;
  }
  CHECK(apart / static_cast<double>(model->membrane.size()) < 3 * 41);
}

TEST_CASE("small steps are chosen for fabric, and other solvers refuse it") {
  const auto model = model_of(fabric_curtain({}, 3));
  CHECK(Cloth::create(model, {}).value().settings().solver == Solver::small_steps);
  for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
    const auto cloth = Cloth::create(model, {.solver = solver});
    REQUIRE_FALSE(cloth);
    CHECK(cloth.error() ==
          "membrane: is solved by small_steps only (" + std::string(name(solver)) + ")");
  }
}

// ---------------------------------------------------------------------------------- closed forms

TEST_CASE("a triangle that is pulled and sheared takes the shape that its laws say") {
  for (const Backend backend : kBackends) {
    for (const double angle : kAngles) {
      for (const Affine& deformation : deformations()) {
        CAPTURE(angle);
        SceneDescription scene = fabric_triangle({.density = kHeavy, .angle = angle});
        scene.fixed = {0};
        scene.damping.motion = 20;
        scene.damping.stretch = 0.01;
        const std::vector<Vec3> end = deformed(scene, deformation);
        std::vector<Vec3> forces(3);
        for (const std::uint32_t i : {1u, 2u}) forces[i] = fabric_gradient(scene, end, i);
        Cloth cloth = cloth_of(scene, settings_on(backend, 40));
        REQUIRE(cloth.write_forces(forces));
        run(cloth, kFrame, 200);
        for (const std::uint32_t i : {1u, 2u}) {
          const Vec3 side = cloth.position(i) - cloth.position(0);
          const Vec3 expected = end[i] - end[0];
          const Vec3 rest = scene.positions[i] - scene.positions[0];
          CHECK(distance(side, expected) < 0.01 * distance(rest, expected));
        }
      }
    }
  }
}

TEST_CASE("a patch whose outline is deformed follows, and stores what the laws say") {
  constexpr std::uint32_t kCells = 6;
  for (const Backend backend : kBackends) {
    for (const double angle : kAngles) {
      for (const Affine& deformation : deformations()) {
        CAPTURE(angle);
        const Fabric fabric{.density = kHeavy, .angle = angle};
        SceneDescription scene = fabric_patch(fabric, kCells, 2);
        const std::vector<Vec3> end = deformed(scene, deformation);
        const double area = area_of(scene);
        scene.fixed = outline_of(kCells);
        for (const std::uint32_t i : scene.fixed) scene.positions[i] = end[i];
        scene.damping.motion = 20;
        const std::vector<Vec3> start = scene.positions;
        Cloth cloth = cloth_of(scene, settings_on(backend, 40));
        run(cloth, kFrame, 150);
        CHECK(largest_distance(positions(cloth), end) < 0.01 * largest_distance(start, end));
        const double energy = area * energy_density(fabric, deformation);
        CHECK(fabric_energy(scene, positions(cloth)) == doctest::Approx(energy).epsilon(0.01));
        const auto [warp, weft, shear] = laws_of(fabric, deformation);
        const Strain strain = cloth.strain();
        const double stretch = std::max(std::abs(warp), std::abs(weft));
        CHECK(strain.max == doctest::Approx(stretch).epsilon(0.02));
        CHECK(std::abs(strain.max_shear - std::abs(shear)) < 0.02 * stretch);
        CHECK(strain.worst_constraint == kNoIndex);
        CHECK(strain.worst_element < scene.membrane.size());
      }
    }
  }
}

TEST_CASE("a curtain is stretched by its weight, half of it on average") {
  constexpr std::uint32_t kCells = 8;
  const Fabric fabric{.weft = 25};
  for (const Backend backend : kBackends) {
    SceneDescription scene = fabric_curtain(fabric, kCells);
    scene.damping.motion = 4;
    Cloth cloth = cloth_of(scene, settings_on(backend));
    run(cloth, kFrame, 200);
    const double length = 0.05 * kCells;
    const double stretch = fabric.density * 10 * length * length / (2 * fabric.weft);
    for (std::uint32_t i = kCells * (kCells + 1); i < (kCells + 1) * (kCells + 1); ++i)
      CHECK(-cloth.position(i).y - length == doctest::Approx(stretch).epsilon(0.02));
  }
}

TEST_CASE("fabric that only pulls becomes narrower without a force") {
  for (const Backend backend : kBackends) {
    const Fabric fabric{.shear = 0, .kind = ConstraintKind::rope};
    SceneDescription scene = fabric_patch(fabric, 4, 3);
    for (Vec3& p : scene.positions) p.x *= 0.9;
    scene.fixed = {0};
    Cloth cloth = cloth_of(scene, settings_on(backend));
    run(cloth, kFrame, 20);
    CHECK(largest_distance(positions(cloth), scene.positions) < 1e-6);
    CHECK(cloth.strain().max < 1e-6);
    CHECK(cloth.energy().total() < 1e-9);
  }
}

// -------------------------------------------------------------------------- what it conserves

TEST_CASE("fabric at rest stays at rest") {
  for (const Backend backend : kBackends) {
    const SceneDescription scene = fabric_patch({.angle = 0.5}, 8, 4);
    Cloth cloth = cloth_of(scene, settings_on(backend));
    run(cloth, kFrame, 200);
    CHECK(largest_distance(positions(cloth), scene.positions) < 1e-5);
    CHECK(cloth.energy().kinetic < 1e-9);
  }
}

TEST_CASE("swinging fabric gains no energy, and obeys its laws") {
  for (const Backend backend : kBackends) {
    for (const ConstraintKind kind : {ConstraintKind::distance, ConstraintKind::rope}) {
      for (const int substeps : {8, kAutomaticSubsteps}) {
        SceneDescription scene = fabric_curtain({.warp = 4000, .angle = 0.7, .kind = kind}, 8);
        scene.fixed = {0, 8};
        for (Vec3& p : scene.positions) p = {p.x, 0, p.y};
        Settings settings = settings_on(backend, substeps);
        settings.tolerance = 0.01;
        Cloth cloth = cloth_of(scene, settings);
        const double start = cloth.energy().total();
        for (int frame = 0; frame < 100; ++frame) {
          const StepReport report = step(cloth, kFrame);
          CAPTURE(frame);
          REQUIRE((substeps == 8 || report.status == Status::converged));
          REQUIRE((substeps == 8 || report.max_error <= 0.01));
          REQUIRE(cloth.energy().kinetic + cloth.energy().potential < start + 1e-3);
        }
      }
    }
  }
}

TEST_CASE("free fabric that flies keeps its momentum") {
  for (const Backend backend : kBackends) {
    SceneDescription scene = fabric_patch({}, 6, 6);
    Random random(9);
    Vec3 before{}, after{};
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
      scene.velocities.push_back(random.in_box(1));
      before = before + scene.masses[i] * scene.velocities.back();
    }
    Cloth cloth = cloth_of(scene, settings_on(backend));
    run(cloth, kFrame, 50);
    double scale = 0;
    for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
      after = after + scene.masses[i] * cloth.velocity(i);
      scale += scene.masses[i] * length(scene.velocities[i]);
    }
    CHECK(length(after - before) < 1e-4 * scale);
  }
}

TEST_CASE("crumpled, inverted and collapsed fabric comes to rest, and gains nothing") {
  for (const Backend backend : kBackends) {
    for (int spoil = 0; spoil < 3; ++spoil) {
      CAPTURE(spoil);
      SceneDescription scene = fabric_patch({}, 6, 7);
      Random random(10);
      for (Vec3& p : scene.positions) {
        if (spoil == 0) p = {};
        if (spoil == 1) p = {p.x, 0, 0};
        if (spoil == 2) p = p + random.in_box(0.1);
      }
      scene.damping.motion = 2;
      Cloth cloth = cloth_of(scene, settings_on(backend));
      const double start = fabric_energy(scene, scene.positions);
      for (int frame = 0; frame < 100; ++frame) {
        step(cloth, kFrame);
        const double kinetic = cloth.energy().kinetic;
        REQUIRE(std::isfinite(kinetic));
        REQUIRE(kinetic <= (spoil == 2 ? start : area_of(scene) * 400) + 1e-6);
      }
    }
  }
}

// ---------------------------------------------------------------------------- what it is done by

TEST_CASE("lanes move fabric as double does") {
  SceneDescription scene = fabric_curtain({.angle = 0.6}, 10);
  for (Vec3& p : scene.positions) p = {p.x, 0, p.y};
  for (const double damping : {0., 2e-3}) {
    scene.damping.stretch = damping;
    std::vector<std::vector<Vec3>> ends;
    for (const Backend backend : kBackends) {
      Cloth cloth = cloth_of(scene, settings_on(backend, 32));
      run(cloth, kFrame, 20);
      ends.push_back(positions(cloth));
    }
    CHECK(largest_distance(ends[0], scene.positions) > 0.1);
    CHECK(largest_distance(ends[0], ends[1]) < 1e-4);
  }
}

TEST_CASE("any number of threads moves fabric to the same bits") {
  SceneDescription scene = fabric_curtain({.angle = 0.6}, 70);
  for (Vec3& p : scene.positions) p = {p.x, 0, p.y};
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    Settings settings = settings_on(Backend::simd, 8);
    settings.threads = threads;
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, kFrame, 5);
    hashes.push_back(cloth.state_hash());
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

/// A curtain that has swung for a while.
Cloth swinging(Backend backend) {
  SceneDescription scene = fabric_curtain({.angle = 0.6}, 8);
  for (Vec3& p : scene.positions) p = {p.x, 0, p.y};
  Cloth cloth = cloth_of(scene, settings_on(backend));
  run(cloth, kFrame, 10);
  return cloth;
}

TEST_CASE("a clone, and who takes a state over, goes on to the same bits") {
  for (const Backend backend : kBackends) {
    Cloth cloth = swinging(backend), other = cloth.clone();
    Cloth third = Cloth::create(cloth.model(), settings_on(backend)).value();
    REQUIRE(third.copy_state(cloth));
    for (Cloth* c : {&cloth, &other, &third}) run(*c, kFrame, 5);
    CHECK(cloth.state_hash() == other.state_hash());
    CHECK(cloth.state_hash() == third.state_hash());
  }
}

TEST_CASE("a model that was changed is that of the changed description, and goes on smoothly") {
  for (const Backend backend : kBackends) {
    Cloth cloth = swinging(backend), same = cloth.clone();
    const Changes changes{.fix = {40, 41, 49}, .release = {0, 1}, .masses = {{50, 0.01}}};
    REQUIRE(cloth.change(changes));
    REQUIRE(cloth.change({.fix = {0, 1}, .release = {40, 41, 49}}));
    REQUIRE(
        cloth.change({.masses = {{50, same.model()->mass[same.model()->ordering.slot_of[50]]}}}));
    CHECK(cloth.model()->membrane.size() == same.model()->membrane.size());
    const auto is_same = [](const auto& a, const auto& b) { return a == b; };
    CHECK(is_same(cloth.model()->membrane.slots, same.model()->membrane.slots));
    CHECK(is_same(cloth.model()->membrane.rest, same.model()->membrane.rest));
    run(cloth, kFrame, 3);
    run(same, kFrame, 3);
    CHECK(largest_distance(positions(cloth), positions(same)) < 0.02);
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_membrane
