/// Anticipated errors (paper 4.2) against errors recomputed from positions, where the printed
/// formula would be wrong: unequal masses, constraints that meet head to head and tail to head,
/// fixed ends.
#include "kernels/reference/anticipated.h"
#include "engine/solvers/sweeps/reference_layout.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "tests/support/clothes.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::kernels_reference_anticipated {
namespace {

using reference::Relaxation;

/// 40 particles of 0.01 to 100 kg, four fixed, 100 bars and ropes between random pairs in random
/// orientation, 30 of them at a hub.
SceneDescription tangle(std::uint32_t seed) {
  Random random(seed);
  SceneDescription scene;
  for (int i = 0; i < 40; ++i) {
    scene.positions.push_back(random.in_box(1));
    scene.masses.push_back(std::pow(10, random.between(-2, 2)));
  }
  scene.fixed = {3, 11, 19, 27};
  for (std::uint32_t k = 0; k < 100; ++k) {
    // Steps of 1, 2, 3 through the particles repeat no pair; the last 30 all start at particle 0.
    std::uint32_t a = k < 70 ? k % 35 : 0;
    std::uint32_t b = k < 70 ? a + 1 + k / 35 : k - 67 + 6;
    if (random.below(2) == 1) std::swap(a, b);
    const auto kind = random.below(5) == 0 ? ConstraintKind::rope : ConstraintKind::distance;
    scene.constraints.push_back({a, b, random.between(0.2, 1.5), kind});
  }
  return scene;
}

/// The position problem of a model at its initial positions, and the memory to solve it in.
struct Problem {
  std::shared_ptr<const Model> model;
  kernels::Vectors x, n, hub_motion;
  std::vector<double> tolerance, impulse, error, pending, row_product;
  std::vector<reference::Flag> row_ready, changed, moved;

  Problem(const SceneDescription& scene, double strain)
      : model(model_of(scene)),
        x(model->initial_position),
        n(model->constraints.size()),
        hub_motion(model->slots()),
        impulse(n.size()),
        error(n.size()),
        pending(n.size()),
        row_product(model->reference().rows.items.size()),
        row_ready(n.size()),
        changed(topology().blocks),
        moved(model->slots()) {
    for (const double rest : model->constraints.rest_length) tolerance.push_back(strain * rest);
  }

  reference::Topology topology() const { return model->reference().topology(); }

  Relaxation view() {
    const ConstraintStore& s = model->constraints;
    Relaxation r;
    r.particles = model->slots();
    r.plain = s.plain;
    r.bilateral = s.bilateral;
    r.pulling = r.count = s.size();
    r.a = s.a.data();
    r.b = s.b.data();
    r.target = s.rest_length.data();
    r.tolerance = tolerance.data();
    r.effective_mass = s.effective_mass.data();
    r.inverse_mass = model->inverse_mass.data();
    r.x = x.view();
    r.n = n.view();
    r.impulse = impulse.data();
    return r;
  }

  reference::Workspace workspace() {
    reference::Workspace w;
    w.error = error.data();
    w.pending = pending.data();
    w.row_product = row_product.data();
    w.row_ready = row_ready.data();
    w.hub_motion = hub_motion.view();
    w.hubs = model->hubs;
    w.changed = changed.data();
    w.moved = moved.data();
    return w;
  }
};

/// What anticipation says of constraint c: its own error and what the hubs at its ends moved since.
double anticipated_error(const Relaxation& r, const reference::Topology& t,
                         const reference::Workspace& w, std::size_t c) {
  double e = w.error[c];
  if (c < r.plain) return e;
  if (t.hub[r.a[c]]) e += dot(r.n[c], w.hub_motion[r.a[c]]);
  if (t.hub[r.b[c]]) e -= dot(r.n[c], w.hub_motion[r.b[c]]);
  return e;
}

struct Run {
  double strain = 0;  // tolerated
  double limit = reference::kUnlimited;
  bool skip = false;
  int fixed_iterations = 0;
};

void check_anticipation(const Run& run, std::uint32_t seed) {
  Problem problem(tangle(seed), run.strain);
  Relaxation r = problem.view();
  r.limit = run.limit;
  REQUIRE(r.plain > 20);
  REQUIRE(r.bilateral - r.plain > 10);
  REQUIRE(r.count - r.bilateral > 10);
  const reference::Topology topology = problem.topology();
  const reference::Workspace workspace = problem.workspace();
  const reference::Method method{
      .anticipate = true,
      .skip = run.skip,
      .frozen_directions = true,
      .limits = {.fixed_iterations = run.fixed_iterations, .max_iterations = 4}};
  const auto result = relax_positions(r, topology, {}, workspace, method);
  CHECK(result.direction_updates == 1);
  CHECK(result.corrections > 50);
  for (std::size_t c = 0; c < r.count; ++c) {
    CAPTURE(c);
    REQUIRE(std::abs(anticipated_error(r, topology, workspace, c) - error(r, c)) < 1e-12);
  }
}

TEST_CASE("anticipated errors are the true ones along the directions, for unequal masses") {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    check_anticipation({.fixed_iterations = 4}, seed);
    check_anticipation({.strain = 1e-9, .skip = true}, seed);
    check_anticipation({.limit = 0.01, .fixed_iterations = 4}, seed);
  }
}

// Three in a row, 0 - 1 - 2 along x, of 1, 4 and 2 kg, where the first bar is 0.2 m too long and
// the second, at an angle of 60 degrees, is at rest. Correcting the first moves particle 1 towards
// 0 by 0.2 (1/4) / (1 + 1/4) = 0.04 m, which makes the second 0.04 cos(60) = 0.02 m too long.
TEST_CASE("one correction, worked by hand") {
  for (const bool swapped : {false, true}) {
    CAPTURE(swapped);
    SceneDescription scene;
    scene.positions = {{0, 0, 0}, {1.2, 0, 0}, {1.7, std::sqrt(0.75), 0}};
    scene.masses = {1, 4, 2};
    scene.constraints = {{0, 1, 1.0}, {1, 2, 1.0}};
    if (swapped) std::swap(scene.constraints[1].a, scene.constraints[1].b);
    Problem problem(scene, 0.1);
    const Relaxation r = problem.view();
    const reference::Workspace workspace = problem.workspace();
    const auto result = relax_positions(
        r, problem.topology(), {}, workspace,
        {.anticipate = true, .frozen_directions = true, .limits = {.max_iterations = 1}});
    CHECK(result.corrections == 1);
    // Constraints and particles stand in the order of the model.
    const ConstraintStore& store = problem.model->constraints;
    for (std::size_t c = 0; c < 2; ++c) {
      const double left = store.described[c] == 0 ? 0 : 0.02;
      CHECK(workspace.error[c] == doctest::Approx(left).epsilon(1e-12));
    }
    const auto& slot_of = problem.model->ordering.slot_of;
    CHECK(problem.x.x[slot_of[1]] == doctest::Approx(1.16).epsilon(1e-14));
    CHECK(problem.x.x[slot_of[0]] == doctest::Approx(0.16).epsilon(1e-14));
  }
}

}  // namespace
}  // namespace weft::test::kernels_reference_anticipated
