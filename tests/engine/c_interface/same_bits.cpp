/// What is done in C comes to the bits that it comes to in C++.
#include <doctest/doctest.h>
#include <weft/report_fields.h>
#include <weft/surface.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/c_interface/report.h"
#include "engine/c_interface/scene_arrays.h"
#include "tests/support/c_interface.h"
#include "tests/support/clothes.h"
#include "tests/support/job_systems.h"
#include "tests/support/random_cases.h"

namespace weft::test::engine_c_interface_same_bits {
namespace {

/// The same cloth twice, in C++ and in C.
struct Both {
  Cloth cpp;
  Owned<weft_cloth> c;
};

Owned<weft_model> model_in_c(const SceneDescription& scene) {
  const c_interface::SceneArrays arrays = c_interface::arrays_of(scene);
  const weft_scene its = c_interface::scene_of(scene, arrays);
  return made<weft_model>([&](weft_model** out) { return weft_build_model(&its, out); });
}

weft_settings settings_in_c(const Settings& s) {
  auto out = initial(weft_init_settings);
  out.tolerance = s.tolerance;
  out.substeps = s.substeps;
  out.iterations = s.iterations;
  out.renew_after = s.measuring.renew_after;
  out.max_iterations = s.max_iterations;
  out.contact_tolerance = s.contact_tolerance;
  out.velocity_tolerance = s.velocity_tolerance;
  out.motion_tolerance = s.motion_tolerance;
  out.impulse_limit = s.measuring.impulse_limit;
  out.solver = static_cast<int>(s.solver);
  out.scheme = static_cast<int>(s.scheme);
  out.backend = static_cast<int>(s.backend);
  out.isa = static_cast<int>(s.isa);
  out.threads = s.threads;
  out.directions = static_cast<int>(s.measuring.directions);
  out.anticipate = s.measuring.anticipate;
  out.anticipate_products = s.measuring.anticipate_products;
  out.sleep = s.sleep;
  out.skip = s.measuring.skip;
  out.velocity_correction = s.velocity_correction;
  return out;
}

Both both(const SceneDescription& scene, const Settings& settings) {
  const auto model = model_in_c(scene);
  const weft_settings its = settings_in_c(settings);
  return {cloth_of(scene, settings), made<weft_cloth>([&](weft_cloth** out) {
            return weft_create_cloth(model.get(), &its, out);
          })};
}

void check_equal(const Both& b) { CHECK(weft_state_hash(b.c.get()) == b.cpp.state_hash()); }

/// Every field but the times, which differ from run to run.
void check_equal(const weft_report& c, const StepReport& r) {
  CHECK(c.status == static_cast<int>(r.status));
  CHECK(bool(c.asleep) == r.asleep);
  CHECK(std::array{c.substeps, c.halvings, c.scheme_fallbacks, c.contacts, c.body_contacts,
                   c.contact_failures, c.zones, c.intersecting, c.self_contacts, c.tangled,
                   c.open_seams, c.late_seams, c.held_apart, c.torn} ==
        std::array{r.substeps, r.halvings, r.scheme_fallbacks, r.contacts, r.body_contacts,
                   r.contact_failures, r.zones, r.intersecting, r.self_contacts, r.tangled,
                   r.open_seams, r.late_seams, r.held_apart, r.torn});
  CHECK(std::array{c.iterations, c.direction_updates, c.velocity_iterations, c.visits,
                   c.corrections} == std::array{r.iterations, r.direction_updates,
                                                r.velocity_iterations, r.visits, r.corrections});
  CHECK(std::array{c.max_strain, c.rms_strain, c.max_shear, c.max_error, c.max_penetration,
                   c.max_anchor_error, c.max_seam_gap, c.seam_work, c.motion_error, c.energy_lost,
                   c.pin_work, c.body_work, c.friction_work, c.max_bending_error, c.untangling_work,
                   c.max_rail_gap} ==
        std::array{r.max_strain, r.rms_strain, r.max_shear, r.max_error, r.max_penetration,
                   r.max_anchor_error, r.max_seam_gap, r.seam_work, r.motion_error, r.energy_lost,
                   r.pin_work, r.body_work, r.friction_work, r.max_bending_error, r.untangling_work,
                   r.max_rail_gap});
  CHECK(std::array{c.worst_constraint, c.worst_element, c.failed_particle, c.passed_particle,
                   c.worst_seam, c.worst_held} == std::array{r.worst_constraint, r.worst_element,
                                                             r.failed_particle, r.passed_particle,
                                                             r.worst_seam, r.worst_held});
}

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

void step_both(Both& b, double dt) {
  auto report = initial(weft_init_report);
  const auto expected = b.cpp.step(dt);
  REQUIRE(weft_step(b.c.get(), dt, nullptr, &report) == (expected ? WEFT_OK : WEFT_REFUSED));
  if (!expected) {
    CHECK(weft_last_message() == expected.error());
    return;
  }
  check_equal(report, expected.value());
  CHECK((report.contact_ms.find > 0) == (expected.value().contact_ms.find > 0));
  CHECK((report.contact_ms.sweep > 0) == (expected.value().contact_ms.sweep > 0));
  check_equal(b);
}

constexpr std::uint32_t kSide = 13;

MeshDescription sheet(std::uint32_t side) {
  MeshDescription mesh;
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      mesh.positions.push_back({column / (side - 1.), 0, row / (side - 1.)});
      if (row == 0 || column == 0) continue;
      const std::uint32_t last = row * side + column;
      mesh.corners.insert(mesh.corners.end(), {last - side - 1, last - side, last, last - 1});
      mesh.face_sizes.push_back(4);
    }
  }
  mesh.pins = {0, side - 1};
  return mesh;
}

