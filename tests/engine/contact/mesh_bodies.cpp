/// What callers do with bodies of triangles between steps: what is refused, what copies carry on,
/// what comes and goes while it is touched.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_mesh_bodies {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Settings small_steps(Backend backend = Backend::simd) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

SceneDescription sheet_over_origin(std::uint32_t size, double height) {
  MeshDescription mesh = quads(size);
  const double spacing = 0.5 / (size - 1);
  for (Vec3& v : mesh.positions) v = {spacing * v.x - 0.24, height, spacing * v.y - 0.26};
  mesh.material = find_material("cotton").value();
  return made(mesh).scene;
}

std::string refused(const TriangleMesh& mesh) {
  const auto built = build_shape(mesh);
  REQUIRE_FALSE(built);
  return built.error();
}

TEST_CASE("a mesh that cannot be is refused with one line") {
  const TriangleMesh good = icosphere(1, 0);
  TriangleMesh mesh = good;
  mesh.triangles[3][1] = 12;
  CHECK(refused(mesh) == "triangles[3][1]: no such vertex, the mesh has 12 (12)");
  mesh = good;
  mesh.vertices[7].y = kNan;
  CHECK(refused(mesh).starts_with("vertices[7]: must be finite"));
  mesh = good;
  mesh.triangles.push_back({0, 1, 0});  // left out, whatever the others are
  mesh.triangles.push_back({0, 2, 2});
  mesh.triangles.push_back({3, 3, 3});
  CHECK(build_shape(mesh));
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  CHECK(refused(mesh).find("runs along an edge in the same direction as another triangle") !=
        std::string::npos);
  CHECK(refused(mesh).starts_with("triangles["));
  mesh.two_sided = true;
  CHECK(build_shape(mesh));
  mesh = {.vertices = good.vertices, .triangles = {{0, 1, 1}, {2, 2, 2}}};
  CHECK(refused(mesh) == "triangles: must be one or more with three corners (2)");
  CHECK(refused({}).starts_with("triangles: must be one or more"));
}

TEST_CASE("vertices that cannot be are refused, and nothing changes") {
  Cloth cloth = cloth_of(sheet_over_origin(6, 0.11), small_steps());
  const TriangleMesh mesh = icosphere(0.1, 1);
  const auto id = add(cloth, {.shape = shape_of(mesh)});
  const auto ball = add(cloth, {.shape = shape_of(Ball{.radius = 0.1}), .pose = {{2, 0, 0}, {}}});
  Cloth other = cloth.clone();
  std::vector<Vec3> vertices = mesh.vertices;
  vertices[5].z = kNan;
  const auto each = [&](auto&& check) {
    check([&](std::uint32_t i, std::span<const Vec3> v) { return cloth.move_body_vertices(i, v); });
    check(
        [&](std::uint32_t i, std::span<const Vec3> v) { return cloth.place_body_vertices(i, v); });
  };
  each([&](auto&& give) {
    CHECK(give(id, vertices).error().starts_with("vertices[5]: must be finite"));
    const auto few = std::span(mesh.vertices).first(3);
    CHECK(give(id, few).error().find("3") != std::string::npos);
    CHECK_FALSE(give(ball, mesh.vertices));
    CHECK_FALSE(give(99, mesh.vertices));
  });
  run(cloth, 1.0 / 60, 5);
  run(other, 1.0 / 60, 5);
  CHECK(cloth.state_hash() == other.state_hash());
}

TEST_CASE("cloth lies on two triangles of 40 km as on small ones") {
  for (const double size : {2.0, 10'000.0, 40'000.0}) {
    CAPTURE(size);
    Cloth cloth = cloth_of(sheet_over_origin(12, 0.02), small_steps());
    add(cloth, {.shape = shape_of(plane_mesh(size, 1)), .thickness = 2e-3});
    for (int frame = 0; frame < 30; ++frame)
      REQUIRE(cloth.step(1.0 / 60).value().status == Status::converged);
    for (std::uint32_t i = 0; i < cloth.particle_count(); ++i)
      CHECK(cloth.position(i).y == doctest::Approx(2e-3).epsilon(0.01));
  }
}

