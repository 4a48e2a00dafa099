/// Cloth that touches itself: a layer slides on another one or sticks, a stack weighs what it
/// weighs, and a loop whose ends are held together is as high as it should be.
#include <weft/body.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

constexpr double kLayerFriction = 0.3;
constexpr double kLayer = 2e-3;  // m, from one layer to the next

Material material_of_layers() {
  Material material = cotton();
  material.drag = material.lift = material.damping_motion = 0;
  material.thickness = kLayer;
  material.friction = kLayerFriction;
  return material;
}

/// The sheet is added, its first corner at a place.
void add_layer(const Sheet& sheet, Vec3 corner, MeshDescription& mesh) {
  const MeshDescription layer = mesh_of(sheet, *mesh.material);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3 p : layer.positions)
    mesh.positions.push_back({p.x + corner.x, p.y + corner.y, p.z + corner.z});
  for (const std::uint32_t v : layer.corners) mesh.corners.push_back(first + v);
  mesh.face_sizes.insert(mesh.face_sizes.end(), layer.face_sizes.begin(), layer.face_sizes.end());
}

SceneDescription touching(const MeshDescription& mesh) {
  SceneDescription scene = scene_of(mesh);
  scene.self_contact.on = true;
  return scene;
}

// ------------------------------------------------------------------------------------- incline

Sheet sliding_layer(int refinement) {
  return sheet_of(Pattern::irregular, 0.15, 0.15, 3 << refinement);
}

struct Slope {
  SceneDescription scene;
  std::vector<std::uint32_t> sliding;
};

/// A small layer on one that is held, on a slope that falls towards +x: gravity leans, not they.
Slope slope_of(double angle, int refinement) {
  constexpr double kHeldSide = 0.6;  // m
  MeshDescription mesh;
  mesh.material = material_of_layers();
  add_layer(sheet_of(Pattern::irregular, kHeldSide, kHeldSide, 7 << refinement), {}, mesh);
  pin(mesh, [](Vec3) { return true; });
  add_layer(sliding_layer(refinement), {0.07, kLayer, 0.22}, mesh);
  Slope slope{touching(mesh), {}};
  slope.scene.gravity = {kGravity * std::sin(angle), -kGravity * std::cos(angle), 0};
  slope.sliding = particles_at(slope.scene, [](Vec3 p) { return p.y > kLayer / 2; });
  return slope;
}

double mean_x(const Run& run, const std::vector<std::uint32_t>& particles) {
  double sum = 0;
  for (const std::uint32_t i : particles) sum += run.at(i).x;
  return sum / static_cast<double>(particles.size());
}

/// m, after half a second.
double descent(Run& run, const Slope& slope, int frames = 30) {
  const double from = mean_x(run, slope.sliding);
  run.steps(frames, kFrame);
  return mean_x(run, slope.sliding) - from;
}

Reading layer_begins_to_slide(int refinement) {
  constexpr int kHalvings = 7;
  const double expected = std::atan(kLayerFriction);
  double low = 0.8 * expected, high = 1.2 * expected;
  Reading reading;
  for (int i = 0; i < kHalvings; ++i) {
    const double angle = (low + high) / 2;
    const Slope slope = slope_of(angle, refinement);
    Run run(slope.scene, {});
    (descent(run, slope) > 1e-3 ? high : low) = angle;
    reading = run.reading(size_of(sliding_layer(refinement)), expected * 180 / kPi, 0);
  }
  reading.measured = (low + high) / 2 * 180 / kPi;
  return reading;
}

Reading layer_slides_down(int refinement) {
  constexpr double kAngle = 25 * kPi / 180;
  const Slope slope = slope_of(kAngle, refinement);
  Run run(slope.scene, {});
  constexpr int kFrames = 30;
  const double way = descent(run, slope, kFrames), time = kFrames * kFrame;
  return run.reading(size_of(sliding_layer(refinement)),
                     kGravity * (std::sin(kAngle) - kLayerFriction * std::cos(kAngle)),
                     2 * way / (time * time));
}

