#include "engine/c_interface/scene_arrays.h"

#include "engine/c_interface/arrays.h"
#include "engine/c_interface/pressure_structs.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

using Pair = std::array<std::uint32_t, 2>;
using Triple = std::array<std::uint32_t, 3>;
using Four = std::array<std::uint32_t, 4>;

ConstraintKind kind_of(std::uint8_t number) { return static_cast<ConstraintKind>(number); }
std::uint8_t number_of(ConstraintKind kind) { return static_cast<std::uint8_t>(kind); }

void read_particles(const weft_scene& s, Arrays& in, SceneDescription& out) {
  const std::size_t n = s.particle_count;
  out.positions = list_of(in.needed<Vec3>("positions", s.positions, n));
  out.velocities = list_of(in.optional<Vec3>("velocities", s.velocities, n));
  out.masses = list_of(in.needed<double>("masses", s.masses, n));
  out.fixed = list_of(in.needed<std::uint32_t>("fixed", s.fixed, s.fixed_count));
  out.spheres = list_of(in.needed<std::uint32_t>("spheres", s.spheres, s.sphere_count));
  out.radii = list_of(in.optional<double>("radii", s.radii, n));
}

void read_constraints(const weft_scene& s, Arrays& in, SceneDescription& out) {
  const std::size_t n = s.constraint_count;
  const auto particles = in.needed<Pair>("constraint_particles", s.constraint_particles, n);
  const auto lengths = in.needed<double>("rest_lengths", s.rest_lengths, n);
  const auto kinds = in.optional<std::uint8_t>("constraint_kinds", s.constraint_kinds, n);
  const auto compliances = in.optional<double>("compliances", s.compliances, n);
  if (!in.are_good()) return;
  const Constraint usual;
  for (std::size_t i = 0; i < n; ++i) {
    out.constraints.push_back({particles[i][0], particles[i][1], lengths[i],
                               kind_of(item_or(kinds, i, number_of(usual.kind))),
                               item_or(compliances, i, usual.compliance)});
  }
}

void read_membrane(const weft_scene& s, Arrays& in, SceneDescription& out) {
  const std::size_t n = s.membrane_count;
  const auto particles = in.needed<Triple>("membrane_particles", s.membrane_particles, n);
  const auto rest =
      in.needed<std::array<std::array<double, 2>, 3>>("membrane_rest", s.membrane_rest, n);
  const auto stiffnesses =
      in.needed<std::array<double, 3>>("membrane_stiffnesses", s.membrane_stiffnesses, n);
  const auto kinds = in.optional<std::uint8_t>("membrane_kinds", s.membrane_kinds, n);
  if (!in.are_good()) return;
  for (std::size_t i = 0; i < n; ++i) {
    out.membrane.push_back({particles[i], rest[i], stiffnesses[i][0], stiffnesses[i][1],
                            stiffnesses[i][2],
                            kind_of(item_or(kinds, i, number_of(MembraneElement{}.kind)))});
  }
}

void read_bending(const weft_scene& s, Arrays& in, SceneDescription& out) {
  const std::size_t n = s.bending_count;
  const auto particles = in.needed<Four>("bending_particles", s.bending_particles, n);
  const auto weights = in.needed<std::array<double, 4>>("bending_weights", s.bending_weights, n);
  const auto rests = in.optional<double>("bending_rests", s.bending_rests, n);
  const auto compliances = in.needed<double>("bending_compliances", s.bending_compliances, n);
  const auto folds = in.optional<double>("bending_folds", s.bending_folds, n);
  if (!in.are_good()) return;
  for (std::size_t i = 0; i < n; ++i) {
    out.bending.push_back({particles[i], weights[i], item_or(rests, i, BendingElement{}.rest),
                           compliances[i], item_or(folds, i, BendingElement{}.fold)});
  }
}