/// Cloth that has come to lie on a sphere, and a box that some of its particles are inside of.
struct Draped {
  Cloth cloth;
  std::uint32_t ball = 0, box = 0;
  Vec3 middle{};  // of the box

  explicit Draped(Backend backend)
      : cloth(cloth_of(sheet_over_origin(10, 0.105), small_steps(backend))) {
    ball = add(cloth, {.shape = shape_of(icosphere(0.1, 2))});
    run(cloth, 1.0 / 60, 8);
  }
  /// Around a particle near a corner of the cloth.
  void put_box() {
    middle = cloth.position(88) + Vec3{0.02, -0.03, 0.01};
    box = add(cloth,
              {.shape = shape_of(box_mesh({0.16, 0.2, 0.16}, 3)), .pose = {.position = middle}});
  }
};

TEST_CASE("copies go on bit for bit in the middle of contact, and with particles inside a body") {
  const Backend backend = each_backend();
  Draped draped(backend);
  Cloth& from = draped.cloth;
  draped.put_box();
  REQUIRE(from.move_body(draped.ball, {.position = {0.02, 0.01, 0}}));
  run(from, 1.0 / 60, 1);
  REQUIRE(from.body_contacts().size() > 3);
  const auto is_inside = [&](Vec3 v) {
    const Vec3 d = v - draped.middle;
    return std::max({std::abs(d.x), std::abs(d.y) - 0.02, std::abs(d.z)}) < 0.08;
  };
  REQUIRE(std::ranges::any_of(positions(from), is_inside));
  Cloth copy = from.clone();
  Cloth other = Cloth::create(from.model(), small_steps(backend)).value();
  run(other, 1.0 / 60, 3);
  REQUIRE(other.copy_state(from));
  for (Cloth* cloth : {&from, &copy, &other}) {
    REQUIRE(
        cloth->move_body(draped.ball, {.position = {0.04, 0.02, 0}, .rotation = {0, 0.1, 0, 1}}));
    run(*cloth, 1.0 / 60, 4);
  }
  CHECK(copy.state_hash() == from.state_hash());
  CHECK(other.state_hash() == from.state_hash());
}

/// Beads of 10 g, not joined: some inside a box, one far below its surface.
TEST_CASE("what is inside a body comes out slowly, and gains no speed") {
  const Backend backend = each_backend();
  SceneDescription scene;
  for (int i = 0; i < 6; ++i) {
    scene.positions.push_back({0.03 * i - 0.05, 0.095 - 0.008 * i, 0.01});
    scene.masses.push_back(0.01);
  }
  scene.gravity = {0, 0, 0};
  Cloth cloth = cloth_of(scene, small_steps(backend));
  add(cloth, {.shape = shape_of(box_mesh({0.3, 0.2, 0.3}, 3))});
  std::vector<Vec3> before = positions(cloth);
  for (int i = 0; i < 30; ++i) {
    step(cloth, 1.0 / 60);
    const std::vector<Vec3> now = positions(cloth);
    for (std::size_t k = 0; k < now.size(); ++k) CHECK(distance(now[k], before[k]) < 3.0 / 60);
    for (const Vec3 v : velocities(cloth)) CHECK(length(v) < 1e-3);
    before = now;
  }
  for (const Vec3 x : positions(cloth)) CHECK(x.y > 0.101 - 1e-5);
}