weft_mesh mesh_in_c(const MeshDescription& mesh) {
  auto out = initial(weft_init_mesh);
  out.vertex_count = mesh.positions.size();
  out.positions = numbers(mesh.positions);
  out.corner_count = mesh.corners.size();
  out.corners = mesh.corners.data();
  out.face_count = mesh.face_sizes.size();
  out.face_sizes = mesh.face_sizes.data();
  out.pin_count = mesh.pins.size();
  out.pins = mesh.pins.data();
  return out;
}

struct CottonSheet {
  MeshDescription mesh = sheet(kSide);
  weft_mesh c_mesh = mesh_in_c(mesh);
  weft_material c_material = initial(weft_init_material);
  MeshCloth made_in_cpp;
  Owned<weft_mesh_cloth> made_in_c;

  CottonSheet() {
    mesh.material = find_material("cotton").value();
    mesh.material->friction = 0.45;
    REQUIRE(weft_find_material("cotton", &c_material) == WEFT_OK);
    c_material.friction = 0.45;
    c_mesh.material = &c_material;
    made_in_cpp = cloth_from_mesh(mesh).value();
    made_in_c = made<weft_mesh_cloth>(
        [&](weft_mesh_cloth** out) { return weft_cloth_from_mesh(&c_mesh, out); });
  }

  Both cloths() const {
    auto scene = initial(weft_init_scene);
    REQUIRE(weft_scene_of(made_in_c.get(), &scene) == WEFT_OK);
    CHECK(scene.self_contact_thickness == c_material.thickness);
    CHECK(scene.self_contact_friction == 0.45);
    CHECK(scene.self_contact_untangle == 0);
    const auto model =
        made<weft_model>([&](weft_model** out) { return weft_build_model(&scene, out); });
    return {cloth_of(made_in_cpp.scene, {}), made<weft_cloth>([&](weft_cloth** out) {
              return weft_create_cloth(model.get(), nullptr, out);
            })};
  }
};

