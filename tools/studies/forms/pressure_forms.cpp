/// Air that presses: canopies that fall, a balloon, and a cushion.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

using Triple = std::array<std::uint32_t, 3>;

// ------------------------------------------------------------------------------------- canopies

/// Half a ball, its mouth down, of rings of quads around a cap of triangles.
struct Canopy {
  int rings = 4;
  int around() const { return 3 * rings; }
  std::string size() const { return fmt::format("{} x {} cells", rings, around()); }
};
constexpr double kMouth = 1.5, kLines = 3;  // m: radius; from the mouth down to the load

MeshDescription mesh_of(const Canopy& canopy, const Material& material) {
  MeshDescription mesh;
  mesh.material = material;
  mesh.positions.push_back({0, kMouth, 0});
  const auto around = static_cast<std::uint32_t>(canopy.around());
  const auto at = [&](int ring, std::uint32_t k) {
    return 1 + static_cast<std::uint32_t>(ring - 1) * around + k % around;
  };
  const auto add = [&](std::initializer_list<std::uint32_t> corners) {
    mesh.corners.insert(mesh.corners.end(), corners);
    mesh.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  };
  for (int ring = 1; ring <= canopy.rings; ++ring) {
    const double down = kPi / 2 * ring / canopy.rings;
    for (std::uint32_t k = 0; k < around; ++k) {
      const double turn = 2 * kPi * k / around, r = kMouth * std::sin(down);
      mesh.positions.push_back({r * std::cos(turn), kMouth * std::cos(down), r * std::sin(turn)});
      if (ring == 1)
        add({0, at(1, k + 1), at(1, k)});
      else
        add({at(ring - 1, k), at(ring - 1, k + 1), at(ring, k + 1), at(ring, k)});
    }
  }
  return mesh;
}

/// m^2, as it is: the lines draw it together.
double mouth_of(const Run& run, const SceneDescription& scene) {
  double sum = 0;
  for (const auto& [a, b, c] : scene.air.triangles) {
    const Vec3 p = run.at(a), q = run.at(b), r = run.at(c);
    sum += 0.5 * ((q.z - p.z) * (r.x - p.x) - (q.x - p.x) * (r.z - p.z));
  }
  return sum;
}

/// m/s, of the load, once the canopy falls evenly.
Reading canopy_falls(double load, int refinement) {
  constexpr double kRam = 1.3;
  constexpr int kFrames = 360, kWatched = 60;
  const Canopy canopy{4 << refinement};
  Material material = cotton();
  material.density = 0.05;
  material.drag = material.lift = 0;
  material.ram = kRam;
  SceneDescription scene = scene_of(mesh_of(canopy, material));
  const auto particles = static_cast<std::uint32_t>(scene.positions.size());
  double mass = load;
  for (const double m : scene.masses) mass += m;
  scene.positions.push_back({0, -kLines, 0});
  scene.masses.push_back(load);
  for (std::uint32_t i = 0; i < particles; ++i) {
    if (scene.positions[i].y < 1e-9)
      scene.constraints.push_back({i, particles, std::hypot(kMouth, kLines)});
  }
  const auto speed_with = [&](double area) {
    return std::sqrt(2 * mass * kGravity / (scene.air.density * kRam * area));
  };
  const double speed = speed_with(kPi * kMouth * kMouth);
  scene.velocities.assign(scene.positions.size(), {0, -0.7 * speed, 0});
  Run run(scene, {});
  run.steps(kFrames - kWatched, kFrame);
  const double from = run.at(particles).y;
  run.steps(kWatched, kFrame);
  return run.reading(canopy.size(), speed_with(mouth_of(run, scene)),
                     (from - run.at(particles).y) / (kWatched * kFrame));
}

// -------------------------------------------------------------------------------------- balloon

/// A ball whose triangles are those of an icosahedron, cut in four again and again.
MeshDescription ball_of(double radius, int cuts) {
  const double g = (1 + std::sqrt(5)) / 2;
  MeshDescription mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<Triple> triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto next = static_cast<std::uint32_t>(mesh.positions.size());
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), next);
      const Vec3 p = mesh.positions[a], q = mesh.positions[b];
      if (is_new) mesh.positions.push_back({p.x + q.x, p.y + q.y, p.z + q.z});
      return found->second;
    };
    std::vector<Triple> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triple& t :
           {Triple{a, ab, ca}, Triple{b, bc, ab}, Triple{c, ca, bc}, Triple{ab, bc, ca}})
        finer.push_back(t);
    }
    triangles = std::move(finer);
    for (Vec3& p : mesh.positions) {
      const double to = radius / std::hypot(p.x, p.y, p.z);
      p = {to * p.x, to * p.y, to * p.z};
    }
  }
  for (const Triple& t : triangles) mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
  return mesh;
}

/// m^3
double volume_of(const SceneDescription& scene) {
  double sum = 0;
  for (const auto& [a, b, c] : scene.surface) {
    const Vec3 p = scene.positions[a], q = scene.positions[b], r = scene.positions[c];
    sum += (p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) +
            p.z * (q.x * r.y - q.y * r.x)) /
           6;
  }
  return sum;
}

