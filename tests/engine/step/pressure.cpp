/// Pressures: of air that a piece of cloth catches, and given ones. Forces and work against closed
/// forms.
#include "engine/step/pressure.h"

#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <cmath>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/pressed.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_pressure {
namespace {

/// N, the mean of all that acts on the cloth in a step.
Vec3 force_of(const SceneDescription& scene, const Settings& settings, double dt) {
  Cloth cloth = cloth_of(scene, settings);
  const Vec3 before = momentum(scene.masses, velocities(cloth));
  step(cloth, dt);
  return (1 / dt) * (momentum(scene.masses, velocities(cloth)) - before);
}

// ------------------------------------------------------------------------------- ram pressure

TEST_CASE("a plate feels the pressure of the flow along its normal, on the side that it meets") {
  constexpr double kSpeed = 7, kTime = 1e-4;
  for (const double degrees : {0., 20., 60., 90., 150., 180., 270.}) {
    for (const bool turned : {false, true}) {
      for (const Solver solver : {Solver::small_steps, Solver::gauss_seidel}) {
        for (const Backend backend : kBackends) {
          CAPTURE(degrees);
          CAPTURE(turned);
          CAPTURE(name(solver));
          CAPTURE(name(backend));
          const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
          SceneDescription scene = in_air(plate(10), {kSpeed * s, kSpeed * c, 0});
          if (turned) {
            for (auto& t : scene.air.triangles) std::swap(t[1], t[2]);
          }
          const Vec3 force = force_of(scene, {.solver = solver, .backend = backend}, kTime);
          const double expected = -0.5 * kAirDensity * kRam * kSpeed * kSpeed * c * std::abs(c);
          CHECK(force.y == doctest::Approx(expected).epsilon(1e-3));
          CHECK(std::abs(force.x) < 0.02);
          CHECK(std::abs(force.z) < 0.02);
        }
      }
    }
  }
}

TEST_CASE(
    "a wind presses as a plate presses that moves against it; a plate along with it is free") {
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = in_air(plate(10), {0, 3, 0});
    const Vec3 still = force_of(scene, settings, 1e-4);
    scene.air.wind = {2, 5, -1};
    for (Vec3& v : scene.velocities) v = v + scene.air.wind;
    CHECK(distance(force_of(scene, settings, 1e-4), still) < 0.02);
    for (Vec3& v : scene.velocities) v = scene.air.wind;
    CHECK(length(force_of(scene, settings, 1e-4)) < 1e-6);
  }
}

/// The lower half of a sphere is left out: a canopy whose mouth is a polygon.
SceneDescription canopy(double area_density, double* mouth) {
  const TriangleMesh ball = icosphere(1, 3);
  Triangles kept;
  for (const auto& t : triangles_of(ball)) {
    const double y = ball.vertices[t[0]].y + ball.vertices[t[1]].y + ball.vertices[t[2]].y;
    if (y > 0) kept.push_back(t);
  }
  std::vector<std::uint32_t> number(ball.vertices.size(), kNoIndex);
  std::vector<Vec3> positions;
  for (auto& t : kept) {
    for (std::uint32_t& corner : t) {
      if (number[corner] == kNoIndex) {
        number[corner] = static_cast<std::uint32_t>(positions.size());
        positions.push_back(ball.vertices[corner]);
      }
      corner = number[corner];
    }
  }
  *mouth = 0;
  for (const auto& [a, b, c] : kept) {
    *mouth += 0.5 * cross(positions[b] - positions[a], positions[c] - positions[a]).y;
  }
  return loose(positions, kept, area_density);
}

TEST_CASE("a canopy feels the pressure in it over its mouth, and is pushed open around it") {
  for (const Settings& settings : kSmallSteps) {
    double mouth = 0;
    const SceneDescription scene = in_air(canopy(10, &mouth), {0, -4, 0});
    CHECK(mouth == doctest::Approx(M_PI).epsilon(0.05));
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, 1e-4);
    const std::vector<Vec3> v = velocities(cloth);
    const Vec3 force = 1e4 * (momentum(scene.masses, v) - momentum(scene.masses, scene.velocities));
    CHECK(force.y == doctest::Approx(0.5 * kAirDensity * kRam * 16 * mouth).epsilon(0.01));
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3 x = scene.positions[i], pushed = v[i] - Vec3{0, -4, 0};
      CHECK(dot(pushed, x) > 0.9 * length(pushed));
    }
  }
}

TEST_CASE("pieces catch the wind each for itself, and a closed one catches none") {
  for (const Settings& settings : kSmallSteps) {
    const TriangleMesh ball = icosphere(0.5, 2);
    const SceneDescription closed = in_air(loose(ball.vertices, triangles_of(ball), 1), {0, -4, 0});
    CHECK(length(force_of(closed, settings, 1e-4)) < 1e-3);
    // Two plates that move against each other.
    SceneDescription both = in_air(plate(10), {0, -4, 0});
    const SceneDescription other = plate(10);
    const auto first = static_cast<std::uint32_t>(both.positions.size());
    for (const Vec3 p : other.positions) {
      both.positions.push_back(p + Vec3{0, 3, 0});
      both.velocities.push_back({0, 2, 0});
    }
    both.masses.insert(both.masses.end(), other.masses.begin(), other.masses.end());
    for (const auto& [a, b, c] : other.surface)
      both.air.triangles.push_back({first + a, first + b, first + c});
    Cloth cloth = cloth_of(both, settings);
    step(cloth, 1e-4);
    const double half = 0.5 * kAirDensity * kRam / 10 * 1e-4;
    CHECK(cloth.velocity(0).y + 4 == doctest::Approx(16 * half).epsilon(0.01));
    CHECK(cloth.velocity(first).y - 2 == doctest::Approx(-4 * half).epsilon(0.01));
  }
}

