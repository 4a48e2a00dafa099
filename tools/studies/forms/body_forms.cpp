/// What lies on bodies, slides over them and is taken along by them: sheets and strips of cotton.
#include <weft/body.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tools/scenes/body_meshes.h"
#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

constexpr double kFriction = 0.3;
constexpr double kBound = 0.01;
constexpr double kThickness = 1e-3;  // m, of bodies

/// Air and the decay of motion would be missing in the closed forms.
Material bare_cotton() {
  Material material = cotton();
  material.drag = material.lift = material.damping_motion = 0;
  return material;
}

Sheet square(int refinement) { return sheet_of(Pattern::irregular, 0.5, 0.5, 5 << refinement); }

/// The geometric mean of both frictions counts.
std::uint32_t add(Run& run, const ShapeDescription& shape, double thickness = kThickness) {
  auto built = build_shape(shape);
  if (!built) throw std::runtime_error(built.error());
  const auto id =
      run.cloth().add_body({.shape = built.value(), .thickness = thickness, .friction = kFriction});
  if (!id) throw std::runtime_error(id.error());
  return id.value();
}

Vec3 mean(const std::vector<Vec3>& vectors) {
  Vec3 sum;
  for (const Vec3 v : vectors) sum = {sum.x + v.x, sum.y + v.y, sum.z + v.z};
  const double share = 1 / static_cast<double>(vectors.size());
  return {share * sum.x, share * sum.y, share * sum.z};
}

std::vector<Vec3> positions(Run& run) {
  std::vector<Vec3> all;
  for (std::uint32_t i = 0; i < run.cloth().particle_count(); ++i) all.push_back(run.at(i));
  return all;
}

/// A point of an incline that falls by the angle towards +x.
Vec3 on_incline(double angle, double along, double height, double across) {
  return {std::cos(angle) * along + std::sin(angle) * height,
          std::cos(angle) * height - std::sin(angle) * along, across};
}

/// What bears a sheet: a closed shape, or a mesh of it that gets finer as the sheet does.
enum class Surface { closed, mesh };

/// A plane through the origin, or a plate of triangles in it that do not fit those of the sheet.
ShapeDescription plane(Surface surface, double angle, int refinement) {
  if (surface == Surface::closed) return Plane{.normal = on_incline(angle, 0, 1, 0)};
  TriangleMesh plate = scenes::plate_mesh(11, 3, 31 << refinement, 7 << refinement);
  for (Vec3& v : plate.vertices) v = on_incline(angle, v.x + 3, v.y, v.z);
  return plate;
}

/// Around an axis along z through the origin.
Capsule drum(double radius) { return {{0, 0, -1}, {0, 0, 2}, radius, radius}; }

/// A table from x = -2 m to 0 whose top is at 0.
ShapeDescription table(Surface surface, int along) {
  const Vec3 size{2, 1, 2}, middle{-1, -0.5, 0};
  const auto move = [&](std::vector<Vec3>& points) {
    for (Vec3& p : points) p = {p.x + middle.x, p.y + middle.y, p.z + middle.z};
  };
  if (surface == Surface::mesh) {
    TriangleMesh mesh = scenes::box_mesh(size, along);
    move(mesh.vertices);
    return mesh;
  }
  Hull hull = box(size);
  move(hull.points);
  return hull;
}

/// A sheet on an incline is let go. `descent` is told after so many frames, in the mean.
struct Incline {
  double angle = 0;     // rad
  double friction = 0;  // of the cloth; the geometric mean with that of the plane counts
  int refinement = 0, frames = 0;
  Surface surface = Surface::closed;

  Run run() const {
    SceneDescription scene = scene_of(mesh_of(square(refinement), bare_cotton()));
    for (Vec3& p : scene.positions) p = on_incline(angle, p.x, kThickness, p.z);
    scene.friction = friction;
    Run run(scene, {});
    add(run, plane(surface, angle, refinement));
    return run;
  }
  double descent(Run& run) const {
    const Vec3 from = mean(positions(run));
    run.steps(frames, kFrame);
    const Vec3 to = mean(positions(run));
    return std::hypot(to.x - from.x, to.y - from.y);
  }
};

/// The smallest value in a range that `slides` is true of.
template <class Slides>
double first_slide(double low, double high, Slides&& slides) {
  constexpr int kHalvings = 8;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (slides(middle) ? high : low) = middle;
  }
  return (low + high) / 2;
}

/// A sheet rests on an incline that is less steep, by little.
Reading begins_to_slide(Surface surface, int refinement) {
  const double expected = std::atan(kFriction);
  Reading reading;
  const double angle = first_slide(0.8 * expected, 1.2 * expected, [&](double tried) {
    const Incline incline{tried, kFriction, refinement, 60, surface};
    Run run = incline.run();
    const bool slides = incline.descent(run) > 1e-3;
    reading = run.reading(size_of(square(refinement)), 0, 0);
    return slides;
  });
  reading.expected = expected * 180 / kPi;
  reading.measured = angle * 180 / kPi;
  return reading;
}

