/// Chains, trees and bridges, solved together: the system against its law, and motions against
/// closed forms.
#include "engine/solvers/small_steps/linkage.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "tests/support/clothes.h"
#include "tests/support/random.h"

namespace weft::test::engine_solvers_small_steps_linkage {
namespace {

using kernels::Vector;

struct Shape {
  SceneDescription scene;
  void add(Vec3 position, double mass, std::uint32_t to, ConstraintKind kind) {
    const auto particle = static_cast<std::uint32_t>(scene.positions.size());
    const Vec3 from = scene.positions.at(to);
    const double dx = position.x - from.x, dy = position.y - from.y, dz = position.z - from.z;
    scene.positions.push_back(position);
    scene.masses.push_back(mass);
    scene.constraints.push_back({to, particle, std::sqrt(dx * dx + dy * dy + dz * dz), kind});
  }
};

/// One metre from a fixed particle at the origin, `angle` from the vertical; 1 kg in all, and a
/// particle of `end` kg in place of the last.
SceneDescription pendulum(int links, double end, ConstraintKind kind, double angle) {
  Shape shape;
  shape.scene.positions = {{0, 0, 0}};
  shape.scene.masses = {1};
  shape.scene.fixed = {0};
  for (int i = 1; i <= links; ++i) {
    const double l = static_cast<double>(i) / links;
    shape.add({l * std::sin(angle), -l * std::cos(angle), 0}, i == links ? end : 1.0 / links,
              static_cast<std::uint32_t>(i - 1), kind);
  }
  return shape.scene;
}

/// Limbs at random particles, with masses over four decades; every third limb is a bar.
SceneDescription random_tree(Random& random, int limbs) {
  Shape shape;
  shape.scene.positions = {{0, 0, 0}};
  shape.scene.masses = {1};
  shape.scene.fixed = {0};
  std::vector<int> degree{0};
  for (int i = 0; i < limbs; ++i) {
    std::uint32_t to = 0;
    do to = random.below(static_cast<std::uint32_t>(degree.size()));
    while (degree[to] >= 5);
    const Vec3 from = shape.scene.positions[to];
    shape.add(
        {from.x + random.between(-0.1, 0.1), from.y - 0.05, from.z + random.between(-0.1, 0.1)},
        std::pow(10, random.between(-2, 2)), to,
        i % 3 == 0 ? ConstraintKind::distance : ConstraintKind::rope);
    ++degree[to];
    degree.push_back(1);
  }
  return shape.scene;
}

/// What a sweep sees and moves.
struct Places {
  kernels::Vectors& x;
  Vector difference(std::uint32_t a, std::uint32_t b) const { return x[a] - x[b]; }
  void move(std::uint32_t slot, Vector by) const { x.view().add(slot, by); }
};

double half_square_beyond(const Model& model, const kernels::Vectors& x, std::size_t c) {
  const ConstraintStore& s = model.constraints;
  const Vector d = x[s.a[c]] - x[s.b[c]];
  return 0.5 * (dot(d, d) - s.rest_length[c] * s.rest_length[c]);
}

TEST_CASE("of a linkage all links, and no other model's") {
  Random random(1);
  for (const int limbs : {2, 7, 200}) {
    const auto model = build_model(random_tree(random, limbs)).value();
    CHECK(is_linkage(*model));
    CHECK(model->small_steps().linkage.row_of_link.size() == model->constraints.size());
    CHECK_FALSE(model->small_steps().has_single_constraints());
  }
  CHECK_FALSE(is_linkage(*build_model(drifting_sheet(8, 3)).value()));
  CHECK(build_model(drifting_sheet(8, 3)).value()->small_steps().linkage.empty());
}

TEST_CASE(
    "a sweep solves the linear laws of all links: bars have no error, ropes pull or are slack") {
  Random random(2);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const auto model = build_model(random_tree(random, 60)).value();
    const ConstraintStore& s = model->constraints;
    kernels::Vectors x = model->initial_position;
    constexpr double kSmall = 1e-6;  // the square of a move is beyond what is compared
    for (std::uint32_t slot = 0; slot < model->slots(); ++slot) {
      if (model->inverse_mass[slot] > 0)
        x.view().add(slot, kSmall * Vector{random.between(-1, 1), random.between(-1, 1),
                                           random.between(-1, 1)});
    }
    const kernels::Vectors before = x;
    Linkage linkage(*model, model->small_steps().linkage);
    linkage.sweep(Places{x}, {1, 0}, 1e-3, false);
    double most = 0, worst_bar = 0, longest_rope = 0, slack_and_pulled = 0;
    for (std::size_t c = 0; c < s.size(); ++c) {
      const double left = half_square_beyond(*model, x, c) / s.rest_length[c];
      const bool is_rope = c >= s.bilateral;
      most = std::max(most, std::abs(half_square_beyond(*model, before, c)) / s.rest_length[c]);
      if (is_rope)
        longest_rope = std::max(longest_rope, left);
      else
        worst_bar = std::max(worst_bar, std::abs(left));
      if (is_rope && left < -2e-9)
        slack_and_pulled = std::max(slack_and_pulled, linkage.impulse(c));
    }
    CHECK(most > 1e-7);
    CHECK(worst_bar < 2e-9);
    CHECK(longest_rope < 2e-9);
    CHECK(slack_and_pulled == 0);
    for (std::size_t c = s.bilateral; c < s.size(); ++c) CHECK(linkage.impulse(c) >= 0);
  }
}

/// The largest displacement of the end, to the side, in each half of a swing.
std::vector<double> swings(Cloth& cloth, double dt, int steps) {
  std::vector<double> largest;
  double side = 0, now = 0;
  const auto end = static_cast<std::uint32_t>(cloth.particle_count() - 1);
  for (int i = 0; i < steps; ++i) {
    step(cloth, dt);
    const double x = cloth.position(end).x;
    if (x * side < 0) {
      largest.push_back(now);
      now = 0;
    }
    side = x;
    now = std::max(now, std::abs(x));
  }
  return largest;
}

TEST_CASE("a chain swings on, whatever hangs at its end") {
  const double angle = 0.3;
  for (const ConstraintKind kind : {ConstraintKind::distance, ConstraintKind::rope}) {
    for (const double end : {0.01, 3.0, 1000.0}) {
      for (const int links : {5, 40}) {
        CAPTURE(end);
        CAPTURE(links);
        Cloth cloth = cloth_of(pendulum(links, end, kind, angle), Settings{});
        CHECK(cloth.settings().solver == Solver::small_steps);
        const std::vector<double> each = swings(cloth, 1.0 / 60, 1200);
        REQUIRE(each.size() > 18);
        const double last = std::max(each[each.size() - 1], each[each.size() - 2]);
        CHECK(last > (end < 1 ? 0.9 : 0.99) * std::sin(angle));  // a light end whips about
        if (end > 1) CHECK(last < 1.01 * std::sin(angle));
      }
    }
  }
}

TEST_CASE("a chain follows its pin, however far that jumps, and comes to hang below it") {
  for (const ConstraintKind kind : {ConstraintKind::distance, ConstraintKind::rope}) {
    SceneDescription scene = pendulum(20, 1, kind, 0);
    scene.damping.motion = 2;
    Cloth cloth = cloth_of(scene, Settings{});
    Vec3 pin{0, 0, 0};
    for (int i = 0; i < 40; ++i) {
      pin = {0.1 * i, 0.3 * (i % 2), 0};  // m a frame
      REQUIRE(cloth.move_fixed(0, pin));
      step(cloth, 1.0 / 60);
    }
    for (int i = 0; i < 600; ++i) {
      const StepReport report = step(cloth, 1.0 / 60);
      CHECK(report.status == Status::converged);
      CHECK(report.max_strain <= 0.01);
    }
    const Vec3 end = cloth.position(20);
    CHECK(std::hypot(end.x - pin.x, end.y - (pin.y - 1), end.z) < 2e-3);
  }
}

/// Two rails, one of bars and one of ropes, and rungs of bars: a third of the links close a loop.
TEST_CASE("a ladder that hangs from one particle falls and swings within tolerance") {
  Shape shape;
  shape.scene.positions = {{0, 0, 0}};
  shape.scene.masses = {1};
  shape.scene.fixed = {0};
  for (std::uint32_t i = 1; i <= 30; ++i) {
    const double x = 0.05 * ((i + 1) / 2), y = i % 2 == 0 ? 0.05 : 0;
    shape.add({x, y, 0}, 0.02, i < 3 ? 0 : i - 2,
              i % 2 == 0 ? ConstraintKind::rope : ConstraintKind::distance);
    if (i % 2 == 0) shape.scene.constraints.push_back({i - 1, i, 0.05, ConstraintKind::distance});
  }
  Cloth cloth = cloth_of(shape.scene, Settings{});
  REQUIRE(is_linkage(*cloth.model()));
  const double start = cloth.energy().total();
  for (int i = 0; i < 300; ++i) {
    const StepReport report = step(cloth, 1.0 / 60);
    CHECK(report.status == Status::converged);
    CHECK(report.max_strain <= 0.01);
    CHECK(cloth.energy().total() <= start + 1e-3);
  }
}

TEST_CASE("what hangs on a chain is still") {
  for (const ConstraintKind kind : {ConstraintKind::distance, ConstraintKind::rope}) {
    for (const int links : {10, 200}) {
      Cloth cloth = cloth_of(pendulum(links, 100, kind, 0), Settings{});
      for (int i = 0; i < 60; ++i) step(cloth, 1.0 / 60);
      for (int i = 0; i < 60; ++i) {
        const double before = cloth.position(static_cast<std::uint32_t>(links)).y;
        step(cloth, 1.0 / 60);
        CHECK(std::abs(cloth.position(static_cast<std::uint32_t>(links)).y - before) < 1e-6);
        CHECK(std::abs(cloth.velocity(static_cast<std::uint32_t>(links)).y) < 1e-3);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_linkage
