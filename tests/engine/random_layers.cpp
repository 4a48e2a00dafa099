/// Sheets drawn by chance that touch each other and themselves, thrown onto a floor and at a ball
/// that moves: what crosses when a step ends is in its report, and what began apart stays apart.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "engine/model/threads.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/layers.h"
#include "tests/support/random_cases.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_random_layers {
namespace {

struct Case {
  std::uint32_t seed = 0;
  SceneDescription scene;
  Settings settings;
  double dt = 1.0 / 60;
  int steps = 0;
  bool has_ball = false;
  Vec3 ball_velocity{};  // m/s
};

/// A flat or wavy sheet. Some begin in each other; none lies exactly in the plane of another.
Sheet random_sheet(Random& random) {
  const std::uint32_t cells = 2 + random.below(6);
  const double cell = random.between(0.01, 0.05), wave = random.below(2) == 0 ? 0 : cell;
  const bool is_level = random.below(3) == 0;
  const Vec3 axis = random.in_box(1);
  const Rotation turned =
      is_level || length(axis) < 0.1 ? Rotation{} : turn((1 / length(axis)) * axis, 2);
  const double x = random.between(-0.1, 0.1), level = 0.05 + 0.05 * random.below(6),
               y = level + random.between(0, 0.01), z = random.between(-0.1, 0.1);
  const Pose pose{.position = {x, y, z}, .rotation = turned};
  return {cells, cells, [=](double u, double v) {
            const Vec3 flat{cell * cells * (u - 0.5), wave * std::sin(9 * u + 4 * v),
                            cell * cells * (v - 0.5)};
            return placed({flat}, pose)[0];
          }};
}

Case random_layers(std::uint32_t seed) {
  Random random(seed);
  Case c;
  c.seed = seed;
  std::vector<Sheet> sheets;
  const std::uint32_t count = 1 + random.below(6);
  for (std::uint32_t i = 0; i < count; ++i) sheets.push_back(random_sheet(random));
  c.scene = scene_of(sheets, random.below(4) == 0 ? 0 : random.between(0, 1));
  if (random.below(2) == 0) c.scene.self_contact.thickness = random.between(1e-4, 2e-3);
  const double speed = random.below(3) == 0 ? 0 : random.between(0, 4);
  std::uint32_t particle = 0;
  for (const Sheet& sheet : sheets) {
    const Vec3 v = random.in_box(speed);
    const std::uint32_t end = particle + (sheet.rows + 1) * (sheet.columns + 1);
    for (; particle < end; ++particle) c.scene.velocities.push_back(v);
  }
  c.settings.solver = Solver::small_steps;
  c.settings.backend = random.below(8) == 0 ? Backend::reference : Backend::simd;
  c.settings.threads = 1;
  c.settings.tolerance = random.below(2) == 0 ? 1e-2 : 1e-3;
  c.dt = 1.0 / (random.below(2) == 0 ? 60 : 30 + 210 * random.between(0, 1));
  c.steps = static_cast<int>(8 + random.below(24));
  c.has_ball = random.below(2) == 0;
  if (random.below(2) == 0) c.ball_velocity = random.in_box(2);
  return c;
}

/// Cords between the sheets, loose or tied to one of their particles or to two.
Case random_threads(std::uint32_t seed) {
  Case c = random_layers(seed);
  Random random(seed + 1000000);
  const auto sheets = static_cast<std::uint32_t>(c.scene.positions.size());
  if (c.scene.velocities.empty()) c.scene.velocities.resize(sheets);
  const std::uint32_t count = 1 + random.below(4);
  const auto add_particle = [&](Vec3 place, Vec3 velocity, double mass) {
    c.scene.positions.push_back(place);
    c.scene.velocities.push_back(velocity);
    c.scene.masses.push_back(mass);
    return static_cast<std::uint32_t>(c.scene.positions.size() - 1);
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t links = 1 + random.below(8);
    const double link = random.between(0.004, 0.06);
    const Vec3 box = random.in_box(1), v = random.in_box(2);
    Vec3 way = random.in_box(1);
    if (length(way) < 0.1) way = {1, 0, 0};
    way = (link / length(way)) * way;
    const bool is_tied = random.below(2) == 0;
    Vec3 place{0.15 * box.x, 0.2 + 0.15 * box.y, 0.15 * box.z};
    std::uint32_t last = is_tied ? random.below(sheets) : add_particle(place, v, 1e-3 * link);
    place = c.scene.positions[last];
    for (std::uint32_t k = 0; k < links; ++k) {
      place = place + way + 0.3 * link * random.in_box(1);
      const std::uint32_t next = add_particle(place, v, 1e-3 * link);
      const double rest = length(place - c.scene.positions[last]);
      const bool is_rope = random.below(4) == 0;
      c.scene.constraints.push_back(
          {last, next, rest, is_rope ? ConstraintKind::rope : ConstraintKind::distance});
      last = next;
    }
  }
  return c;
}

std::string text(const Case& c) {
  std::ostringstream out;
  out << "WEFT_SEED=" << c.seed << " WEFT_CASES=1: " << c.scene.positions.size() << " particles, "
      << name(c.settings.backend) << ", tolerance " << c.settings.tolerance << ", dt " << c.dt
      << ", ball " << c.has_ball;
  return out.str();
}

void check_case(const Case& c) {
  INFO(text(c));
  Cloth cloth = cloth_of(c.scene, c.settings);
  add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
  Pose pose{.position = {0, 0.1, 0}};
  std::uint32_t ball = 0;
  if (c.has_ball) ball = add(cloth, {.shape = shape_of(Ball{.radius = 0.05}), .pose = pose});
  auto features = c.scene.surface;
  for (const auto& [a, b] : threads_of(*model_of(c.scene))) features.push_back({a, b, b});
  int tangled = count_self_crossings({positions(cloth), features});
  for (int k = 0; k < c.steps; ++k) {
    CAPTURE(k);
    if (c.has_ball) {
      pose.position = pose.position + c.dt * c.ball_velocity;
      REQUIRE(cloth.move_body(ball, pose));
    }
    const std::uint64_t hash = cloth.state_hash();
    const StepReport report = step(cloth, c.dt);
    CAPTURE(name(report.status));
    if (!committed(report.status)) {
      CHECK(cloth.state_hash() == hash);
      continue;
    }
    const int now = count_self_crossings({positions(cloth), features});
    if (now > 0) CHECK(report.tangled > 0);
    if (tangled == 0 && report.status == Status::converged) CHECK(report.tangled == 0);
    tangled = report.tangled;
  }
}

TEST_CASE("random layers: what crosses is reported, and what is apart stays apart") {
  for_each_case(100, random_layers, check_case);
}

TEST_CASE("random layers with threads: what crosses is reported, and what is apart stays apart") {
  for_each_case(100, random_threads, check_case);
}

/// Two triangles come apart in the first look at the end of an interval, and cross again before the
/// second one.
TEST_CASE("layers that cross again within a step are reported") {
  check_case(random_layers(300476));
}

}  // namespace
}  // namespace weft::test::engine_random_layers
