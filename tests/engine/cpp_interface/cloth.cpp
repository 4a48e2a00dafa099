/// What a Cloth reads, writes and keeps, beside stepping.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_cpp_interface_cloth {
namespace {

TEST_CASE("a cloth starts as described") {
  const Backend backend = each_backend();
  SceneDescription scene = scene_of("hang", 4);
  scene.velocities.assign(16, {0, 0, 0});
  scene.velocities[9] = {1, 2, 3};
  Cloth cloth = cloth_of(scene, on(backend));
  CHECK(cloth.particle_count() == 16);
  CHECK(largest_distance(positions(cloth), scene.positions) == 0);
  CHECK(largest_distance(velocities(cloth), scene.velocities) == 0);
  CHECK(distance(cloth.velocity(9), {1, 2, 3}) == 0);
  CHECK(cloth.settings().tolerance == 0.01);
  CHECK(describe(*cloth.model()).particles == 16);
}

Solver chosen(const SceneDescription& scene, const Settings& settings) {
  return cloth_of(scene, settings).settings().solver;
}

TEST_CASE("automatic is small steps for cloth, where these are said to be the fastest") {
  for (const char* name : {"hang", "hang_sphere", "corners", "banner", "four_pins", "cape"}) {
    CAPTURE(std::string(name));
    const SceneDescription scene = scene_of(name, 9);
    for (const Scheme scheme : {Scheme::automatic, Scheme::bdf2, Scheme::implicit}) {
      const Cloth cloth = cloth_of(scene, {.scheme = scheme});
      CHECK(cloth.settings().solver == Solver::small_steps);
      CHECK(cloth.settings().scheme == (scheme == Scheme::automatic ? Scheme::bdf2 : scheme));
    }
    CHECK(chosen(scene, {.tolerance = 1e-3}) == Solver::small_steps);
    CHECK(chosen(scene, {.tolerance = 0.9e-3}) == Solver::yarn);
    CHECK(chosen(scene, {.substeps = 4}) == Solver::small_steps);
    CHECK(chosen(scene, {.scheme = Scheme::paper}) == Solver::yarn);
    CHECK(chosen(scene, {.scheme = Scheme::rattle}) == Solver::yarn);
    CHECK(chosen(scene, {.velocity_correction = true}) == Solver::yarn);
    CHECK(chosen(scene, {.iterations = 3}) == Solver::gauss_seidel);
    CHECK(chosen(scene, {.backend = Backend::reference}) == Solver::gauss_seidel);
  }
  CHECK(chosen(scene_of("sphere_drop", 9), {}) == Solver::yarn);
  CHECK(chosen(scene_of("chain", 9), {}) == Solver::small_steps);
  CHECK(chosen(scene_of("chain", 9), {.tolerance = 0.9e-3}) == Solver::yarn);
  SceneDescription uneven = scene_of("hang", 9);
  uneven.masses.back() *= 99;
  CHECK(chosen(uneven, {}) == Solver::small_steps);
  uneven.masses.back() *= 2;
  CHECK(chosen(uneven, {}) == Solver::yarn);
  SceneDescription ropes = scene_of("hang", 9);
  for (Constraint& c : ropes.constraints) c.kind = ConstraintKind::rope;
  CHECK(chosen(ropes, {}) == Solver::small_steps);
}

TEST_CASE("what automatic is by scheme: paper unless small steps are chosen") {
  const SceneDescription scene = scene_of("hang", 9);
  const auto scheme = [&](const Settings& settings) {
    return cloth_of(scene, settings).settings().scheme;
  };
  CHECK(scheme({.solver = Solver::small_steps}) == Scheme::bdf2);
  CHECK(scheme({.solver = Solver::small_steps, .scheme = Scheme::implicit}) == Scheme::implicit);
  for (const Solver solver : {Solver::gauss_seidel, Solver::direct, Solver::yarn}) {
    CHECK(scheme({.solver = solver}) == Scheme::paper);
  }
  CHECK(scheme({.tolerance = 1e-4}) == Scheme::paper);
  CHECK(scheme({.scheme = Scheme::rattle}) == Scheme::rattle);
}

TEST_CASE("the solver that automatic stands for: another than yarns where they have no chance") {
  const SceneDescription hang = scene_of("hang", 4), sphere = scene_of("hang_sphere", 4);
  const Settings paper{.scheme = Scheme::paper}, rattle{.scheme = Scheme::rattle};
  for (const Settings& settings : {paper, rattle}) {
    CHECK(chosen(hang, settings) == Solver::yarn);
    CHECK(chosen(sphere, settings) == Solver::yarn);
  }
  CHECK(chosen(hang, {.iterations = 3}) == Solver::gauss_seidel);
  CHECK(chosen(hang, {.backend = Backend::reference}) == Solver::gauss_seidel);
  CHECK(cloth_of(hang, {.backend = Backend::reference}).settings().substeps == 1);
  SceneDescription heavy = scene_of("chain", 4);
  for (const double ratio : {9e3, 2e4, 2e6}) {
    heavy.masses.back() = ratio * heavy.masses[1];
    CHECK(chosen(heavy, {}) == Solver::small_steps);
    CHECK(chosen(heavy, {.substeps = 2}) == Solver::small_steps);
    CHECK(chosen(heavy, {.tolerance = 1e-6}) == Solver::small_steps);
    CHECK(chosen(heavy, paper) == Solver::yarn);
  }
  heavy.constraints.back().kind = ConstraintKind::rope;
  CHECK(chosen(heavy, paper) == Solver::direct);
  SceneDescription net = scene_of("hang", 33);
  for (std::size_t c = 0; c < net.constraints.size(); ++c) {
    if (c % 5 > 0) net.constraints[c].kind = ConstraintKind::rope;
  }
  CHECK(chosen(net, paper) == Solver::yarn);
  for (std::size_t c = 0; c < net.constraints.size(); c += 5) {
    if (c > 200) net.constraints[c].kind = ConstraintKind::rope;
  }
  CHECK(chosen(net, paper) == Solver::yarn);
  net.masses.back() = 2e4 * net.masses[20];
  CHECK(chosen(net, paper) == Solver::yarn);
}

/// Ropes in a row, the first particle fixed, from a plumb line by 0.3 rad.
SceneDescription cord(std::uint32_t ropes, double length) {
  SceneDescription scene;
  const Vec3 along{std::sin(0.3) * length / ropes, -std::cos(0.3) * length / ropes, 0};
  for (std::uint32_t i = 0; i <= ropes; ++i) {
    scene.positions.push_back({along.x * i, along.y * i, 0});
    if (i > 0) scene.constraints.push_back({i - 1, i, length / ropes, ConstraintKind::rope});
  }
  scene.masses.assign(ropes + 1, 1);
  scene.fixed = {0};
  return scene;
}

TEST_CASE(
    "automatic: chains of ropes are for small steps, and those with heavy spheres for direct") {
  CHECK(chosen(cord(1, 2), {}) == Solver::small_steps);
  CHECK(chosen(cord(40, 1.1), {}) == Solver::small_steps);
  CHECK(chosen(cord(40, 0.9), {.tolerance = 1e-6}) == Solver::small_steps);
  CHECK(chosen(cord(40, 0.9), {.scheme = Scheme::paper}) == Solver::direct);
  SceneDescription loaded = cord(40, 0.9);
  loaded.masses.back() = 200;
  CHECK(chosen(loaded, {}) == Solver::small_steps);
  SceneDescription bridge = cord(40, 2);  // of two cords
  const SceneDescription other = cord(40, 2);
  bridge.positions.insert(bridge.positions.end(), other.positions.begin(), other.positions.end());
  bridge.masses.assign(82, 1);
  for (const Constraint& c : other.constraints) {
    bridge.constraints.push_back({c.a + 41, c.b + 41, c.rest_length, c.kind});
  }
  for (std::uint32_t i = 0; i <= 40; ++i) {
    bridge.positions[i + 41].z = 1;
    bridge.constraints.push_back({i, i + 41, 1});
  }
  CHECK(chosen(bridge, {}) == Solver::small_steps);
  SceneDescription net = scene_of("hang", 20);
  for (Constraint& c : net.constraints) c.kind = ConstraintKind::rope;
  CHECK(chosen(net, {.scheme = Scheme::paper}) == Solver::yarn);
  SceneDescription beads = cord(17, 2);
  beads.radii.assign(18, 0.01);
  for (std::uint32_t i = 0; i <= 16; ++i) beads.spheres.push_back(i);  // the first one is fixed
  CHECK(chosen(beads, {}) == Solver::small_steps);
  beads.masses.back() = beads.masses[16] = 200;
  CHECK(chosen(beads, {}) == Solver::direct);
  beads.spheres.push_back(17);
  CHECK(chosen(beads, {}) == Solver::yarn);
}

TEST_CASE("automatic: a weight on a cord swings, and gains no energy, however short the steps") {
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
    for (const std::uint32_t ropes : {1u, 8u}) {
      for (const double dt : {1 / 60., 1 / 240.}) {
        CAPTURE(dt);
        Cloth cloth = cloth_of(cord(ropes, 2), {.scheme = scheme});
        const double start = cloth.energy().total();
        double most = start, fastest = 0;
        for (double t = 0; t < 2; t += dt) {
          REQUIRE(cloth.step(dt).value().status == Status::converged);
          most = std::max(most, cloth.energy().total());
          fastest = std::max(fastest, cloth.energy().kinetic);
        }
        CHECK(most - start < 0.02 * fastest);
        CHECK(fastest > 0.7 * ropes / 2.);
      }
    }
  }
}

