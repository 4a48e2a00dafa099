#include "tests/fuzz/c_structs.h"

#include <utility>

#include "tests/fuzz/c_calls.h"

namespace weft::fuzz {
namespace {

constexpr double kSpacing = 0.1;

/// Rows of three in the plane y = 0; some of them elsewhere.
std::vector<double> places(Drawing& drawing, std::size_t count) {
  std::vector<double> places;
  const bool as_usual = !drawing.flag();
  for (std::size_t i = 0; i < count; ++i) {
    for (const double usual :
         {kSpacing * static_cast<double>(i / 3), 0., kSpacing * static_cast<double>(i % 3)})
      places.push_back(as_usual ? usual : drawing.near(usual));
  }
  return places;
}

void draw_constraints(Arrays& arrays, weft_scene& scene) {
  scene.constraint_count = arrays.drawing().below(16);
  scene.constraint_particles = arrays.indices(2 * scene.constraint_count, scene.particle_count);
  scene.rest_lengths = arrays.numbers(scene.constraint_count, kSpacing);
  scene.constraint_kinds = arrays.optional_bytes(scene.constraint_count);
  scene.compliances = arrays.optional_numbers(scene.constraint_count, 1e-3);
  scene.constraint_strengths = arrays.optional_numbers(scene.constraint_count, 1);
}

void draw_fabric(Arrays& arrays, weft_scene& scene) {
  Drawing& drawing = arrays.drawing();
  scene.membrane_count = drawing.below(4);
  scene.membrane_particles = arrays.indices(3 * scene.membrane_count, scene.particle_count);
  scene.membrane_rest = arrays.numbers(6 * scene.membrane_count, kSpacing);
  scene.membrane_stiffnesses = arrays.numbers(3 * scene.membrane_count, 100);
  scene.membrane_kinds = arrays.optional_bytes(scene.membrane_count);
  scene.membrane_strengths = arrays.optional_numbers(scene.membrane_count, 10);
  scene.bending_count = drawing.below(3);
  scene.bending_particles = arrays.indices(4 * scene.bending_count, scene.particle_count);
  std::vector<double> weights;
  for (std::size_t i = 0; i < scene.bending_count; ++i) {
    for (const double weight : {1., -1., -1., 1.}) weights.push_back(drawing.near(weight));
  }
  scene.bending_weights = arrays.given(std::move(weights));
  scene.bending_rests = arrays.optional_numbers(scene.bending_count, 0);
  scene.bending_compliances = arrays.numbers(scene.bending_count, 1);
  scene.bending_folds = arrays.optional_numbers(scene.bending_count, 0);
  scene.bending_yields = arrays.optional_numbers(scene.bending_count, 0.1);
  scene.bending_hardenings = arrays.optional_numbers(scene.bending_count, 0.1);
  scene.bending_arms = arrays.optional_numbers(scene.bending_count, 1);
  scene.surface_count = drawing.below(6);
  scene.surface_triangles = arrays.indices(3 * scene.surface_count, scene.particle_count);
  scene.air_triangle_count = drawing.below(4);
  scene.air_triangles = arrays.indices(3 * scene.air_triangle_count, scene.particle_count);
}

void draw_anchors_and_seams(Arrays& arrays, weft_scene& scene) {
  Drawing& drawing = arrays.drawing();
  scene.anchor_count = drawing.below(3);
  scene.anchor_particles = arrays.indices(scene.anchor_count, scene.particle_count);
  scene.anchor_points = arrays.numbers(3 * scene.anchor_count, 0);
  scene.anchor_normals = arrays.optional_numbers(3 * scene.anchor_count, 1);
  scene.anchor_max_distances = arrays.optional_numbers(scene.anchor_count, 0.05);
  scene.backstop_distances = arrays.optional_numbers(scene.anchor_count, 0.01);
  scene.backstop_radii = arrays.optional_numbers(scene.anchor_count, 1);
  scene.anchor_strengths = arrays.optional_numbers(scene.anchor_count, 1);
  scene.seam_count = drawing.below(2);
  scene.seam_particles = arrays.indices(2 * scene.seam_count, scene.particle_count);
  scene.seam_times = arrays.optional_numbers(scene.seam_count, 0.1);
  scene.seam_max_forces = arrays.optional_numbers(scene.seam_count, 1);
  scene.seam_strengths = arrays.optional_numbers(scene.seam_count, 1);
}

void draw_world(Arrays& arrays, weft_scene& scene) {
  Drawing& drawing = arrays.drawing();
  scene.damping_stretch = drawing.near(0), scene.damping_bending = drawing.near(0);
  scene.damping_motion = drawing.near(0);
  scene.air_density = drawing.near(1.2), scene.air_drag = drawing.near(1);
  scene.air_lift = drawing.near(0);
  for (double& component : scene.wind) component = drawing.near(0);
  for (double& component : scene.gravity) component = drawing.near(-10);
  scene.friction = drawing.near(0.3);
  scene.sphere_count = drawing.below(3);
  scene.spheres = arrays.indices(scene.sphere_count, scene.particle_count);
  scene.radii = scene.sphere_count > 0 ? arrays.numbers(scene.particle_count, 0.02) : nullptr;
}

}  // namespace

const double* Arrays::given(std::vector<double> numbers) {
  return numbers_.emplace_back(std::move(numbers)).data();
}

const std::uint32_t* Arrays::given_indices(std::vector<std::uint32_t> indices) {
  return indices_.emplace_back(std::move(indices)).data();
}

const double* Arrays::numbers(std::size_t count, double usual) {
  if (drawing_.rarely(64)) return nullptr;
  return given(drawing_.numbers(count, usual));
}

const std::uint32_t* Arrays::indices(std::size_t count, std::size_t things) {
  if (drawing_.rarely(64)) return nullptr;
  return given_indices(drawing_.indices(count, things));
}

const std::uint8_t* Arrays::bytes(std::size_t count) {
  return bytes_.emplace_back(drawing_.bytes(count)).data();
}

const double* Arrays::optional_numbers(std::size_t count, double usual) {
  return drawing_.below(4) == 3 ? given(drawing_.numbers(count, usual)) : nullptr;
}

const std::uint8_t* Arrays::optional_bytes(std::size_t count) {
  return drawing_.below(4) == 3 ? bytes(count) : nullptr;
}

weft_scene draw_scene(Arrays& arrays) {
  Drawing& drawing = arrays.drawing();
  auto scene = initial(weft_init_scene);
  scene.particle_count = 1 + drawing.below(12);
  scene.positions = arrays.given(places(drawing, scene.particle_count));
  scene.velocities = arrays.optional_numbers(3 * scene.particle_count, 0);
  scene.masses = arrays.numbers(scene.particle_count, 0.1);
  scene.fixed_count = drawing.below(3);
  scene.fixed = arrays.indices(scene.fixed_count, scene.particle_count);
  draw_constraints(arrays, scene);
  if (drawing.flag()) draw_fabric(arrays, scene);
  if (drawing.flag()) draw_anchors_and_seams(arrays, scene);
  if (drawing.flag()) draw_world(arrays, scene);
  return scene;
}

weft_settings draw_settings(Drawing& drawing) {
  auto s = initial(drawing.rarely(8) ? weft_init_paper_settings : weft_init_settings);
  s.max_iterations = 100;
  if (!drawing.flag()) return s;
  s.tolerance = drawing.near(0.01), s.contact_tolerance = drawing.near(1e-4);
  s.velocity_tolerance = drawing.near(0.01), s.motion_tolerance = drawing.near(0);
  s.impulse_limit = drawing.near(0);
  for (int* choice : {&s.solver, &s.scheme, &s.backend, &s.directions})
    *choice = drawing.rarely() ? drawing.integer() : static_cast<int>(drawing.below(5));
  s.isa = drawing.rarely() ? drawing.integer() : WEFT_ISA_AUTOMATIC;
  for (int* count : {&s.substeps, &s.iterations, &s.renew_after, &s.threads})
    *count = drawing.rarely(4) ? drawing.integer() % 1000 : 0;
  if (drawing.rarely(8)) s.max_iterations = drawing.integer() % 1000;
  for (int* choice :
       {&s.anticipate, &s.anticipate_products, &s.sleep, &s.skip, &s.velocity_correction}) {
    if (drawing.rarely(4)) *choice = drawing.integer();
  }
  return s;
}

weft_changes draw_changes(Arrays& arrays, std::size_t particles) {
  Drawing& drawing = arrays.drawing();
  auto changes = initial(weft_init_changes);
  const auto some = [&] {
    return static_cast<std::size_t>(drawing.rarely(3) ? drawing.below(3) : 0);
  };
  changes.fix_count = some(), changes.fix = arrays.indices(changes.fix_count, particles);
  changes.release_count = some();
  changes.release = arrays.indices(changes.release_count, particles);
  changes.mass_count = some();
  changes.mass_particles = arrays.indices(changes.mass_count, particles);
  changes.masses = arrays.numbers(changes.mass_count, 0.2);
  changes.rest_length_count = some();
  changes.rest_length_constraints = arrays.indices(changes.rest_length_count, 8);
  changes.rest_lengths = arrays.numbers(changes.rest_length_count, kSpacing);
  changes.compliance_count = some();
  changes.compliance_constraints = arrays.indices(changes.compliance_count, 8);
  changes.compliances = arrays.numbers(changes.compliance_count, 1e-3);
  changes.membrane_count = some();
  changes.membrane_elements = arrays.indices(changes.membrane_count, 3);
  changes.membrane_stiffnesses = arrays.numbers(3 * changes.membrane_count, 50);
  changes.bending_count = some();
  changes.bending_elements = arrays.indices(changes.bending_count, 2);
  changes.bending_compliances = arrays.numbers(changes.bending_count, 2);
  changes.change_damping = drawing.rarely(4), changes.change_air = drawing.rarely(4);
  for (double* value : {&changes.damping_stretch, &changes.damping_bending, &changes.damping_motion,
                        &changes.air_density, &changes.air_drag, &changes.air_lift})
    *value = drawing.near(0.5);
  return changes;
}

weft_mesh draw_mesh(Arrays& arrays, weft_material& material) {
  Drawing& drawing = arrays.drawing();
  auto mesh = initial(weft_init_mesh);
  mesh.vertex_count = 3 + drawing.below(10);
  mesh.positions = arrays.given(places(drawing, mesh.vertex_count));
  if (drawing.flag()) {  // faces of any size
    mesh.face_count = drawing.below(6);
    std::vector<std::uint32_t> sizes;
    for (std::size_t i = 0; i < mesh.face_count; ++i) sizes.push_back(3 + drawing.below(3));
    for (const std::uint32_t size : sizes) mesh.corner_count += size;
    mesh.face_sizes = arrays.given_indices(std::move(sizes));
  } else {
    mesh.corner_count = 3 * drawing.below(8);
  }
  if (drawing.rarely(64)) mesh.corner_count /= 2;
  mesh.corners = arrays.indices(mesh.corner_count, mesh.vertex_count);
  const std::size_t faces = mesh.face_count > 0 ? mesh.face_count : mesh.corner_count / 3;
  mesh.line_count = drawing.rarely(3) ? drawing.below(4) : 0;
  mesh.lines = arrays.indices(2 * mesh.line_count, mesh.vertex_count);
  if (drawing.rarely(4)) mesh.rest_positions = arrays.given(places(drawing, mesh.vertex_count));
  mesh.rest_corners = arrays.optional_numbers(2 * mesh.corner_count, 0);
  mesh.warp_count = drawing.rarely(3) ? (drawing.flag() ? 1 : faces) : 0;
  mesh.warp = arrays.numbers(3 * mesh.warp_count, 1);
  mesh.pin_count = drawing.below(3);
  mesh.pins = arrays.indices(mesh.pin_count, mesh.vertex_count);
  mesh.seam_count = drawing.rarely(3) ? 1 : 0;
  mesh.seams = arrays.indices(2 * mesh.seam_count, mesh.vertex_count);
  mesh.mass = drawing.near(1), mesh.thread_density = drawing.near(1e-3);
  mesh.weld_distance = drawing.near(0), mesh.seam_time = drawing.near(0);
  mesh.seam_force = drawing.near(1), mesh.ropes = drawing.rarely() ? drawing.integer() : 0;
  if (drawing.flag()) return mesh;
  check(weft_find_material("cotton", &material) == WEFT_OK, "there is cotton");
  for (double* value :
       {&material.density, &material.warp, &material.weft, &material.shear, &material.bending})
    *value = drawing.near(*value);
  mesh.material = &material;
  return mesh;
}

}  // namespace weft::fuzz
