/// Bodies that move by themselves: balls, boxes and capsules with a mass, in flight and on cloth.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "engine/bodies/body_mass.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/free_body.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/random_cases.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_free_bodies {
namespace {

constexpr int kRates[] = {30, 60, 240};
constexpr double kG = 10;  // m/s^2

Settings small_steps(Backend backend) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

/// A particle far away: a body beside it is alone.
Cloth empty_space(double gravity, Backend backend) {
  SceneDescription scene;
  scene.positions = {{9, 0, 0}};
  scene.masses = {0.01};
  scene.gravity = {0, -gravity, 0};
  return cloth_of(scene, small_steps(backend));
}

/// Level, `width` wide, of `size` particles a side.
SceneDescription sheet(std::uint32_t size, double width, double height,
                       const std::function<void(Material&)>& change = {}) {
  MeshDescription mesh = quads(size);
  const double spacing = width / (size - 1);
  for (Vec3& v : mesh.positions) v = {spacing * v.x - width / 2, height, spacing * v.y - width / 2};
  Material material = find_material("cotton").value();
  if (change) change(material);
  mesh.material = material;
  SceneDescription scene = made(mesh).scene;
  scene.friction = 0.3;
  scene.air.density = 0;
  return scene;
}

void pin_corners(SceneDescription& scene, std::uint32_t size) {
  scene.fixed = {0, size - 1, size * (size - 1), size * size - 1};
}

double cloth_mass(const SceneDescription& scene) {
  return std::accumulate(scene.masses.begin(), scene.masses.end(), 0.0);
}

TEST_CASE("masses and inertias are those of full bodies") {
  constexpr double kPi = 3.14159265358979;
  const auto of = [](const ShapeDescription& shape) {
    return weft::mass_of(*shape_of(shape), 1000).value();
  };
  const BodyMass ball = of(Ball{{1, 2, 3}, 0.1});
  CHECK(ball.mass == doctest::Approx(1000 * 4. / 3 * kPi * 1e-3));
  CHECK(length(ball.centre - Vec3{1, 2, 3}) < 1e-12);
  const BodyMass box = of(weft::box({0.1, 0.2, 0.4}));
  CHECK(box.mass == doctest::Approx(8));
  CHECK(box.inertia[0] == doctest::Approx(8. / 12 * (0.04 + 0.16)));
  CHECK(box.inertia[1] == doctest::Approx(8. / 12 * (0.16 + 0.01)));
  CHECK(box.inertia[2] == doctest::Approx(8. / 12 * (0.01 + 0.04)));
  for (int i = 0; i < 3; ++i) {
    CHECK(ball.inertia[static_cast<std::size_t>(i)] == doctest::Approx(0.4 * ball.mass * 0.01));
    CHECK(std::abs(box.inertia[static_cast<std::size_t>(i) + 3]) < 1e-12);
  }
  // A cylinder with two halves of a ball.
  const BodyMass capsule = of(Capsule{{0, 0, 0}, {0.3, 0, 0}, 0.1, 0.1});
  const double tube = 1000 * kPi * 0.01 * 0.3, caps = 1000 * 4. / 3 * kPi * 1e-3;
  CHECK(capsule.mass == doctest::Approx(tube + caps));
  CHECK(length(capsule.centre - Vec3{0.15, 0, 0}) < 1e-12);
  CHECK(capsule.inertia[0] == doctest::Approx(tube * 0.005 + caps * 0.004));
  CHECK(capsule.inertia[1] ==
        doctest::Approx(tube * (0.01 / 4 + 0.09 / 12) +
                        caps * (0.4 * 0.01 + 0.15 * 0.15 + 3. / 8 * 2 * 0.15 * 0.1)));
}

TEST_CASE("a box that tumbles keeps its energy and its angular momentum, and falls as a stone") {
  for (const Backend backend : kBackends) {
    for (const int rate : kRates) {
      CAPTURE(rate);
      Cloth cloth = empty_space(kG, backend);
      const Free box = add_free(cloth, weft::box({0.1, 0.2, 0.4}), 8, {});
      REQUIRE(cloth.set_body_velocity(box.id, {{1, 50, 0}, {0.1, 10, 0.1}}));
      const double energy = box.energy(cloth, kG);
      const Vec3 spin = box.spin_momentum(cloth);
      for (int k = 0; k < 10 * rate; ++k) {
        CHECK(step(cloth, 1. / rate).status == Status::converged);
        CHECK(box.energy(cloth, kG) == doctest::Approx(energy).epsilon(1e-7));
        CHECK(length(box.spin_momentum(cloth) - spin) < 1e-12 * length(spin));
      }
      CHECK(length(box.centre(cloth) - Vec3{10, 0, 0}) < 1e-8);
    }
  }
}

TEST_CASE("a force and a moment of the caller move a body as Newton and Euler say") {
  for (const int rate : kRates) {
    Cloth cloth = empty_space(0, Backend::simd);
    const Free box = add_free(cloth, weft::box({0.1, 0.2, 0.4}), 8, {});
    REQUIRE(cloth.set_body_force(box.id, {16, 0, 0}, {0, 0, 0.1}));
    run(cloth, 1. / rate, rate);
    CHECK(length(box.velocity(cloth).linear - Vec3{2, 0, 0}) < 1e-9);
    CHECK(length(box.centre(cloth) - Vec3{1, 0, 0}) < 1e-9);
    const double turns = 0.1 / box.mass.inertia[2];
    CHECK(length(box.velocity(cloth).angular - Vec3{0, 0, turns}) < 1e-9);
    const Rotation to = box.pose(cloth).rotation;
    CHECK(2 * std::atan2(to.z, to.w) == doctest::Approx(0.5 * turns).epsilon(1e-6));
  }
}

/// Of a sheet and a ball, that both fly.
struct Balance {
  Vec3 momentum, spin;
  double energy = 0;
};
Balance balance(const Cloth& cloth, const SceneDescription& scene, const Free& ball) {
  const std::vector<Vec3> x = positions(cloth), v = velocities(cloth);
  return {momentum(scene.masses, v) + ball.momentum(cloth),
          angular_momentum(scene.masses, x, v) + ball.spin_momentum(cloth) +
              cross(ball.centre(cloth), ball.momentum(cloth)),
          cloth.energy().total() + ball.energy(cloth, 0)};
}

TEST_CASE(
    "a ball that is thrown at a sheet in flight keeps the momentum of both, and their energy") {
  SceneDescription scene = sheet(11, 0.5, 0);
  scene.gravity = {};
  for (const Backend backend : kBackends) {
    for (const int rate : kRates) {
      for (const double mass : {0.005, 0.05, 1.0}) {
        CAPTURE(rate);
        CAPTURE(mass);
        Cloth cloth = cloth_of(scene, small_steps(backend));
        const Free ball = add_free(cloth, Ball{{}, 0.06}, mass, {.position = {0.02, 0.1, 0.03}});
        REQUIRE(cloth.set_body_velocity(ball.id, {{0.5, -3, 0}, {0, 3, 5}}));
        const Balance before = balance(cloth, scene, ball);
        int converged = 0;
        for (int k = 0; k < rate / 2; ++k) {
          converged += step(cloth, 1. / rate).status == Status::converged ? 1 : 0;
          CHECK(balance(cloth, scene, ball).energy < before.energy * (1 + 1e-6));
        }
        CHECK(converged == rate / 2);
        const Balance after = balance(cloth, scene, ball);
        // In lanes the velocities of the cloth are floats.
        const double close = backend == Backend::reference ? 1e-6 : 1e-5;
        CHECK(length(after.momentum - before.momentum) < close * length(before.momentum));
        CHECK(length(after.spin - before.spin) < (mass < 0.01 ? 0.03 : 0.01) * length(before.spin));
        CHECK(ball.velocity(cloth).linear.y > -3);
        CHECK(ball.velocity(cloth).linear.y < 0.97 * -3 + 10 * 0.05 / (mass + 0.05));
      }
    }
  }
}

/// N, its mean over the last second of `seconds`, of a body in cloth that comes to rest.
struct Resting {
  double load = 0, height = 0, speed = 0;  // N; m, of its centre; m/s
  int missed = 0;                          // steps that have not converged
};
Resting rest(Cloth& cloth, const Free& body, int rate, int seconds) {
  Resting found;
  for (int k = 0; k < seconds * rate; ++k) {
    found.missed += step(cloth, 1. / rate).status != Status::converged ? 1 : 0;
    if (k >= (seconds - 1) * rate) found.load += cloth.body_load(body.id).value().force.y / rate;
  }
  found.height = body.centre(cloth).y;
  found.speed = length(body.velocity(cloth).linear);
  return found;
}

TEST_CASE(
    "a ball in a sheet on four pins comes to rest, weighs its weight and hangs as deep in short "
    "substeps" *
    doctest::test_suite("slow")) {
  constexpr std::uint32_t kSize = 13;
  for (const double mass : {0.02, 0.3, 1.0}) {
    CAPTURE(mass);
    SceneDescription scene = sheet(kSize, 0.6, 0, [](Material& m) {
      m.damping_stretch = 0.01;
      m.damping_motion = 2;
    });
    pin_corners(scene, kSize);
    const auto hang = [&](int rate, int substeps) {
      Settings settings = small_steps(Backend::simd);
      if (substeps > 0) settings.substeps = substeps;
      Cloth cloth = cloth_of(scene, settings);
      const Free ball = add_free(cloth, Ball{{}, 0.1}, mass, {.position = {0.01, 0.104, 0.02}});
      return rest(cloth, ball, rate, 8);
    };
    const Resting reference = hang(240, 60);
    CHECK(reference.missed == 0);
    for (const int rate : kRates) {
      CAPTURE(rate);
      const Resting found = hang(rate, 0);
      CHECK(found.missed == 0);
      CHECK(found.load == doctest::Approx(mass * kG).epsilon(0.01));
      CHECK(found.speed < 5e-3);
      CHECK(found.height - 0.1 == doctest::Approx(reference.height - 0.1).epsilon(0.03));
    }
  }
}

/// A closed bag, a sphere of 0.25 m that hangs at its top.
SceneDescription bag() {
  MeshDescription mesh;
  const TriangleMesh ball = icosphere(0.25, 3);
  mesh.positions = ball.vertices;
  for (const auto& triangle : ball.triangles)
    mesh.corners.insert(mesh.corners.end(), triangle.begin(), triangle.end());
  std::uint32_t top = 0;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
    if (mesh.positions[i].y > mesh.positions[top].y) top = i;
  mesh.pins = {top};
  Material material = find_material("cotton").value();
  material.damping_stretch = 0.01;
  material.damping_motion = 2;
  mesh.material = material;
  SceneDescription scene = made(mesh).scene;
  scene.friction = 0.3;
  scene.air.density = 0;
  return scene;
}

TEST_CASE("a ball in a closed bag that hangs stays in it and rests by its weight" *
          doctest::test_suite("long")) {
  const SceneDescription scene = bag();
  for (const int rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
    const Free ball = add_free(cloth, Ball{{}, 0.1}, 0.3, {.position = {0, -0.13, 0.002}});
    const Resting found = rest(cloth, ball, rate, 8);
    CHECK(found.missed == 0);
    CHECK(found.load == doctest::Approx(3).epsilon(0.01));
    CHECK(found.speed < 5e-3);
    CHECK(found.height > -0.4);
  }
}

TEST_CASE("a ball that rises lifts a sheet by its tethers, and pulls with what it has too much" *
          doctest::test_suite("slow")) {
  constexpr std::uint32_t kSize = 15;
  SceneDescription scene = sheet(kSize, 0.6, 0.25, [](Material& m) {
    m.damping_stretch = 0.01;
    m.damping_motion = 2;
  });
  for (const std::uint32_t corner : {0u, kSize - 1, kSize * (kSize - 1), kSize * kSize - 1}) {
    const Vec3 at = scene.positions[corner];
    const auto pin = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.push_back({at.x, -0.1, at.z});
    scene.masses.push_back(1);
    scene.fixed.push_back(pin);
    scene.tethers.push_back({corner, pin, 0.36});
  }
  for (const int rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
    const Free ball = add_free(cloth, Ball{{}, 0.12}, 0.1, {.position = {0, 0.25 - 0.125, 0}});
    REQUIRE(cloth.set_body_force(ball.id, {0, 0.1 * kG + 3, 0}, {}));
    const Resting found = rest(cloth, ball, rate, 8);
    CHECK(found.missed == 0);
    CHECK(found.load == doctest::Approx(-3).epsilon(0.01));
    CHECK(found.speed < 5e-3);
  }
}

/// A box on cloth that lies on a plane, of which one border is pinned.
struct Laid {
  SceneDescription scene;
  std::vector<Vec3> border;
  Cloth cloth;
  Free box;
};
Laid laid(int rate, double mass, double friction, bool on_mesh) {
  constexpr std::uint32_t kSize = 15;
  SceneDescription scene = sheet(kSize, 0.6, 0.002);
  std::vector<Vec3> border;
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    if (scene.positions[i].x < 0.299) continue;
    scene.fixed.push_back(i);
    border.push_back(scene.positions[i]);
  }
  Cloth cloth = cloth_of(scene, small_steps(Backend::simd));
  const ShapeDescription floor =
      on_mesh ? ShapeDescription(box_mesh({4, 1, 4}, 1)) : ShapeDescription(Plane{});
  test::add(
      cloth,
      {.shape = shape_of(floor), .pose = {.position = {0, on_mesh ? -0.5 : 0, 0}}, .friction = 0});
  const Free box = add_free(cloth, weft::box({0.16, 0.08, 0.16}), mass,
                            {.position = {-0.1, 0.044, 0}}, friction);
  run(cloth, 1. / rate, rate / 2);
  return {std::move(scene), std::move(border), std::move(cloth), box};
}

