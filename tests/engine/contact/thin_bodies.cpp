/// Closed forms that fit between the particles of a cloth: its edges and faces touch them.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/isas.h"
#include "tests/support/layers.h"
#include "tests/support/motion.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_thin_bodies {
namespace {

constexpr double kG = 10;            // m/s^2
constexpr double kCell = 0.025;      // m
constexpr double kThickness = 1e-3;  // m
constexpr std::array kRates{30, 60, 240};
constexpr std::array kMaterials{"cotton", "silk"};

struct Setting {
  int rate;
  const char* material;
  Cut cut;
};
void for_each_setting(const std::function<void(const Setting&)>& check) {
  for (const int rate : kRates) {
    for (const char* material : kMaterials) {
      for (const Cut cut : {Cut::none, Cut::first}) {
        INFO(rate << " Hz, " << material << ", " << (cut == Cut::none ? "quads" : "triangles"));
        check({rate, material, cut});
      }
    }
  }
}

Settings small_steps() { return {.solver = Solver::small_steps, .threads = 1}; }

/// In the plane y = height, its middle at the origin, askew to the axes so that no row of particles
/// is along one.
MeshDescription sheet_of(const Setting& setting, std::uint32_t size, double height,
                         double turned = 0.2) {
  const double c = std::cos(turned), s = std::sin(turned);
  MeshDescription mesh = sheet(
      size, size,
      [&](double row, double column) {
        const double x = kCell * (row - 0.5 * (size - 1)), z = kCell * (column - 0.5 * (size - 1));
        return Vec3{c * x - s * z, height, s * x + c * z};
      },
      [&](std::uint32_t, std::uint32_t) { return setting.cut; });
  mesh.material = find_material(setting.material).value();
  return mesh;
}

SceneDescription scene_of(const MeshDescription& mesh) {
  SceneDescription scene = made(mesh).scene;
  scene.damping.motion = 2;  // 1/s
  scene.friction = 0.5;
  return scene;
}

double sum(const std::vector<double>& values) {
  double all = 0;
  for (const double value : values) all += value;
  return all;
}

/// A line from a to b, in the middle of a capsule.
struct Line {
  Vec3 a, b;
};
int crossings(const Cloth& cloth, const SceneDescription& scene, const Line& line) {
  const std::vector<Vec3> ends{line.a, line.b};
  const std::vector<std::array<std::uint32_t, 3>> edge{{0, 1, 1}};
  return count_crossings({positions(cloth), scene.surface}, {ends, edge});
}

Capsule rod(double radius, double half_length = 0.5) {
  return {{0, 0, -half_length}, {0, 0, half_length}, radius, radius};
}

TEST_CASE("a sheet falls on a rod that is thin beside its cells, stays on it, and weighs on it" *
          doctest::test_suite("long")) {
  for_each_setting([](const Setting& setting) {
    for (const double radius : {1e-3, 2e-3}) {
      CAPTURE(radius);
      const SceneDescription scene = scene_of(sheet_of(setting, 13, 0.03));
      Cloth cloth = cloth_of(scene, small_steps());
      const auto id =
          add(cloth, {.shape = shape_of(rod(radius)), .thickness = kThickness, .friction = 0.5});
      const double seconds = 4;
      double load = 0;
      const int frames = static_cast<int>(seconds * setting.rate);
      for (int frame = 0; frame < frames; ++frame) {
        CAPTURE(frame);
        const StepReport report = step(cloth, 1.0 / setting.rate);
        CHECK(report.intersecting == 0);
        if (frame % std::max(1, setting.rate / 30) == 0)
          CHECK(crossings(cloth, scene, {{0, 0, -0.5}, {0, 0, 0.5}}) == 0);
        if (frame >= frames / 2)
          load -= cloth.body_load(id).value().force.y / (frames - frames / 2);
      }
      double highest = -1;
      for (const Vec3 x : positions(cloth)) highest = std::max(highest, x.y);
      CHECK(highest > -0.02);
      CHECK(load == doctest::Approx(sum(scene.masses) * kG).epsilon(0.01));
    }
  });
}

/// Pinned along its border.
MeshDescription net_of(const Setting& setting, std::uint32_t size) {
  MeshDescription mesh = sheet_of(setting, size, 0);
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t j = 0; j < size; ++j) {
      if (i == 0 || j == 0 || i + 1 == size || j + 1 == size) mesh.pins.push_back(i * size + j);
    }
  }
  for (Vec3& v : mesh.positions) v = {0.97 * v.x, 0, 0.97 * v.z};
  return mesh;
}