TEST_CASE("automatic: particles that nothing joins have no say in it") {
  SceneDescription braced = scene_of("hang", 20);
  for (std::uint32_t i = 0; i < 399; ++i) {
    const bool diagonal = i % 20 < 19 && i < 380;
    if (diagonal) {
      braced.constraints.push_back({i, i + 21, 0.06 * std::sqrt(2.), ConstraintKind::rope});
    }
  }
  for (const SceneDescription& scene : {braced, scene_of("hang", 20), cord(40, 2)}) {
    const Solver alone = cloth_of(scene, {}).settings().solver;
    SceneDescription beside = scene;
    beside.positions.resize(scene.positions.size() + 1000);
    beside.masses.resize(beside.positions.size(), 1);
    CHECK(cloth_of(beside, {}).settings().solver == alone);
  }
}

/// Whether the vectors stand in the buffer, and -7 between them.
bool holds(const std::vector<float>& buffer, std::size_t stride, std::size_t offset,
           const std::vector<Vec3>& vectors, Vec3 origin) {
  std::vector<float> expected(buffer.size(), -7);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const Vec3 v = vectors[i];
    float* const to = &expected[offset + i * stride];
    to[0] = static_cast<float>(v.x - origin.x);
    to[1] = static_cast<float>(v.y - origin.y);
    to[2] = static_cast<float>(v.z - origin.z);
  }
  return buffer == expected;
}

