/// The yarn solver alone, on what pulls or pushes only: ropes and contacts.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "engine/solvers/yarn/single_constraints.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "engine/solvers/yarn/yarn_solver.h"
#include "tests/support/clothes.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_yarn_yarn_one_sided {
namespace {

constexpr double kTolerance = 0.01, kContactTolerance = 1e-3;

/// A particle, number 0, at `x` and at a speed `v`; what else there is is fixed.
SceneDescription lone_particle(Vec3 x, Vec3 v) {
  SceneDescription scene;
  scene.positions = {x};
  scene.velocities = {v};
  scene.masses = {1};
  return scene;
}

std::uint32_t add_fixed(SceneDescription& scene, Vec3 x) {
  const auto particle = static_cast<std::uint32_t>(scene.positions.size());
  scene.positions.push_back(x);
  scene.velocities.push_back({0, 0, 0});
  scene.masses.push_back(1);
  scene.fixed.push_back(particle);
  return particle;
}

void add_rope(SceneDescription& scene, Vec3 end, double rest) {
  scene.constraints.push_back({0, add_fixed(scene, end), rest, ConstraintKind::rope});
}

void add_sphere(SceneDescription& scene, Vec3 centre, double radius) {
  scene.spheres.push_back(add_fixed(scene, centre));
  scene.radii.assign(scene.positions.size(), 0);
  scene.radii.back() = radius;
}

struct Trial {
  std::shared_ptr<const Model> model;
  kernels::Vectors start, x, v;
  const simd::Table& table = simd::table(simd::best_isa());
  SphereContacts contacts;
  SimdMeasure measure;
  YarnSolver solver;
  Team team;

  Trial(const SceneDescription& scene, double velocity_tolerance)
      : model(model_of(scene)),
        start(model->initial_position),
        x(start),
        v(model->initial_velocity),
        contacts(make_sphere_contacts(*model)),
        measure(*model, table),
        solver(*model,
               {.tolerance = kTolerance,
                .contact_tolerance = kContactTolerance,
                .velocity_tolerance = velocity_tolerance},
               table, measure) {
    find_contacts(*model, table, x.view(), contacts);
  }
  Vec3 correct_velocities(bool exact) {
    (void)solver.correct_velocities({.x = x.view(),
                                     .v = v.view(),
                                     .contacts = contacts,
                                     .exact = exact,
                                     .max_iterations = 1000},
                                    team);
    return of_particle(v);
  }
  /// From where the particle is at the start to `to`, along the directions at the start.
  bool solve_positions(Vec3 to) {
    x.set(model->ordering.slot_of[0], {to.x, to.y, to.z});
    const PositionTask task{.x = x.view(),
                            .start = start.view(),
                            .contacts = contacts,
                            .along_start = true,
                            .max_iterations = 1000};
    return solver.solve_positions(task, team).converged;
  }
  Vec3 of_particle(kernels::Vectors& vectors) const {
    const kernels::Vector at = vectors[model->ordering.slot_of[0]];
    return {at.x, at.y, at.z};
  }
};

TEST_CASE("a rope holds speeds if it is taut but for its tolerance") {
  for (const double tolerances : {0.5, 2.0}) {
    CAPTURE(tolerances);
    SceneDescription scene = lone_particle({2 * (1 - tolerances * kTolerance), 0, 0}, {1, 1, 0});
    add_rope(scene, {0, 0, 0}, 2);
    Trial trial(scene, 0.01);
    const double held = tolerances < 1 ? 0 : 1;
    CHECK(distance(trial.correct_velocities(false), {held, 1, 0}) < 0.01);
  }
}

TEST_CASE("a sphere holds speeds if it is touched but for the tolerance of contacts") {
  for (const double tolerances : {0.5, 2.0}) {
    CAPTURE(tolerances);
    SceneDescription scene =
        lone_particle({0.5 + tolerances * kContactTolerance, 0, 0}, {-1, 1, 0});
    add_sphere(scene, {0, 0, 0}, 0.5);
    Trial trial(scene, 0.01);
    REQUIRE(trial.contacts.count() == 1);
    const double held = tolerances < 1 ? 0 : -1;
    CHECK(distance(trial.correct_velocities(false), {held, 1, 0}) < 0.01);
  }
}

// Exactly solved for, the second of two ropes in nearly the same direction would push and is left
// out, and the first pulls as if it had not been: five times as much as it should.
TEST_CASE("ropes that depend on each other bring no energy into velocities") {
  const double cosine = 0.9, sine = std::sqrt(1 - cosine * cosine);
  SceneDescription scene = lone_particle({0, 0, 0}, {0, 0, 0});
  add_rope(scene, {-1, 0, 0}, 1);
  add_rope(scene, {-cosine, -sine, 0}, 1);
  scene.velocities[0] = {0.05, (0.001 - 0.05 * cosine) / sine, 0};
  Trial trial(scene, 1);
  const double before = length(scene.velocities[0]);
  CHECK(length(trial.correct_velocities(true)) <= before * (1 + 1e-6));
}

/// Ropes and contacts of a lone particle without the yarns, in floats.
struct Others {
  explicit Others(const SceneDescription& scene)
      : trial(scene, 0.01),
        places(trial.model->yarns().places),
        base(places.floats),
        u(places.floats),
        others(*trial.model, {.tolerance = kTolerance, .contact_tolerance = kContactTolerance}) {
    others.start(trial.contacts, nullptr, true);
    places.clear(u.data());
    places.split(trial.table, trial.x.view(), 0, 0, trial.model->slots(), base.data(), u.data());
  }
  void relax() { others.relax(base.data(), u.data()); }
  /// In tolerances, with the particle moved so far along x.
  double violation(double moved) const {
    auto there = u;
    there[places.of(trial.model->ordering.slot_of[0])] += static_cast<float>(moved);
    return others.violation(base.data(), there.data());
  }