TEST_CASE("a rod that is pushed into a net takes it along, lengthwise and end first") {
  for_each_setting([](const Setting& setting) {
    for (const double radius : {1e-3, 2e-3}) {
      for (const bool is_upright : {false, true}) {
        CAPTURE(radius);
        CAPTURE(is_upright);
        MeshDescription mesh = net_of(setting, 9);
        SceneDescription scene = scene_of(mesh);
        Cloth cloth = cloth_of(scene, small_steps());
        Capsule shape = rod(radius, 0.03);
        if (is_upright) shape = {{0, 0, 0}, {0, 0.2, 0}, radius, radius};
        const double x = 0.011, z = 0.007;
        const auto id = add(cloth, {.shape = shape_of(shape),
                                    .pose = {.position = {x, 0.01, z}},
                                    .thickness = kThickness});
        const int frames = setting.rate / 5;
        for (int frame = 1; frame <= frames; ++frame) {
          CAPTURE(frame);
          const double y = 0.01 - 0.025 * frame / frames;
          REQUIRE(cloth.move_body(id, {.position = {x, y, z}}));
          const StepReport report = step(cloth, 1.0 / setting.rate);
          CHECK(report.intersecting == 0);
          const Vec3 at{x, y, z};
          CHECK(crossings(cloth, scene, {shape.a + at, shape.b + at}) == 0);
        }
        CHECK(cloth.body_load(id).value().force.y > 0);
      }
    }
  });
}

TEST_CASE("a rod that is thrown across a hanging sheet takes it along") {
  for_each_setting([](const Setting& setting) {
    for (const double speed : {1.0, 5.0, 15.0}) {
      CAPTURE(speed);
      MeshDescription mesh = sheet_of(setting, 13, 0, 0);
      for (Vec3& v : mesh.positions) v = {0, v.x, v.z};
      for (std::uint32_t j = 0; j < 13; ++j) mesh.pins.push_back(12 * 13 + j);
      const SceneDescription scene = scene_of(mesh);
      Cloth cloth = cloth_of(scene, small_steps());
      const Capsule shape = rod(2e-3, 0.3);
      Pose pose{.position = {-0.02, -0.07, 0}, .rotation = turn({1, 0, 0}, 0.1)};
      const auto id = add(cloth, {.shape = shape_of(shape), .pose = pose, .thickness = kThickness});
      while (pose.position.x < 0.1) {
        pose.position.x += speed / setting.rate;
        REQUIRE(cloth.move_body(id, pose));
        const StepReport report = step(cloth, 1.0 / setting.rate);
        CHECK(report.intersecting == 0);
        const std::vector<Vec3> ends = placed({shape.a, shape.b}, pose);
        CHECK(crossings(cloth, scene, {ends[0], ends[1]}) == 0);
      }
    }
  });
}