TEST_CASE("a box on cloth on a floor rests, and its weight goes to the floor") {
  for (const bool on_mesh : {false, true}) {
    for (const int rate : kRates) {
      CAPTURE(on_mesh);
      CAPTURE(rate);
      Laid at = laid(rate, 0.3, 0.3, on_mesh);
      int missed = 0;
      double load = 0, on_floor = 0;
      for (int k = 0; k < rate; ++k) {
        missed += step(at.cloth, 1. / rate).status != Status::converged ? 1 : 0;
        load += at.cloth.body_load(at.box.id).value().force.y / rate;
        on_floor -= at.cloth.body_load(0).value().force.y / rate;
      }
      CHECK(missed == 0);
      CHECK(load == doctest::Approx(0.3 * kG).epsilon(0.01));
      double free = 0;
      for (std::uint32_t i = 0; i < at.scene.masses.size(); ++i) free += at.scene.masses[i];
      for (const std::uint32_t i : at.scene.fixed) free -= at.scene.masses[i];
      CHECK(on_floor == doctest::Approx((0.3 + free) * kG).epsilon(0.02));
      CHECK(length(at.box.velocity(at.cloth).linear) < 1e-3);
      CHECK(at.box.centre(at.cloth).y == doctest::Approx(0.042).epsilon(1e-3));
    }
  }
}