/// A bar that stands in the middle of a cell of a sheet, and touches no particle of it. It has two
/// sides: on which the sheet should be nothing tells.
TEST_CASE("cloth that crosses a mesh says so, is held by nothing, and comes apart") {
  const Backend backend = each_backend();
  const SceneDescription scene = sheet_over_origin(6, 0.11);
  Cloth cloth = cloth_of(scene, small_steps(backend));
  TriangleMesh bar = box_mesh({0.03, 0.2, 0.03}, 2);
  bar.two_sided = true;
  const Pose pose{.position = {0.01, 0.05, -0.01}};
  add(cloth, {.shape = shape_of(bar), .pose = pose});
  const std::vector<Vec3> vertices = placed(bar.vertices, pose);
  const auto crossing = [&] {
    const std::vector<Vec3> places = positions(cloth);
    return static_cast<int>(std::ranges::count_if(scene.surface, [&](const auto& triangle) {
      return count_crossings({places, {triangle}}, {vertices, bar.triangles}) > 0;
    }));
  };
  REQUIRE(crossing() > 0);
  int crossed = 0;
  std::optional<Cloth> copy;
  for (int i = 0; i < 30; ++i) {
    const StepReport report = step(cloth, 1.0 / 60);
    CHECK(report.contact_failures == 0);
    CHECK(report.intersecting == crossing());
    CHECK((report.status == Status::converged) == (report.intersecting == 0));
    CHECK(report.max_strain < 0.01);
    crossed += report.intersecting > 0;
    if (i == 3) copy = cloth.clone();
    if (i > 3) step(*copy, 1.0 / 60);
    CHECK((i < 3 || copy->state_hash() == cloth.state_hash()));
  }
  CHECK(crossed > 5);
  CHECK(cloth.position(14).y < -0.3);
  CHECK(crossing() == 0);
}

TEST_CASE("a body may be switched, placed and removed while it is touched, and come back") {
  const Backend backend = each_backend();
  Draped draped(backend);
  Cloth& cloth = draped.cloth;
  const auto ball = draped.ball;
  const auto top = [&] { return cloth.position(44).y; };
  run(cloth, 1.0 / 60, 60);
  REQUIRE(cloth.switch_body(ball, false));
  const double lies = top();
  run(cloth, 1.0 / 60, 2);
  CHECK(cloth.body_contacts().empty());
  CHECK(top() < lies - 1e-3);
  REQUIRE(cloth.place_body(ball, {.position = {0, -0.03, 0}}));
  REQUIRE(cloth.switch_body(ball, true));
  run(cloth, 1.0 / 60, 8);
  const std::size_t touching = cloth.body_contacts().size();
  CHECK(touching > 0);
  REQUIRE(cloth.remove_body(ball));
  CHECK(cloth.body_contacts().size() == touching);
  for (const BodyContact& contact : cloth.body_contacts()) {
    CHECK(contact.body == ball);
    CHECK(std::isfinite(contact.point.x + contact.normal.y + contact.push));
  }
  CHECK_FALSE(cloth.body_load(ball));
  CHECK_FALSE(cloth.move_body_vertices(ball, icosphere(0.1, 2).vertices));
  const double before = top();
  run(cloth, 1.0 / 60, 6);
  CHECK(cloth.body_contacts().empty());
  CHECK(top() < before - 0.02);
  const Vec3 under = cloth.position(44) + Vec3{0, -0.25, 0};
  const auto again =
      add(cloth, {.shape = shape_of(icosphere(0.1, 2)), .pose = {.position = under}});
  CHECK(again != ball);
  run(cloth, 1.0 / 60, 20);
  CHECK_FALSE(cloth.body_contacts().empty());
}