// --------------------------------------------------------------------------------------- stack

/// What the lowest of four layers bears and weighs, as the floor under it feels it, in the mean.
Reading stack_weighs(int refinement) {
  constexpr int kLayers = 4, kFrames = 30;
  constexpr double kFloor = 1e-3;  // m
  const Sheet sheet = sheet_of(Pattern::irregular, 0.3, 0.3, 3 << refinement);
  MeshDescription mesh;
  mesh.material = material_of_layers();
  for (int layer = 0; layer < kLayers; ++layer)
    add_layer(sheet, {0.01 * layer, kFloor + layer * kLayer, 0.007 * layer}, mesh);
  Run run(touching(mesh), {});
  const auto id = run.cloth().add_body(
      {.shape = build_shape(Plane{}).value(), .thickness = kFloor, .friction = kLayerFriction});
  if (!id) throw std::runtime_error(id.error());
  run.steps(60, kFrame);
  double load = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    run.step(kFrame);
    load -= run.cloth().body_load(id.value()).value().force.y / kFrames;
  }
  const double area = sheet.length * sheet.width;
  return run.reading(size_of(sheet), kLayers * mesh.material->density * area * kGravity, load);
}

// ---------------------------------------------------------------------------------------- loop

/// Both ends of a strip are held beside each other, a layer apart, and point upwards. Without
/// weight the elastica between them is the pear of Peirce, The Handle of Cloth as a Measurable
/// Quantity, 1930: with theta from the axis, theta'' = N cos theta, theta(0) = 0, theta(L / 2) =
/// pi / 2, x(L / 2) = 0 gives 0.42431 L.
Reading loop_stands(int refinement) {
  constexpr double kLength = 0.24, kWidth = 0.04, kHigh = 0.42431;  // m; of the length
  constexpr int kHeldRows =
      3;  // the clamp is in the middle between the last two, as it bends there
  Material material = material_of_layers();
  material.damping_motion = 10;
  material.thickness = 0.4e-3;
  const int cells = (12 << refinement) + 1;
  const double cell = kLength / cells, held = (kHeldRows - 1.5) * cell;
  const Sheet sheet = sheet_of(Pattern::quads, kLength + 2 * held, kWidth, cells + 3);
  SceneDescription scene = touching(mesh_of(sheet, material));
  std::vector<std::uint32_t> top;
  const double leg = 0.1 * kLength, radius = (kLength - 2 * leg) / (2 * kPi);
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    Vec3& p = scene.positions[i];
    const double s = p.x - held, to_end = std::min(s, kLength - s);
    const double side = s < kLength / 2 ? -1 : 1;
    if (to_end < (kHeldRows - 2) * cell) scene.fixed.push_back(i);
    if (std::abs(s - kLength / 2) < 0.6 * cell) top.push_back(i);
    const double angle = (to_end - leg) / radius;  // around the circle, from below
    p = angle < 0 ? Vec3{side * material.thickness / 2, to_end, p.z}
                  : Vec3{side * (material.thickness / 2 + radius * std::sin(angle)),
                         leg + radius * (1 - std::cos(angle)), p.z};
  }
  scene.gravity = {};
  Run run(scene, {.tolerance = 1e-3});
  run.steps(180, kFrame);
  return run.reading(size_of(sheet), kHigh * kLength, run.mean_y(top));
}

}  // namespace

std::vector<Form> layer_forms() {
  constexpr double kLayerBound = 0.02;
  constexpr double kCreep = 0.03;  // layers creep by 2 mm/s where they are 2 % less steep
  return {
      {"a layer on another one begins to slide", "atan mu", "degrees", layer_begins_to_slide,
       kCreep, false},
      {"a layer slides down another one", "g (sin a - mu cos a)", "m/s^2", layer_slides_down,
       kLayerBound, false},
      {"a stack of four layers lies on its lowest", "4 m g", "N", stack_weighs, kLayerBound, false},
      {"a loop stands whose ends lie on each other", "0.42431 L", "m", loop_stands}};
}

}  // namespace weft::tools::forms