TEST_CASE("floats are the positions and velocities; what lies between them stays") {
  const Backend backend = each_backend();
  Cloth cloth = cloth_of(scene_of("corners", 5), on(backend));
  run(cloth, 0.01, 3);
  for (const auto& [stride, offset] : {std::pair{3, 0}, {4, 0}, {4, 1}, {8, 0}, {8, 3}, {8, 5}}) {
    CAPTURE(stride);
    CAPTURE(offset);
    const auto step = static_cast<std::size_t>(stride), first = static_cast<std::size_t>(offset);
    std::vector<float> buffer(25 * step, -7);
    const FloatVectors out{std::span(buffer).subspan(first), step};
    REQUIRE(cloth.read_positions(out));
    CHECK(holds(buffer, step, first, positions(cloth), {}));
    REQUIRE(cloth.read_positions(out, {3, -4, 5}));
    CHECK(holds(buffer, step, first, positions(cloth), {3, -4, 5}));
    REQUIRE(cloth.read_velocities(out));
    CHECK(holds(buffer, step, first, velocities(cloth), {}));
  }
  std::vector<float> packed(75);
  REQUIRE(cloth.read_positions({packed}));
  CHECK(holds(packed, 3, 0, positions(cloth), {}));
}

TEST_CASE("floats relative to an origin keep their precision far away") {
  SceneDescription scene = scene_of("hang", 5);
  const Vec3 far{1e7, -2e7, 3e7};
  std::vector<Vec3> moved = scene.positions;
  for (Vec3& p : moved) p = p + far;
  Cloth cloth = cloth_of(scene, {});
  REQUIRE(cloth.write_positions(moved));
  std::vector<float> near(75), rounded(75);
  REQUIRE(cloth.read_positions({near}, far));
  REQUIRE(cloth.read_positions({rounded}));
  double worst = 0, worst_rounded = 0;
  for (std::size_t i = 0; i < 25; ++i) {
    const Vec3 p{near[3 * i], near[3 * i + 1], near[3 * i + 2]};
    const Vec3 q{rounded[3 * i], rounded[3 * i + 1], rounded[3 * i + 2]};
    worst = std::max(worst, distance(p, scene.positions[i]));
    worst_rounded = std::max(worst_rounded, distance(q - far, scene.positions[i]));
  }
  CHECK(worst < 2e-7);
  CHECK(worst_rounded > 0.1);
}

