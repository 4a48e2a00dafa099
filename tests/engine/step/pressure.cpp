/// Pressures: of air that a piece of cloth catches, given ones, and of gas. Forces, work and rest
/// against closed forms.
#include "engine/step/pressure.h"

#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "engine/isa.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_pressure {
namespace {

constexpr double kDensity = 1.2;  // kg/m^3
constexpr double kRam = 1.3;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles triangles_of(const TriangleMesh& mesh) {
  return {mesh.triangles.begin(), mesh.triangles.end()};
}

/// Nothing holds the particles: each has the mass of a third of its triangles.
SceneDescription loose(const std::vector<Vec3>& positions, const Triangles& triangles,
                       double area_density) {
  SceneDescription scene;
  scene.positions = positions;
  scene.surface = triangles;
  scene.masses.assign(positions.size(), 0);
  for (const auto& [a, b, c] : triangles) {
    const double area =
        0.5 * length(cross(positions[b] - positions[a], positions[c] - positions[a]));
    for (const std::uint32_t corner : {a, b, c}) scene.masses[corner] += area_density * area / 3;
  }
  scene.gravity = {};
  return scene;
}

/// A square of 1 m in the plane y = 0, its normal along y.
SceneDescription plate(double area_density) {
  const TriangleMesh mesh = plane_mesh(1, 4);
  return loose(mesh.vertices, triangles_of(mesh), area_density);
}

SceneDescription in_air(SceneDescription scene, Vec3 velocity) {
  scene.air.triangles = scene.surface;
  scene.air.density = kDensity;
  scene.air.ram = kRam;
  scene.velocities.assign(scene.positions.size(), velocity);
  return scene;
}

constexpr Settings kSmallSteps[] = {{.solver = Solver::small_steps, .backend = Backend::reference},
                                    {.solver = Solver::small_steps, .backend = Backend::simd}};

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
          const double expected = -0.5 * kDensity * kRam * kSpeed * kSpeed * c * std::abs(c);
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
    CHECK(force.y == doctest::Approx(0.5 * kDensity * kRam * 16 * mouth).epsilon(0.01));
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
    const double half = 0.5 * kDensity * kRam / 10 * 1e-4;
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

/// A triangle whose first two corners are fixed, on the axis z; the third, of 1 kg, is 1 m off it.
SceneDescription flap() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}};
  scene.masses = {1, 1, 1};
  scene.fixed = {0, 1};
  scene.constraints = {{0, 2, std::hypot(1, 0.5)}, {1, 2, std::hypot(1, 0.5)}};
  scene.surface = {{0, 1, 2}};
  scene.gravity = {};
  return scene;
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

// ------------------------------------------------------------------------------------- balloon

constexpr double kRadius = 0.5;  // m

/// A balloon of fabric, 0.2 kg/m^2, at rest.
SceneDescription balloon(int level, double stiffness, double damping) {
  const TriangleMesh ball = icosphere(kRadius, level);
  MeshDescription mesh;
  mesh.positions = ball.vertices;
  for (const auto& t : ball.triangles) mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
  mesh.material = Material{.density = 0.2,
                           .warp = stiffness,
                           .weft = stiffness,
                           .shear = stiffness / 2,
                           .damping_motion = damping};
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.gravity = {};
  return scene;
}

double mean_radius(const Cloth& cloth) {
  double sum = 0;
  for (const Vec3& x : positions(cloth)) sum += length(x);
  return sum / static_cast<double>(cloth.particle_count());
}

TEST_CASE("a balloon grows until its pressure is 2 T / r") {
  constexpr double kStiffness = 4000, kPressure = 800;
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = balloon(2, kStiffness, 8);
    scene.pressures = {{.pressure = kPressure}};
    Settings tight = settings;
    tight.tolerance = 1e-3;
    Cloth cloth = cloth_of(scene, tight);
    run(cloth, 1. / 60, 60);
    CHECK(step(cloth, 1. / 60).status == Status::converged);
    // T = k (r - R) / R: warp and weft do not contract each other.
    const double radius = 1 / (1 / kRadius - kPressure / (2 * kStiffness));
    CHECK(mean_radius(cloth) - kRadius ==
          doctest::Approx(radius - kRadius).epsilon(0.06));  // a polyhedron
    CHECK(cloth.pressures()[0].pressure == kPressure);
    CHECK(cloth.pressures()[0].volume ==
          doctest::Approx(4. / 3 * M_PI * std::pow(radius, 3)).epsilon(0.05));
    double fastest = 0;
    for (const Vec3& v : velocities(cloth)) fastest = std::max(fastest, length(v));
    CHECK(fastest < 0.2);  // a ball without bending shivers
  }
}