TEST_CASE("cloth that is drawn away under a box takes it along by Coulomb's law") {
  for (const int rate : kRates) {
    CAPTURE(rate);
    // Fast: it slides all the time that there is cloth under the box.
    Laid fast = laid(rate, 0.3, 0.3, false);
    double along = 0, across = 0;
    for (int k = 1; k * 1. / rate < 0.2; ++k) {
      for (std::size_t i = 0; i < fast.border.size(); ++i)
        REQUIRE(
            fast.cloth.move_fixed(fast.scene.fixed[i], fast.border[i] + Vec3{5. * k / rate, 0, 0}));
      step(fast.cloth, 1. / rate);
      const Vec3 load = fast.cloth.body_load(fast.box.id).value().force;
      along += load.x / rate;
      across += load.y / rate;
    }
    CHECK(across > 0.05);
    CHECK(along == doctest::Approx(0.3 * across).epsilon(0.03));
    CHECK(fast.box.velocity(fast.cloth).linear.x == doctest::Approx(along / 0.3).epsilon(0.01));
    // Slow: it comes along.
    Laid slow = laid(rate, 0.3, 0.3, false);
    const Vec3 from = slow.box.centre(slow.cloth);
    int missed = 0;
    for (int k = 1; k <= 2 * rate; ++k) {
      for (std::size_t i = 0; i < slow.border.size(); ++i)
        REQUIRE(slow.cloth.move_fixed(slow.scene.fixed[i],
                                      slow.border[i] + Vec3{0.1 * k / rate, 0, 0}));
      missed += step(slow.cloth, 1. / rate).status != Status::converged ? 1 : 0;
    }
    CHECK(missed <= rate / 30);
    CHECK(slow.box.centre(slow.cloth).x - from.x == doctest::Approx(0.2).epsilon(0.03));
    CHECK(std::abs(slow.box.centre(slow.cloth).y - from.y) < 1e-3);
  }
}

