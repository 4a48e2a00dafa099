/// Cloth whose motion decays comes to rest: it moves by nothing that can be seen, and says so.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_rest {
namespace {

/// A sheet of triangles, 2 m wide, level where it begins and held at two corners.
MeshDescription held_sheet(std::uint32_t size) {
  MeshDescription mesh;
  const double cell = 2.0 / (size - 1);
  for (std::uint32_t i = 0; i < size * size; ++i)
    mesh.positions.push_back({cell * (i % size), 0, cell * (i / size)});
  for (std::uint32_t j = 0; j + 1 < size; ++j) {
    for (std::uint32_t i = 0; i + 1 < size; ++i) {
      const std::uint32_t a = j * size + i, b = a + 1, c = a + size + 1, d = a + size;
      for (const std::uint32_t corner : {a, b, c, a, c, d}) mesh.corners.push_back(corner);
      mesh.face_sizes.insert(mesh.face_sizes.end(), {3, 3});
    }
  }
  mesh.pins = {0, size - 1};
  return mesh;
}

SceneDescription scene_of(const MeshDescription& mesh, double decay) {
  auto cloth = cloth_from_mesh(mesh);
  REQUIRE(cloth);
  SceneDescription scene = std::move(cloth.value().scene);
  scene.damping.motion = decay;
  return scene;
}

SceneDescription sheet_of_ropes(std::uint32_t size, double decay) {
  MeshDescription mesh = held_sheet(size);
  mesh.ropes = Ropes::all;
  return scene_of(mesh, decay);
}

SceneDescription sheet_of(const char* material, std::uint32_t size, double decay) {
  MeshDescription mesh = held_sheet(size);
  mesh.material = find_material(material).value();
  return scene_of(mesh, decay);
}

/// Ten frames, after `seconds`.
struct Rest {
  double moved = 0;  ///< m, the largest of a frame
  double speed = 0;  ///< m/s, the largest that is reported
};

Rest rest_after(double seconds, const SceneDescription& scene, double dt,
                const Settings& settings = {}) {
  Cloth cloth = cloth_of(scene, settings);
  run(cloth, dt, static_cast<int>(seconds / dt));
  Rest rest;
  for (int frame = 0; frame < 10; ++frame) {
    const std::vector<Vec3> before = positions(cloth);
    run(cloth, dt, 1);
    for (std::uint32_t i = 0; i < before.size(); ++i) {
      rest.moved = std::max(rest.moved, distance(before[i], cloth.position(i)));
      rest.speed = std::max(rest.speed, length(cloth.velocity(i)));
    }
  }
  return rest;
}

void check_rest(const Rest& rest) {
  CHECK(rest.moved < 1e-5);
  CHECK(rest.speed < 1e-3);
}

// With mending that took whole errors: 0.8 to 3 mm a frame, 0.5 to 1.2 m/s.
TEST_CASE("a sheet of ropes comes to rest, at any frame rate, though some of it is mended") {
  for (const double rate : {30., 60., 240.}) {
    CAPTURE(rate);
    check_rest(rest_after(12, sheet_of_ropes(14, 3), 1 / rate));
  }
  check_rest(rest_after(12, sheet_of_ropes(14, 3), 1 / 60., {.substeps = 24}));
  check_rest(rest_after(40, sheet_of_ropes(14, 0.5), 1 / 60.));
}

TEST_CASE("so does one that is mended everywhere, by sweeps") {
  scenes::Options options;
  options.size = 15;
  options.ropes = true;
  auto scene = scenes::make("four_pins", options);
  REQUIRE(scene);
  scene.value().damping.motion = 3;
  check_rest(rest_after(12, scene.value(), 1 / 60.));
}

TEST_CASE("fabric comes to rest") {
  for (const char* material : {"cotton", "silk"}) {
    CAPTURE(material);
    const Rest rest = rest_after(12, sheet_of(material, 12, 3), 1 / 60.);
    check_rest(rest);
  }
}

/// Rows by columns of square cells around a place, level.
void add_sheet(MeshDescription& mesh, std::uint32_t rows, std::uint32_t columns, double cell,
               double height) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t i = 0; i <= rows; ++i) {
    for (std::uint32_t j = 0; j <= columns; ++j)
      mesh.positions.push_back({cell * (j - 0.5 * columns), height, cell * (i - 0.5 * rows)});
  }
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t at = first + i * (columns + 1) + j, next = at + columns + 1;
      mesh.face_sizes.push_back(4);
      for (const std::uint32_t corner : {at, next, next + 1, at + 1})
        mesh.corners.push_back(corner);
    }
  }
}

