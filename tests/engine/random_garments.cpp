/// Layers drawn by chance that are sewn, tear, keep creases and slide on a rail, and bodies that
/// they move: no step gains energy, and one that has converged holds all that it reports.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <weft/mesh.h>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/free_body.h"
#include "tests/support/motion.h"
#include "tests/support/random_cases.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_random_garments {
namespace {

constexpr double kG = 10;         // m/s^2
constexpr double kSeconds = 0.7;  // of a case

struct FreeBall {
  double radius = 0, mass = 0;
  Vec3 place{};
};
struct Case {
  std::uint32_t seed = 0, rate = 60, count = 1;  // frames a second, layers
  SceneDescription scene{};
  Settings settings{};
  std::vector<FreeBall> balls{};
  bool has_floor = false;
};

template <class T>
T one_of(std::initializer_list<T> list, Random& random) {
  return list.begin()[random.below(static_cast<std::uint32_t>(list.size()))];
}
bool chance(int of_ten, Random& random) {
  return random.below(10) < static_cast<std::uint32_t>(of_ten);
}

/// Layers of size x size vertices below each other. Along some of the first row each is sewn to the
/// next.
MeshDescription layers(std::uint32_t count, std::uint32_t size, double spacing, Random& random) {
  const MeshDescription layer = chance(5, random) ? quads(size) : right_triangles(size);
  const double apart = random.between(0.1, 0.6) * spacing;
  const std::uint32_t sewn = random.below(size + 1), vertices = size * size;
  MeshDescription mesh;
  for (std::uint32_t k = 0; k < count; ++k) {
    for (std::uint32_t i = 0; i < vertices; ++i)
      mesh.positions.push_back({spacing * (i % size), -apart * k, spacing * (i / size)});
    for (const std::uint32_t corner : layer.corners) mesh.corners.push_back(corner + k * vertices);
    mesh.face_sizes.insert(mesh.face_sizes.end(), layer.face_sizes.begin(), layer.face_sizes.end());
    for (std::uint32_t i = 0; i < sewn && k > 0; ++i)
      mesh.seams.push_back({i + (k - 1) * vertices, i + k * vertices});
  }
  mesh.seam_time = random.between(0.1, 0.5);
  Material material = find_material(one_of({"cotton", "silk", "denim", "wool"}, random)).value();
  if (chance(4, random)) material.strength = std::pow(10, random.between(0, 3));
  if (chance(3, random)) material.bending_yield = std::pow(10, random.between(0, 2));
  if (chance(2, random)) material.bending_friction = std::pow(10, random.between(-5, -3));
  mesh.material = material;
  if (chance(3, random)) mesh.pins = {0};
  if (chance(3, random)) mesh.pins = {0, size - 1, size * (size - 1), vertices - 1};
  return mesh;
}

/// Some of the first row slide on a rail that leads along it.
void add_rail(SceneDescription& scene, std::uint32_t size, double spacing, Random& random) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (int i = 0; i < 5; ++i) {
    scene.positions.push_back({(0.5 * i - 0.5) * spacing * size, 0.1 * spacing * (i % 2), 0});
    scene.masses.push_back(0.01);
    scene.fixed.push_back(first + static_cast<std::uint32_t>(i));
    scene.rail_particles.push_back(scene.fixed.back());
  }
  for (std::uint32_t i = 0; i < size; i += 1 + random.below(2)) {
    if (std::ranges::find(scene.fixed, i) == scene.fixed.end())
      scene.sliders.push_back({.particle = i, .first = 0, .last = 4, .friction = 0.3});
  }
}

Case random_garment(std::uint32_t seed) {
  Random random(seed);
  Case c;
  c.seed = seed;
  c.rate = one_of({30u, 60u, 60u, 240u}, random);
  c.count = 1 + random.below(3);
  const std::uint32_t size = 4 + random.below(7);
  const double spacing = one_of({0.02, 0.05, 0.1}, random);
  c.scene = made(layers(c.count, size, spacing, random)).scene;
  c.scene.gravity = {0, -kG, 0};
  c.scene.air.density = 0;
  if (chance(4, random)) add_rail(c.scene, size, spacing, random);
  if (chance(5, random))
    c.scene.self_contact = {.on = true, .thickness = 0.05 * spacing, .friction = 0.3};
  c.settings = {.tolerance = one_of({0.003, 0.01, 0.05}, random), .threads = 1};
  if (chance(2, random)) c.settings.substeps = 4 + static_cast<int>(random.below(20));
  c.has_floor = chance(5, random);
  for (std::uint32_t i = random.below(3); i > 0; --i) {
    const double radius = random.between(1.05, 2) * spacing, x = spacing * size / 2;
    c.balls.push_back({radius,
                       std::pow(10, random.between(-4, 0)),
                       {x + radius * (i - 1.), radius + 0.1 * i, x}});
  }
  return c;
}

std::string text(const Case& c) {
  std::ostringstream out;
  out << "WEFT_SEED=" << c.seed << " WEFT_CASES=1: " << c.count << " layers, "
      << c.scene.seams.size() << " seams, " << c.scene.sliders.size() << " sliders, "
      << c.balls.size() << " balls, rate " << c.rate << ", floor " << c.has_floor
      << ", self-contact " << c.scene.self_contact.on;
  return out.str();
}

/// What a step that has converged holds.
void check_promise(const Settings& s, const StepReport& report) {
  CHECK(report.max_error <= s.tolerance);
  CHECK(report.max_penetration <= s.contact_tolerance);
  CHECK(report.max_seam_gap <= s.contact_tolerance);
  CHECK(report.max_rail_gap <= s.contact_tolerance);
  CHECK(report.late_seams == 0);
}

void check_case(const Case& c) {
  INFO(text(c));
  Cloth cloth = cloth_of(c.scene, c.settings);
  if (c.has_floor) add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, -0.3}), .friction = 0.3});
  std::vector<Free> balls;
  for (const FreeBall& ball : c.balls)
    balls.push_back(add_free(cloth, Ball{{}, ball.radius}, ball.mass, {.position = ball.place}));
  const auto energy = [&] {
    double sum = cloth.energy().total();
    for (const Free& ball : balls) sum += ball.energy(cloth, kG);
    return sum;
  };
  double mass = 0, seam_work = 0, before = 0;
  int tangled = 0;
  for (const double m : c.scene.masses) mass += m;
  for (const FreeBall& ball : c.balls) mass += ball.mass;
  const double scale = mass * kG;  // J, of a fall of 1 m
  for (int k = 0; k < static_cast<int>(kSeconds * c.rate); ++k) {
    CAPTURE(k);
    const StepReport report = step(cloth, 1. / c.rate);
    CAPTURE(name(report.status));
    REQUIRE(committed(report.status));
    if (report.status == Status::converged) {
      check_promise(c.settings, report);
      if (tangled == 0) CHECK(report.tangled == 0);
    }
    tangled = report.tangled;
    seam_work += std::max(0.0, report.seam_work);
    const double now = energy();
    REQUIRE(std::isfinite(now));
    if (k == 0) before = now;  // sliders were put on their rail
    CHECK(now - before <= seam_work + 0.04 * scale);
  }
}

TEST_CASE("random garments: a step that has converged keeps its promise, and nothing is thrown") {
  for_each_case(100, random_garment, check_case);
}

}  // namespace
}  // namespace weft::test::engine_random_garments
