/// Damping of bending: it is about what an element bends, whatever it turns by, and however little
/// of its d is a bend.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "engine/public_vectors.h"
#include "engine/solvers/small_steps/bending_arms.h"
#include "tests/support/bending.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_damped_bending {
namespace {

/// Quads of `cell` m in the plane y = 0, `along` by `across` of them, numbered along x first.
MeshDescription grid(double cell, std::uint32_t along, std::uint32_t across) {
  MeshDescription mesh;
  for (std::uint32_t j = 0; j <= across; ++j) {
    for (std::uint32_t i = 0; i <= along; ++i) mesh.positions.push_back({cell * i, 0, cell * j});
  }
  for (std::uint32_t j = 0; j < across; ++j) {
    for (std::uint32_t i = 0; i < along; ++i) {
      const std::uint32_t a = j * (along + 1) + i, d = a + along + 1;
      mesh.corners.insert(mesh.corners.end(), {a, d, d + 1, a + 1});
      mesh.face_sizes.push_back(4);
    }
  }
  return mesh;
}

// ------------------------------------------------------------------------------------ fine cells

constexpr std::uint32_t kAlong = 130, kAcross = 4;

/// A strip of a fabric of 64 x 2 mm, at cells of 0.5 mm, that is clamped at one end.
SceneDescription fine_strip(const std::string& fabric) {
  MeshDescription mesh = grid(0.064 / (kAlong - 1.5), kAlong, kAcross);
  Material material = find_material(fabric).value();
  material.drag = material.lift = 0;
  material.damping_motion = 20;
  mesh.material = material;
  for (std::uint32_t j = 0; j <= kAcross; ++j) {
    for (std::uint32_t i = 0; i < 3; ++i) mesh.pins.push_back(j * (kAlong + 1) + i);
  }
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.gravity = {0, -10, 0};
  return scene;
}

// When an element turned with its d denim came to strains of 0.7 and 3e-3 J within 12 frames.
TEST_CASE("a damped strip of fine cells rests where one without damping does" *
          doctest::test_suite("slow")) {
  const struct {
    std::string fabric;
    double height;  // m, of its end, without damping
  } cases[] = {
      {"denim", -0.04887}, {"polyester", -0.03691}, {"wool", -0.05843}, {"cotton", -0.05804}};
  for (const auto& [fabric, height] : cases) {
    CAPTURE(fabric);
    const SceneDescription scene = fine_strip(fabric);
    REQUIRE(scene.damping.bending == 0.01);
    Cloth cloth = cloth_of(scene, {.tolerance = 1e-3, .threads = 1});
    for (int frame = 0; frame < 72; ++frame) {
      const StepReport report = step(cloth, 1. / 60);
      REQUIRE(report.status == Status::converged);
      REQUIRE(report.max_strain < 0.01);
      REQUIRE(cloth.energy().elastic < 2e-6);
    }
    CHECK(cloth.position(kAlong).y == doctest::Approx(height).epsilon(0.02));
    for (const Vec3& v : velocities(cloth)) REQUIRE(length(v) < 1e-3);
  }
}

TEST_CASE("lanes follow the double reference where damped bending is factored") {
  const SceneDescription scene = fine_strip("denim");
  Settings settings{.tolerance = 1e-3, .substeps = 46, .threads = 1};
  Cloth lanes = cloth_of(scene, settings);
  settings.backend = Backend::reference;
  Cloth reference = cloth_of(scene, settings);
  run(lanes, 1. / 60, 6);
  run(reference, 1. / 60, 6);
  CHECK(largest_distance(positions(lanes), positions(reference)) < 2e-5);
}

// ------------------------------------------------------------------------------------------ spin

/// A square of 0.2 m on a cylinder aslant to its yarns, that spins and drifts.
SceneDescription spinning_sheet(double stiffness) {
  constexpr double kTurn = 0.1;  // rad, a cell
  constexpr std::uint32_t kCells = 8;
  MeshDescription mesh = grid(0.2 / kCells, kCells, kCells);
  mesh.material = Material{.density = 0.2,
                           .warp = 2000,
                           .weft = 2000,
                           .shear = 500,
                           .bending = stiffness,
                           .damping_bending = 0.02};
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  const double radius = 0.2 / kCells / kTurn;
  for (Vec3& p : scene.positions) {
    const double along = (p.x + p.z) / std::sqrt(2), across = (p.x - p.z) / std::sqrt(2);
    const double x = radius * std::sin(along / radius);
    p = {(x + across) / std::sqrt(2), radius * (1 - std::cos(along / radius)),
         (x - across) / std::sqrt(2)};
    scene.velocities.push_back(Vec3{0.3, -0.2, 0.1} + cross({3, 2, -3}, p));
  }
  scene.gravity = {};
  return scene;
}

// Of chords alone, without particles beside, 1e-3; without any turn 4e-3.
TEST_CASE("a damped sheet that flies keeps its spin, soft or stiff") {
  for (const double stiffness : {1e-4, 1e-2}) {
    CAPTURE(stiffness);
    const SceneDescription scene = spinning_sheet(stiffness);
    const Vec3 spin = angular_momentum(scene.masses, scene.positions, scene.velocities);
    const Vec3 drift = momentum(scene.masses, scene.velocities);
    for (const Backend backend : kBackends) {
      Settings settings{.substeps = 100, .iterations = 1, .threads = 1};  // no guard of energy
      settings.backend = backend;
      Cloth cloth = cloth_of(scene, settings);
      run(cloth, 0.01, 40);
      const std::vector<Vec3> x = positions(cloth), v = velocities(cloth);
      CHECK(distance(angular_momentum(scene.masses, x, v), spin) < 5e-4 * length(spin));
      CHECK(distance(momentum(scene.masses, v), drift) < 2e-4 * length(drift));
    }
  }
}

// ----------------------------------------------------------------------------------------- folds

/// A sheet that hangs over a line, folded sharply: the middle of its fold is held.
SceneDescription over_a_line(const std::string& fabric, bool triangles) {
  constexpr std::uint32_t kCells = 20;
  constexpr double kCell = 0.02, kApart = 1.2e-3;  // m; both halves from each other
  MeshDescription mesh = grid(kCell, kCells, kCells);
  if (triangles) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < mesh.corners.size(); i += 4) {
      const auto c = mesh.corners.begin() + static_cast<std::ptrdiff_t>(i);
      corners.insert(corners.end(), {c[0], c[1], c[2], c[0], c[2], c[3]});
    }
    mesh.corners = corners;
    mesh.face_sizes.assign(corners.size() / 3, 3);
  }
  mesh.material = find_material(fabric).value();
  mesh.rest_positions = mesh.positions;
  for (Vec3& p : mesh.positions) {
    const double from_fold = p.x - kCell * kCells / 2;
    if (from_fold == 0 && std::abs(p.z - kCell * kCells / 2) < 2.5 * kCell)
      mesh.pins.push_back(static_cast<std::uint32_t>(&p - mesh.positions.data()));
    p.x = from_fold == 0 ? 0 : std::copysign(kApart / 2, from_fold);
    p.y = -std::abs(from_fold);
  }
  return cloth_from_mesh(mesh).value().scene;
}

