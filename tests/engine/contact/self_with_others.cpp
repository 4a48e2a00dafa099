/// Cloth that touches itself beside what else a scene may have: bodies that are meshes, other
/// cloths, changes on the way.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/layers.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_self_with_others {
namespace {

constexpr double kFrame = 1.0 / 60;

Settings small_steps(int threads = 1) {
  return {.solver = Solver::small_steps, .threads = threads};
}

/// Pairs of triangles.
int self_crossings(const Cloth& cloth, const SceneDescription& scene) {
  const std::vector<Vec3> x = positions(cloth);
  return count_self_crossings({x, scene.surface});
}

int mesh_crossings(const Cloth& cloth, const SceneDescription& scene, const TriangleMesh& mesh,
                   const Pose& pose) {
  const std::vector<Vec3> x = positions(cloth), y = placed(mesh.vertices, pose);
  return count_crossings({x, scene.surface}, {y, mesh.triangles});
}

double weight_of(const SceneDescription& scene) {
  double weight = 0;
  for (const double mass : scene.masses) weight += 10 * mass;
  return weight;
}

/// N, in the mean of ten frames.
double load_of(Cloth& cloth, std::uint32_t body) {
  double load = 0;
  for (int frame = 0; frame < 10; ++frame) {
    step(cloth, kFrame);
    load -= cloth.body_load(body).value().force.y / 10;
  }
  return load;
}

// ------------------------------------------------------------------------------------ mesh bodies

TEST_CASE("layers fall on a mesh, cross neither it nor each other, and weigh what they weigh") {
  const SceneDescription scene = scene_of(stack(3, 10, 0.01), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  const TriangleMesh block = box_mesh({1, 0.1, 1}, 7);
  const Pose pose{.position = {0.013, -0.05, 0.007}};
  const auto id = add(cloth, {.shape = shape_of(block), .pose = pose});
  for (int frame = 0; frame < 50; ++frame) {
    CAPTURE(frame);
    const StepReport report = step(cloth, kFrame);
    CHECK(report.status == Status::converged);
    CHECK(self_crossings(cloth, scene) == 0);
    CHECK(mesh_crossings(cloth, scene, block, pose) == 0);
  }
  CHECK(load_of(cloth, id) == doctest::Approx(weight_of(scene)).epsilon(0.02));
}

TEST_CASE("layers hang over a ball of triangles that moves, and cross nothing") {
  const SceneDescription scene = scene_of(stack(2, 12, 0.01), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  const TriangleMesh ball = icosphere(0.12, 2);
  Pose pose{.position = {0, -0.13, 0}};
  const auto id = add(cloth, {.shape = shape_of(ball), .pose = pose});
  for (int frame = 1; frame <= 60; ++frame) {
    CAPTURE(frame);
    pose.position.x = frame > 30 ? 0.5 * (frame - 30) * kFrame : 0;
    REQUIRE(cloth.move_body(id, pose));
    step(cloth, kFrame);
    CHECK(self_crossings(cloth, scene) == 0);
    CHECK(mesh_crossings(cloth, scene, ball, pose) == 0);
  }
}

TEST_CASE("bits of layers on a mesh do not depend on threads, and a copy goes on with them") {
  const auto fallen = [](int threads) {
    Cloth cloth = cloth_of(scene_of(stack(2, 10, 0.006), 0.3), small_steps(threads));
    add(cloth, {.shape = shape_of(plane_mesh(1, 6))});
    run(cloth, kFrame, 12);
    return cloth;
  };
  Cloth one = fallen(1);
  CHECK(fallen(2).state_hash() == one.state_hash());
  Cloth copy = one.clone();
  run(copy, kFrame, 4);
  run(one, kFrame, 4);
  CHECK(copy.state_hash() == one.state_hash());
}

/// Two blocks close on two layers until there is no room for them, and open again.
TEST_CASE("layers that bodies pinch are reported, and come apart when the bodies open" *
          doctest::test_suite("long")) {
  const SceneDescription scene = scene_of(stack(2, 8, 0.004), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  const TriangleMesh block = box_mesh({0.3, 0.05, 0.3}, 3);
  std::vector<std::uint32_t> ids;
  const auto pose = [](double side, double apart) {
    return Pose{.position = {0, 0.006 + side * (apart / 2 + 0.025), 0}};
  };
  for (const double side : {-1., 1.})
    ids.push_back(add(cloth, {.shape = shape_of(block), .pose = pose(side, 0.03)}));
  bool was_reported = false;
  for (int frame = 1; frame <= 90; ++frame) {
    CAPTURE(frame);
    const double closed = frame < 30 ? frame / 15.0 : std::max(0.0, (50 - frame) / 20.0);
    const double apart = 0.03 - 0.028 * std::min(1.0, closed);
    REQUIRE(cloth.move_body(ids[0], pose(-1, apart)));
    REQUIRE(cloth.move_body(ids[1], pose(1, apart)));
    const StepReport report = step(cloth, kFrame);
    REQUIRE(committed(report.status));
    const int crossed = self_crossings(cloth, scene);
    CHECK(report.tangled == crossed);
    was_reported = was_reported || report.status != Status::converged;
    if (crossed > 0) CHECK(report.status != Status::converged);
  }
  CHECK(was_reported);
  CHECK(self_crossings(cloth, scene) == 0);
}

// ------------------------------------------------------------------------------------ many cloths

std::vector<std::uint32_t> border_of(std::uint32_t cells) {
  std::vector<std::uint32_t> border;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t j = 0; j <= cells; ++j) {
      if (std::min(i, j) == 0 || std::max(i, j) == cells) border.push_back(i * (cells + 1) + j);
    }
  }
  return border;
}

TEST_CASE("cloths of a scene touch each other: one that is held bears one that falls") {
  constexpr std::uint32_t kCells = 12;
  SceneDescription scene = scene_of({{kCells, kCells,
                                      [](double u, double v) {
                                        return Vec3{u - 0.5, 0, v - 0.5};
                                      }},
                                     {5, 4,
                                      [](double u, double v) {
                                        return Vec3{0.2 * (u - 0.47), 0.05, 0.16 * (v - 0.52)};
                                      }}},
                                    0.3, border_of(kCells));
  for (std::size_t i = (kCells + 1) * (kCells + 1); i < scene.masses.size(); ++i)
    scene.masses[i] *= 8;
  Cloth cloth = cloth_of(scene, small_steps());
  for (int frame = 0; frame < 60; ++frame) {
    CAPTURE(frame);
    CHECK(step(cloth, kFrame).status == Status::converged);
    CHECK(self_crossings(cloth, scene) == 0);
  }
  // It would have fallen by 5 m.
  CHECK(cloth.position(static_cast<std::uint32_t>(scene.positions.size() - 1)).y > -0.2);
}

TEST_CASE("particles of a thread lie on layers, as those of triangles do") {
  SceneDescription scene = scene_of(stack(2, 8, 0.006), 0.3);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {{0.01, 0.05, 0.013}, {0.03, 0.05, 0.013}});
  scene.masses.insert(scene.masses.end(), {1e-3, 1e-3});
  scene.constraints.push_back({first, first + 1, 0.02});
  Cloth cloth = cloth_of(scene, small_steps());
  add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
  run(cloth, kFrame, 40);
  CHECK(self_crossings(cloth, scene) == 0);
  for (const std::uint32_t end : {first, first + 1})
    CHECK(cloth.position(end).y == doctest::Approx(1e-3 + 2 * kLayerThickness).epsilon(0.1));
}

// --------------------------------------------------------------------------------------- fineness

TEST_CASE("a level sheet whose edges are shorter than the thickness falls as it is") {
  SceneDescription scene = scene_of({{14, 14,
                                      [](double u, double v) {
                                        return Vec3{0.03 * u, 0, 0.03 * v};
                                      }}},
                                    0.3);
  for (const double edges : {0.9, 2.0, 5.0}) {
    CAPTURE(edges);
    scene.self_contact.thickness = edges * 0.03 / 14;
    Cloth cloth = cloth_of(scene, small_steps());
    for (int frame = 0; frame < 8; ++frame) {
      const StepReport report = step(cloth, kFrame);
      CHECK(report.status == Status::converged);
      CHECK(report.max_strain < 1e-6);
    }
    double lowest = 0, highest = -1;
    for (const Vec3& x : positions(cloth)) {
      lowest = std::min(lowest, x.y);
      highest = std::max(highest, x.y);
    }
    CHECK(highest - lowest < 1e-6);
  }
}

// ---------------------------------------------------------------------------------------- changes

TEST_CASE("layers stay apart while masses, springs, pins and lengths change under them") {
  const SceneDescription scene = scene_of(stack(3, 8, 0.006), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  const auto floor = add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
  const auto goes_on = [&](int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      CAPTURE(frame);
      CHECK(committed(step(cloth, kFrame).status));
      CHECK(self_crossings(cloth, scene) == 0);
    }
  };
  goes_on(15);
  Changes heavier, softer, fixed, released, shorter;
  const auto top = static_cast<std::uint32_t>(scene.positions.size() - 1);
  for (std::uint32_t i = 0; i < scene.masses.size(); ++i)
    heavier.masses.push_back({i, 3 * scene.masses[i]});
  for (std::uint32_t i = 0; i < scene.constraints.size(); ++i) {
    softer.compliances.push_back({i, 4 * scene.constraints[i].compliance});
    if (i % 3 == 0) shorter.rest_lengths.push_back({i, 0.97 * scene.constraints[i].rest_length});
  }
  fixed.fix = {0, top};
  released.release = {0, top};
  for (const Changes& changes : {heavier, softer, fixed, released, shorter}) {
    REQUIRE(cloth.change(changes));
    CHECK(self_crossings(cloth, scene) == 0);
    goes_on(10);
  }
  CHECK(load_of(cloth, floor) == doctest::Approx(3 * weight_of(scene)).epsilon(0.05));
}

TEST_CASE("what is tangled stays known when constraints change") {
  // A sheet that is held, and one that leads through it.
  SceneDescription scene =
      scene_of({{8, 8,
                 [](double u, double v) {
                   return Vec3{0.3 * (u - 0.5), 0, 0.3 * (v - 0.5)};
                 }},
                {8, 8,
                 [](double u, double v) {
                   return Vec3{0.2 * (u - 0.51), 0.12 * (v - 0.43), 0.01 + 0.05 * (v - 0.5)};
                 }}},
               0.3, border_of(8));
  scene.gravity = {};
  for (const Backend backend : kBackends) {
    CAPTURE(backend);
    Settings settings = small_steps();
    settings.backend = backend;
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, kFrame, 3);
    REQUIRE(self_crossings(cloth, scene) > 10);
    Changes heavier;
    heavier.masses.push_back({100, 2 * scene.masses[100]});
    REQUIRE(cloth.change(heavier));
    for (int frame = 0; frame < 5; ++frame)
      CHECK(step(cloth, kFrame).tangled == self_crossings(cloth, scene));
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_self_with_others