TEST_CASE("a balloon that breathes gains no energy, and keeps most of it") {
  constexpr double kPressure = 600;
  for (const Settings& settings : kSmallSteps) {
    for (const double dt : {1. / 60, 1. / 240}) {
      CAPTURE(dt);
      Cloth cloth = cloth_of(balloon(2, 3000, 0), settings);
      REQUIRE(cloth.set_pressure(kPressure));
      const auto energy = [&] {
        return cloth.energy().total() - kPressure * cloth.pressures()[0].volume;
      };
      const double start = energy();
      double most = start;
      for (int k = 0; k < 30; ++k) {
        step(cloth, dt);
        most = std::max(most, energy());
      }
      const double whole = kPressure * 4. / 3 * M_PI * std::pow(kRadius, 3) * 0.3;
      CHECK(most - start < 0.02 * whole);
    }
  }
}

// ------------------------------------------------------------------------------------------ gas

/// A column of gas, 1 m high and 0.25 m^2 wide, under a rigid piston of 5 kg that gravity loads.
SceneDescription piston(double ambient, double damping) {
  SceneDescription scene;
  for (const double y : {0., 1.}) {
    for (const double x : {-0.25, 0.25}) {
      for (const double z : {-0.25, 0.25}) scene.positions.push_back({x, y, z});
    }
  }
  scene.masses.assign(8, 1.25);
  scene.fixed = {0, 1, 2, 3};
  for (std::uint32_t a = 4; a < 8; ++a) {
    for (std::uint32_t b = a + 1; b < 8; ++b)
      scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
  }
  scene.surface = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  scene.damping.motion = damping;
  scene.pressures = {{.pressure = 0, .gas = true, .ambient = ambient}};
  return scene;
}

TEST_CASE("a gas under a piston keeps its pressure times its volume") {
  constexpr double kAmbient = 1000, kArea = 0.25;
  for (const Settings& settings : kSmallSteps) {
    for (const double mass : {5., 20.}) {
      CAPTURE(mass);
      SceneDescription scene = piston(kAmbient, 4);
      for (std::uint32_t i = 4; i < 8; ++i) scene.masses[i] = mass / 4;
      Settings tight = settings;
      tight.tolerance = 1e-5;  // or the gas makes the piston wider
      Cloth cloth = cloth_of(scene, tight);
      CHECK(cloth.pressures()[0].volume == doctest::Approx(kArea));
      CHECK(cloth.pressures()[0].pressure == doctest::Approx(0));
      run(cloth, 1. / 60, 300);
      const double height = kAmbient / (kAmbient + 10 * mass / kArea);
      CHECK(cloth.position(4).y == doctest::Approx(height).epsilon(0.01));  // it turns a little
      const PressureNow now = cloth.pressures()[0];
      CHECK(now.pressure == doctest::Approx(10 * mass / kArea).epsilon(0.01));
      CHECK(now.volume == doctest::Approx(kArea * height).epsilon(4e-3));
      CHECK((kAmbient + now.pressure) * now.volume == doctest::Approx(kAmbient * kArea));
    }
  }
}

TEST_CASE("a piston swings on a gas with its frequency, and gains no energy") {
  constexpr double kAmbient = 4000, kMass = 5, kArea = 0.25;
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = piston(kAmbient, 0);
    scene.velocities.assign(8, {});
    scene.gravity = {};
    for (std::uint32_t i = 4; i < 8; ++i) scene.velocities[i] = {0, -0.3, 0};
    Cloth cloth = cloth_of(scene, settings);
    const double expected = std::sqrt(kAmbient * kArea / kMass) / (2 * M_PI);
    constexpr double kTime = 1. / 240;
    int crossings = 0;
    double first = 0, last = 0, before = 1, fastest = 0;
    for (int k = 1; k <= 480; ++k) {
      step(cloth, kTime);
      const double y = cloth.position(4).y;
      fastest = std::max(fastest, std::abs(cloth.velocity(4).y));
      if ((y - 1) * (before - 1) < 0) {
        (crossings++ == 0 ? first : last) = (k - (y - 1) / (y - before)) * kTime;
      }
      before = y;
    }
    CHECK((crossings - 1) / (2 * (last - first)) == doctest::Approx(expected).epsilon(0.02));
    CHECK(fastest < 0.301);
  }
}