Reading slides_down(Surface surface, double friction, int refinement) {
  const Incline incline{25 * kPi / 180, friction * friction / kFriction, refinement, 60, surface};
  Run run = incline.run();
  const double descent = incline.descent(run), time = incline.frames * kFrame;
  return run.reading(size_of(square(refinement)),
                     kGravity * (std::sin(incline.angle) - friction * std::cos(incline.angle)),
                     2 * descent / (time * time));
}

/// What a plane bears after a second.
Reading weighs(Surface surface, int refinement) {
  const Incline level{0, kFriction, refinement, 60, surface};
  Run run = level.run();
  level.descent(run);
  const Sheet sheet = square(refinement);
  const double mass = bare_cotton().density * sheet.length * sheet.width;
  return run.reading(size_of(sheet), mass * kGravity, -run.cloth().body_load(0).value().force.y);
}

/// A plane moves from rest at 2 m/s. The sheet on it reaches its speed by and by.
Reading is_dragged(Surface surface, int refinement) {
  constexpr double kSpeed = 2;  // m/s
  constexpr int kFrames = 60;
  const Incline level{0, kFriction, refinement, 1, surface};
  Run run = level.run();
  const double from = mean(positions(run)).x;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const auto moved = run.cloth().move_body(0, {.position = {kSpeed * frame * kFrame, 0, 0}});
    if (!moved) throw std::runtime_error(moved.error());
    run.step(kFrame);
  }
  const double reached = kSpeed / (kFriction * kGravity);
  return run.reading(size_of(square(refinement)), kSpeed * (kFrames * kFrame - reached / 2),
                     mean(positions(run)).x - from);
}

constexpr double kDrum = 0.1, kNearSide = 0.2;  // m: its radius, and what hangs from its near side
constexpr double kHalfWay = kPi * kDrum / 2;

/// m, that may hang from the far side of the drum. With the weight w per length and the tension T
/// at the angle p from the near side, where the strip is about to slide
/// T' = mu (T + w r sin p) + w r cos p.
double held_length(double near) {
  const double b = 2 * kFriction * kDrum / (1 + kFriction * kFriction);
  return (near + b) * std::exp(kFriction * kPi) + b;
}

/// A strip over the drum that comes to hang from both sides. It is slowed down while it does.
struct HungStrip {
  Sheet sheet;
  SceneDescription scene{};
  std::vector<std::uint32_t> near{}, far{};  // the ends
};

HungStrip strip_over_drum(double far, int refinement) {
  Material material = bare_cotton();
  material.damping_motion = 10;
  const double length = kNearSide + 2 * kHalfWay + far;
  HungStrip strip{.sheet = sheet_of(Pattern::quads, length, length / 15, 60 << refinement)};
  strip.scene = scene_of(mesh_of(strip.sheet, material));
  strip.near = particles_at(strip.scene, [](Vec3 p) { return p.x < 1e-9; });
  strip.far = particles_at(strip.scene, [&](Vec3 p) { return p.x > length - 1e-9; });
  for (Vec3& p : strip.scene.positions) {
    const double s = p.x - kNearSide - kHalfWay, hangs = std::abs(s) - kHalfWay, angle = s / kDrum;
    p = hangs > 0 ? Vec3{std::copysign(kDrum, s), -hangs, p.z}
                  : Vec3{kDrum * std::sin(angle), kDrum * std::cos(angle), p.z};
  }
  strip.scene.friction = kFriction;
  return strip;
}

/// What hangs once the strip, which was let go without tension, has come to rest: the longest.
Reading is_held_by_a_drum(int refinement) {
  constexpr int kSubsteps = 15;
  Reading reading;
  const double expected = held_length(kNearSide);
  first_slide(0.8 * expected, 1.1 * expected, [&](double tried) {
    const HungStrip strip = strip_over_drum(tried, refinement);
    Run run(strip.scene, {.substeps = kSubsteps});
    add(run, drum(kDrum), 0);
    run.steps(60, kFrame);
    const double near = -run.mean_y(strip.near), far = -run.mean_y(strip.far);
    run.steps(60, kFrame);
    const bool slides = -run.mean_y(strip.far) > far + 3e-4;
    if (!slides) reading = run.reading(size_of(strip.sheet), held_length(near), far);
    return slides;
  });
  return reading;
}

/// Twice the kinetic and potential energy per mass.
double energy(Run& run, const SceneDescription& scene) {
  double sum = 0, mass = 0;
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    const Vec3 v = run.cloth().velocity(i);
    sum += scene.masses[i] * (v.x * v.x + v.y * v.y + v.z * v.z + 2 * kGravity * run.at(i).y);
    mass += scene.masses[i];
  }
  return sum / mass;
}