TEST_CASE("bounds are those of all particles, of fixed ones too") {
  Cloth cloth = cloth_of(scene_of("hang", 9), {});
  run(cloth, 0.01, 20);
  REQUIRE(cloth.move_fixed(0, {-3, 4, 5}));
  Vec3 least = cloth.position(0), most = least;
  for (const Vec3& p : positions(cloth)) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  CHECK(distance(cloth.bounds().least, least) == 0);
  CHECK(distance(cloth.bounds().most, most) == 0);
  CHECK(least.x == -3);
  CHECK(most.y == 4);
}

/// Pins of a sheet, some twice, and where each is to be at a time.
struct PinPlan {
  std::vector<std::uint32_t> pins;
  std::vector<Vec3> places;
};
PinPlan pin_plan(const SceneDescription& scene, double time) {
  PinPlan plan;
  for (const std::uint32_t pin : scene.fixed) {
    const Vec3 start = scene.positions[pin];
    plan.pins.push_back(pin);
    plan.places.push_back({start.x, start.y + 0.1 * std::sin(9 * time + pin), start.z});
  }
  plan.pins.push_back(scene.fixed[1]);
  plan.places.push_back(scene.positions[scene.fixed[1]]);
  return plan;
}

TEST_CASE("many pins are moved and placed as one after the other, bit for bit") {
  const Backend backend = each_backend();
  const SceneDescription scene = scene_of("hang", 8);
  Cloth many = cloth_of(scene, on(backend)), single = many.clone();
  for (int k = 0; k < 12; ++k) {
    const PinPlan plan = pin_plan(scene, 0.01 * k);
    const PinPlan first = pin_plan(scene, 0.02 * k + 0.3);
    if (k % 4 == 2) {  // some frames move before they place, some only place
      REQUIRE(many.move_fixed(first.pins, first.places));
      for (std::size_t i = 0; i < first.pins.size(); ++i)
        REQUIRE(single.move_fixed(first.pins[i], first.places[i]));
    }
    for (std::size_t i = 0; i < plan.pins.size(); ++i) {
      REQUIRE((k % 2 == 0 ? single.place_fixed(plan.pins[i], plan.places[i])
                          : single.move_fixed(plan.pins[i], plan.places[i])));
    }
    REQUIRE((k % 2 == 0 ? many.place_fixed(plan.pins, plan.places)
                        : many.move_fixed(plan.pins, plan.places)));
    REQUIRE(many.state_hash() == single.state_hash());
    run(many, 0.01, 1);
    run(single, 0.01, 1);
    REQUIRE(many.state_hash() == single.state_hash());
  }
}

TEST_CASE("of many pins all are moved and placed, or none") {
  const SceneDescription scene = scene_of("hang", 8);
  Cloth cloth = cloth_of(scene, {}), untouched = cloth.clone();
  const std::uint32_t a = scene.fixed[0], b = scene.fixed[1];
  const double nan = std::nan("");
  const auto refused = [&](const std::vector<std::uint32_t>& pins, const std::vector<Vec3>& places,
                           const std::string& line) {
    CHECK(cloth.move_fixed(pins, places).error() == line);
    CHECK(cloth.place_fixed(pins, places).error() == line);
  };
  refused({a, b}, {{}}, "positions: needs 2 elements (1)");
  refused({a, b}, {{1, 2, 3}, {0, nan, 0}}, "positions[1]: must be finite (0, nan, 0)");
  refused({a, 63}, {{1, 2, 3}, {}}, "particles[1]: is not fixed (63)");
  refused({a, 64}, {{1, 2, 3}, {}}, "particles[1]: no such particle, the scene has 64 (64)");
  run(cloth, 0.01, 3);
  run(untouched, 0.01, 3);
  CHECK(cloth.state_hash() == untouched.state_hash());
  CHECK(cloth.move_fixed({}, {}));
  CHECK(cloth.place_fixed({}, {}));
  run(cloth, 0.01, 3);
  run(untouched, 0.01, 3);
  CHECK(cloth.state_hash() == untouched.state_hash());
}

