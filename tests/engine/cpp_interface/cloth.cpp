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