/// m/s^2, in the mean, of a sheet that lies on rods along x while gravity is turned by an angle.
double acceleration(const Setting& setting, double angle, double friction, double seconds) {
  SceneDescription scene = scene_of(sheet_of(setting, 9, 3e-3 + 1e-5));
  scene.damping.motion = 0;
  scene.air = {};
  scene.friction = friction;
  scene.gravity = {kG * std::sin(angle), -kG * std::cos(angle), 0};
  Cloth cloth = cloth_of(scene, small_steps());
  for (int i = -8; i <= 8; ++i) {
    add(cloth, {.shape = shape_of(Capsule{{-1, 0, 0.017 * i}, {3, 0, 0.017 * i}, 2e-3, 2e-3}),
                .thickness = kThickness,
                .friction = friction});
  }
  const std::vector<Vec3> start = positions(cloth);
  run(cloth, 1.0 / setting.rate, static_cast<int>(seconds * setting.rate));
  double way = 0;
  for (std::uint32_t i = 0; i < start.size(); ++i) {
    way += (cloth.position(i).x - start[i].x) / static_cast<double>(start.size());
    CHECK(cloth.position(i).y > -0.012);
  }
  return 2 * way / (seconds * seconds);
}

TEST_CASE("a sheet on thin rods rests below the angle of friction, and slides by its law above" *
          doctest::test_suite("long")) {
  constexpr double kDegree = std::numbers::pi / 180;
  for_each_setting([](const Setting& setting) {
    CHECK(std::abs(acceleration(setting, 14 * kDegree, 0.3, 0.5)) < 0.01);
    const double angle = 25 * kDegree;
    for (const double friction : {0.0, 0.3}) {
      CAPTURE(friction);
      const double a = kG * (std::sin(angle) - friction * std::cos(angle));
      CHECK(acceleration(setting, angle, friction, 0.5) == doctest::Approx(a).epsilon(0.02));
    }
  });
}

TEST_CASE("thin rods that spin take a sheet along at the speed of their surface" *
          doctest::test_suite("long")) {
  for_each_setting([](const Setting& setting) {
    constexpr double kRadius = 2e-3, kSpin = 50;
    SceneDescription scene = scene_of(sheet_of(setting, 7, kRadius + kThickness));
    scene.damping.motion = 0;
    scene.air = {};
    Cloth cloth = cloth_of(scene, small_steps());
    std::vector<std::uint32_t> ids;
    for (int i = -9; i <= 9; ++i)
      ids.push_back(add(cloth, {.shape = shape_of(rod(kRadius)),
                                .pose = {.position = {0.015 * i, 0, 0}},
                                .thickness = kThickness,
                                .friction = 0.5}));
    for (int frame = 1; frame <= setting.rate; ++frame) {
      for (std::size_t i = 0; i < ids.size(); ++i) {
        REQUIRE(
            cloth.move_body(ids[i], {.position = {0.015 * (static_cast<double>(i) - 9), 0, 0},
                                     .rotation = turn({0, 0, 1}, -kSpin * frame / setting.rate)}));
      }
      step(cloth, 1.0 / setting.rate);
    }
    const Vec3 p = momentum(scene.masses, velocities(cloth));
    CHECK(p.x / sum(scene.masses) == doctest::Approx(kRadius * kSpin).epsilon(0.05));
  });
}

/// Threads along both, that meet at the particles of a net.
SceneDescription threads_of_net(std::uint32_t size, double mass) {
  SceneDescription scene;
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * size + j; };
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t j = 0; j < size; ++j) {
      scene.positions.push_back(
          {0.97 * kCell * (i - 0.5 * (size - 1)), 0, 0.97 * kCell * (j - 0.5 * (size - 1))});
      scene.masses.push_back(mass);
      if (i == 0 || j == 0 || i + 1 == size || j + 1 == size) scene.fixed.push_back(at(i, j));
      if (i > 0) scene.constraints.push_back({at(i - 1, j), at(i, j), kCell});
      if (j > 0) scene.constraints.push_back({at(i, j - 1), at(i, j), kCell});
    }
  }
  scene.damping.motion = 2;
  scene.gravity = {};
  return scene;
}