/// mm, by which its radius grows. Threads of the material pull by k (s - 1) where all is s times as
/// long as at rest, and lie s times as far apart: p r / 2 = T = k (s - 1) / s.
Reading balloon_grows(bool gas, int refinement) {
  constexpr double kRadius = 0.5, kStiffness = 4000, kPressure = 800;  // m, N/m, Pa
  MeshDescription mesh = ball_of(kRadius, 1 + refinement);
  mesh.material = Material{.density = 0.2,
                           .warp = kStiffness,
                           .weft = kStiffness,
                           .shear = kStiffness / 2,
                           .damping_motion = 8};
  SceneDescription scene = scene_of(mesh);
  scene.gravity = {};
  const double load = kPressure * kRadius / (2 * kStiffness);
  const double grown = (1 - std::sqrt(1 - 4 * load)) / (2 * load);
  scene.pressures = {{.pressure = kPressure}};
  if (gas) {  // that has the same pressure when the balloon is as large as that
    scene.pressures[0].gas = true;
    scene.pressures[0].volume = volume_of(scene) * std::pow(grown, 3);
    scene.pressures[0].ambient = 4000;
  }
  Run run(scene, {.tolerance = 1e-3});
  run.steps(90, kFrame);
  double radius = 0;
  const auto count = static_cast<std::uint32_t>(run.cloth().particle_count());
  for (std::uint32_t i = 0; i < count; ++i)
    radius += std::hypot(run.at(i).x, run.at(i).y, run.at(i).z) / count;
  return run.reading(fmt::format("{} triangles", scene.surface.size()), 1e3 * kRadius * (grown - 1),
                     1e3 * (radius - kRadius));
}

// -------------------------------------------------------------------------------------- cushion

/// mm, by which the middle of each side of a square cushion rises: a membrane of 588 MPa and 0.6
/// mm, whose diagonal is 1.2 m, with 5 kPa. Bauer, Wuechner and Bletzinger, and others before them,
/// 216.6 mm with a Poisson's ratio of 0.4; warp and weft here have none.
Reading cushion_rises(int refinement) {
  constexpr double kModulus = 588e6, kThick = 0.6e-3, kRatio = 0.4;  // Pa, m
  constexpr double kPressure = 5000, kRise = 0.2166;                 // Pa, m
  const double side = 1.2 / std::sqrt(2);
  const Material material{.density = 0.6,
                          .warp = kModulus * kThick,
                          .weft = kModulus * kThick,
                          .shear = kModulus * kThick / (2 * (1 + kRatio)),
                          .damping_stretch = 1e-3,
                          .damping_motion = 6};
  const Sheet sheet = sheet_of(Pattern::quads, side, side, 8 << refinement);
  MeshDescription mesh = forms::mesh_of(sheet, material);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const std::size_t corners = mesh.corners.size();
  for (std::uint32_t i = 0; i < first; ++i) {
    Vec3& p = mesh.positions[i];
    mesh.rest_positions.push_back(p);
    p.y = 0.05 * std::sin(kPi * p.x / side) * std::sin(kPi * p.z / side);
    if (p.y < 1e-9) p.y = 0;
  }
  for (std::uint32_t i = 0; i < first; ++i) {
    const Vec3 p = mesh.positions[i];
    mesh.positions.push_back({p.x, -p.y, p.z});
    mesh.rest_positions.push_back(mesh.rest_positions[i]);
  }
  for (std::size_t i = 0; i < corners; ++i) mesh.corners.push_back(first + mesh.corners[i]);
  for (std::size_t i = 0; i < corners; i += 4) std::swap(mesh.corners[i], mesh.corners[i + 2]);
  mesh.face_sizes.resize(2 * mesh.face_sizes.size(), 4);
  SceneDescription scene = scene_of(mesh);
  scene.gravity = {};
  scene.pressures = {{.pressure = kPressure}};
  const auto middle = particles_at(scene, [&](Vec3 p) {
    return std::abs(p.x - side / 2) < 1e-6 && std::abs(p.z - side / 2) < 1e-6;
  });
  Run run(scene, {});
  run.steps(60, kFrame);
  const Vec3 one = run.at(middle.at(0)), other = run.at(middle.at(1));  // it is free to turn
  const double high = std::hypot(one.x - other.x, one.y - other.y, one.z - other.z);
  return run.reading(size_of(sheet), 1e3 * kRise, 1e3 * high / 2);
}

}  // namespace

std::vector<Form> pressure_forms() {
  std::vector<Form> forms;
  for (const double load : {2., 20., 80.}) {
    forms.push_back({fmt::format("a canopy falls with {:g} kg", load),
                     "sqrt(2 m g / rho C_p A), A of the mouth as it is", "m/s",
                     [=](int r) { return canopy_falls(load, r); }});
  }
  forms.push_back({"a balloon grows", "p = 2 T / r, T = k (s - 1) / s", "mm",
                   [](int r) { return balloon_grows(false, r); }});
  forms.push_back({"a balloon of gas grows", "p = 2 T / r, (p + a) V as it was", "mm",
                   [](int r) { return balloon_grows(true, r); }});
  forms.push_back({"a square cushion rises", "216.6 mm with a ratio of 0.4", "mm", cushion_rises});
  return forms;
}

}  // namespace weft::tools::forms