TEST_CASE(
    "what is drawn by chance gains no energy and is finite, `converged` means apart, and the work "
    "of bodies is what they lose") {
  for_each_case(
      12, [](std::uint32_t seed) { return seed; },
      [](std::uint32_t seed) {
        CAPTURE(seed);
        Random random(seed);
        const std::uint32_t size = 8 + seed % 5;
        SceneDescription scene = sheet(size, 0.6, 0);
        if (seed % 2 == 0) pin_corners(scene, size);
        Cloth cloth = cloth_of(scene, small_steps(kBackends[seed % 2]));
        if (seed % 3 == 0)
          test::add(cloth, {.shape = shape_of(Plane{}), .pose = {.position = {0, -0.1, 0}}});
        const double mass = std::pow(10., random.between(-2, 0)), rate = kRates[seed % 3];
        const ShapeDescription shapes[] = {Ball{{}, 0.08}, weft::box({0.2, 0.16, 0.18}),
                                           Capsule{{-0.1, 0, 0}, {0.1, 0, 0}, 0.08, 0.07}};
        std::vector<Free> bodies;
        for (int i = 0; i < 2; ++i) {
          const Vec3 at{random.between(-0.15, 0.15), 0.2 + 0.25 * i, random.between(-0.15, 0.15)};
          bodies.push_back(
              add_free(cloth, shapes[(seed + static_cast<std::uint32_t>(i)) % 3], mass,
                       {.position = at, .rotation = turn({0, 0, 1}, random.between(-2, 2))}));
        }
        const auto of_bodies = [&] {
          double sum = 0;
          for (const Free& body : bodies) sum += body.energy(cloth, kG);
          return sum;
        };
        const auto energy = [&] {
          return cloth.energy().kinetic + cloth.energy().potential + of_bodies();
        };
        const double before = energy(), weighs = (mass * 2 + cloth_mass(scene)) * kG;
        for (int k = 0; k < static_cast<int>(rate); ++k) {
          const double had = of_bodies();
          const StepReport report = step(cloth, 1. / rate);
          REQUIRE(committed(report.status));
          CHECK(std::abs(report.body_work - (had - of_bodies())) < 1e-9 * weighs);
          CHECK(energy() < before + 1e-3 * weighs);
          if (report.status == Status::converged) CHECK(report.max_penetration <= 1e-4);
        }
      });
}