TEST_CASE("a step that fails leaves the cloth and what it did to bodies as they were") {
  Draped draped(each_backend());
  Cloth& cloth = draped.cloth;
  run(cloth, 1.0 / 60, 60);
  std::vector<Vec3> forces(cloth.particle_count());
  forces[3] = {1e300, 0, 0};
  REQUIRE(cloth.write_forces(forces));
  const std::uint64_t before = cloth.state_hash();
  REQUIRE(cloth.body_contacts().size() > 0);
  const double load = cloth.body_load(draped.ball).value().force.y;
  CHECK_FALSE(committed(step(cloth, 1e10).status));
  CHECK(cloth.state_hash() == before);
  CHECK(cloth.body_load(draped.ball).value().force.y == load);
  REQUIRE(cloth.write_forces({}));
  for (int i = 0; i < 5; ++i) CHECK(step(cloth, 1.0 / 60).intersecting == 0);
  CHECK(cloth.body_contacts().size() > 0);
}

TEST_CASE("cloths that share a shape, and bodies of all kinds together, are held as alone") {
  const auto shape = shape_of(icosphere(0.1, 2));
  Cloth a = cloth_of(sheet_over_origin(8, 0.12), small_steps());
  Cloth b = cloth_of(sheet_over_origin(8, 0.12), small_steps());
  Cloth alone = cloth_of(sheet_over_origin(8, 0.12), small_steps());
  for (Cloth* cloth : {&a, &b}) add(*cloth, {.shape = shape});
  add(alone, {.shape = shape_of(icosphere(0.1, 2))});
  std::vector<Vec3> swollen = icosphere(0.12, 2).vertices;
  REQUIRE(b.move_body_vertices(0, swollen));  // its own, not the shape's
  for (int i = 0; i < 10; ++i) {
    for (Cloth* cloth : {&a, &b, &alone}) step(*cloth, 1.0 / 60);
  }
  CHECK(a.state_hash() == alone.state_hash());
  CHECK(b.state_hash() != a.state_hash());
  const auto floor = add(a, {.shape = shape_of(Plane{{0, 1, 0}, -0.05})});
  run(a, 1.0 / 60, 120);
  const std::vector<BodyContact> contacts = a.body_contacts();
  const auto touches = [&](std::uint32_t id) {
    return std::ranges::any_of(contacts, [id](const BodyContact& c) { return c.body == id; });
  };
  CHECK(touches(0));
  CHECK(touches(floor));
  for (const Vec3 x : positions(a)) CHECK(x.y > -0.05);
}

TEST_CASE("cloth that rests on a mesh falls asleep, and wakes when the mesh moves") {
  Settings settings = small_steps();
  settings.sleep = true;
  Cloth cloth = cloth_of(sheet_over_origin(8, 2e-3), settings);
  const auto id = add(cloth, {.shape = shape_of(plane_mesh(2, 7))});
  StepReport last;
  for (int i = 0; i < 180; ++i) last = step(cloth, 1.0 / 60);
  bool asleep = last.asleep;
  CHECK(asleep);
  CHECK(last.body_contacts > 0);
  REQUIRE(cloth.move_body(id, {.position = {0, 0.05, 0}}));
  CHECK_FALSE(step(cloth, 1.0 / 60).asleep);
  for (const Vec3 x : positions(cloth)) CHECK(x.y > 0.0505);
  asleep = false;
  for (int i = 0; i < 180; ++i) asleep = step(cloth, 1.0 / 60).asleep;
  CHECK(asleep);
  std::vector<Vec3> vertices = plane_mesh(2, 7).vertices;
  for (Vec3& v : vertices) v.y += 0.01;
  REQUIRE(cloth.move_body_vertices(id, vertices));
  CHECK_FALSE(step(cloth, 1.0 / 60).asleep);
}

TEST_CASE("particles without a surface are held by meshes too") {
  const Backend backend = each_backend();
  SceneDescription scene;
  for (int i = 0; i < 30; ++i) {
    scene.positions.push_back({0.02 * (i % 6) - 0.05, 0.12 + 0.01 * i, 0.02 * (i / 6) - 0.05});
    scene.masses.push_back(0.01);
  }
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const TriangleMesh mesh = box_mesh({0.3, 0.2, 0.3}, 1);
  add(cloth, {.shape = shape_of(mesh), .friction = 1});
  for (int i = 0; i < 60; ++i) CHECK(step(cloth, 1.0 / 60).max_penetration < 1e-4);
  for (const Vec3 x : positions(cloth)) CHECK(std::abs(x.y - 0.101) < 2e-5);
}

