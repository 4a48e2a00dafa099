/// What is done in C comes to the bits that it comes to in C++.
#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "engine/c_interface/scene_arrays.h"
#include "tests/support/c_interface.h"
#include "tests/support/c_twins.h"
#include "tests/support/clothes.h"
#include "tests/support/random_cases.h"

namespace weft::test::engine_c_interface_same_bits {
namespace {

using namespace c_twins;

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