/// A sheet of 12 cm by 30 cm that is held by both long sides, and a patch that falls on it.
SceneDescription patch_on_a_sheet(const char* material, double cell) {
  const auto cells = [&](double length) {
    return static_cast<std::uint32_t>(std::lround(length / cell));
  };
  MeshDescription mesh;
  mesh.material = find_material(material).value();
  add_sheet(mesh, cells(0.3), cells(0.12), cell, 0);
  const std::uint32_t in_row = cells(0.12) + 1;
  for (std::uint32_t i = 0; i <= cells(0.3); ++i)
    mesh.pins.insert(mesh.pins.end(), {i * in_row, (i + 1) * in_row - 1});
  add_sheet(mesh, cells(0.16), cells(0.06), cell, 0.01);
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.self_contact.on = true;
  return scene;
}

/// m/s, the largest of half a second, after `seconds`.
double fastest_after(double seconds, const SceneDescription& scene, double rate) {
  Cloth cloth = cloth_of(scene, {.threads = 1});
  run(cloth, 1 / rate, static_cast<int>(seconds * rate));
  double fastest = 0;
  for (int frame = 0; frame < rate / 2; ++frame) {
    const std::vector<Vec3> before = positions(cloth);
    run(cloth, 1 / rate, 1);
    for (std::uint32_t i = 0; i < before.size(); ++i)
      fastest = std::max(fastest, rate * distance(before[i], cloth.position(i)));
  }
  return fastest;
}

// Substeps that became longer in each calm frame, until one failed: 0.1 to 0.4 m/s, for ever.
TEST_CASE("a patch lies still on a sheet that is held, at any frame rate" *
          doctest::test_suite("long")) {
  for (const std::string material : {"cotton", "denim"}) {
    for (const double cell : {0.015, 0.02}) {
      for (const double rate : {30., 60., 240.}) {
        CAPTURE(material);
        CAPTURE(cell);
        CAPTURE(rate);
        CHECK(fastest_after(3.5, patch_on_a_sheet(material.c_str(), cell), rate) < 1e-2);
      }
    }
  }
}

// By a memory that was not of the state, or outlived what it knew.
TEST_CASE("a saved cloth and a copy have as many substeps as the one that they are of") {
  const SceneDescription scene = patch_on_a_sheet("cotton", 0.015);
  Cloth cloth = cloth_of(scene, {.threads = 1});
  run(cloth, 1 / 60., 40);
  Cloth copy = cloth.clone(), loaded = cloth_of(scene, {.threads = 1});
  REQUIRE(loaded.load_state(cloth.save_state()));
  for (int frame = 0; frame < 60; ++frame) {
    const int substeps = step(cloth, 1 / 60.).substeps;
    CHECK(step(copy, 1 / 60.).substeps == substeps);
    CHECK(step(loaded, 1 / 60.).substeps == substeps);
  }
  CHECK(copy.state_hash() == cloth.state_hash());
  CHECK(loaded.state_hash() == cloth.state_hash());
}

// As many as where all of it hangs on the corner: ten times as many.
TEST_CASE(
    "where a corner of cloth that lies is taken a frame has at most four times as many substeps") {
  for (const std::string material : {"cotton", "denim"}) {
    for (const std::uint32_t cells : {12u, 24u}) {
      for (const double rate : {30., 60., 240.}) {
        CAPTURE(material);
        CAPTURE(cells);
        CAPTURE(rate);
        MeshDescription mesh;
        mesh.material = find_material(material).value();
        add_sheet(mesh, cells, cells, 0.4 / cells, 1.5e-3);
        Cloth cloth = cloth_of(cloth_from_mesh(mesh).value().scene, {.threads = 1});
        REQUIRE(cloth.add_body({.shape = build_shape(Plane{}).value(), .friction = 0.5}));
        run(cloth, 1 / rate, static_cast<int>(rate / 4));
        const int before = step(cloth, 1 / rate).substeps;
        REQUIRE(cloth.change({.fix = {0}}));
        const StepReport taken = step(cloth, 1 / rate);
        CHECK(taken.status == Status::converged);
        CHECK(taken.substeps <= 4 * before);
        REQUIRE(cloth.change({.release = {0}}));
        const StepReport let_go = step(cloth, 1 / rate);
        CHECK(let_go.status == Status::converged);
        CHECK(let_go.substeps <= 4 * before);
      }
    }
  }
}

TEST_CASE("in doubles, too") {
  check_rest(rest_after(12, sheet_of_ropes(8, 3), 1 / 60.,
                        {.solver = Solver::small_steps, .backend = Backend::reference}));
}

}  // namespace
}  // namespace weft::test::engine_step_rest
