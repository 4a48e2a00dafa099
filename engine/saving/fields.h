/// The fields of public structures, for archives.
#pragma once

#include <weft/report_fields.h>
#include <weft/weft.h>

#include "engine/saving/archive.h"

namespace weft {

void visit_fields(Is<Vec3> auto& v, auto& archive) {
  auto& [x, y, z] = v;
  archive(x, y, z);
}

// scene.h

void visit_fields(Is<Constraint> auto& constraint, auto& archive) {
  auto& [a, b, rest_length, kind, compliance] = constraint;
  archive(a, b, rest_length, kind, compliance);
}

void visit_fields(Is<MembraneElement> auto& element, auto& archive) {
  auto& [particles, rest, warp, weft, shear, kind] = element;
  archive(particles, rest, warp, weft, shear, kind);
}

void visit_fields(Is<BendingElement> auto& element, auto& archive) {
  auto& [particles, weights, rest, compliance, fold] = element;
  archive(particles, weights, rest, compliance, fold);
}

void visit_fields(Is<Anchor> auto& anchor, auto& archive) {
  auto& [particle, point, normal, max_distance, backstop_distance, backstop_radius] = anchor;
  archive(particle, point, normal, max_distance, backstop_distance, backstop_radius);
}

void visit_fields(Is<Seam> auto& seam, auto& archive) {
  auto& [a, b, time, max_force] = seam;
  archive(a, b, time, max_force);
}

void visit_fields(Is<Damping> auto& damping, auto& archive) {
  auto& [stretch, bending, motion] = damping;
  archive(stretch, bending, motion);
}

void visit_fields(Is<Air> auto& air, auto& archive) {
  auto& [triangles, density, drag, lift, wind, ram] = air;
  archive(triangles, density, drag, lift, wind, ram);
}

void visit_fields(Is<Pressure> auto& part, auto& archive) {
  auto& [pressure, triangles, gas, volume, ambient] = part;
  archive(pressure, triangles, gas, volume, ambient);
}

void visit_fields(Is<SelfContact> auto& contact, auto& archive) {
  auto& [on, thickness, friction, untangle] = contact;
  archive(on, thickness, friction, untangle);
}

void visit_fields(Is<SceneDescription> auto& scene, auto& archive) {
  auto& [positions, velocities, masses, fixed, constraints, membrane, bending, anchors, seams,
         surface, damping, air, pressures, friction, self_contact, gravity, spheres, radii] = scene;
  archive(positions, velocities, masses, fixed, constraints, membrane, bending, anchors, seams,
          surface, damping, air, pressures, friction, self_contact, gravity, spheres, radii);
}

// body.h

void visit_fields(Is<Rotation> auto& rotation, auto& archive) {
  auto& [x, y, z, w] = rotation;
  archive(x, y, z, w);
}

void visit_fields(Is<Pose> auto& pose, auto& archive) {
  auto& [position, rotation] = pose;
  archive(position, rotation);
}

void visit_fields(Is<Plane> auto& plane, auto& archive) {
  auto& [normal, offset] = plane;
  archive(normal, offset);
}

void visit_fields(Is<Ball> auto& ball, auto& archive) {
  auto& [centre, radius] = ball;
  archive(centre, radius);
}

void visit_fields(Is<Capsule> auto& capsule, auto& archive) {
  auto& [a, b, radius_a, radius_b] = capsule;
  archive(a, b, radius_a, radius_b);
}

void visit_fields(Is<Hull> auto& hull, auto& archive) {
  auto& [points] = hull;
  archive(points);
}

void visit_fields(Is<TriangleMesh> auto& mesh, auto& archive) {
  auto& [vertices, triangles, two_sided] = mesh;
  archive(vertices, triangles, two_sided);
}

void visit_fields(Is<BodyLoad> auto& load, auto& archive) {
  auto& [force, moment] = load;
  archive(force, moment);
}

// settings.h

void visit_fields(Is<Settings> auto& settings, auto& archive) {
  auto& [tolerance, substeps, iterations, renew_after, max_iterations, contact_tolerance,
         velocity_tolerance, motion_tolerance, impulse_limit, solver, scheme, backend, isa, threads,
         directions, anticipate, anticipate_products, sleep, skip, velocity_correction] = settings;
  archive(tolerance, substeps, iterations, renew_after, max_iterations, contact_tolerance,
          velocity_tolerance, motion_tolerance, impulse_limit, solver, scheme, backend, isa,
          threads, directions, anticipate, anticipate_products, sleep, skip, velocity_correction);
}

// cloth.h

void visit_fields(Is<AnchorLimit> auto& limit, auto& archive) {
  auto& [max_distance, backstop] = limit;
  archive(max_distance, backstop);
}

void visit_fields(Is<ContactMs> auto& ms, auto& archive) {
  auto& [find, sweep, verify] = ms;
  archive(find, sweep, verify);
}

void visit_fields(Is<StepReport> auto& report, auto& archive) {
  for_each_report_field([&](const auto& field) { archive(report.*field.member); });
}

}  // namespace weft
