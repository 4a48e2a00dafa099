/// What is folded or curled at rest, begins flat and is let go: it comes to the side that it has at
/// rest. No load acts in the end, so that the shape at rest is the closed form.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

Material still_denim() {
  Material m = find_material("denim").value();
  m.damping_motion = 20;
  return m;
}

constexpr double kDegree = kPi / 180;

/// The level plane turned up by the angle behind the line x = at.
Vec3 folded(Vec3 p, double at, double angle) {
  if (p.x <= at) return p;
  return {at + (p.x - at) * std::cos(angle), (p.x - at) * std::sin(angle), p.z};
}

/// In degrees. A strip is held at one end, and has its fold in the middle. It is let go as it lies
/// at the angle `start`.
Reading pleat(Pattern pattern, double angle, double start, int refinement) {
  constexpr double kLength = 0.08;
  const Sheet sheet = sheet_of(pattern, kLength, kLength / 4, 8 << refinement);
  const double middle = kLength / 2, cell = kLength / sheet.along;
  MeshDescription mesh = mesh_of(sheet, still_denim());
  for (Vec3& p : mesh.positions) {
    if (std::abs(p.x - middle) < 0.4 * cell) p.x = middle;  // the fold is straight in every pattern
  }
  mesh.rest_positions = mesh.positions;
  for (Vec3& p : mesh.rest_positions) p = folded(p, middle, angle * kDegree);
  pin(mesh, [&](Vec3 p) { return p.x < middle / 2; });
  const auto line = [&](double x) {
    return particles_at(scene_of(mesh), [=](Vec3 p) { return std::abs(p.x - x) < 0.1 * cell; });
  };
  const auto fold = line(middle), end = line(kLength);
  for (Vec3& p : mesh.positions) p = folded(p, middle, start * kDegree);
  SceneDescription scene = scene_of(mesh);
  scene.gravity = {};
  Run run(scene, {.tolerance = 1e-3});
  run.steps(120, kFrame);
  const auto mean_x = [&](const std::vector<std::uint32_t>& particles) {
    double sum = 0;
    for (const std::uint32_t i : particles) sum += run.at(i).x;
    return sum / static_cast<double>(particles.size());
  };
  const double turned = std::atan2(run.mean_y(end) - run.mean_y(fold), mean_x(end) - mean_x(fold));
  return run.reading(size_of(sheet), angle, turned / kDegree);
}

/// Six times the volume of the tetrahedron of four points of a line, a third of it from each other:
/// it has the sign of the helix's hand.
double hand_of(const std::vector<Vec3>& points) {
  const auto way = [&](std::size_t k) {
    return Vec3{points[k].x - points[0].x, points[k].y - points[0].y, points[k].z - points[0].z};
  };
  const Vec3 a = way(1), b = way(2), c = way(3);
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
         a.z * (b.x * c.y - b.y * c.x);
}

/// A ribbon that is part of a cylinder at rest, along a helix of 30 degrees. It floats. In cm^3.
Reading helix(Pattern pattern, double radius, int refinement) {
  constexpr double kLength = 0.12, kTurn = kPi / 6;
  const Sheet sheet = sheet_of(pattern, kLength, kLength / 12, 12 << refinement);
  MeshDescription mesh = mesh_of(sheet, still_denim());
  mesh.rest_positions = mesh.positions;
  for (Vec3& p : mesh.rest_positions) p = rolled(p, radius, kTurn);
  const SceneDescription level = scene_of(mesh);
  const auto at_corner = [&](double x) {
    return particles_at(level, [&](Vec3 p) { return std::abs(p.x - x) + p.z < 1e-6; }).at(0);
  };
  std::vector<std::uint32_t> line;
  for (int k = 0; k < 4; ++k) line.push_back(at_corner(kLength * k / 3));
  SceneDescription scene = level;
  scene.gravity = {};
  Run run(scene, {.tolerance = 1e-3});
  run.steps(180, kFrame);
  std::vector<Vec3> expected, measured;
  for (const std::uint32_t i : line) {
    expected.push_back(rolled(scene.positions[i], radius, kTurn));
    measured.push_back(run.at(i));
  }
  return run.reading(size_of(sheet), 1e6 * hand_of(expected), 1e6 * hand_of(measured));
}

}  // namespace

std::vector<Form> fold_forms() {
  std::vector<Form> forms;
  for (const Pattern pattern : {Pattern::quads, Pattern::right_angled}) {
    for (const double angle : {30., -30., 60., -60., 120., -120.}) {
      for (const double start : {0., angle > 0 ? -20. : 20.}) {
        forms.push_back(
            {fmt::format("a pleat of {:g} degrees from {:g}, {}", angle, start, name(pattern)),
             "the angle at rest", "degrees", [=](int r) { return pleat(pattern, angle, start, r); },
             0.02, false});
      }
    }
    for (const double radius : {0.03, -0.03}) {
      forms.push_back(
          {fmt::format("a helix to the {}, {}", radius > 0 ? "left" : "right", name(pattern)),
           "(x1 - x0) x (x2 - x0) . (x3 - x0)", "cm^3",
           [=](int r) { return helix(pattern, radius, r); }, 0.02, false});
    }
  }
  return forms;
}

}  // namespace weft::tools::forms