/// A square of 0.1 m, held along one side. The tip of a body is under that side but for a
/// micrometre: what may move has a small part in what the tip touches.
TEST_CASE("a particle with a small part in a touch is not thrown") {
  const Backend backend = each_backend();
  MeshDescription mesh = quads(2);
  for (Vec3& v : mesh.positions) v = {0.1 * v.x, 0, 0.1 * v.y};
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (mesh.positions[i].x == 0) mesh.pins.push_back(i);
  }
  mesh.material = find_material("cotton").value();
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {};
  Cloth cloth = cloth_of(scene, small_steps(backend));
  const TriangleMesh tip{
      .vertices = {{0, 0, 0}, {0.01, -0.02, 0}, {-0.005, -0.02, 0.008}, {-0.005, -0.02, -0.008}},
      .triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
  add(cloth, {.shape = shape_of(tip), .pose = {.position = {1e-6, -0.0005, 0.043}}});
  for (int i = 0; i < 30; ++i) {
    step(cloth, 1.0 / 60);
    CHECK(largest_distance(positions(cloth), scene.positions) < 0.01);
  }
  CHECK(cloth.body_contacts().size() > 0);
}

/// All particles are out: nothing tells but what leads through.
TEST_CASE("cloth that a corner or an edge of a mesh leads through comes off it") {
  const Backend backend = each_backend();
  for (const bool with_edge : {false, true}) {
    CAPTURE(with_edge);
    const SceneDescription scene = sheet_over_origin(with_edge ? 5 : 8, 0);
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const TriangleMesh mesh = with_edge ? knife_mesh(1.5, 0.1, 0.06, 1) : icosphere(0.1, 0);
    double top = -1;
    for (const Vec3 v : mesh.vertices) top = std::max(top, v.y);
    const Pose pose{.position = {0.02, 1e-3 - top, 0.03}};
    add(cloth, {.shape = shape_of(mesh), .pose = pose});
    const std::vector<Vec3> at = placed(mesh.vertices, pose);
    const auto crossings = [&] {
      const std::vector<Vec3> x = positions(cloth);
      return count_crossings({x, scene.surface}, {at, mesh.triangles});
    };
    REQUIRE(crossings() > 0);
    for (int i = 0; i < 60; ++i) step(cloth, 1.0 / 60);
    CHECK(crossings() == 0);
  }
}

/// Of a sheet that is worth two threads and lies down on a ball, which then goes on.
std::uint64_t hash_beside_ball(const std::shared_ptr<const Model>& model, int threads) {
  tbb::task_arena arena(threads);
  return arena.execute([&] {
    auto made = Cloth::create(model, {.substeps = 12, .solver = Solver::small_steps});
    REQUIRE(made);
    Cloth& cloth = made.value();
    const auto ball = add(cloth, {.shape = shape_of(icosphere(0.1, 3)), .thickness = 2e-3});
    int contacts = 0;
    for (int frame = 0; frame < 6; ++frame) {
      REQUIRE(cloth.move_body(ball, {.position = {0.002 * frame, 0, 0}}));
      contacts = std::max(contacts, step(cloth, 1. / 60).body_contacts);
    }
    CHECK(contacts > 20);
    return cloth.state_hash();
  });
}

TEST_CASE("the number of threads changes no bit of a cloth beside a mesh") {
  const auto model = model_of(sheet_over_origin(48, 0.1025));
  const std::uint64_t alone = hash_beside_ball(model, 1);
  for (const int threads : {2, 3}) CHECK(hash_beside_ball(model, threads) == alone);
}

}  // namespace
}  // namespace weft::test::engine_contact_mesh_bodies
