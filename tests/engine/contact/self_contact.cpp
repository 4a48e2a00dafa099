/// Cloth that touches itself: it does not go through itself, rests, sticks, slides and weighs as it
/// should, and keeps the promises of a step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/isas.h"
#include "tests/support/layers.h"
#include "tests/support/meshes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_self_contact {
namespace {

constexpr double kFrame = 1.0 / 60;

Settings small_steps(Backend backend = Backend::simd) {
  return {.solver = Solver::small_steps, .backend = backend, .threads = 1};
}

std::uint32_t add_floor(Cloth& cloth) {
  return add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
}

double fastest(const Cloth& cloth) {
  double most = 0;
  for (const Vec3& v : velocities(cloth)) most = std::max(most, length(v));
  return most;
}

/// A sheet that stands on the floor and folds.
SceneDescription standing(std::uint32_t cells) {
  return scene_of(
      {{cells, cells / 2,
        [](double u, double v) {
          return Vec3{0.002 * std::sin(20 * u) + 1e-3 * chance(u, v), 0.02 + 0.6 * u, 0.3 * v};
        }}},
      0.3);
}

/// Pairs of triangles.
int crossings_of(const Cloth& cloth, const SceneDescription& scene) {
  const std::vector<Vec3> x = positions(cloth);
  return count_self_crossings({x, scene.surface});
}

/// Energy falls but for what the tolerance explains, no frame ends with a crossing, and all
/// converge.
void fall(Cloth& cloth, const SceneDescription& scene, int frames) {
  double energy = cloth.energy().total();
  const double unit = 1e-3 * energy;
  for (int frame = 0; frame < frames; ++frame) {
    CAPTURE(frame);
    const StepReport report = step(cloth, kFrame);
    CHECK(report.status == Status::converged);
    CHECK(report.max_penetration <= 1e-4);
    CHECK(crossings_of(cloth, scene) == 0);
    const double now = cloth.energy().total();
    CHECK(now < energy + unit);
    energy = std::min(energy, now);
  }
}

TEST_CASE("a stack that falls on the floor lies on it, layer by layer") {
  const std::uint32_t kLayers = 3;
  const SceneDescription scene = scene_of(stack(kLayers, 10, 0.01), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  const auto floor = add_floor(cloth);
  fall(cloth, scene, 40);
  double lowest = 1, highest = 0;
  for (const Vec3& x : positions(cloth)) {
    lowest = std::min(lowest, x.y);
    highest = std::max(highest, x.y);
  }
  CHECK(lowest > 0);
  CHECK(highest < 1.2 * kLayers * kLayerThickness);
  CHECK(highest > 0.8 * (kLayers - 1) * kLayerThickness);
  double weight = 0;
  for (const double mass : scene.masses) weight += 10 * mass;
  double load = 0;
  const int kFrames = 10;
  for (int frame = 0; frame < kFrames; ++frame) {
    step(cloth, kFrame);
    load -= cloth.body_load(floor).value().force.y / kFrames;
  }
  CHECK(load == doctest::Approx(weight).epsilon(0.02));
}

/// Two squares of 1 m over each other, of which one is turned by an angle.
SceneDescription askew(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto lower = [](double u, double v) { return Vec3{u - 0.5, 0.01, v - 0.5}; };
  const auto upper = [=](double u, double v) {
    const Vec3 from = lower(u, v);
    return Vec3{c * from.x + s * from.z, 0.02, c * from.z - s * from.x};
  };
  return scene_of({{11, 11, lower}, {11, 11, upper}}, 0.3);
}

TEST_CASE("two layers whose borders lie over each other come to rest") {
  for (const Backend backend : kBackends) {
    CAPTURE(backend);
    Cloth cloth = cloth_of(askew(0.1), small_steps(backend));
    add_floor(cloth);
    run(cloth, kFrame, 60);
    for (int frame = 0; frame < 5; ++frame) {
      step(cloth, kFrame);
      CHECK(fastest(cloth) < 1e-3);
    }
  }
}

TEST_CASE("a sheet that folds on the floor does not go through itself, and rests") {
  const SceneDescription scene = standing(16);
  Cloth cloth = cloth_of(scene, small_steps());
  add_floor(cloth);
  fall(cloth, scene, 90);
  run(cloth, kFrame, 60);
  CHECK(fastest(cloth) < 0.05);
}

TEST_CASE("a ribbon whose ends turn does not go through itself") {
  const std::uint32_t kRows = 40, kColumns = 4;
  std::vector<std::uint32_t> pins;
  for (std::uint32_t j = 0; j <= kColumns; ++j) {
    pins.push_back(j);
    pins.push_back(kRows * (kColumns + 1) + j);
  }
  const auto place = [](double u, double v) { return Vec3{u - 0.5, 0, 0.08 * (v - 0.5)}; };
  const SceneDescription scene = scene_of({{kRows, kColumns, place}}, 0.3, pins);
  Cloth cloth = cloth_of(scene, small_steps());
  bool has_touched = false;
  for (int frame = 1; frame <= 45; ++frame) {
    const double turn = 0.15 * frame, nearer = 1 - 0.007 * frame;
    for (const std::uint32_t pin : scene.fixed) {
      const Vec3 from = scene.positions[pin];
      const double angle = from.x > 0 ? turn : -turn;
      REQUIRE(cloth.move_fixed(
          pin, {nearer * from.x, -std::sin(angle) * from.z, std::cos(angle) * from.z}));
    }
    const StepReport report = step(cloth, kFrame);
    REQUIRE(crossings_of(cloth, scene) == 0);
    has_touched = has_touched || report.contact_ms.sweep > 0;
  }
  CHECK(has_touched);
}

/// Of a small sheet on a large one that is held, along the slope of that.
struct Slide {
  double speed = 0;  // m/s, at the end
  double way = 0;    // m, from the beginning
};
Slide slide_on_slope(double slope, double friction, int frames) {
  const std::uint32_t kLarge = 12, kSmall = 5;
  std::vector<std::uint32_t> pins;
  for (std::uint32_t i = 0; i < (kLarge + 1) * (kLarge + 1); ++i) pins.push_back(i);
  const auto square = [](double size, Vec3 at) {
    return [=](double u, double v) { return at + Vec3{size * (u - 0.5), 0, size * (v - 0.5)}; };
  };
  SceneDescription scene = scene_of({{kLarge, kLarge, square(0.6, {})},
                                     {kSmall, kSmall, square(0.15, {-0.1, kLayerThickness, 0.01})}},
                                    friction, pins);
  scene.gravity = {10 * std::sin(slope), -10 * std::cos(slope), 0};
  Cloth cloth = cloth_of(scene, small_steps());
  for (int frame = 0; frame < frames; ++frame)
    CHECK(step(cloth, kFrame).status == Status::converged);
  Vec3 momentum{}, moment{};
  double mass = 0;
  const std::vector<Vec3> v = velocities(cloth), x = positions(cloth);
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (std::ranges::count(scene.fixed, i) > 0) continue;
    momentum = momentum + scene.masses[i] * v[i];
    moment = moment + scene.masses[i] * (x[i] - scene.positions[i]);
    mass += scene.masses[i];
  }
  CHECK(std::abs(momentum.y / mass) < 0.01);
  return {momentum.x / mass, moment.x / mass};
}

TEST_CASE("a layer slides on another one as Coulomb's law says, and sticks below") {
  for (const double friction : {0.1, 0.3, 0.6}) {
    CAPTURE(friction);
    const double sticks = std::atan(friction);
    // It creeps while it comes to rest, by 0.4 mm in this second at most.
    const Slide still = slide_on_slope(sticks - 0.03, friction, 60);
    CHECK(std::abs(still.speed) < 1e-3);
    CHECK(std::abs(still.way) < 1e-3);
    const double steeper = sticks + 0.1;
    CHECK(slide_on_slope(steeper, friction, 30).speed ==
          doctest::Approx(5 * (std::sin(steeper) - friction * std::cos(steeper))).epsilon(0.02));
  }
}

/// What flies over another at 2 m/s, and hits it.
SceneDescription flying_sheets() {
  const auto square = [](Vec3 at) {
    return [=](double u, double v) { return at + Vec3{0.3 * (u - 0.5), 0, 0.3 * (v - 0.5)}; };
  };
  SceneDescription scene =
      scene_of({{8, 8, square({0.017, 0.02, 0.013})}, {8, 8, square({0, -0.02, 0})}}, 0.3);
  scene.gravity = {};
  scene.velocities.assign(scene.positions.size(), Vec3{});
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    if (scene.positions[i].y > 0) scene.velocities[i] = {0.3, -2, 0};
  }
  return scene;
}