std::uint32_t add_ball(Both& b) {
  const auto shape = build_shape(Ball{{}, 0.2}).value();
  const double centre[3] = {};
  const auto c_shape =
      made<weft_shape>([&](weft_shape** out) { return weft_ball(centre, 0.2, out); });
  auto body = initial(weft_init_body);
  body.shape = c_shape.get();
  body.position[0] = 0.5, body.position[1] = -0.25, body.position[2] = 0.5;
  body.friction = 0.4;
  const auto id =
      b.cpp.add_body({.shape = shape, .pose = {{0.5, -0.25, 0.5}, {}}, .friction = 0.4});
  std::uint32_t c_id = 99;
  REQUIRE(weft_add_body(b.c.get(), &body, &c_id) == WEFT_OK);
  REQUIRE(id.value() == c_id);
  return c_id;
}

/// What moves a cloth between frames: pins, a body, forces, wind, gravity.
void disturb(Both& b, std::uint32_t body, int frame) {
  const std::array<std::uint32_t, 2> pins{0, kSide - 1};
  const std::vector<Vec3> places{{0.01 * frame, 0, 0}, {1, 0.005 * frame, 0}};
  REQUIRE(b.cpp.move_fixed(pins, places));
  REQUIRE(weft_move_fixed(b.c.get(), 2, pins.data(), numbers(places)) == WEFT_OK);

  const Pose pose{{0.5, -0.25 + 0.004 * frame, 0.5}, {0, std::sin(0.02), 0, std::cos(0.02)}};
  const Rotation& r = pose.rotation;
  const double position[3] = {0.5, -0.25 + 0.004 * frame, 0.5}, rotation[4] = {r.x, r.y, r.z, r.w};
  REQUIRE(b.cpp.move_body(body, pose));
  REQUIRE(weft_move_body(b.c.get(), body, position, rotation) == WEFT_OK);

  const std::vector<Vec3> forces(b.cpp.particle_count(), Vec3{0, 0, 1e-4 * frame});
  REQUIRE(b.cpp.write_forces(forces));
  REQUIRE(weft_write_forces(b.c.get(), forces.size(), numbers(forces)) == WEFT_OK);
  const double wind[3] = {1, 0, 0.5}, gravity[3] = {0, -9.8, 0.1};
  REQUIRE(b.cpp.set_wind({1, 0, 0.5}));
  REQUIRE(weft_set_wind(b.c.get(), wind) == WEFT_OK);
  REQUIRE(b.cpp.set_gravity({0, -9.8, 0.1}));
  REQUIRE(weft_set_gravity(b.c.get(), gravity) == WEFT_OK);
}

void check_same_readings(const Both& b) {
  const std::size_t n = b.cpp.particle_count();
  REQUIRE(weft_particle_count(b.c.get()) == n);
  std::vector<double> read(3 * n);
  REQUIRE(weft_read_positions(b.c.get(), n, read.data()) == WEFT_OK);
  CHECK(std::memcmp(read.data(), positions(b.cpp).data(), 24 * n) == 0);
  REQUIRE(weft_read_velocities(b.c.get(), n, read.data()) == WEFT_OK);
  CHECK(std::memcmp(read.data(), velocities(b.cpp).data(), 24 * n) == 0);

  const double origin[3] = {0.5, 0, 0};
  std::vector<float> in_c(5 * n), in_cpp(5 * n);
  REQUIRE(weft_read_float_positions(b.c.get(), {in_c.data(), in_c.size(), 5}, origin) == WEFT_OK);
  REQUIRE(b.cpp.read_positions({in_cpp, 5}, {0.5, 0, 0}));
  CHECK(in_c == in_cpp);
  REQUIRE(weft_read_float_velocities(b.c.get(), {in_c.data(), in_c.size(), 5}) == WEFT_OK);
  REQUIRE(b.cpp.read_velocities({in_cpp, 5}));
  CHECK(in_c == in_cpp);

  double place[3], least[3], most[3];
  REQUIRE(weft_position(b.c.get(), 5, place) == WEFT_OK);
  CHECK(place[1] == b.cpp.position(5).y);
  REQUIRE(weft_velocity(b.c.get(), 5, place) == WEFT_OK);
  CHECK(place[1] == b.cpp.velocity(5).y);
  REQUIRE(weft_bounds(b.c.get(), least, most) == WEFT_OK);
  CHECK(least[1] == b.cpp.bounds().least.y);
  CHECK(most[2] == b.cpp.bounds().most.z);
}

