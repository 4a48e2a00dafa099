/// What held particles exclude is told from the first step on, and so is a seam that is late.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_held_apart {
namespace {

/// Two particles that are fixed 1 m apart, and one that hangs on the second by 0.3 m.
SceneDescription held() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, -0.3, 0}};
  scene.masses = {0.1, 0.1, 0.1};
  scene.fixed = {0, 1};
  scene.constraints = {{1, 2, 0.3}};
  return scene;
}

TEST_CASE("a length that two pins exclude is told, with its number, until they are moved") {
  for (const int rate : {30, 60, 240}) {
    for (const Solver solver : {Solver::automatic, Solver::yarn, Solver::gauss_seidel}) {
      for (const auto& [constraint, wanted] :
           {std::pair{Constraint{0, 1, 0.5}, 0.5},
            std::pair{Constraint{0, 1, 0.5, ConstraintKind::rope}, 0.5},
            std::pair{Constraint{0, 1, 1.5}, 1.5}}) {
        CAPTURE(rate);
        CAPTURE(name(solver));
        CAPTURE(wanted);
        SceneDescription scene = held();
        scene.constraints.push_back(constraint);
        Cloth cloth = cloth_of(scene, {.solver = solver, .threads = 1});
        for (int frame = 0; frame < 3; ++frame) {
          const StepReport report = step(cloth, 1.0 / rate);
          CHECK(report.status == Status::infeasible);
          CHECK(report.held_apart == 1);
          CHECK(report.worst_held == 1);
          CHECK(report.max_strain <= 0.01);
        }
        REQUIRE(cloth.move_fixed(0, {1 - wanted, 0, 0}));
        const StepReport report = step(cloth, 1.0 / rate);
        CHECK(report.status == Status::converged);
        CHECK(report.held_apart == 0);
        CHECK(report.worst_held == kNoIndex);
      }
    }
  }
}

TEST_CASE("a spring, and a rope that is slack, bear what pins do") {
  for (const Constraint& constraint :
       {Constraint{0, 1, 0.5, ConstraintKind::distance, 1e-3},
        Constraint{0, 1, 1.5, ConstraintKind::rope}, Constraint{0, 1, 1.005}}) {
    SceneDescription scene = held();
    scene.constraints.push_back(constraint);
    Cloth cloth = cloth_of(scene, {.threads = 1});
    const StepReport report = step(cloth, 1.0 / 60);
    CHECK(report.status == Status::converged);
    CHECK(report.held_apart == 0);
  }
}

TEST_CASE("anchors without a limit to move within hold as pins do") {
  SceneDescription scene = held();
  scene.fixed = {0};
  scene.anchors = {{.particle = 1, .point = {1, 0, 0}}};
  scene.constraints.push_back({0, 1, 0.5});
  Cloth cloth = cloth_of(scene, {.threads = 1});
  const StepReport report = step(cloth, 1.0 / 60);
  CHECK(report.status == Status::infeasible);
  CHECK(report.worst_held == 1);
}

TEST_CASE("a seam between pins is told at once, and misses when its time is over") {
  for (const int rate : {30, 60, 240}) {
    CAPTURE(rate);
    SceneDescription scene = held();
    scene.seams = {{2, 1, 0.5}, {0, 1, 0.5}};
    scene.constraints = {};
    Cloth cloth = cloth_of(scene, {.threads = 1, .sleep = true});
    for (int frame = 1; frame <= 2 * rate; ++frame) {
      CAPTURE(frame);
      const StepReport report = step(cloth, 1.0 / rate);
      CHECK(report.held_apart == 1);
      CHECK(report.worst_seam == 1);
      CHECK(report.worst_held == kNoIndex);
      if (frame == rate / 2) continue;  // rounding tells
      const bool is_late = frame > rate / 2;
      CHECK(report.late_seams == (is_late ? 1 : 0));
      CHECK(report.status == (is_late ? Status::infeasible : Status::converged));
    }
    REQUIRE(cloth.move_fixed(0, {1, 0, 0}));
    const StepReport report = step(cloth, 1.0 / rate);
    CHECK(report.status == Status::converged);
    CHECK(report.open_seams == 0);
    CHECK(report.held_apart == 0);
    CHECK(report.worst_seam == kNoIndex);
  }
}

TEST_CASE("a seam between pins that come together in its time closes without a word") {
  for (const int rate : {30, 60, 240}) {
    SceneDescription scene = held();
    scene.seams = {{0, 1, 0.5}};
    Cloth cloth = cloth_of(scene, {.threads = 1});
    for (int frame = 1; frame <= rate; ++frame) {
      CAPTURE(frame);
      REQUIRE(cloth.move_fixed(0, {std::min(1.0, 2.0 * frame / rate), 0, 0}));
      CHECK(step(cloth, 1.0 / rate).status == Status::converged);
    }
    CHECK(step(cloth, 1.0 / rate).open_seams == 0);
  }
}

TEST_CASE("a seam whose force is too small for its time is late, with its number") {
  for (const int rate : {30, 60, 240}) {
    CAPTURE(rate);
    SceneDescription scene = held();
    scene.gravity = {0, 0, 0};
    scene.constraints = {};
    scene.seams = {{2, 0, 10, 1e-3}, {2, 1, 0.5, 0.1}};  // 0.3 m by 1 m/s^2: 0.77 s
    Cloth cloth = cloth_of(scene, {.threads = 1});
    for (int frame = 1; frame < 0.7 * rate; ++frame) {
      CAPTURE(frame);
      const StepReport report = step(cloth, 1.0 / rate);
      if (frame == rate / 2) continue;  // rounding tells
      const bool is_late = frame > rate / 2;
      CHECK(report.late_seams == (is_late ? 1 : 0));
      CHECK(report.held_apart == 0);
      CHECK(report.status == (is_late ? Status::iteration_limit : Status::converged));
      CHECK(report.worst_seam == (is_late ? 1 : kNoIndex));
    }
  }
}

TEST_CASE("two seams that lead to pins apart from each other do not both close") {
  SceneDescription scene = held();
  scene.constraints = {};
  scene.seams = {{2, 0, 0.2}, {2, 1, 0.2}};
  Cloth cloth = cloth_of(scene, {.threads = 1});
  run(cloth, 1.0 / 60, 12);
  const StepReport report = step(cloth, 1.0 / 60);
  CHECK(report.status != Status::converged);
  CHECK(report.late_seams >= 1);
}

}  // namespace
}  // namespace weft::test::engine_step_held_apart