void read_anchors(const weft_scene& s, Arrays& in, SceneDescription& out) {
  const std::size_t n = s.anchor_count;
  const auto particles = in.needed<std::uint32_t>("anchor_particles", s.anchor_particles, n);
  const auto points = in.needed<Vec3>("anchor_points", s.anchor_points, n);
  const auto normals = in.optional<Vec3>("anchor_normals", s.anchor_normals, n);
  const auto distances = in.optional<double>("anchor_max_distances", s.anchor_max_distances, n);
  const auto backstops = in.optional<double>("backstop_distances", s.backstop_distances, n);
  const auto radii = in.optional<double>("backstop_radii", s.backstop_radii, n);
  if (!in.are_good()) return;
  const Anchor usual;
  for (std::size_t i = 0; i < n; ++i) {
    out.anchors.push_back({particles[i], points[i], item_or(normals, i, usual.normal),
                           item_or(distances, i, usual.max_distance),
                           item_or(backstops, i, usual.backstop_distance),
                           item_or(radii, i, usual.backstop_radius)});
  }
}

void read_seams(const weft_scene& s, Arrays& in, SceneDescription& out) {
  const std::size_t n = s.seam_count;
  const auto particles = in.needed<Pair>("seam_particles", s.seam_particles, n);
  const auto times = in.optional<double>("seam_times", s.seam_times, n);
  const auto forces = in.optional<double>("seam_max_forces", s.seam_max_forces, n);
  if (!in.are_good()) return;
  const Seam usual;
  for (std::size_t i = 0; i < n; ++i) {
    out.seams.push_back({particles[i][0], particles[i][1], item_or(times, i, usual.time),
                         item_or(forces, i, usual.max_force)});
  }
}

void read_world(const weft_scene& s, Arrays& in, SceneDescription& out) {
  out.surface =
      list_of(in.needed<Triple>("surface_triangles", s.surface_triangles, s.surface_count));
  out.damping = {s.damping_stretch, s.damping_bending, s.damping_motion};
  out.air.triangles =
      list_of(in.needed<Triple>("air_triangles", s.air_triangles, s.air_triangle_count));
  out.air.density = s.air_density;
  out.air.drag = s.air_drag;
  out.air.lift = s.air_lift;
  out.air.ram = s.air_ram;
  out.air.wind = vector_of(s.wind);
  out.friction = s.friction;
  out.self_contact = {s.self_contact != 0, s.self_contact_thickness, s.self_contact_friction,
                      s.self_contact_untangle != 0};
  out.gravity = vector_of(s.gravity);
}

void write_world(const SceneDescription& scene, weft_scene& out) {
  out.damping_stretch = scene.damping.stretch;
  out.damping_bending = scene.damping.bending;
  out.damping_motion = scene.damping.motion;
  out.air_density = scene.air.density;
  out.air_drag = scene.air.drag;
  out.air_lift = scene.air.lift;
  out.air_ram = scene.air.ram;
  write_vector(scene.air.wind, out.wind);
  out.friction = scene.friction;
  out.self_contact = scene.self_contact.on ? 1 : 0;
  out.self_contact_thickness = scene.self_contact.thickness;
  out.self_contact_friction = scene.self_contact.friction;
  out.self_contact_untangle = scene.self_contact.untangle ? 1 : 0;
  write_vector(scene.gravity, out.gravity);
}

void write_elements(const SceneArrays& a, weft_scene& out) {
  out.constraint_count = a.constraint_particles.size();
  out.constraint_particles = as_numbers<std::uint32_t>(a.constraint_particles);
  out.rest_lengths = a.rest_lengths.data();
  out.constraint_kinds = a.constraint_kinds.data();
  out.compliances = a.compliances.data();

  out.membrane_count = a.membrane_particles.size();
  out.membrane_particles = as_numbers<std::uint32_t>(a.membrane_particles);
  out.membrane_rest = as_numbers<double>(a.membrane_rest);
  out.membrane_stiffnesses = as_numbers<double>(a.membrane_stiffnesses);
  out.membrane_kinds = a.membrane_kinds.data();

  out.bending_count = a.bending_particles.size();
  out.bending_particles = as_numbers<std::uint32_t>(a.bending_particles);
  out.bending_weights = as_numbers<double>(a.bending_weights);
  out.bending_rests = a.bending_rests.data();
  out.bending_compliances = a.bending_compliances.data();
  out.bending_folds = a.bending_folds.data();
}