TEST_CASE("air at rest never speeds a plate up or turns it back, however light it is") {
  for (const Settings& settings : kSmallSteps) {
    for (const double area_density : {1e-4, 0.01, 1.}) {
      for (const double dt : {1e-3, 1. / 60, 0.5}) {
        CAPTURE(area_density);
        CAPTURE(dt);
        Cloth cloth = cloth_of(in_air(plate(area_density), {0, 5, 0}), settings);
        double before = 5;
        for (int k = 0; k < 5; ++k) {
          step(cloth, dt);
          const double v = cloth.velocity(0).y;
          CHECK(v >= -1e-5);
          CHECK(v <= before + 1e-5);
          before = v;
        }
      }
    }
  }
}

// ------------------------------------------------------------------------------ given pressure

TEST_CASE("a flat patch takes p A t along its normal; what is fixed stays") {
  for (const Settings& settings : kSmallSteps) {
    for (const double pressure : {50., -20.}) {
      SceneDescription scene = plate(0.5);
      scene.fixed = {7};
      Cloth cloth = cloth_of(scene, settings);
      REQUIRE(cloth.set_pressure(pressure));
      step(cloth, 1. / 60);
      CHECK(length(cloth.velocity(7)) == 0);
      double sum = 0, given = 0;
      for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
        if (i == 7) continue;
        sum += scene.masses[i] * cloth.velocity(i).y;
        given += scene.masses[i] / 0.5;
      }
      CHECK(sum == doctest::Approx(pressure * given / 60).epsilon(0.02));
    }
  }
}

TEST_CASE("a closed surface of any shape is not pushed anywhere") {
  Random random(5);
  const TriangleMesh ball = icosphere(0.5, 2);
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = loose(ball.vertices, triangles_of(ball), 1);
    for (Vec3& x : scene.positions) x = x + random.in_box(0.1);
    scene.pressures = {{.pressure = 1000}};
    Cloth cloth = cloth_of(scene, settings);
    step(cloth, 1e-3);
    CHECK(length(cloth.velocity(3)) > 0.3);
    CHECK(length(momentum(scene.masses, velocities(cloth))) < 1e-4);
  }
}

TEST_CASE("two sheets that share a border enclose a volume, though a side in a corner is of four") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, 0.2, 0.5}, {0.5, -0.1, 0.5}};
  scene.masses.assign(6, 1);
  for (const std::uint32_t top : {4u, 5u}) {
    for (auto t : Triangles{{0, 2, 1}, {1, 2, top}, {2, 3, top}, {3, 1, top}}) {
      if (top == 5) std::swap(t[1], t[2]);
      scene.surface.push_back(t);
    }
  }
  scene.pressures = {{.pressure = 1, .gas = true}};
  Cloth cloth = cloth_of(scene, {});
  CHECK(cloth.pressures()[0].volume == doctest::Approx(0.3 * 0.5 / 3));
}

TEST_CASE("a flap swings as the pressure that follows it says, with its work and no more") {
  constexpr double kPressure = 60, kForce = kPressure * 0.5 / 3;
  for (const Settings& settings : kSmallSteps) {
    for (const double dt : {1. / 30, 1. / 60, 1. / 240}) {
      CAPTURE(dt);
      Cloth cloth = cloth_of(flap(), settings);
      REQUIRE(cloth.set_pressure(kPressure));
      double work = 0;
      int frames = 0;
      for (double t = 0; t < 0.5; t += dt, ++frames) work -= step(cloth, dt).energy_lost;
      const double time = frames * dt, angle = 0.5 * kForce * time * time;
      const Vec3 x = cloth.position(2);
      CHECK(x.x == doctest::Approx(std::cos(angle)).epsilon(0.01));
      CHECK(std::abs(x.y) == doctest::Approx(std::abs(std::sin(angle))).epsilon(0.01));
      const double kinetic = 0.5 * dot(cloth.velocity(2), cloth.velocity(2));
      CHECK(kinetic == doctest::Approx(kForce * angle).epsilon(0.01));
      CHECK(std::abs(work) < 0.01 * kinetic);  // what pressure did is no gain, and none is lost
    }
  }
}

TEST_CASE("pressures of parts add up, and those of other triangles do nothing") {
  const TriangleMesh mesh = plane_mesh(1, 2);
  const SceneDescription scene = loose(mesh.vertices, triangles_of(mesh), 1);
  for (const Settings& settings : kSmallSteps) {
    Cloth cloth = cloth_of(scene, settings);
    const std::vector<Pressure> parts{{.pressure = 7, .triangles = {0, 1, 2}},
                                      {.pressure = -4, .triangles = {2}},
                                      {.pressure = 1}};
    REQUIRE(cloth.set_pressure(parts));
    step(cloth, 1e-3);
    const double of_each = 0.125, sum = momentum(scene.masses, velocities(cloth)).y;
    CHECK(sum == doctest::Approx(1e-3 * of_each * (3 * 7 - 4 + 8)).epsilon(1e-3));
  }
}

TEST_CASE("a pressure that changes counts from the next step on, and 0 ends it") {
  for (const Settings& settings : kSmallSteps) {
    Settings at_once = settings;
    at_once.scheme = Scheme::implicit;  // bdf2 is half a substep late
    Cloth cloth = cloth_of(plate(1), at_once);
    double expected = 0;
    for (const double pressure : {100., -250., 30., 0., 60.}) {
      REQUIRE(cloth.set_pressure(pressure));
      CHECK(cloth.pressures().size() == (pressure == 0 ? 0 : 1));
      step(cloth, 0.01);
      expected += 0.01 * pressure;
      CHECK(cloth.velocity(5).y == doctest::Approx(expected).epsilon(1e-4));
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_pressure