// When damping followed the arms of a fold, whose ends lie beside each other, the fold was fed: its
// speed was 0.6 to 1 m/s for ever.
TEST_CASE("a sheet that hangs over a line rests, whatever lies beside what in its fold") {
  for (const char* fabric : {"cotton", "silk"}) {
    for (const bool triangles : {false, true}) {
      CAPTURE(fabric);
      CAPTURE(triangles);
      Cloth cloth = cloth_of(over_a_line(fabric, triangles), {.threads = 1});
      double fastest = 0;
      for (int frame = 0; frame < 420; ++frame) {
        REQUIRE(step(cloth, 1. / 60).status == Status::converged);
        if (frame < 360) continue;
        for (const Vec3& v : velocities(cloth)) fastest = std::max(fastest, length(v));
      }
      CHECK(fastest < 0.1);
    }
  }
}

// ------------------------------------------------------------------------------ particles beside

TEST_CASE("an element of three has a particle beside it two cells away, a yarn by itself none") {
  MeshDescription mesh = grid(0.1, 6, 4);
  mesh.material = find_material("cotton").value();
  const auto sheet = model_of(cloth_from_mesh(mesh).value().scene);
  const auto beside = particles_beside(*sheet);
  int count = 0;
  for (std::size_t i = 0; i < beside.size(); ++i) {
    const auto& slots = sheet->bending.slots[i];
    CHECK(beside[i].has_value() == (slots[2] == slots[3]));
    if (!beside[i]) continue;
    ++count;
    const auto at = [&](std::uint32_t slot) { return to_public(sheet->initial_position[slot]); };
    const Vec3 along = at(slots[0]) - at(slots[2]), away = at(*beside[i]) - at(slots[1]);
    CHECK(length(cross(away, along)) == doctest::Approx(0.2 * length(along)));
  }
  CHECK(count == 5 * 5 + 7 * 3);
  for (const auto& none : particles_beside(*model_of(cantilever({}))))
    CHECK_FALSE(none.has_value());
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_damped_bending