void write_anchors_and_seams(const SceneArrays& a, weft_scene& out) {
  out.anchor_count = a.anchor_particles.size();
  out.anchor_particles = a.anchor_particles.data();
  out.anchor_points = as_numbers<double>(a.anchor_points);
  out.anchor_normals = as_numbers<double>(a.anchor_normals);
  out.anchor_max_distances = a.anchor_max_distances.data();
  out.backstop_distances = a.backstop_distances.data();
  out.backstop_radii = a.backstop_radii.data();

  out.seam_count = a.seam_particles.size();
  out.seam_particles = as_numbers<std::uint32_t>(a.seam_particles);
  out.seam_times = a.seam_times.data();
  out.seam_max_forces = a.seam_max_forces.data();
}

}  // namespace

weft_scene default_scene() {
  weft_scene scene{};
  scene.size = sizeof scene;
  write_world(SceneDescription{}, scene);
  return scene;
}

Result<SceneDescription> read_scene(const weft_scene* scene) {
  const auto s = read_struct("scene", scene, default_scene());
  if (!s) return Error{s.error()};
  Arrays in;
  SceneDescription out;
  read_particles(s.value(), in, out);
  read_constraints(s.value(), in, out);
  read_membrane(s.value(), in, out);
  read_bending(s.value(), in, out);
  read_anchors(s.value(), in, out);
  read_seams(s.value(), in, out);
  read_world(s.value(), in, out);
  if (!in.are_good()) return in.error();
  auto pressures = read_pressures(s.value().pressure_count, s.value().pressures);
  if (!pressures) return Error{pressures.error()};
  out.pressures = std::move(pressures).value();
  return out;
}

SceneArrays arrays_of(const SceneDescription& scene) {
  SceneArrays a;
  for (const Constraint& c : scene.constraints) {
    a.constraint_particles.push_back({c.a, c.b});
    a.rest_lengths.push_back(c.rest_length);
    a.constraint_kinds.push_back(number_of(c.kind));
    a.compliances.push_back(c.compliance);
  }
  for (const MembraneElement& e : scene.membrane) {
    a.membrane_particles.push_back(e.particles);
    a.membrane_rest.push_back(e.rest);
    a.membrane_stiffnesses.push_back({e.warp, e.weft, e.shear});
    a.membrane_kinds.push_back(number_of(e.kind));
  }
  for (const BendingElement& e : scene.bending) {
    a.bending_particles.push_back(e.particles);
    a.bending_weights.push_back(e.weights);
    a.bending_rests.push_back(e.rest);
    a.bending_compliances.push_back(e.compliance);
    a.bending_folds.push_back(e.fold);
  }
  for (const Anchor& anchor : scene.anchors) {
    a.anchor_particles.push_back(anchor.particle);
    a.anchor_points.push_back(anchor.point);
    a.anchor_normals.push_back(anchor.normal);
    a.anchor_max_distances.push_back(anchor.max_distance);
    a.backstop_distances.push_back(anchor.backstop_distance);
    a.backstop_radii.push_back(anchor.backstop_radius);
  }
  for (const Pressure& part : scene.pressures) a.pressures.push_back(pressure_of(part));
  for (const Seam& seam : scene.seams) {
    a.seam_particles.push_back({seam.a, seam.b});
    a.seam_times.push_back(seam.time);
    a.seam_max_forces.push_back(seam.max_force);
  }
  return a;
}

weft_scene scene_of(const SceneDescription& scene, const SceneArrays& arrays) {
  weft_scene out = default_scene();
  out.particle_count = scene.positions.size();
  out.positions = as_numbers<double>(scene.positions);
  out.velocities = scene.velocities.empty() ? nullptr : as_numbers<double>(scene.velocities);
  out.masses = scene.masses.data();
  out.fixed_count = scene.fixed.size();
  out.fixed = scene.fixed.data();
  write_elements(arrays, out);
  write_anchors_and_seams(arrays, out);
  out.surface_count = scene.surface.size();
  out.surface_triangles = as_numbers<std::uint32_t>(scene.surface);
  out.pressure_count = arrays.pressures.size();
  out.pressures = arrays.pressures.data();
  out.air_triangle_count = scene.air.triangles.size();
  out.air_triangles = as_numbers<std::uint32_t>(scene.air.triangles);
  write_world(scene, out);
  out.sphere_count = scene.spheres.size();
  out.spheres = scene.spheres.data();
  out.radii = scene.radii.empty() ? nullptr : scene.radii.data();
  return out;
}

}  // namespace weft::c_interface