TEST_CASE("a state that is read and written into another cloth goes on bit for bit") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Settings settings = with(paper_settings(), method);
    settings.velocity_correction = true;
    const SceneDescription scene = scene_of("hang_sphere", 8);
    Cloth first = cloth_of(scene, settings);
    run(first, 0.01, 60);
    Cloth second = cloth_of(scene, settings);
    REQUIRE(second.write_positions(positions(first)));
    REQUIRE(second.write_velocities(velocities(first)));
    CHECK(second.state_hash() == first.state_hash());
    run(first, 0.01, 20);
    run(second, 0.01, 20);
    CHECK(second.state_hash() == first.state_hash());
  }
}

/// A sheet whose pins move, under forces, after some steps.
Cloth on_its_way(const SceneDescription& scene, const Settings& settings) {
  Cloth cloth = cloth_of(scene, settings);
  REQUIRE(cloth.write_forces(std::vector<Vec3>(scene.positions.size(), {0.001, 0, 0})));
  REQUIRE(cloth.set_gravity({0, -9, 1}));
  for (int k = 0; k < 30; ++k) {
    for (const std::uint32_t pin : scene.fixed) {
      const Vec3 at = cloth.position(pin);
      REQUIRE(cloth.move_fixed(pin, {at.x, at.y, at.z + 0.02}));
    }
    run(cloth, 0.01, 1);
  }
  return cloth;
}

TEST_CASE("a clone, and a cloth that copies the state of another, go on bit for bit") {
  for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
    for (const char* name : {"hang_sphere", "corners"}) {
      for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
        CAPTURE(weft::name(solver));
        CAPTURE(name);
        CAPTURE(weft::name(scheme));
        const SceneDescription scene = scene_of(name, 9);
        Cloth cloth = on_its_way(scene, {.solver = solver, .scheme = scheme});
        Cloth clone = cloth.clone();
        Cloth back = cloth.clone();
        run(back, 0.0002, 7);
        REQUIRE(back.copy_state(cloth));
        for (int k = 0; k < 20; ++k) {
          const double dt = k == 0 ? 0.0005 : 0.01;  // a short step depends on the one before
          for (Cloth* each : {&cloth, &clone, &back}) {
            const Vec3 at = each->position(scene.fixed[0]);
            REQUIRE(each->move_fixed(scene.fixed[0], {at.x, at.y, at.z + 0.02}));
            run(*each, dt, 1);
          }
          REQUIRE(clone.state_hash() == cloth.state_hash());
          REQUIRE(back.state_hash() == cloth.state_hash());
        }
      }
    }
  }
}

TEST_CASE("copies know of moves to come, and at what speed pins have moved") {
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  Cloth cloth = cloth_of(scene, {}), back = cloth.clone();
  for (const double x : {-0.01, -0.03, -0.06, -0.1}) {
    REQUIRE(cloth.move_fixed(0, {x, 0, 0}));
    Cloth clone = cloth.clone();
    REQUIRE(back.copy_state(cloth));
    for (Cloth* each : {&cloth, &clone, &back}) step(*each, 0.01);
    CHECK(clone.state_hash() == cloth.state_hash());
    CHECK(back.state_hash() == cloth.state_hash());
  }
  CHECK(cloth.velocity(1).x < -3);
}

TEST_CASE("a state goes on to another tolerance, but not to another model") {
  const auto model = model_of(scene_of("hang", 6));
  auto loose = Cloth::create(model, {}), tight = Cloth::create(model, {.tolerance = 1e-4});
  REQUIRE(loose);
  REQUIRE(tight);
  run(loose.value(), 0.01, 20);
  REQUIRE(tight.value().copy_state(loose.value()));
  CHECK(tight.value().state_hash() == loose.value().state_hash());
  CHECK(step(tight.value(), 0.01).max_strain <= 1e-4);
  Cloth other = cloth_of(scene_of("hang", 6), {});
  const std::uint64_t before = other.state_hash();
  const auto refused = other.copy_state(loose.value());
  REQUIRE_FALSE(refused);
  CHECK(refused.error().find("another model (36 particles)") != std::string::npos);
  CHECK(other.state_hash() == before);
}

