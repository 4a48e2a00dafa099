/// What a host makes in C, meshes, shapes, batches, saved models and reports, is what it is in C++.
#include <doctest/doctest.h>
#include <weft/report_fields.h>
#include <weft/surface.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/c_interface/report.h"
#include "tests/support/c_interface.h"
#include "tests/support/c_twins.h"
#include "tests/support/clothes.h"
#include "tests/support/job_systems.h"

namespace weft::test::engine_c_interface_same_parts {
namespace {

using namespace c_twins;

/// A report in which no two fields have the same value.
StepReport report_of_different_values() {
  StepReport report;
  int value = 0;
  for_each_report_field([&]<class T>(const ReportField<T>& field) {
    ++value;
    if constexpr (std::is_same_v<T, Status>)
      report.*field.member = Status::infeasible;
    else if constexpr (requires { report.*field.member = T(value); })
      report.*field.member = T(value);
  });
  for (double& seconds : report.stage_seconds) seconds = ++value;
  report.contact_ms = {value + 1., value + 2., value + 3.};
  return report;
}

TEST_CASE("each field of a report has its name in C, too") {
  const StepReport report = report_of_different_values();
  const weft_report in_c = c_interface::report_of(report);
  CHECK(in_c.size == sizeof in_c);
  check_equal(in_c, report);
  for (std::size_t stage = 0; stage < kStageCount; ++stage)
    CHECK(in_c.stage_seconds[stage] == report.stage_seconds[stage]);
  CHECK(in_c.contact_ms.find == report.contact_ms.find);
  CHECK(in_c.contact_ms.sweep == report.contact_ms.sweep);
  CHECK(in_c.contact_ms.verify == report.contact_ms.verify);
}

TEST_CASE("states and models that are saved are the same bytes, and go on") {
  std::uint32_t body = 0;
  Both b = on_a_ball(body);
  const auto state =
      made<weft_bytes>([&](weft_bytes** out) { return weft_save_state(b.c.get(), out); });
  const std::vector<std::byte> expected = b.cpp.save_state();
  REQUIRE(weft_bytes_size(state.get()) == expected.size());
  CHECK(std::memcmp(weft_bytes_data(state.get()), expected.data(), expected.size()) == 0);

  const auto model =
      made<weft_model>([&](weft_model** out) { return weft_model_of(b.c.get(), out); });
  const auto cooked =
      made<weft_bytes>([&](weft_bytes** out) { return weft_save_model(model.get(), out); });
  CHECK(weft_bytes_size(cooked.get()) == save_model(*b.cpp.model()).size());
  const auto again = made<weft_model>([&](weft_model** out) {
    return weft_load_model(weft_bytes_data(cooked.get()), weft_bytes_size(cooked.get()), out);
  });
  const auto resumed = made<weft_cloth>(
      [&](weft_cloth** out) { return weft_create_cloth(again.get(), nullptr, out); });
  REQUIRE(weft_load_state(resumed.get(), weft_bytes_data(state.get()),
                          weft_bytes_size(state.get())) == WEFT_OK);
  const auto copy =
      made<weft_cloth>([&](weft_cloth** out) { return weft_clone_cloth(b.c.get(), out); });
  const auto other = made<weft_cloth>(
      [&](weft_cloth** out) { return weft_create_cloth(model.get(), nullptr, out); });
  REQUIRE(weft_copy_state(other.get(), b.c.get()) == WEFT_OK);
  step_both(b, 0.01);
  for (weft_cloth* cloth : {resumed.get(), copy.get(), other.get()}) {
    REQUIRE(weft_step(cloth, 0.01, nullptr, nullptr) == WEFT_OK);
    CHECK(weft_state_hash(cloth) == b.cpp.state_hash());
  }
}

TEST_CASE("batches, by the threads of a host too; one that is null does not keep others from it") {
  Both first = both(scene_of("hang", 64), {}), second = both(scene_of("corners", 9), {});
  Pool pool(2);
  const JobSystem system = pool.jobs();
  struct Host {
    const JobSystem* system;
    int runs;
  } host{&system, 0};
  auto jobs = initial(weft_init_jobs);
  jobs.host = &host;
  jobs.threads = [](void* it) {
    const JobSystem& its = *static_cast<Host*>(it)->system;
    return its.threads(its.host);
  };
  jobs.run = [](void* it, void (*job)(void*), void* context, int times) {
    auto& asked = *static_cast<Host*>(it);
    ++asked.runs;
    struct Call {
      void (*job)(void*);
      void* context;
    } call{job, context};
    const auto make = [](void* c) noexcept {
      static_cast<Call*>(c)->job(static_cast<Call*>(c)->context);
    };
    asked.system->run(asked.system->host, {make, &call}, times);
  };
  std::vector<weft_batch_step> steps(3, initial(weft_init_batch_step));
  steps[0].cloth = first.c.get(), steps[0].dt = 0.01;
  steps[1].dt = 0.01;
  steps[2].cloth = second.c.get(), steps[2].dt = 0.02;
  for (const weft_jobs* by :
       {static_cast<const weft_jobs*>(nullptr), static_cast<const weft_jobs*>(&jobs)}) {
    REQUIRE(weft_step_all(steps.size(), steps.data(), by) == WEFT_OK);
    const StepReport one = step(first.cpp, 0.01), two = step(second.cpp, 0.02);
    CHECK(steps[0].result == WEFT_OK);
    CHECK(steps[1].result == WEFT_REFUSED);
    CHECK(std::string(steps[1].message) != "");
    CHECK(steps[2].result == WEFT_OK);
    check_equal(steps[0].report, one);
    check_equal(steps[2].report, two);
    check_equal(first), check_equal(second);
  }
  CHECK(host.runs > 0);
}

TEST_CASE("meshes, what is found in them, and surfaces") {
  CottonSheet cotton;
  auto counts = initial(weft_init_mesh_counts);
  REQUIRE(weft_counts_of(cotton.made_in_c.get(), &counts) == WEFT_OK);
  CHECK(counts.quads == cotton.made_in_cpp.counts.quads);
  CHECK(counts.pieces == cotton.made_in_cpp.counts.pieces);
  REQUIRE(weft_cell_count(cotton.made_in_c.get()) == cotton.made_in_cpp.cells.size());
  CHECK(weft_cells(cotton.made_in_c.get())[5] == cotton.made_in_cpp.cells[1][1]);
  CHECK(weft_particle_of_vertex(cotton.made_in_c.get())[7] ==
        cotton.made_in_cpp.particle_of_vertex[7]);

  const MeshDescription fine = sheet(2 * kSheetSide - 1);
  const weft_mesh c_fine = mesh_in_c(fine);
  auto own = surface_of_mesh(cotton.mesh, cotton.made_in_cpp).value();
  auto mapped = map_surface(cotton.mesh, cotton.made_in_cpp, fine).value();
  const auto c_own = made<weft_surface>([&](weft_surface** out) {
    return weft_surface_of_mesh(&cotton.c_mesh, cotton.made_in_c.get(), out);
  });
  const auto c_mapped = made<weft_surface>([&](weft_surface** out) {
    return weft_map_surface(&cotton.c_mesh, cotton.made_in_c.get(), &c_fine, HUGE_VAL, out);
  });
  Both b = cotton.cloths();
  for (int frame = 0; frame < 5; ++frame) step_both(b, 1. / 60);
  const auto compare = [&](Surface& cpp, weft_surface* c) {
    REQUIRE(weft_surface_vertex_count(c) == cpp.vertex_count());
    REQUIRE(weft_surface_particle_count(c) == cpp.particle_count());
    REQUIRE(weft_surface_triangle_count(c) == cpp.triangles().size());
    CHECK(weft_surface_triangles(c)[4] == cpp.triangles()[1][1]);
    std::vector<float> in_c(6 * cpp.vertex_count()), in_cpp(in_c);
    REQUIRE(weft_read_vertices(c, b.c.get(), {in_c.data(), in_c.size(), 6},
                               {in_c.data() + 3, in_c.size() - 3, 6}, nullptr) == WEFT_OK);
    REQUIRE(cpp.read_vertices(b.cpp, {in_cpp, 6}, {std::span(in_cpp).subspan(3), 6}));
    CHECK(in_c == in_cpp);
  };
  compare(own, c_own.get());
  compare(mapped, c_mapped.get());
  const auto c_clone = made<weft_surface>(
      [&](weft_surface** out) { return weft_clone_surface(c_mapped.get(), out); });
  compare(mapped, c_clone.get());

  Both other = both(cloth_from_mesh(fine).value().scene, {});
  REQUIRE(mapped.copy_shape(b.cpp, other.cpp));
  REQUIRE(weft_copy_shape(c_mapped.get(), b.c.get(), other.c.get()) == WEFT_OK);
  step_both(other, 0.01);
}

TEST_CASE("shapes of every kind") {
  const double up[3] = {0, 1, 0}, low[3] = {0, -0.1, 0.1}, lower[3] = {0, -0.4, 0},
               edges[3] = {0.3, 0.2, 0.3};
  const std::vector<Vec3> corners{{-0.5, -1, -0.5}, {0.5, -1, -0.5}, {-0.5, -1, 0.5}, {0, 0.2, 0}};
  const std::vector<std::uint32_t> faces{0, 1, 3, 1, 2, 3, 2, 0, 3, 0, 2, 1};
  const TriangleMesh mesh{corners, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}, true};
  std::vector<std::pair<ShapeDescription, Owned<weft_shape>>> shapes;
  const auto add = [&](ShapeDescription shape, const auto& make) {
    shapes.emplace_back(std::move(shape), made<weft_shape>(make));
  };
  add(Plane{{0, 1, 0}, -0.1}, [&](weft_shape** out) { return weft_plane(up, -0.1, out); });
  add(Ball{{0, -0.1, 0.1}, 0.2}, [&](weft_shape** out) { return weft_ball(low, 0.2, out); });
  add(Capsule{{0, -0.1, 0.1}, {0, -0.4, 0}, 0.1, 0.2},
      [&](weft_shape** out) { return weft_capsule(low, lower, 0.1, 0.2, out); });
  add(box({0.3, 0.2, 0.3}), [&](weft_shape** out) { return weft_box(edges, out); });
  add(Hull{corners}, [&](weft_shape** out) { return weft_hull(4, numbers(corners), out); });
  add(mesh, [&](weft_shape** out) {
    return weft_triangle_mesh(4, numbers(corners), 4, faces.data(), 1, out);
  });
  const std::vector<double> heights{-0.1, -0.3, 0, -0.1, -0.2, -0.1};
  add(HeightField{3, 2, 0.4, 0.6, heights},
      [&](weft_shape** out) { return weft_height_field(3, 2, 0.4, 0.6, heights.data(), out); });
  add(Torus{{0, -0.1, 0.1}, {0, 1, 0}, 0.3, 0.1},
      [&](weft_shape** out) { return weft_torus(low, up, 0.3, 0.1, out); });
  for (const auto& [shape, c_shape] : shapes) {
    Both b = CottonSheet().cloths();
    auto body = initial(weft_init_body);
    body.shape = c_shape.get();
    body.position[0] = 0.5, body.position[1] = -0.3, body.position[2] = 0.5;
    std::uint32_t id = 0;
    REQUIRE(weft_add_body(b.c.get(), &body, &id) == WEFT_OK);
    REQUIRE(b.cpp.add_body({.shape = build_shape(shape).value(), .pose = {{0.5, -0.3, 0.5}, {}}}));
    for (int frame = 0; frame < 12; ++frame) step_both(b, 1. / 60);
    if (!std::holds_alternative<TriangleMesh>(shape)) continue;
    std::vector<Vec3> moved = corners;
    for (Vec3& corner : moved) corner.y += 0.01;
    REQUIRE(b.cpp.move_body_vertices(id, moved));
    REQUIRE(weft_move_body_vertices(b.c.get(), id, 4, numbers(moved)) == WEFT_OK);
    step_both(b, 1. / 60);
    REQUIRE(b.cpp.place_body_vertices(id, corners));
    REQUIRE(weft_place_body_vertices(b.c.get(), id, 4, numbers(corners)) == WEFT_OK);
    step_both(b, 1. / 60);
  }
}

TEST_CASE("surfaces that follow tears are the same") {
  CottonSheet cotton(0.3);
  auto surface = surface_of_mesh(cotton.mesh, cotton.made_in_cpp).value();
  const auto c_surface = made<weft_surface>([&](weft_surface** out) {
    return weft_surface_of_mesh(&cotton.c_mesh, cotton.made_in_c.get(), out);
  });
  Both b = cotton.cloths();
  int changes = 0;
  for (int i = 0; i < 60; ++i) {
    step_both(b, 1. / 60);
    int changes_in_c = 2;
    REQUIRE(weft_follow(c_surface.get(), b.c.get(), &changes_in_c) == WEFT_OK);
    const auto follows = surface.follow(b.cpp);
    REQUIRE(follows);
    CHECK(changes_in_c == follows.value());
    changes += changes_in_c;
    REQUIRE(weft_surface_vertex_count(c_surface.get()) == surface.vertex_count());
    REQUIRE(weft_surface_split_count(c_surface.get()) == surface.split_from().size());
    CHECK(std::ranges::equal(
        std::span(weft_surface_split_from(c_surface.get()), surface.split_from().size()),
        surface.split_from()));
    std::vector<float> in_c(3 * surface.vertex_count()), in_cpp(in_c);
    REQUIRE(weft_read_vertices(c_surface.get(), b.c.get(), {in_c.data(), in_c.size(), 3}, {},
                               nullptr) == WEFT_OK);
    REQUIRE(surface.read_vertices(b.cpp, {in_cpp}));
    CHECK(in_c == in_cpp);
  }
  CHECK(changes > 0);
}

TEST_CASE("a body with a mass moves in C as in C++") {
  Both b = CottonSheet().cloths();
  const auto shape = build_shape(Ball{{}, 0.2}).value();
  const double centre[3] = {};
  const auto c_shape =
      made<weft_shape>([&](weft_shape** out) { return weft_ball(centre, 0.2, out); });
  auto body = initial(weft_init_body);
  CHECK(body.mass == 0);
  body.shape = c_shape.get();
  body.position[0] = 0.5, body.position[1] = 0.3, body.position[2] = 0.5;
  REQUIRE(weft_give_mass(&body, 20) == WEFT_OK);
  const BodyMass mass = mass_of(*shape, 20).value();
  CHECK(body.mass == mass.mass);
  CHECK(body.inertia[2] == mass.inertia[2]);
  std::uint32_t id = 0;
  REQUIRE(weft_add_body(b.c.get(), &body, &id) == WEFT_OK);
  REQUIRE(b.cpp.add_body({.shape = shape, .pose = {{0.5, 0.3, 0.5}, {}}, .mass = mass}));
  const double linear[3] = {0.1, 0, 0}, angular[3] = {0, 1, 0}, force[3] = {0, 0, 0.2},
               moment[3] = {};
  REQUIRE(weft_set_body_velocity(b.c.get(), id, linear, angular) == WEFT_OK);
  REQUIRE(b.cpp.set_body_velocity(id, {{0.1, 0, 0}, {0, 1, 0}}));
  REQUIRE(weft_set_body_force(b.c.get(), id, force, moment) == WEFT_OK);
  REQUIRE(b.cpp.set_body_force(id, {0, 0, 0.2}, {}));
  for (int frame = 0; frame < 12; ++frame) step_both(b, 1. / 60);
  double position[3], rotation[4], speed[3], spin[3];
  REQUIRE(weft_body_pose_of(b.c.get(), id, position, rotation) == WEFT_OK);
  REQUIRE(weft_body_velocity_of(b.c.get(), id, speed, spin) == WEFT_OK);
  const Pose pose = b.cpp.body_pose(id).value();
  CHECK(position[1] == pose.position.y);
  CHECK(position[1] < 0.3);
  CHECK(rotation[1] == pose.rotation.y);
  CHECK(speed[2] == b.cpp.body_velocity(id).value().linear.z);
  CHECK(spin[1] == b.cpp.body_velocity(id).value().angular.y);
  CHECK(weft_body_velocity_of(b.c.get(), 9, speed, spin) == WEFT_REFUSED);
}

}  // namespace
}  // namespace weft::test::engine_c_interface_same_parts