double height(Run& run, const SceneDescription& scene) {
  double sum = 0, mass = 0;
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    sum += scene.masses[i] * run.at(i).y;
    mass += scene.masses[i];
  }
  return sum / mass;
}

/// Of a sheet that slides for some frames: the speed that its fall leaves it, and what it has.
Reading keeps_its_speed(const Sheet& sheet, const SceneDescription& scene,
                        const ShapeDescription& shape, int frames) {
  Run run(scene, {});
  add(run, shape);
  const double start = energy(run, scene);
  run.steps(frames, kFrame);
  const double fell = 2 * kGravity * height(run, scene);
  return run.reading(size_of(sheet), std::sqrt(start - fell), std::sqrt(energy(run, scene) - fell));
}

/// From the top of a drum of a metre down its side, as far as it stays on it.
Reading slides_over_a_drum(int refinement) {
  constexpr double kRadius = 1, kSpeed = 1;  // m, m/s
  const Sheet sheet = square(refinement);
  SceneDescription scene = scene_of(mesh_of(sheet, bare_cotton()));
  scene.friction = 0;
  for (Vec3& p : scene.positions) {
    const double angle = p.x / (kRadius + kThickness);
    scene.velocities.push_back({kSpeed * std::cos(angle), -kSpeed * std::sin(angle), 0});
    p = {(kRadius + kThickness) * std::sin(angle), (kRadius + kThickness) * std::cos(angle), p.z};
  }
  return keeps_its_speed(sheet, scene, drum(kRadius), 18);
}

/// A sheet whose first corner is at (x, 0) and which moves along x at 2 m/s, as high as it lies.
SceneDescription sliding_sheet(const Sheet& sheet, double x) {
  constexpr double kSpeed = 2;  // m/s
  SceneDescription scene = scene_of(mesh_of(sheet, bare_cotton()));
  scene.friction = 0;
  for (Vec3& p : scene.positions) p = {p.x + x, kThickness, p.z - sheet.width / 2};
  scene.velocities.assign(scene.positions.size(), {kSpeed, 0, 0});
  return scene;
}

/// Along a table and over its edge, until half of it hangs.
Reading slides_off_a_table(Surface surface, int refinement) {
  const Sheet sheet = square(refinement);
  return keeps_its_speed(sheet, sliding_sheet(sheet, -1), table(surface, 5 << refinement), 30);
}

/// Over two metres of triangles.
Reading slides_over_a_plate(int refinement) {
  const Sheet sheet = square(refinement);
  return keeps_its_speed(sheet, sliding_sheet(sheet, 0), plane(Surface::mesh, 0, refinement), 60);
}

Form within_bound(std::string name, std::string formula, std::string unit,
                  std::function<Reading(int)> measure) {
  return {std::move(name), std::move(formula), std::move(unit), std::move(measure), kBound, false};
}

}  // namespace

std::vector<Form> body_forms() {
  std::vector<Form> forms;
  const auto add = [&](const std::string& name, Surface surface, std::string formula,
                       std::string unit, auto measure) {
    forms.push_back(within_bound(surface == Surface::mesh ? name + " (mesh)" : name,
                                 std::move(formula), std::move(unit),
                                 [=](int r) { return measure(surface, r); }));
  };
  const auto slides = [](double friction) {
    return [=](Surface surface, int r) { return slides_down(surface, friction, r); };
  };
  const std::string falls = "sqrt(v^2 + 2 g h)";
  for (const Surface surface : {Surface::closed, Surface::mesh}) {
    add("a sheet on an incline begins to slide", surface, "atan mu", "degrees", begins_to_slide);
    add("a sheet slides down an incline", surface, "g (sin a - mu cos a)", "m/s^2",
        slides(kFriction));
    add("a sheet slides down an incline, without friction", surface, "g sin a", "m/s^2", slides(0));
    add("a sheet lies on a plane", surface, "m g", "N", weighs);
    add("a plane drags a sheet", surface, "v (t - v / 2 mu g)", "m", is_dragged);
    add("a sheet slides off a table, without friction", surface, falls, "m/s", slides_off_a_table);
  }
  forms.push_back(within_bound("a strip is held by a drum",
                               "(h + b) e^(mu pi) + b, b = 2 mu r / (1 + mu^2)", "m",
                               is_held_by_a_drum));
  // Not over a mesh: between particles that lie on it a coarse sheet would be inside.
  forms.push_back(within_bound("a sheet slides over a drum, without friction", falls, "m/s",
                               slides_over_a_drum));
  forms.push_back(within_bound("a sheet slides over a plate of triangles, without friction", "v",
                               "m/s", slides_over_a_plate));
  return forms;
}

}  // namespace weft::tools::forms