TEST_CASE("a ball that is thin beside the cells of a net is borne by it, and pulls it down") {
  for_each_setting([](const Setting& setting) {
    for (const double radius : {3e-3, 6e-3}) {
      for (const Vec3 at : {Vec3{0.011, 0, 0.007}, Vec3{0.0129, 0, 0.0128}, Vec3{0, 0, 0}}) {
        CAPTURE(radius);
        CAPTURE(at.x);
        const SceneDescription scene = scene_of(net_of(setting, 9));
        Cloth cloth = cloth_of(scene, small_steps());
        const auto id = add(cloth, {.shape = shape_of(Ball{.radius = radius}),
                                    .pose = {.position = {at.x, 0.012, at.z}},
                                    .thickness = kThickness});
        const int frames = setting.rate / 5;
        double deepest = 0;
        for (int frame = 1; frame <= frames; ++frame) {
          CAPTURE(frame);
          const Vec3 centre{at.x, 0.012 - 0.03 * frame / frames, at.z};
          REQUIRE(cloth.move_body(id, {.position = centre}));
          const StepReport report = step(cloth, 1.0 / setting.rate);
          CHECK(report.intersecting == 0);
          // A line up from the centre, on which there is no cloth.
          CHECK(crossings(cloth, scene, {centre, centre + Vec3{0, 0.1, 0}}) == 0);
          if (report.status == Status::converged)
            deepest = std::max(deepest, report.max_penetration);
        }
        CHECK(deepest < 1e-4);
        CHECK(cloth.body_load(id).value().force.y > 0);
      }
    }
  });
}

TEST_CASE("a ball takes threads along that it fits between the ends of") {
  for (const int rate : kRates) {
    for (const double mass : {1e-4, 1e-3}) {
      CAPTURE(rate);
      CAPTURE(mass);
      const SceneDescription scene = threads_of_net(7, mass);
      Cloth cloth = cloth_of(scene, small_steps());
      const auto id = add(cloth, {.shape = shape_of(Ball{.radius = 3e-3}),
                                  .pose = {.position = {0.0002, 0.012, 0.011}},
                                  .thickness = kThickness});
      const int frames = rate / 5;
      for (int frame = 1; frame <= frames; ++frame) {
        REQUIRE(cloth.move_body(id, {.position = {0.0002, 0.012 - 0.022 * frame / frames, 0.011}}));
        step(cloth, 1.0 / rate);
      }
      CHECK(cloth.body_load(id).value().force.y > 0);
      double lowest = 1;
      for (const Vec3 x : positions(cloth)) lowest = std::min(lowest, x.y);
      CHECK(lowest < -0.0135);
    }
  }
}

TEST_CASE("blades and tapered capsules do not pass between rows of particles") {
  for_each_setting([](const Setting& setting) {
    const Capsule tapered{{0, 0, -0.05}, {0, 0, 0.05}, 4e-3, 2e-3};
    for (const bool is_blade : {false, true}) {
      CAPTURE(is_blade);
      const SceneDescription scene = scene_of(net_of(setting, 9));
      Cloth cloth = cloth_of(scene, small_steps());
      const auto shape = is_blade ? shape_of(box({2e-3, 0.04, 0.1})) : shape_of(tapered);
      const double above = is_blade ? 0.025 : 0.009;
      const auto id =
          add(cloth,
              {.shape = shape, .pose = {.position = {0.003, above, 0}}, .thickness = kThickness});
      const int frames = setting.rate / 5;
      for (int frame = 1; frame <= frames; ++frame) {
        CAPTURE(frame);
        const double y = above - 0.025 * frame / frames;
        REQUIRE(cloth.move_body(id, {.position = {0.003, y, 0}}));
        const StepReport report = step(cloth, 1.0 / setting.rate);
        CHECK(report.intersecting == 0);
        const double low = is_blade ? y - 0.0195 : y;
        CHECK(crossings(cloth, scene, {{0.003, low, -0.049}, {0.003, low, 0.049}}) == 0);
      }
      CHECK(cloth.body_load(id).value().force.y > 0);
    }
  });
}