TEST_CASE("a bag that lies flat is blown up by the volume that its gas has elsewhere") {
  for (const Settings& settings : kSmallSteps) {
    SceneDescription scene = balloon(2, 4000, 8);
    scene.pressures = {{.pressure = 2000, .gas = true}};
    Cloth cloth = cloth_of(scene, settings);
    const double volume = cloth.pressures()[0].volume;
    for (Vec3& x : scene.positions) x.y *= 0.01;
    scene.pressures[0].volume = volume;
    Cloth flat = cloth_of(scene, settings);
    CHECK(flat.pressures()[0].volume < 0.02 * volume);
    CHECK(flat.pressures()[0].pressure > 1e6);
    run(cloth, 1. / 60, 90);
    run(flat, 1. / 60, 90);
    CHECK(flat.pressures()[0].volume == doctest::Approx(cloth.pressures()[0].volume).epsilon(0.01));
  }
}

// ------------------------------------------------------------------- what a Cloth does with them

std::string refusal(Cloth& cloth, const std::vector<Pressure>& pressures) {
  const std::uint64_t before = cloth.state_hash();
  const auto set = cloth.set_pressure(pressures);
  CHECK(cloth.state_hash() == before);
  CHECK(cloth.pressures().empty());
  return set ? "" : set.error();
}

TEST_CASE("what is wrong with a pressure is refused by field and value, and changes nothing") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto begins = [](const std::string& error, const char* with) {
    CAPTURE(error);
    CHECK(error.starts_with(with));
    CHECK(error.find('\n') == std::string::npos);
  };
  Cloth open = cloth_of(plate(1), {});
  begins(refusal(open, {{.pressure = kNan}}), "pressures[0].pressure: must be finite (nan)");
  begins(refusal(open, {{.pressure = 1}, {.pressure = 1, .triangles = {3, 99}}}),
         "pressures[1].triangles[1]: no such triangle, the surface has 32 (99)");
  begins(refusal(open, {{.pressure = 1, .triangles = {3, 5, 3}}}),
         "pressures[0].triangles: lists a triangle twice (3)");
  begins(refusal(open, {{.pressure = 1, .gas = true}}), "pressures[0].gas: its triangles do not");
  CHECK_FALSE(open.set_pressure(kNan));

  const TriangleMesh ball = icosphere(kRadius, 1);
  Cloth closed = cloth_of(loose(ball.vertices, triangles_of(ball), 1), {});
  begins(refusal(closed, {{.pressure = -2e5, .gas = true}}),
         "pressures[0].pressure: a gas has more than none");
  begins(refusal(closed, {{.pressure = 1, .gas = true, .volume = -1}}), "pressures[0].volume: ");
  begins(refusal(closed, {{.pressure = 1, .gas = true, .ambient = 0}}), "pressures[0].ambient: ");
  SceneDescription inside_out = loose(ball.vertices, triangles_of(ball), 1);
  for (auto& t : inside_out.surface) std::swap(t[1], t[2]);
  Cloth turned = cloth_of(inside_out, {});
  begins(refusal(turned, {{.pressure = 1, .gas = true}}), "pressures[0].gas: its normals must");
  CHECK(closed.set_pressure({}));

  Cloth bar = cloth_of(free_bar(1, 1), {});
  begins(refusal(bar, {{.pressure = 1}}), "pressures[0]: needs the triangles of `surface`");
  Cloth by_yarns = cloth_of(flap(), {.solver = Solver::direct});
  begins(refusal(by_yarns, {{.pressure = 1}}), "pressures: needs solver small_steps (direct)");
  SceneDescription scene = flap();
  scene.pressures = {{.pressure = 1}};
  const auto refused = Cloth::create(model_of(scene), {.solver = Solver::direct});
  REQUIRE_FALSE(refused);
  begins(refused.error(), "pressures: is solved by small_steps only");
  scene.pressures = {{.pressure = kNan}};
  CHECK(build_model(scene).error().starts_with("pressures[0].pressure: "));
  scene = flap();
  scene.air.ram = -1;
  CHECK(build_model(scene).error().starts_with("air.ram: "));
  scene.air.ram = 1;
  CHECK(build_model(scene).error().starts_with("air.ram: given without air.triangles"));
}

TEST_CASE("a cloth goes on by small steps with a pressure, and no pressure changes nothing") {
  Cloth cloth = cloth_of(scene_of("hang", 6), {}), other = cloth_of(scene_of("hang", 6), {});
  REQUIRE(other.set_pressure(0));
  run(cloth, 0.01, 5);
  run(other, 0.01, 5);
  CHECK(cloth.state_hash() == other.state_hash());
  SceneDescription scene = flap();
  Cloth chosen = cloth_of(scene, {});
  run(chosen, 0.01, 2);
  REQUIRE(chosen.set_pressure(5));
  CHECK(chosen.settings().solver == Solver::small_steps);
  REQUIRE(chosen.change({.masses = {{2, 2}}}));
  CHECK(chosen.pressures().size() == 1);
  step(chosen, 0.01);
  CHECK(length(chosen.velocity(2)) > 0);
}