void check_same_measures(const Both& b) {
  auto strain = initial(weft_init_strain);
  REQUIRE(weft_strain_of(b.c.get(), &strain) == WEFT_OK);
  const Strain expected = b.cpp.strain();
  CHECK(std::array{strain.max, strain.rms, strain.max_shear} ==
        std::array{expected.max, expected.rms, expected.max_shear});
  CHECK(strain.worst_constraint == expected.worst_constraint);
  CHECK(strain.worst_element == expected.worst_element);
  auto energy = initial(weft_init_energy);
  REQUIRE(weft_energy_of(b.c.get(), &energy) == WEFT_OK);
  const Energy e = b.cpp.energy();
  CHECK(std::array{energy.kinetic, energy.potential, energy.elastic} ==
        std::array{e.kinetic, e.potential, e.elastic});
  CHECK(weft_max_penetration(b.c.get()) == b.cpp.max_penetration());
}

void check_same_touch(const Both& b, std::uint32_t body) {
  auto load = initial(weft_init_body_load);
  REQUIRE(weft_body_load_of(b.c.get(), body, &load) == WEFT_OK);
  const BodyLoad expected = b.cpp.body_load(body).value();
  CHECK(load.force[1] == expected.force.y);
  CHECK(load.moment[0] == expected.moment.x);

  const std::vector<BodyContact> contacts = b.cpp.body_contacts();
  std::vector<weft_body_contact> in_c(contacts.size() + 1, initial(weft_init_body_contact));
  std::size_t count = 0;
  REQUIRE(weft_body_contacts(b.c.get(), in_c.size(), in_c.data(), &count) == WEFT_OK);
  REQUIRE(count == contacts.size());
  REQUIRE(count > 0);
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(in_c[i].particle == contacts[i].particle);
    CHECK(in_c[i].body == contacts[i].body);
    CHECK(in_c[i].point[1] == contacts[i].point.y);
    CHECK(in_c[i].normal[2] == contacts[i].normal.z);
    CHECK(in_c[i].push == contacts[i].push);
  }
}

/// Cotton that has fallen on a ball.
Both on_a_ball(std::uint32_t& body) {
  Both b = CottonSheet().cloths();
  body = add_ball(b);
  for (int frame = 1; frame <= 30; ++frame) {
    disturb(b, body, frame);
    step_both(b, 1. / 60);
  }
  return b;
}

TEST_CASE("cotton with pins, a body, forces and wind comes to the same bits in C and C++") {
  std::uint32_t body = 0;
  const Both b = on_a_ball(body);
  check_same_readings(b);
  check_same_measures(b);
  check_same_touch(b, body);
}

TEST_CASE("cloths of every kind, settings and element do") {
  const auto compare = [](const RandomCase& c) {
    Both b = both(c.scene, c.settings);
    REQUIRE(b.cpp.write_forces(c.forces));
    REQUIRE(weft_write_forces(b.c.get(), c.forces.size(), numbers(c.forces)) == WEFT_OK);
    for (int frame = 0; frame < 3; ++frame) step_both(b, c.dt);
  };
  for_each_case(15, random_case, compare);
  for_each_case(5, softened_case, compare);
  for_each_case(5, fabric_case, compare);
}

