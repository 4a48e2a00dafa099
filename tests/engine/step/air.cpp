/// Drag and lift: the force on a triangle, how fast cloth falls in the end, and what the air must
/// not do at any step: give energy where it rests.
#include "engine/step/air.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/isa.h"
#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_air {
namespace {

constexpr double kDensity = 1.2;

/// kg, of each particle: a third of its triangles'.
std::vector<double> masses_of(const SceneDescription& scene, double area_density) {
  std::vector<double> masses(scene.positions.size());
  for (const auto& [a, b, c] : scene.air.triangles) {
    const Vec3 origin = scene.positions[a];
    const double area =
        0.5 * length(cross(scene.positions[b] - origin, scene.positions[c] - origin));
    for (const std::uint32_t corner : {a, b, c}) masses[corner] += area_density * area / 3;
  }
  return masses;
}

void add_air(SceneDescription& scene, std::uint32_t size, Air air) {
  for (std::uint32_t i = 0; i + 1 < size; ++i) {
    for (std::uint32_t j = 0; j + 1 < size; ++j) {
      const std::uint32_t at = i * size + j;
      air.triangles.push_back({at, at + 1, at + size});
      air.triangles.push_back({at + size, at + 1, at + size + 1});
    }
  }
  scene.air = air;
}

/// The sheet of the scenes "hang" and the like, of two triangles in each cell.
SceneDescription sheet_in_air(const char* name, std::uint32_t size, double area_density, Air air) {
  SceneDescription scene = scene_of(name, static_cast<int>(size));
  add_air(scene, size, std::move(air));
  scene.masses = masses_of(scene, area_density);
  return scene;
}

SceneDescription free_sheet(std::uint32_t size, double area_density, Air air) {
  SceneDescription scene = sheet_in_air("hang", size, area_density, std::move(air));
  scene.fixed.clear();
  for (std::uint32_t j = 0; j + 1 < size; ++j) {  // between particles that were fixed
    scene.constraints.push_back({j, j + 1, 1.0 / (size - 1)});
  }
  return scene;
}

/// A triangle of area 0.5 whose normal is at `angle` from x towards y, moving with v.
SceneDescription plate(double angle, Vec3 v, const Air& air) {
  SceneDescription scene;
  const Vec3 up{-std::sin(angle), std::cos(angle), 0};
  scene.positions = {{0, 0, 0}, up, {0, 0, 1}};
  scene.velocities = {v, v, v};
  scene.masses = {1, 2, 3};
  scene.air = air;
  scene.air.triangles = {{0, 1, 2}};
  return scene;
}

Vec3 to_public(kernels::Vector v) { return {v.x, v.y, v.z}; }

/// N, of each particle besides gravity, in the time h to come.
std::vector<Vec3> forces_of(const SceneDescription& scene, double h) {
  State state(model_of(scene),
              {.solver = Solver::gauss_seidel, .isa = resolve(Isa::automatic).value()});
  Team team;
  find_velocity_forces(state, state.model->damping.motion, h, team);
  std::vector<Vec3> forces;
  for (const std::uint32_t slot : state.model->ordering.slot_of) {
    forces.push_back(to_public(state.total_force[slot]));
  }
  return forces;
}

Vec3 sum(const std::vector<Vec3>& vectors) {
  Vec3 sum;
  for (const Vec3& v : vectors) sum = sum + v;
  return sum;
}

constexpr double kNoTime = 1e-15;

TEST_CASE("a plate that moves along x, tilted, feels drag against x and lift across it") {
  constexpr double kSpeed = 7, kArea = 0.5, kDrag = 1.3, kLift = 0.7;
  const double pressure = 0.5 * kDensity * kArea * kSpeed * kSpeed;
  for (const double degrees : {0., 10., 30., 45., 60., 89., 120., 170., 200., 300.}) {
    CAPTURE(degrees);
    const double angle = degrees * M_PI / 180, c = std::cos(angle), s = std::sin(angle);
    const Air air{{}, kDensity, kDrag, kLift, {}};
    const Vec3 force = sum(forces_of(plate(angle, {kSpeed, 0, 0}, air), kNoTime));
    CHECK(force.x == doctest::Approx(-pressure * kDrag * std::abs(c)));
    CHECK(force.y == doctest::Approx(-pressure * kLift * c * s));
    CHECK(std::abs(force.z) < 1e-9);
  }
}

TEST_CASE("edge-on, at rest, or without an area there is no force") {
  const Air air{{}, kDensity, 1, 1, {}};
  const auto none = [](const SceneDescription& scene) {
    for (const Vec3& force : forces_of(scene, kNoTime)) CHECK(length(force) < 1e-13);
  };
  none(plate(M_PI / 2, {5, 0, 0}, air));
  none(plate(0, {0, 0, 5}, air));
  none(plate(0.3, {0, 0, 0}, air));
  SceneDescription line = plate(0.3, {1, 2, 3}, air);
  line.positions[2] = {-2 * std::sin(0.3), 2 * std::cos(0.3), 0};
  none(line);
}

/// Corners that move each in their own way, in a wind.
SceneDescription tumbling_sheet(std::uint32_t seed) {
  Random random(seed);
  SceneDescription scene = free_sheet(6, 0.2, {{}, kDensity, 0.9, 0.6, {3, -1, 2}});
  for (Vec3& x : scene.positions) x = x + random.in_box(0.05);
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    scene.velocities.push_back(random.in_box(4));
  }
  return scene;
}