TEST_CASE("a step that fails leaves the state as it was, under any pressure") {
  for (const Settings& settings : kSmallSteps) {
    Cloth cloth = cloth_of(balloon(1, 3000, 0), settings);
    REQUIRE(cloth.set_pressure(500));
    run(cloth, 0.01, 3);
    const std::uint64_t before = cloth.state_hash();
    const std::vector<std::byte> saved = cloth.save_state();
    std::vector<Vec3> forces(cloth.particle_count());
    forces[5] = {1e308, 0, 0};
    REQUIRE(cloth.write_forces(forces));
    CHECK(step(cloth, 0.01).status == Status::non_finite_input);
    REQUIRE(cloth.write_forces({}));
    CHECK(cloth.state_hash() == before);
    Cloth other = cloth_of(balloon(1, 3000, 0), settings);
    REQUIRE(other.load_state(saved));
    run(cloth, 0.01, 3);
    run(other, 0.01, 3);
    CHECK(cloth.state_hash() == other.state_hash());
  }
}

TEST_CASE("states are saved, loaded and copied with their pressures, and go on bit for bit") {
  for (const Settings& settings : kSmallSteps) {
    const SceneDescription scene = balloon(1, 3000, 0);
    Cloth cloth = cloth_of(scene, settings);
    const std::vector<Pressure> parts{{.pressure = 900, .gas = true, .ambient = 5000},
                                      {.pressure = -30, .triangles = {4, 7}}};
    REQUIRE(cloth.set_pressure(parts));
    run(cloth, 0.01, 3);
    Cloth loaded = cloth_of(scene, settings);
    Cloth copied = Cloth::create(cloth.model(), settings).value();
    REQUIRE(loaded.load_state(cloth.save_state()));
    REQUIRE(copied.copy_state(cloth));
    CHECK(loaded.pressures()[0].volume == cloth.pressures()[0].volume);
    run(cloth, 0.01, 3);
    run(loaded, 0.01, 3);
    run(copied, 0.01, 3);
    CHECK(loaded.state_hash() == cloth.state_hash());
    CHECK(copied.state_hash() == cloth.state_hash());
    CHECK(loaded.save_state() == cloth.save_state());
  }
}

TEST_CASE("a pressure of a description is one that is set, and stays in models that are saved") {
  SceneDescription scene = balloon(1, 3000, 0);
  Cloth set = cloth_of(scene, {});
  const std::vector<Pressure> parts{{.pressure = 900, .gas = true}};
  REQUIRE(set.set_pressure(parts));
  scene.pressures = parts;
  const auto model = load_model(save_model(*model_of(scene)));
  REQUIRE(model);
  Cloth of_model = cloth_of(scene, {});
  auto of_saved = Cloth::create(model.value(), {});
  run(set, 0.01, 3);
  run(of_model, 0.01, 3);
  run(of_saved.value(), 0.01, 3);
  CHECK(of_model.state_hash() == set.state_hash());
  CHECK(of_saved.value().state_hash() == set.state_hash());
}

TEST_CASE("threads and instruction sets change no bit of pressures") {
  const TriangleMesh ball = icosphere(kRadius, 5);
  SceneDescription scene = in_air(loose(ball.vertices, triangles_of(ball), 1), {0, -3, 0});
  scene.pressures = {{.pressure = 300, .gas = true}};
  scene.air.triangles.resize(scene.air.triangles.size() / 2);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    for (const Isa isa : {Isa::avx2, Isa::avx512}) {
      if (!resolve(isa)) continue;
      Cloth cloth =
          cloth_of(scene, {.solver = Solver::small_steps, .isa = isa, .threads = threads});
      run(cloth, 1. / 60, 3);
      hashes.push_back(cloth.state_hash());
    }
  }
  for (const std::uint64_t hash : hashes) CHECK(hash == hashes.front());
}

TEST_CASE("a cloth that sleeps wakes where its pressure becomes another one") {
  SceneDescription scene = flap();
  scene.damping.motion = 5;
  scene.gravity = {0, -10, 0};
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .sleep = true});
  REQUIRE(cloth.set_pressure(1));
  for (int k = 0; k < 2000 && !step(cloth, 1. / 60).asleep; ++k) {
  }
  REQUIRE(step(cloth, 1. / 60).asleep);
  REQUIRE(cloth.set_pressure(1));
  CHECK(step(cloth, 1. / 60).asleep);
  REQUIRE(cloth.set_pressure(40));
  CHECK_FALSE(step(cloth, 1. / 60).asleep);
}

}  // namespace
}  // namespace weft::test::engine_step_pressure
