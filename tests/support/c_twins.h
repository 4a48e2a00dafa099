/// The same cloth twice, in C++ and in C.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/c_interface/scene_arrays.h"
#include "tests/support/c_interface.h"
#include "tests/support/clothes.h"

namespace weft::test::c_twins {

/// The same cloth twice, in C++ and in C.
struct Both {
  Cloth cpp;
  Owned<weft_cloth> c;
};

inline Owned<weft_model> model_in_c(const SceneDescription& scene) {
  const c_interface::SceneArrays arrays = c_interface::arrays_of(scene);
  const weft_scene its = c_interface::scene_of(scene, arrays);
  return made<weft_model>([&](weft_model** out) { return weft_build_model(&its, out); });
}

inline weft_settings settings_in_c(const Settings& s) {
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

inline Both both(const SceneDescription& scene, const Settings& settings) {
  const auto model = model_in_c(scene);
  const weft_settings its = settings_in_c(settings);
  return {cloth_of(scene, settings), made<weft_cloth>([&](weft_cloth** out) {
            return weft_create_cloth(model.get(), &its, out);
          })};
}

inline void check_equal(const Both& b) { CHECK(weft_state_hash(b.c.get()) == b.cpp.state_hash()); }

/// Every field but the times, which differ from run to run.
inline void check_equal(const weft_report& c, const StepReport& r) {
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
                   c.max_rail_gap, c.law_error} ==
        std::array{r.max_strain, r.rms_strain, r.max_shear, r.max_error, r.max_penetration,
                   r.max_anchor_error, r.max_seam_gap, r.seam_work, r.motion_error, r.energy_lost,
                   r.pin_work, r.body_work, r.friction_work, r.max_bending_error, r.untangling_work,
                   r.max_rail_gap, r.law_error});
  CHECK(std::array{c.worst_constraint, c.worst_element, c.failed_particle, c.passed_particle,
                   c.worst_seam, c.worst_held} == std::array{r.worst_constraint, r.worst_element,
                                                             r.failed_particle, r.passed_particle,
                                                             r.worst_seam, r.worst_held});
}

inline void step_both(Both& b, double dt) {
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

inline constexpr std::uint32_t kSheetSide = 13;

inline MeshDescription sheet(std::uint32_t side) {
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

inline weft_mesh mesh_in_c(const MeshDescription& mesh) {
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
  MeshDescription mesh = sheet(kSheetSide);
  weft_mesh c_mesh = mesh_in_c(mesh);
  weft_material c_material = initial(weft_init_material);
  MeshCloth made_in_cpp;
  Owned<weft_mesh_cloth> made_in_c;

  explicit CottonSheet(double strength = std::numeric_limits<double>::infinity()) {
    mesh.material = find_material("cotton").value();
    mesh.material->friction = 0.45;
    mesh.material->strength = strength;
    REQUIRE(weft_find_material("cotton", &c_material) == WEFT_OK);
    c_material.friction = 0.45;
    c_material.strength = strength;
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

inline std::uint32_t add_ball(Both& b) {
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
inline void disturb(Both& b, std::uint32_t body, int frame) {
  const std::array<std::uint32_t, 2> pins{0, kSheetSide - 1};
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

/// Cotton that has fallen on a ball.
inline Both on_a_ball(std::uint32_t& body) {
  Both b = CottonSheet().cloths();
  body = add_ball(b);
  for (int frame = 1; frame <= 30; ++frame) {
    disturb(b, body, frame);
    step_both(b, 1. / 60);
  }
  return b;
}

}  // namespace weft::test::c_twins