TEST_CASE("what is carried, teleported, written, placed and changed") {
  std::uint32_t body = 0;
  Both b = on_a_ball(body);
  const double along[3] = {0.1, 0, 0}, turn[3] = {0, 0.2, 0}, about[3] = {0.5, 0, 0.5};
  REQUIRE(b.cpp.carry({{0.1, 0, 0}, {0, 0.2, 0}, {0.5, 0, 0.5}}, 0.5));
  REQUIRE(weft_carry(b.c.get(), along, turn, about, 0.5) == WEFT_OK);
  step_both(b, 0.01);
  REQUIRE(b.cpp.teleport({{0.1, 0, 0}, {}, {}}));
  REQUIRE(weft_teleport(b.c.get(), along, nullptr, nullptr) == WEFT_OK);
  step_both(b, 0.01);

  const std::vector<Vec3> still(b.cpp.particle_count());
  REQUIRE(b.cpp.write_velocities(still));
  REQUIRE(weft_write_velocities(b.c.get(), still.size(), numbers(still)) == WEFT_OK);
  step_both(b, 0.01);
  const std::vector<Vec3> places = positions(b.cpp);
  REQUIRE(b.cpp.write_positions(places));
  REQUIRE(weft_write_positions(b.c.get(), places.size(), numbers(places)) == WEFT_OK);
  step_both(b, 0.01);

  const std::uint32_t pin = 0;
  REQUIRE(b.cpp.place_fixed(pin, {0.2, 0.1, 0}));
  const double place[3] = {0.2, 0.1, 0};
  REQUIRE(weft_place_fixed(b.c.get(), 1, &pin, place) == WEFT_OK);
  step_both(b, 0.01);

  const std::uint32_t fixed = 40, spring = 3;
  const double mass = 0.01, compliance = 1e-3;
  auto changes = initial(weft_init_changes);
  changes.fix_count = 1, changes.fix = &fixed;
  changes.release_count = 1, changes.release = &pin;
  changes.mass_count = 1, changes.mass_particles = &fixed, changes.masses = &mass;
  changes.compliance_count = 1, changes.compliance_constraints = &spring;
  changes.compliances = &compliance;
  changes.change_damping = 1, changes.damping_motion = 0.5;
  changes.change_air = 1, changes.air_density = 1.2, changes.air_drag = 1;
  REQUIRE(weft_change(b.c.get(), &changes) == WEFT_OK);
  REQUIRE(b.cpp.change({.fix = {fixed},
                        .release = {pin},
                        .masses = {{fixed, mass}},
                        .compliances = {{spring, compliance}},
                        .damping = Damping{0, 0, 0.5},
                        .air = ChangedAir{1.2, 1, 0}}));
  step_both(b, 0.01);

  REQUIRE(b.cpp.switch_body(body, false));
  REQUIRE(weft_switch_body(b.c.get(), body, 0) == WEFT_OK);
  step_both(b, 0.01);
  const double origin[3] = {};
  REQUIRE(b.cpp.place_body(body, {}));
  REQUIRE(weft_place_body(b.c.get(), body, origin, nullptr) == WEFT_OK);
  REQUIRE(weft_switch_body(b.c.get(), body, 1) == WEFT_OK);
  REQUIRE(b.cpp.switch_body(body, true));
  step_both(b, 0.01);
  REQUIRE(b.cpp.remove_body(body));
  REQUIRE(weft_remove_body(b.c.get(), body) == WEFT_OK);
  step_both(b, 0.01);
}

TEST_CASE("anchors that are moved, limited and scaled") {
  SceneDescription scene = scene_of("hang", 8);
  scene.anchors.push_back({.particle = 30, .point = scene.positions[30], .max_distance = 0.1});
  scene.anchors.push_back({.particle = 40, .point = scene.positions[40], .max_distance = 0.1});
  Both b = both(scene, {});
  const std::vector<Vec3> points{{0, 0.1, 0}, {0.5, 0.1, 0}};
  REQUIRE(b.cpp.move_anchors(points));
  REQUIRE(weft_move_anchors(b.c.get(), 2, numbers(points), nullptr) == WEFT_OK);
  step_both(b, 0.01);
  const double limits[2] = {0.05, HUGE_VAL};
  const std::uint8_t backstops[2] = {1, 0};
  REQUIRE(b.cpp.limit_anchors(std::array{AnchorLimit{0.05, true}, AnchorLimit{HUGE_VAL, false}}));
  REQUIRE(weft_limit_anchors(b.c.get(), 2, limits, backstops) == WEFT_OK);
  step_both(b, 0.01);
  REQUIRE(b.cpp.limit_anchor(1, {0.2, true}));
  REQUIRE(weft_limit_anchor(b.c.get(), 1, 0.2, 1) == WEFT_OK);
  REQUIRE(b.cpp.scale_anchors(0.5));
  REQUIRE(weft_scale_anchors(b.c.get(), 0.5) == WEFT_OK);
  step_both(b, 0.01);
}