TEST_CASE("sheets that hit each other keep their momentum, and lose energy") {
  for (const Backend backend : kBackends) {
    CAPTURE(backend);
    const SceneDescription scene = flying_sheets();
    Cloth cloth = cloth_of(scene, small_steps(backend));
    const auto momentum = [&] {
      Vec3 sum{};
      for (std::size_t i = 0; i < scene.masses.size(); ++i)
        sum = sum + scene.masses[i] * cloth.velocity(static_cast<std::uint32_t>(i));
      return sum;
    };
    const Vec3 before = momentum();
    const double energy = cloth.energy().kinetic;
    for (int frame = 0; frame < 12; ++frame) {
      step(cloth, kFrame);
      REQUIRE(crossings_of(cloth, scene) == 0);
    }
    CHECK(length(momentum() - before) < 0.01 * length(before));
    CHECK(cloth.energy().kinetic < 0.8 * energy);
  }
}

std::uint64_t hash_of(const Settings& settings) {
  Cloth cloth = cloth_of(scene_of(stack(3, 10, 0.01), 0.3), settings);
  add_floor(cloth);
  run(cloth, kFrame, 14);
  return cloth.state_hash();
}

TEST_CASE("bits do not depend on threads, nor on AVX2 or AVX-512") {
  Settings settings = small_steps();
  const std::uint64_t one = hash_of(settings);
  settings.threads = 2;
  CHECK(hash_of(settings) == one);
  if (!simd::supported(simd::Isa::avx512)) return;
  settings.threads = 1;
  settings.isa = Isa::avx2;
  const std::uint64_t avx2 = hash_of(settings);
  settings.isa = Isa::avx512;
  CHECK(hash_of(settings) == avx2);
}