TEST_CASE("the force on a triangle is the formula's at the mean velocity of its corners") {
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    const Air air{{}, kDensity, random.between(0, 2), random.between(0, 2), random.in_box(5)};
    SceneDescription scene = plate(0, {}, air);
    for (Vec3& x : scene.positions) x = random.in_box(1);
    for (Vec3& v : scene.velocities) v = random.in_box(10);
    const Vec3 v = (1. / 3) * sum(scene.velocities) - air.wind;
    const Vec3 doubled =
        cross(scene.positions[1] - scene.positions[0], scene.positions[2] - scene.positions[0]);
    const double area = 0.5 * length(doubled), speed = length(v);
    Vec3 n = (0.5 / area) * doubled;
    if (dot(n, v) < 0) n = -1. * n;
    const double through = dot(n, v);
    const Vec3 expected = (-0.5 * kDensity * area * through) *
                          (air.drag * v + air.lift * (speed * n - (through / speed) * v));
    const Vec3 force = sum(forces_of(scene, kNoTime));
    CHECK(distance(force, expected) < 1e-9 * length(expected));
  }
}

TEST_CASE("a sheet at rest in a wind feels what it does where it moves against it in still air") {
  const SceneDescription in_wind = tumbling_sheet(1);
  SceneDescription moving = in_wind;
  for (Vec3& v : moving.velocities) v = v - in_wind.air.wind;
  moving.air.wind = {};
  for (const double h : {kNoTime, 0.01}) {
    const auto a = forces_of(in_wind, h), b = forces_of(moving, h);
    REQUIRE(length(a[0]) > 1e-3);
    CHECK(largest_distance(a, b) < 1e-12);
  }
}

TEST_CASE("what falls flat reaches the speed at which drag is its weight") {
  struct Way {
    Solver solver;
    Backend backend;
  };
  for (const Way way :
       {Way{Solver::small_steps, Backend::simd}, Way{Solver::small_steps, Backend::reference},
        Way{Solver::gauss_seidel, Backend::simd}, Way{Solver::gauss_seidel, Backend::reference},
        Way{Solver::yarn, Backend::simd}, Way{Solver::direct, Backend::simd}}) {
    for (const double area_density : {0.03, 1.}) {
      for (const double dt : {1. / 240, 1. / 60, 0.1}) {
        CAPTURE(name(way.solver));
        CAPTURE(name(way.backend));
        CAPTURE(area_density);
        CAPTURE(dt);
        const double speed = std::sqrt(2 * area_density * 10 / (kDensity * 0.8));
        Cloth cloth = cloth_of(free_sheet(8, area_density, {{}, kDensity, 0.8, 0.5, {}}),
                               {.solver = way.solver, .backend = way.backend});
        run(cloth, dt, static_cast<int>(0.5 * speed / dt) + 10);
        for (const Vec3& v : velocities(cloth)) {
          CHECK(distance(v, {0, -speed, 0}) < 0.01 * speed);
        }
      }
    }
  }
}

/// J, relative to the wind.
double kinetic(const SceneDescription& scene, const std::vector<Vec3>& velocities) {
  double sum = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const Vec3 v = velocities[i] - scene.air.wind;
    sum += 0.5 * scene.masses[i] * dot(v, v);
  }
  return sum;
}

TEST_CASE("no time is so long, and no particle so light, that the air speeds it up") {
  Random random(5);
  for (int k = 0; k < 200; ++k) {
    SceneDescription scene = tumbling_sheet(random.below(1000));
    scene.gravity = {};
    scene.air.drag = k % 3 == 0 ? 0 : random.between(0, 2);
    for (double& m : scene.masses) m *= std::pow(10, random.between(-4, 1));
    const double h = std::pow(10, random.between(-5, 3));
    const std::vector<Vec3> forces = forces_of(scene, h);
    std::vector<Vec3> after = scene.velocities;
    for (std::size_t i = 0; i < after.size(); ++i) {
      after[i] = after[i] + (h / scene.masses[i]) * forces[i];
    }
    CHECK(kinetic(scene, after) <= kinetic(scene, scene.velocities) * (1 + 1e-12));
  }
}