TEST_CASE("seams that are released and closed") {
  SceneDescription scene = scene_of("hang", 8);
  scene.seams = {{30, 40, 0.5}, {31, 41, 0.5}};
  Both b = both(scene, {});
  step_both(b, 0.01);
  const std::uint32_t seams[2] = {1, 0};
  REQUIRE(b.cpp.release_seams(seams));
  REQUIRE(weft_release_seams(b.c.get(), 2, seams) == WEFT_OK);
  step_both(b, 0.01);
  REQUIRE(b.cpp.close_seams({seams, 1}));
  REQUIRE(weft_close_seams(b.c.get(), 1, seams) == WEFT_OK);
  step_both(b, 0.01);
}

TEST_CASE("sliders, and a shape at rest that changes") {
  SceneDescription scene = scene_of("hang", 8);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const double x : {-1., 2.}) {
    scene.positions.push_back({x, scene.positions[60].y, scene.positions[60].z});
    scene.masses.push_back(1);
    scene.fixed.push_back(first + (x > 0));
    scene.rail_particles.push_back(first + (x > 0));
  }
  scene.sliders = {{60, 0, 1, 0.2}};
  Both b = both(scene, {});
  step_both(b, 0.01);
  const c_interface::SceneArrays arrays = c_interface::arrays_of(scene);
  const weft_scene in_c = c_interface::scene_of(scene, arrays);
  REQUIRE(b.cpp.set_rest_shape(scene, 1.01));
  REQUIRE(weft_set_rest_shape(b.c.get(), &in_c, 1.01) == WEFT_OK);
  step_both(b, 0.01);
}

/// A tetrahedron that nothing joins, in wind.
SceneDescription blown() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  scene.masses = {1, 2, 3, 4};
  scene.surface = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  scene.air.triangles = {{1, 2, 3}};
  scene.air.ram = 1.3;
  scene.air.wind = {3, 0, 1};
  scene.pressures = {{.pressure = 20, .triangles = {1, 3}},
                     {.pressure = 500, .gas = true, .volume = 0.1, .ambient = 9000}};
  return scene;
}