bool same(const Pose& a, const Pose& b) {
  const Rotation &q = a.rotation, &r = b.rotation;
  return distance(a.position, b.position) == 0 && q.x == r.x && q.y == r.y && q.z == r.z &&
         q.w == r.w;
}

TEST_CASE("bits are equal over threads, and copies and saved states go on") {
  SceneDescription scene = sheet(13, 0.6, 0);
  pin_corners(scene, 13);
  const auto make = [&](Isa isa, int threads) {
    Settings settings = small_steps(Backend::simd);
    settings.isa = isa;
    settings.threads = threads;
    return cloth_of(scene, settings);
  };
  const auto put_ball = [](Cloth& cloth) {
    return add_free(cloth, weft::box({0.15, 0.15, 0.15}), 0.3, {.position = {0.02, 0.15, 0}});
  };
  Cloth cloth = make(Isa::automatic, 1);
  const Free ball = put_ball(cloth);
  Cloth by_two = make(Isa::automatic, 2);
  put_ball(by_two);
  run(cloth, 1. / 60, 20);
  run(by_two, 1. / 60, 20);
  CHECK(cloth.state_hash() == by_two.state_hash());
  CHECK(same(ball.pose(cloth), ball.pose(by_two)));
  Cloth copy = cloth.clone();
  Cloth loaded = make(Isa::automatic, 1);
  REQUIRE(loaded.load_state(cloth.save_state()));
  CHECK(same(ball.pose(loaded), ball.pose(cloth)));
  run(cloth, 1. / 60, 20);
  run(copy, 1. / 60, 20);
  run(loaded, 1. / 60, 20);
  CHECK(copy.state_hash() == cloth.state_hash());
  CHECK(loaded.state_hash() == cloth.state_hash());
  CHECK(same(ball.pose(copy), ball.pose(cloth)));
  CHECK(same(ball.pose(loaded), ball.pose(cloth)));
}