constexpr Solver kSolvers[] = {Solver::small_steps, Solver::gauss_seidel, Solver::yarn,
                               Solver::direct};

/// By how much energy rises over the least so far in a second, as a share of all that is lost.
double most_gained(const SceneDescription& scene, Solver solver, double dt) {
  Cloth cloth = cloth_of(scene, {.solver = solver});
  const double start = cloth.energy().total();
  double least = start, most = 0;
  for (double t = 0; t < 1; t += dt) {
    step(cloth, dt);
    most = std::max(most, cloth.energy().total() - least);
    least = std::min(least, cloth.energy().total());
  }
  return most / (start - least);
}

// In a vacuum solvers give back some of what they take, and more.
TEST_CASE("air at rest takes energy from cloth that swings, and gives none") {
  for (const Solver solver : kSolvers) {
    for (const double area_density : {0.03, 0.3}) {
      for (const double dt : {0.002, 1. / 60}) {
        CAPTURE(name(solver));
        CAPTURE(area_density);
        CAPTURE(dt);
        const Air air{{}, kDensity, 1, 1, {}};
        const SceneDescription scene = sheet_in_air("corners", 11, area_density, air);
        SceneDescription vacuum = scene;
        vacuum.air = {};
        CHECK(most_gained(scene, solver, dt) < most_gained(vacuum, solver, dt) + 1e-9);
      }
    }
  }
}

TEST_CASE("silk in gusts of 20 m/s stays with them") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    const SceneDescription scene = sheet_in_air("corners", 15, 0.03, {{}, kDensity, 1, 1, {}});
    Cloth cloth = cloth_of(scene, {.max_iterations = 2000, .solver = solver});
    for (int k = 0; k < 120; ++k) {
      const double angle = 0.3 * std::floor(k / 5);
      REQUIRE(cloth.set_wind({20 * std::cos(angle), 0, 20 * std::sin(angle)}));
      REQUIRE(committed(step(cloth, 1. / 60).status));
      for (const Vec3& v : velocities(cloth)) REQUIRE(length(v) < 60);
      for (const Vec3& x : positions(cloth)) REQUIRE(length(x) < 3);
    }
  }
}

TEST_CASE("a wind carries free cloth away at its own speed") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    SceneDescription scene = free_sheet(6, 0.1, {{}, kDensity, 1, 0, {}});
    scene.gravity = {};
    Cloth cloth = cloth_of(scene, {.solver = solver});
    REQUIRE(cloth.set_wind({0, 4, 0}));
    run(cloth, 1. / 60, 600);
    // v' = k (4 - v)^2 with k = 6 / s / (m/s)
    const double slower = 4 / (1 + 4 * 6 * 10.);
    for (const Vec3& v : velocities(cloth)) CHECK(distance(v, {0, 4 - slower, 0}) < 0.005);
  }
}

TEST_CASE("a wind that is no number is refused, and changes nothing") {
  Cloth cloth = cloth_of(free_sheet(6, 0.1, {{}, kDensity, 1, 0, {}}), {});
  Cloth other = cloth.clone();
  const auto refused = cloth.set_wind({0, std::numeric_limits<double>::quiet_NaN(), 0});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().find("air.wind") != std::string::npos);
  run(cloth, 0.01, 5);
  run(other, 0.01, 5);
  CHECK(cloth.state_hash() == other.state_hash());
}

TEST_CASE("a clone, and a cloth that copies another in its wind, go on bit for bit") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    SceneDescription scene = sheet_in_air("corners", 9, 0.2, {{}, kDensity, 1, 0.5, {}});
    scene.damping.motion = 0.3;
    Cloth cloth = cloth_of(scene, {.solver = solver});
    REQUIRE(cloth.set_wind({0, 1, 4}));
    run(cloth, 0.01, 10);
    Cloth clone = cloth.clone();
    auto copy = Cloth::create(cloth.model(), {.solver = solver});
    REQUIRE(copy);
    REQUIRE(copy.value().copy_state(cloth));
    for (Cloth* each : {&cloth, &clone, &copy.value()}) run(*each, 0.01, 10);
    CHECK(clone.state_hash() == cloth.state_hash());
    CHECK(copy.value().state_hash() == cloth.state_hash());
  }
}

TEST_CASE("threads do not change a bit") {
  for (const Solver solver : {Solver::small_steps, Solver::gauss_seidel}) {
    const SceneDescription scene = sheet_in_air("hang", 55, 0.2, {{}, kDensity, 1, 1, {1, 2, 3}});
    std::uint64_t hashes[2] = {};
    for (const int threads : {1, 2}) {
      tbb::task_arena arena(2);
      arena.execute([&] {
        Cloth cloth =
            cloth_of(scene, {.max_iterations = 300, .solver = solver, .threads = threads});
        run(cloth, 0.01, 5);
        hashes[threads - 1] = cloth.state_hash();
      });
    }
    CHECK(hashes[0] == hashes[1]);
  }
}