TEST_CASE("what the new settings do not allow is put right without a change of velocity") {
  const auto model = model_of(scene_of("hang", 12));
  Settings settings = paper_settings();
  settings.tolerance = 0.1;
  auto loose = Cloth::create(model, settings);
  settings.tolerance = 1e-4;
  auto tight = Cloth::create(model, settings);
  run(loose.value(), 0.01, 20);
  REQUIRE(loose.value().strain().max > 0.02);
  REQUIRE(tight.value().copy_state(loose.value()));
  const std::vector<Vec3> before = velocities(loose.value());
  REQUIRE(step(tight.value(), 1e-4).status == Status::converged);
  CHECK(largest_distance(velocities(tight.value()), before) < 1);  // 2 % of 0.1 m / 1e-4 s: 20
}

TEST_CASE("gravity that is set is what a particle falls by, and what energy is measured in") {
  const Backend backend = each_backend();
  Cloth cloth = cloth_of(free_bar(1, 1), on(backend));
  REQUIRE(cloth.set_gravity({0, 0, 3}));
  const double before = cloth.energy().total();
  const Vec3 from = cloth.position(0);
  run(cloth, 0.01, 100);
  CHECK(cloth.position(0).z - from.z == doctest::Approx(1.5));
  CHECK(cloth.position(0).y == from.y);
  CHECK(cloth.energy().total() == doctest::Approx(before));
  CHECK_FALSE(cloth.set_gravity({0, std::nan(""), 0}));
}

TEST_CASE("the hash sees every particle's position and velocity") {
  Cloth cloth = cloth_of(scene_of("hang", 4), {});
  const std::uint64_t start = cloth.state_hash();
  std::vector<Vec3> v(16);
  v[15].z = 1e-300;
  REQUIRE(cloth.write_velocities(v));
  CHECK(cloth.state_hash() != start);
  v[15].z = 0;
  REQUIRE(cloth.write_velocities(v));
  CHECK(cloth.state_hash() == start);
  REQUIRE(cloth.move_fixed(0, {0, 1e-300, 0}));
  CHECK(cloth.state_hash() != start);
}

TEST_CASE("a moved cloth goes on where it was") {
  const Backend backend = each_backend();
  Cloth first = cloth_of(scene_of("hang", 5), on(backend));
  Cloth other = cloth_of(scene_of("hang", 5), on(backend));
  run(first, 0.01, 10);
  run(other, 0.01, 10);
  Cloth moved = std::move(first);
  run(moved, 0.01, 10);
  run(other, 0.01, 10);
  CHECK(moved.state_hash() == other.state_hash());
  other = std::move(moved);
  CHECK(other.particle_count() == 25);
  CHECK(step(other, 0.01).status == Status::converged);
}

TEST_CASE("a fixed particle has no velocity, whatever is written") {
  const Backend backend = each_backend();
  SceneDescription scene = scene_of("hang", 4);
  scene.velocities.assign(16, {1, 1, 1});
  Cloth cloth = cloth_of(scene, on(backend));
  CHECK(length(cloth.velocity(0)) == 0);
  REQUIRE(cloth.write_velocities(scene.velocities));
  CHECK(length(cloth.velocity(0)) == 0);
  CHECK(distance(cloth.velocity(4), {1, 1, 1}) == 0);
}

TEST_CASE("placed pins inject no more than the correction they ask for") {
  // A bar whose pin is placed 0.1 m along it is pulled 0.1 m in one step and no further.
  SceneDescription scene = free_bar(1, 1);
  scene.fixed = {0};
  const Backend backend = each_backend();
  Settings settings = on(backend, tight(1e-10));
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  REQUIRE(cloth.place_fixed(0, {0.1, 0, 0}));
  step(cloth, 0.01);
  CHECK(distance(cloth.position(1), {1.1, 0, 0}) < exactness(backend, 1e-9, 0.1));
  CHECK(length(cloth.velocity(1)) < exactness(backend, 1e-9, 10));
}

}  // namespace
}  // namespace weft::test::engine_cpp_interface_cloth