  Trial trial;
  const YarnPlaces& places;
  kernels::AlignedVector<float> base, u;
  SingleConstraints others;
};

TEST_CASE("a rope that ends slack violates nothing unless it has pulled") {
  for (const double start : {1.9, 2.1}) {
    CAPTURE(start);
    SceneDescription scene = lone_particle({start, 0, 0}, {0, 0, 0});
    add_rope(scene, {0, 0, 0}, 2);
    Others ropes(scene);
    ropes.relax();
    const bool has_pulled = start > 2;
    CHECK(ropes.violation(has_pulled ? 0 : 0.1) < 0.01);
    CHECK(ropes.violation(has_pulled ? -0.1 : 0) ==
          doctest::Approx(has_pulled ? 0.05 / kTolerance : 0).epsilon(1e-3));
  }
}

TEST_CASE("a contact is violated where it is too deep, and where it has pushed too far") {
  for (const double start : {0.45, 0.52}) {
    CAPTURE(start);
    SceneDescription scene = lone_particle({start, 0, 0}, {0, 0, 0});
    add_sphere(scene, {0, 0, 0}, 0.5);
    Others contacts(scene);
    REQUIRE(contacts.trial.contacts.count() == 1);
    contacts.relax();
    const bool has_pushed = start < 0.5;
    const double outside = has_pushed ? 0 : 0.02;
    const auto tolerances = [](double expected) { return doctest::Approx(expected).epsilon(1e-2); };
    CHECK(contacts.violation(-outside - 0.01) == tolerances(0.01 / kContactTolerance));
    CHECK(contacts.violation(0.01) == tolerances(has_pushed ? 0.01 / kContactTolerance : 0));
  }
}

TEST_CASE("directions at the start serve until a rope has turned by nearly a right angle") {
  constexpr double kDegree = std::numbers::pi / 180;
  SceneDescription scene = lone_particle({1, 0, 0}, {0, 0, 0});
  add_rope(scene, {0, 0, 0}, 1);
  const auto turned = [](double degrees, double reach) {
    return reach * Vec3{std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0};
  };
  SUBCASE("pulled along where it was") {
    Trial trial(scene, 0.01);
    const Vec3 to = turned(60, 1.1);
    CHECK(trial.solve_positions(to));
    const Vec3 at = trial.of_particle(trial.x);
    CHECK(length(at) <= 1 + kTolerance);
    CHECK(at.y == doctest::Approx(to.y));
  }
  SUBCASE("left where it is") {
    Trial trial(scene, 0.01);
    const Vec3 to = turned(87, 1.5);
    CHECK_FALSE(trial.solve_positions(to));
    CHECK(distance(trial.of_particle(trial.x), to) < 1e-6);
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_yarn_yarn_one_sided