TEST_CASE("a velocity whose drag is out of range changes nothing") {
  for (const Solver solver : kSolvers) {
    CAPTURE(name(solver));
    const SceneDescription scene = sheet_in_air("hang", 5, 0.2, {{}, kDensity, 1, 1, {}});
    Cloth cloth = cloth_of(scene, {.max_iterations = 1000, .solver = solver});
    run(cloth, 0.01, 3);
    const std::vector<Vec3> healthy = velocities(cloth);
    Cloth other = cloth.clone();
    std::vector<Vec3> v = healthy;
    v[20] = {1e200, 1e200, -1e200};
    REQUIRE(cloth.write_velocities(v));
    const std::uint64_t before = cloth.state_hash();
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::non_finite_input);
    CHECK(cloth.state_hash() == before);
    REQUIRE(cloth.write_velocities(healthy));
    run(cloth, 0.01, 1);
    run(other, 0.01, 1);
    CHECK(cloth.state_hash() == other.state_hash());
  }
}

TEST_CASE("without drag and lift, or without density, air is as good as none") {
  const SceneDescription none = free_sheet(6, 0.1, {});
  const Air still{{}, kDensity, 0, 0, {5, 0, 0}}, vacuum{{}, 0, 1, 1, {5, 0, 0}};
  SceneDescription without = none;
  without.air = {};
  Cloth expected = cloth_of(without, {});
  run(expected, 0.01, 5);
  for (const Air& air : {still, vacuum}) {
    Cloth cloth = cloth_of(free_sheet(6, 0.1, air), {});
    CHECK(cloth.bytes() == cloth_of(without, {}).bytes());
    run(cloth, 0.01, 5);
    CHECK(cloth.state_hash() == expected.state_hash());
  }
}

/// m/s, the root mean square of a flag of 1.5 x 0.9 m in a wind along it, from 2 to 6 s.
double speed_of_flag(const char* material, double wind, double rate,
                     int substeps = kAutomaticSubsteps) {
  MeshDescription mesh;
  constexpr std::uint32_t kWide = 21, kHigh = 13;
  for (std::uint32_t j = 0; j < kHigh; ++j) {
    for (std::uint32_t i = 0; i < kWide; ++i) mesh.positions.push_back({0.075 * i, -0.075 * j, 0});
    mesh.pins.push_back(j * kWide);
  }
  for (std::uint32_t j = 0; j + 1 < kHigh; ++j) {
    for (std::uint32_t i = 0; i + 1 < kWide; ++i) {
      const std::uint32_t at = j * kWide + i;
      mesh.corners.insert(mesh.corners.end(), {at, at + 1, at + kWide + 1, at + kWide});
      mesh.face_sizes.push_back(4);
    }
  }
  mesh.material = find_material(material).value();
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.air.wind = {wind, 0, 0.1 * wind};
  Cloth cloth = cloth_of(scene, {.substeps = substeps});
  run(cloth, 1 / rate, static_cast<int>(2 * rate));
  double squares = 0, count = 0;
  for (int frame = 0; frame < 4 * rate; ++frame) {
    run(cloth, 1 / rate, 1);
    for (const Vec3& v : velocities(cloth)) squares += dot(v, v);
    count += kWide * kHigh;
  }
  return std::sqrt(squares / count);
}

// Looked at once in a step, 60 Hz: 1.6 times the speed at 240 Hz.
TEST_CASE("a flag flutters as fast at 60 Hz as at 240 Hz") {
  for (const auto& [material, wind] : {std::pair{"cotton", 8.}, {"silk", 16.}}) {
    CAPTURE(material);
    const double slow = speed_of_flag(material, wind, 60),
                 fast = speed_of_flag(material, wind, 240);
    CHECK(slow / fast == doctest::Approx(1).epsilon(0.1));
  }
}

// Where the load alone chose substeps: 0.62 and 0.73 of the speed of silk in 20 m/s.
TEST_CASE("a flag flutters at 30 and at 60 Hz as in many substeps") {
  for (const auto& [material, wind] : {std::pair{"cotton", 10.}, {"silk", 20.}}) {
    CAPTURE(material);
    const double many = speed_of_flag(material, wind, 30, 128);
    for (const double rate : {30., 60.}) {
      CAPTURE(rate);
      CHECK(speed_of_flag(material, wind, rate) / many == doctest::Approx(1).epsilon(0.12));
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_air