// As long as rounding is what they differ by: later it decides which corners hop (0.5 mm after nine
// frames).
TEST_CASE("both backends lay a sheet on another alike") {
  const SceneDescription scene = scene_of(stack(2, 8, kLayerThickness), 0.3);
  Cloth a = cloth_of(scene, small_steps(Backend::reference)), b = cloth_of(scene, small_steps());
  for (Cloth* cloth : {&a, &b}) {
    add_floor(*cloth);
    run(*cloth, kFrame, 5);
  }
  CHECK(largest_distance(positions(a), positions(b)) < 0.05 * kLayerThickness);
}

TEST_CASE("a saved state goes on bit for bit, and so does a copy") {
  const SceneDescription scene = scene_of(stack(2, 8, 0.006), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  add_floor(cloth);
  run(cloth, kFrame, 10);
  const std::vector<std::byte> state = cloth.save_state();
  Cloth copy = cloth.clone(), loaded = cloth_of(scene, small_steps());
  add_floor(loaded);
  REQUIRE(loaded.load_state(state));
  for (Cloth* one : {&cloth, &copy, &loaded}) run(*one, kFrame, 5);
  CHECK(copy.state_hash() == cloth.state_hash());
  CHECK(loaded.state_hash() == cloth.state_hash());
}

/// Where a force lifts them off their last pushes are 0. Where all are fixed under their weight
/// nothing is near any more, and nothing takes the last pushes back.
TEST_CASE("layers that have come apart leave no multipliers in the state") {
  const Settings settings = small_steps(each_backend());
  const std::uint32_t kCells = 4, kPoints = (kCells + 1) * (kCells + 1);
  std::vector<std::uint32_t> below(kPoints), above(kPoints);
  std::iota(below.begin(), below.end(), 0u);
  std::iota(above.begin(), above.end(), kPoints);
  const auto level = [](double height) {
    return [=](double u, double v) { return Vec3{0.1 * u, height, 0.1 * v}; };
  };
  const SceneDescription scene = scene_of(
      {{kCells, kCells, level(0)}, {kCells, kCells, level(1.1 * kLayerThickness)}}, 0.3, below);
  const auto lift = [](Cloth& cloth) {
    REQUIRE(cloth.set_gravity({0, 5, 0}));
    run(cloth, kFrame, 20);
  };
  const auto fix = [&](Cloth& cloth) {
    REQUIRE(cloth.change({.fix = above}));
    run(cloth, kFrame, 1);
  };
  for (const bool are_fixed : {false, true}) {
    CAPTURE(are_fixed);
    Cloth pressed = cloth_of(scene, settings), untouched = cloth_of(scene, settings);
    run(pressed, kFrame, 10);
    const std::size_t size = pressed.save_state().size();
    for (Cloth* cloth : {&pressed, &untouched}) are_fixed ? fix(*cloth) : lift(*cloth);
    CHECK(pressed.save_state().size() < size);
    CHECK(pressed.save_state().size() == untouched.save_state().size());
  }
}

TEST_CASE("a step that fails leaves cloth that touches itself as it was") {
  const SceneDescription scene = scene_of(stack(2, 8, 0.006), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  add_floor(cloth);
  run(cloth, kFrame, 10);
  std::vector<Vec3> forces(scene.positions.size());
  forces.back() = {1e300, 0, 0};
  REQUIRE(cloth.write_forces(forces));
  const std::vector<std::byte> before = cloth.save_state();
  REQUIRE_FALSE(committed(step(cloth, kFrame).status));
  CHECK(cloth.save_state() == before);
}

/// A sheet that is held, and another one that leads through it and flies off.
SceneDescription crossing_sheets() {
  constexpr std::uint32_t kCells = 8;
  std::vector<std::uint32_t> pins;
  for (std::uint32_t i = 0; i < (kCells + 1) * (kCells + 1); ++i) pins.push_back(i);
  SceneDescription scene =
      scene_of({{kCells, kCells,
                 [](double u, double v) {
                   return Vec3{0.3 * (u - 0.5), 0, 0.3 * (v - 0.5)};
                 }},
                {kCells, kCells,
                 [](double u, double v) {
                   return Vec3{0.2 * (u - 0.51), 0.12 * (v - 0.43), 0.01 + 0.05 * (v - 0.5)};
                 }}},
               0.3, pins);
  scene.gravity = {};
  scene.velocities.assign(scene.positions.size(), Vec3{0, 0.5, 0});
  for (const std::uint32_t pin : scene.fixed) scene.velocities[pin] = {};
  return scene;
}

TEST_CASE("triangles that cross in the beginning come apart, and no others cross meanwhile") {
  const SceneDescription scene = crossing_sheets();
  Cloth cloth = cloth_of(scene, small_steps());
  int before = crossings_of(cloth, scene);
  REQUIRE(before > 10);
  std::vector<std::byte> state;
  std::uint64_t hash = 0;
  for (int frame = 0; frame < 24; ++frame) {
    CAPTURE(frame);
    const StepReport report = step(cloth, kFrame);
    const int now = crossings_of(cloth, scene);
    CHECK(report.tangled == now);
    CHECK(now <= before + 2);
    before = std::min(now, before);
    if (frame == 2) {
      CHECK(report.tangled > 0);
      state = cloth.save_state();
    }
    if (frame == 9) hash = cloth.state_hash();
  }
  CHECK(before == 0);
  Cloth loaded = cloth_of(scene, small_steps());
  REQUIRE(loaded.load_state(state));
  run(loaded, kFrame, 7);
  CHECK(loaded.state_hash() == hash);
}

/// A sheet of 1 m that hangs by its corners, laid out too narrow.
SceneDescription laid_out(std::uint32_t size, double narrow) {
  MeshDescription mesh = quads(size);
  mesh.material = find_material("cotton").value();
  mesh.rest_positions = mesh.positions;
  const double cell = 1.0 / (size - 1);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double x = cell * mesh.positions[i].x - 0.5, z = cell * mesh.positions[i].y - 0.5;
    mesh.rest_positions[i] = {x, 0, z};
    mesh.positions[i] = {0.7 * x, 0.5 * x * x, narrow * z};
  }
  mesh.pins = {0, size - 1, size * (size - 1), size * size - 1};
  SceneDescription scene = cloth_from_mesh(mesh).value().scene;
  scene.self_contact = {.on = true};
  return scene;
}

TEST_CASE("cloth that is put right at once goes nowhere through itself" *
          doctest::test_suite("long")) {
  for (const double narrow : {0.9, 0.8, 0.7}) {
    CAPTURE(narrow);
    const SceneDescription scene = laid_out(25, narrow);
    Cloth cloth = cloth_of(scene, small_steps());
    REQUIRE(crossings_of(cloth, scene) == 0);
    for (int frame = 0; frame < 12; ++frame) {
      CAPTURE(frame);
      const StepReport report = step(cloth, kFrame);
      CHECK(report.tangled == 0);
      CHECK(crossings_of(cloth, scene) == 0);
      if (frame > 4) CHECK(report.status == Status::converged);
    }
  }
}

TEST_CASE("a report counts pairs that touch each other") {
  const SceneDescription scene = scene_of(stack(2, 8, 0.006), 0.3);
  Cloth cloth = cloth_of(scene, small_steps());
  add_floor(cloth);
  CHECK(step(cloth, kFrame).self_contacts == 0);
  run(cloth, kFrame, 10);
  const StepReport report = step(cloth, kFrame);
  CHECK(report.self_contacts > 81);
  CHECK(report.body_contacts <= 81);
  CHECK(report.tangled == 0);
}

TEST_CASE("self-contact that cannot be is refused with one line") {
  const SceneDescription good = scene_of(stack(2, 4, 0.006), 0.3);
  const auto refused = [&](auto&& change) {
    SceneDescription scene = good;
    change(scene);
    const auto built = build_model(scene);
    REQUIRE_FALSE(built);
    return built.error();
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double thickness : {0.0, -1.0, kNan}) {
    CHECK(refused([&](SceneDescription& s) {
            s.self_contact.thickness = thickness;
          }).starts_with("self_contact.thickness: must be"));
  }
  for (const double friction : {-0.1, kNan}) {
    CHECK(refused([&](SceneDescription& s) {
            s.self_contact.friction = friction;
          }).starts_with("self_contact.friction: must be"));
  }
  const auto clear = [](SceneDescription& s) {
    s.surface.clear();
    s.constraints.clear();
  };
  CHECK(refused(clear) ==
        "self_contact: needs triangles of `surface`, or constraints that are threads (none)");
  const auto cloth = Cloth::create(build_model(good).value(), {.solver = Solver::yarn});
  REQUIRE_FALSE(cloth);
  CHECK(cloth.error().find("by small_steps only") != std::string::npos);
}

TEST_CASE("where it is off, layers fall through each other") {
  SceneDescription scene = scene_of(stack(2, 8, 0.006), 0.3);
  scene.self_contact = {};
  Cloth cloth = cloth_of(scene, small_steps());
  add_floor(cloth);
  run(cloth, kFrame, 15);
  double highest = 0;
  for (const Vec3& x : positions(cloth)) highest = std::max(highest, x.y);
  CHECK(highest < 1.1e-3);  // the thickness of the floor
}

}  // namespace
}  // namespace weft::test::engine_contact_self_contact