TEST_CASE("pressures of a scene, and others that are set") {
  Both b = both(blown(), {});
  step_both(b, 0.01);
  REQUIRE(b.cpp.pressures().size() == 2);
  std::array<double, 2> pressures{}, volumes{};
  REQUIRE(weft_read_pressures(b.c.get(), 2, pressures.data(), volumes.data()) == WEFT_OK);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(pressures[i] == b.cpp.pressures()[i].pressure);
    CHECK(volumes[i] == b.cpp.pressures()[i].volume);
  }
  CHECK(volumes[1] > 0.1);
  CHECK(weft_read_pressures(b.c.get(), 3, pressures.data(), nullptr) == WEFT_REFUSED);
  CHECK(std::string(weft_last_message()) == "count: the cloth has 2 pressures (3)");

  const std::uint32_t listed[] = {2, 0};
  weft_pressure parts[2] = {initial(weft_init_pressure), initial(weft_init_pressure)};
  CHECK(parts[0].ambient == Pressure{}.ambient);
  parts[0].pressure = 7, parts[0].gas = 1;
  parts[1].pressure = -3, parts[1].triangles = listed, parts[1].triangle_count = 2;
  REQUIRE(weft_set_pressures(b.c.get(), 2, parts) == WEFT_OK);
  const std::vector<Pressure> others{{.pressure = 7, .gas = true},
                                     {.pressure = -3, .triangles = {2, 0}}};
  REQUIRE(b.cpp.set_pressure(others));
  step_both(b, 0.01);
  REQUIRE(weft_set_pressure(b.c.get(), 11) == WEFT_OK);
  REQUIRE(b.cpp.set_pressure(11));
  step_both(b, 0.01);
  auto changes = initial(weft_init_changes);
  changes.change_air = 1, changes.air_density = 1.1, changes.air_ram = 0.7;
  REQUIRE(weft_change(b.c.get(), &changes) == WEFT_OK);
  REQUIRE(b.cpp.change({.air = ChangedAir{1.1, 0, 0, 0.7}}));
  step_both(b, 0.01);

  parts[1].triangles = nullptr;
  CHECK(weft_set_pressures(b.c.get(), 2, parts) == WEFT_REFUSED);
  CHECK(std::string(weft_last_message()) == "pressures[1].triangles: must not be NULL (2)");
  parts[1].size = 8;
  CHECK(weft_set_pressures(b.c.get(), 2, parts) == WEFT_REFUSED);
  CHECK(std::string(weft_last_message()).find("pressures[1].size: must be that of") == 0);
  CHECK(weft_set_pressures(b.c.get(), 1, nullptr) == WEFT_REFUSED);
  CHECK(weft_set_pressure(nullptr, 1) == WEFT_REFUSED);
  check_equal(b);
  REQUIRE(weft_set_pressures(b.c.get(), 0, nullptr) == WEFT_OK);
  CHECK(weft_read_pressures(b.c.get(), 0, nullptr, nullptr) == WEFT_OK);
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

  const MeshDescription fine = sheet(2 * kSide - 1);
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

TEST_CASE("what tears is the same") {
  SceneDescription scene;
  for (std::uint32_t i = 0; i < 4; ++i) {
    scene.positions.push_back({0.1 * (i % 2), -0.1 * (i / 2), 0});
    scene.masses.push_back(0.1);
  }
  scene.fixed = {0, 1};
  scene.constraints = {{.a = 0, .b = 2, .rest_length = 0.1, .strength = 1},
                       {.a = 1, .b = 3, .rest_length = 0.1, .strength = 1},
                       {.a = 2, .b = 3, .rest_length = 0.1, .strength = 1}};
  scene.surface = {{0, 2, 1}, {1, 2, 3}};
  Both b = both(scene, {});
  std::size_t torn = 0;
  for (int i = 0; i < 10; ++i) {
    weft_report report = initial(weft_init_report);
    REQUIRE(weft_step(b.c.get(), 0.02, nullptr, &report) == WEFT_OK);
    const auto in_cpp = b.cpp.step(0.02);
    REQUIRE(in_cpp);
    CHECK(report.torn == in_cpp.value().torn);
    const std::vector<Torn> list = b.cpp.torn();
    std::vector<weft_torn> in_c(list.size() + 1, initial(weft_init_torn));
    std::size_t count = 0;
    REQUIRE(weft_torn_of(b.c.get(), in_c.size(), in_c.data(), &count) == WEFT_OK);
    REQUIRE(count == list.size());
    for (std::size_t k = 0; k < count; ++k) {
      CHECK(in_c[k].kind == static_cast<int>(list[k].kind));
      CHECK(in_c[k].index == list[k].index);
      CHECK(in_c[k].particle == list[k].particle);
      CHECK(in_c[k].load == list[k].load);
    }
    torn += count;
    std::array<std::uint32_t, 6> corners{};
    REQUIRE(weft_surface_of(b.c.get(), 2, corners.data(), &count) == WEFT_OK);
    REQUIRE(count == 2);
    CHECK(corners[4] == b.cpp.surface()[1][1]);
    check_equal(b);
  }
  CHECK(torn > 0);
}

}  // namespace
}  // namespace weft::test::engine_c_interface_same_bits