TEST_CASE("a step that fails leaves a body as it was, and bodies are carried along") {
  Cloth cloth = empty_space(kG, Backend::simd);
  const Free ball = add_free(cloth, Ball{{}, 0.1}, 1, {.position = {1, 0, 0}});
  REQUIRE(cloth.set_body_velocity(ball.id, {{2, 0, 0}, {0, 0, 3}}));
  run(cloth, 1. / 60, 3);
  const Pose before = ball.pose(cloth);
  CHECK(!committed(cloth.step(1e155).value().status));
  CHECK(same(ball.pose(cloth), before));
  run(cloth, 1. / 60, 1);
  CHECK(ball.pose(cloth).position.x == doctest::Approx(before.position.x + 2. / 60));
}

TEST_CASE("what has no mass, fits through, or moves by itself is refused with a message") {
  Cloth cloth = cloth_of(sheet(13, 0.6, 0), small_steps(Backend::simd));
  const BodyMass mass{.mass = 1, .inertia = {1, 1, 1}};
  const auto refusal = [&](const Body& body) { return cloth.add_body(body).error(); };
  const auto ball = shape_of(Ball{{}, 0.1});
  CHECK(refusal({.shape = shape_of(box_mesh({1, 1, 1}, 1)), .mass = mass}) ==
        "mass: must be of " + shapes_with_mass() + " (a triangle mesh)");
  CHECK(refusal({.shape = shape_of(Plane{}), .mass = mass}) ==
        "mass: must be of " + shapes_with_mass() + " (a plane)");
  CHECK(refusal({.shape = ball, .mass = BodyMass{.mass = -1, .inertia = {1, 1, 1}}})
            .starts_with("mass.mass: must be"));
  CHECK(refusal({.shape = ball, .mass = BodyMass{.mass = 1, .inertia = {1, 1, 3}}})
            .starts_with("mass.inertia"));
  CHECK(refusal({.shape = shape_of(Ball{{}, 0.001}), .mass = mass})
            .starts_with("mass: must be of a body that does not fit"));
  const std::uint32_t held =
      cloth.add_body({.shape = ball, .pose = {.position = {0, 1, 0}}}).value();
  const std::uint32_t free =
      cloth.add_body({.shape = ball, .pose = {.position = {0, 2, 0}}, .mass = mass}).value();
  CHECK(cloth.move_body(free, {}).error().starts_with("body: moves by itself"));
  CHECK(cloth.body_velocity(held).error().starts_with("body: has no mass"));
  CHECK(cloth.set_body_force(held, {}, {}).error().starts_with("body: has no mass"));
  CHECK(!cloth.set_body_velocity(free, {{NAN, 0, 0}, {}}));
  CHECK(!cloth.body_pose(7));
  CHECK(cloth.place_body(free, {.position = {0, 3, 0}}));
  CHECK(distance(cloth.body_pose(free).value().position, {0, 3, 0}) == 0);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_free_bodies