TEST_CASE("cloth lies on a thin tapered capsule as on its closed form") {
  const Capsule shape{{0, 0, -0.1}, {0, 0, 0.1}, 5e-3, 2e-3};
  const Setting setting{60, "cotton", Cut::none};
  const SceneDescription scene = scene_of(sheet_of(setting, 9, 0.012));
  Cloth cloth = cloth_of(scene, small_steps());
  add(cloth, {.shape = shape_of(shape), .thickness = kThickness, .friction = 1});
  run(cloth, 1.0 / 60, 60);
  const std::vector<BodyContact> contacts = cloth.body_contacts();
  REQUIRE(!contacts.empty());
  const double lean = 0.003 / 0.2;
  for (const BodyContact& contact : contacts) {
    if (std::abs(contact.point.z) > 0.09) continue;
    const double across = std::hypot(contact.point.x, contact.point.y);
    const double radius = (3.5e-3 - lean * contact.point.z) / std::sqrt(1 - lean * lean);
    CHECK(across == doctest::Approx(radius).epsilon(0.02));
  }
}

TEST_CASE("thin bodies come to the same bits by threads, AVX2 and AVX-512, and saved states") {
  const Setting setting{60, "cotton", Cut::first};
  const SceneDescription scene = scene_of(sheet_of(setting, 13, 0.03));
  std::vector<std::uint64_t> hashes;
  for (const Isa isa : {Isa::avx2, Isa::avx512}) {
    if (!simd::supported(isa == Isa::avx2 ? simd::Isa::avx2 : simd::Isa::avx512)) continue;
    const Settings settings{.solver = Solver::small_steps, .isa = isa, .threads = 1};
    Cloth cloth = cloth_of(scene, settings);
    for (const ShapeDescription& shape :
         {ShapeDescription(rod(2e-3)), ShapeDescription(Ball{{0.05, 0, 0}, 4e-3}),
          ShapeDescription(Capsule{{-0.1, 0, 0}, {0.1, 0, 0.02}, 3e-3, 2e-3}),
          ShapeDescription(box({1e-3, 0.02, 0.02}))})
      add(cloth, {.shape = shape_of(shape), .thickness = kThickness});
    run(cloth, 1.0 / 60, 12);
    Cloth loaded = cloth_of(scene, settings);
    REQUIRE(loaded.load_state(cloth.save_state()));
    run(cloth, 1.0 / 60, 12);
    run(loaded, 1.0 / 60, 12);
    CHECK(loaded.state_hash() == cloth.state_hash());
    CHECK(!cloth.body_contacts().empty());
    hashes.push_back(cloth.state_hash());
  }
  for (const std::uint64_t hash : hashes) CHECK(hash == hashes[0]);
}

/// A sheet falls on a ball beside its particles.
Cloth on_ball(SceneDescription scene, double radius) {
  scene.air = {};
  Cloth cloth = cloth_of(scene, small_steps());
  const auto id = add(cloth, {.shape = shape_of(Ball{.radius = radius}),
                              .pose = {.position = {0.012, 0, 0.006}},
                              .thickness = kThickness});
  double load = 0;
  for (int frame = 0; frame < 4; ++frame) {
    step(cloth, 1.0 / 60);
    load -= cloth.body_load(id).value().force.y;
  }
  CHECK((load == 0) == (scene.constraints.empty() && radius < 0.02));
  return cloth;
}

TEST_CASE("particles alone touch bodies that are wider than gaps, and let thin ones through") {
  for (const double radius : {0.01, 0.03}) {
    CAPTURE(radius);
    SceneDescription scene = scene_of(sheet_of({60, "cotton", Cut::first}, 5, radius + 2e-3, 0));
    const std::uint64_t with_surface = on_ball(scene, radius).state_hash();
    scene.surface.clear();
    if (radius == 0.03) {
      CHECK(on_ball(scene, radius).state_hash() == with_surface);
      continue;
    }
    scene.constraints.clear();
    scene.bending.clear();
    on_ball(scene, radius);
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_thin_bodies
