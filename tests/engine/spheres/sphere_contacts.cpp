/// Contacts: spheres push, and do nothing else.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/spheres/sphere_contacts.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_spheres_sphere_contacts {
namespace {

/// A sphere of radius 0.1 at the origin and a particle of radius 0.1 at `distance` along x.
SceneDescription sphere_and_particle(double distance, Vec3 particle_velocity) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {distance, 0, 0}};
  scene.velocities = {{0, 0, 0}, particle_velocity};
  scene.masses = {3, 1};
  scene.spheres = {0};
  scene.radii = {0.1, 0.1};
  scene.gravity = {0, 0, 0};
  return scene;
}

Settings tight_with_velocities(const Method& method) {
  Settings settings = with(tight(1e-12), method);
  settings.velocity_correction = true;
  return settings;
}

TEST_CASE("a contact stops what would pass through, and shares the momentum") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Cloth cloth = cloth_of(sphere_and_particle(0.25, {-8, 0, 0}), tight_with_velocities(method));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(report.contacts == 1);
    CHECK(report.max_penetration <= 1e-12);
    CHECK(distance(cloth.position(0), cloth.position(1)) == doctest::Approx(0.2).epsilon(1e-11));
    CHECK(distance(cloth.velocity(0), {-2, 0, 0}) < exactness(method.backend, 1e-9, 8));
    CHECK(distance(cloth.velocity(1), {-2, 0, 0}) < exactness(method.backend, 1e-9, 8));
  }
}

TEST_CASE("by small steps a particle slides down a sphere as fast as its fall says") {
  const double angle = 0.2;
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {std::sin(angle), std::cos(angle), 0}};
  scene.masses = {1, 1};
  scene.fixed = {0};
  scene.spheres = {0};
  scene.radii = {1, 0};
  for (const Backend backend : {Backend::reference, Backend::simd}) {
    for (const Scheme scheme : {Scheme::implicit, Scheme::bdf2}) {
      CAPTURE(name(backend));
      CAPTURE(name(scheme));
      Cloth cloth = cloth_of(
          scene,
          {.substeps = 16, .solver = Solver::small_steps, .scheme = scheme, .backend = backend});
      run(cloth, 0.01, 50);
      const Vec3 x = cloth.position(1);
      REQUIRE(length(x) == doctest::Approx(1).epsilon(1e-3));  // it has not left the sphere
      CHECK(length(cloth.velocity(1)) ==
            doctest::Approx(std::sqrt(20 * (std::cos(angle) - x.y))).epsilon(0.01));
    }
  }
}

TEST_CASE("a contact never pulls") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    const Vec3 away{5, 1, 0};
    Cloth cloth = cloth_of(sphere_and_particle(0.2, away), tight_with_velocities(method));
    CHECK(step(cloth, 0.01).corrections == 0);
    CHECK(distance(cloth.velocity(1), away) == 0);
    CHECK(length(cloth.velocity(0)) == 0);
  }
}

TEST_CASE("a contact that pushed in one step owes no pull in the next") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Cloth cloth = cloth_of(sphere_and_particle(0.25, {-8, 0, 0}), with(tight(1e-12), method));
    CHECK(step(cloth, 0.01).corrections > 0);
    const std::vector<Vec3> apart{{0, 0, 0}, {0.5, 0, 0}};
    REQUIRE(cloth.write_velocities(apart));
    CHECK(step(cloth, 0.01).corrections == 0);
    CHECK(largest_distance(velocities(cloth), apart) == 0);
  }
}

TEST_CASE("particles near a sphere, but not in touch, are left to approach") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    const Vec3 approach{-0.1, 0, 0};
    Cloth cloth = cloth_of(sphere_and_particle(0.205, approach), tight_with_velocities(method));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.contacts == 1);
    CHECK(report.corrections == 0);
    CHECK(distance(cloth.velocity(1), approach) == 0);
  }
}

// The preview leaves the particle at 0.5, far from the sphere of radius 0.3; it is the bar, whose
// pin is placed elsewhere, that drags it to 0.2 and so into the sphere, which has to make room.
TEST_CASE("a contact that only the constraints bring about is found") {
  SceneDescription scene;
  scene.positions = {{-1, 0.001, 0}, {0.5, 0.001, 0}, {0, 0.001, 0}};
  scene.masses = {1, 1, 1};
  scene.fixed = {0};
  scene.constraints = {{0, 1, 1.5}};
  scene.spheres = {2};
  scene.radii = {0, 0, 0.3};
  scene.gravity = {0, 0, 0};
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Cloth cloth = cloth_of(scene, tight_with_velocities(method));
    REQUIRE(cloth.place_fixed(0, {-1.3, 0.001, 0}));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(report.contacts == 1);
    CHECK(distance(cloth.position(1), {0.2, 0.001, 0}) < exactness(method.backend, 1e-9, 0.3));
    CHECK(distance(cloth.position(2), {-0.1, 0.001, 0}) < exactness(method.backend, 1e-9, 0.3));
    CHECK(max_penetration(scene, positions(cloth)) <= 1e-12 * (1 + 1e-3));
  }
}

// On one line: a sphere S at 0, then Q at 0.3, R at 0.6, and A fixed at 1.0, joined by bars. Q and
// R fly at the sphere; the bars alone stop them, so in truth S is never touched. But before the
// bars have settled, Q stands inside S: whatever the order of visits, S is pushed early on, and the
// whole of that push must be taken back.
SceneDescription early_push() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}, {1, 0, 0}};
  scene.velocities = {{0, 0, 0}, {-25, 0, 0}, {-25, 0, 0}, {0, 0, 0}};
  scene.masses = {1, 1, 1, 1};
  scene.fixed = {3};
  scene.constraints = {{2, 3, 0.4}, {1, 2, 0.3}};
  scene.spheres = {0};
  scene.radii = {0.1, 0.1, 0, 0};
  scene.gravity = {0, 0, 0};
  return scene;
}

TEST_CASE("an early over-push is taken back") {
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Cloth cloth = cloth_of(early_push(), with(tight(1e-12), method));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(report.corrections > 2);
    CHECK(distance(cloth.position(0), {0, 0, 0}) < exactness(method.backend, 1e-10, 0.5));
    CHECK(length(cloth.velocity(0)) < exactness(method.backend, 1e-8, 50));
    CHECK(distance(cloth.position(1), {0.3, 0, 0}) < exactness(method.backend, 1e-10, 0.5));
    CHECK(distance(cloth.position(2), {0.6, 0, 0}) < exactness(method.backend, 1e-10, 0.5));
  }
}

/// Two chains of `links` links in one line, from a fixed sphere to the left and to the right. Their
/// inner ends fly into it, their heavy outer ends away from it.
SceneDescription chains_at_a_sphere(std::uint32_t links) {
  constexpr double kLink = 0.02;
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  scene.positions = {{0, 0, 0}};
  scene.velocities = {{0, 0, 0}};
  scene.masses = {1};
  scene.radii = {1};
  scene.fixed = scene.spheres = {0};
  for (const double side : {1., -1.}) {
    for (std::uint32_t i = 0; i <= links; ++i) {
      const auto particle = static_cast<std::uint32_t>(scene.positions.size());
      const double speed = i == 0 ? -1 : i == links ? 1 : 0;
      scene.positions.push_back({side * (1 + kLink * i), 0, 0});
      scene.velocities.push_back({side * speed, 0, 0});
      scene.masses.push_back(i == links ? 1000 : 1);
      scene.radii.push_back(0);
      if (i > 0) scene.constraints.push_back({particle - 1, particle, kLink});
    }
  }
  return scene;
}

TEST_CASE("contacts take back over-pushes of thousands of iterations, each its own") {
  constexpr std::uint32_t kLinks = 199;
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
    CAPTURE(name(scheme));
    Settings settings = tight(1e-3);
    settings.scheme = scheme;
    settings.contact_tolerance = 1e-6;
    Cloth cloth = cloth_of(chains_at_a_sphere(kLinks), settings);
    CHECK(step(cloth, 0.01).iterations > 4096);  // more than one look at a stall
    for (std::uint32_t i = 1; i <= kLinks + 1; ++i) {
      CHECK(std::abs(cloth.position(i).x + cloth.position(i + kLinks + 1).x) < 1e-9);
    }
  }
}

TEST_CASE("an over-push is taken back whole, however many iterations that takes") {
  constexpr std::uint32_t kLinks = 100;
  SceneDescription scene;  // as early_push, but only the far end of a long chain stops it
  scene.gravity = {0, 0, 0};
  scene.positions = {{0, 0, 0}};
  scene.velocities = {{0, 0, 0}};
  for (std::uint32_t i = 0; i <= kLinks; ++i) {
    scene.positions.push_back({0.2001 + 0.01 * i, 0, 0});
    scene.velocities.push_back({i < kLinks ? -1. : 0., 0, 0});
    if (i > 0) scene.constraints.push_back({i, i + 1, 0.01});
  }
  scene.masses.assign(kLinks + 2, 1);
  scene.radii.assign(kLinks + 2, 0);
  scene.radii[0] = 0.2;
  scene.spheres = {0};
  scene.fixed = {kLinks + 1};
  for (const Backend backend : kBackends) {
    CAPTURE(name(backend));
    Cloth cloth = cloth_of(scene, on(backend, tight(1e-6)));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::converged);
    CHECK(report.iterations > 4096);  // more than one look at a stall
    CHECK(distance(cloth.position(0), {0, 0, 0}) < 1e-4);
  }
}

TEST_CASE("a particle's own size keeps it off the smallest of spheres") {
  SceneDescription scene;  // a ball, and what flies past the sphere and drags it there
  scene.gravity = {0, 0, 0};
  scene.positions = {{0, 0, 0}, {0.8, 0, 0}, {-0.2, 0, 0}};
  scene.velocities = {{0, 0, 0}, {0, 0, 0}, {-45, 0, 0}};
  scene.masses = {1, 1, 3};
  scene.fixed = scene.spheres = {0};
  scene.constraints = {{1, 2, 1}};
  for (const double radius : {5e-5, 2e-4}) {
    scene.radii = {radius, 0.5, 0};
    for (const Solver solver : {Solver::gauss_seidel, Solver::yarn, Solver::direct}) {
      CAPTURE(radius);
      CAPTURE(name(solver));
      Cloth cloth = cloth_of(scene, {.substeps = 1, .solver = solver});
      const StepReport report = step(cloth, 0.01);
      CHECK(report.status == Status::converged);
      CHECK(report.contacts == 1);
      CHECK(report.max_penetration <= 1e-4);
    }
  }
}

TEST_CASE("the velocity loop takes an early over-push back as well") {
  const Backend backend = each_backend();
  SceneDescription scene = early_push();
  // Q starts in touch with S, and no error of position is worth a correction.
  scene.positions[0] = {0.1, 0, 0};
  scene.velocities[0] = {-1, 0, 0};
  Settings settings = on(backend, tight(1e-3));
  settings.velocity_tolerance = 1e-10;
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  const StepReport report = step(cloth, 1e-9);
  CHECK(report.iterations == 1);
  CHECK(report.velocity_iterations > 2);
  CHECK(distance(cloth.velocity(0), {-1, 0, 0}) < exactness(backend, 1e-8, 50));
  CHECK(length(cloth.velocity(1)) < exactness(backend, 1e-8, 50));
  CHECK(length(cloth.velocity(2)) < exactness(backend, 1e-8, 50));
}

TEST_CASE("particles outside the list of spheres do not collide among themselves") {
  const Backend backend = each_backend();
  SceneDescription scene = sphere_and_particle(0.25, {0, 0, 0});
  scene.positions.push_back({0.3, 0, 0});
  scene.velocities.push_back({-5, 0, 0});
  scene.masses.push_back(1);
  scene.radii.push_back(0.1);
  Cloth cloth = cloth_of(scene, on(backend, tight(1e-12)));
  step(cloth, 0.01);
  CHECK(distance(cloth.position(2), {0.25, 0, 0}) < 1e-15);
  CHECK(distance(cloth.velocity(1), {0, 0, 0}) == 0);
}

TEST_CASE("yarns and the direct solver take an early over-push back as well") {
  for (const Solver solver : {Solver::yarn, Solver::direct}) {
    CAPTURE(name(solver));
    Settings settings = tight(1e-5);
    settings.solver = solver;
    Cloth cloth = cloth_of(early_push(), settings);
    CHECK(step(cloth, 0.01).status == Status::converged);
    CHECK(distance(cloth.position(0), {0, 0, 0}) < 2e-5);
    CHECK(distance(cloth.position(1), {0.3, 0, 0}) < 2e-5);
  }
}

TEST_CASE("a light sphere under many heavy particles finds its place in few iterations") {
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  scene.positions = {{0, 0, 0}};
  for (int i = 0; i < 16; ++i) scene.positions.push_back({0.001 * (i % 4), 0.1, 0.001 * (i / 4)});
  scene.velocities.assign(17, {0, -1, 0});
  scene.velocities[0] = {0, 0, 0};
  scene.masses.assign(17, 1);
  scene.masses[0] = 1e-3;
  scene.spheres = {0};
  scene.radii.assign(17, 0);
  scene.radii[0] = 0.1;
  Cloth cloth = cloth_of(scene, paper_settings());
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::converged);
  CHECK(report.iterations < 50);
}

TEST_CASE("what a rope ties to a sphere does not collide with it") {
  const Backend backend = each_backend();
  SceneDescription scene = sphere_and_particle(0.15, {0, 0, 0});
  scene.constraints = {{1, 0, 0.3, ConstraintKind::rope}};
  Cloth cloth = cloth_of(scene, on(backend));
  CHECK(cloth.max_penetration() == 0);
  CHECK(step(cloth, 0.01).contacts == 0);
  CHECK(length(cloth.velocity(1)) == 0);
}

TEST_CASE("two fixed spheres may overlap") {
  const Backend backend = each_backend();
  SceneDescription scene = sphere_and_particle(0.1, {0, 0, 0});
  scene.fixed = {0, 1};
  scene.spheres = {0, 1};
  Cloth cloth = cloth_of(scene, on(backend));
  CHECK(step(cloth, 0.01).status == Status::converged);
  CHECK(cloth.max_penetration() == 0);
}

TEST_CASE("two free spheres that list each other are one pair") {
  const Backend backend = each_backend();
  SceneDescription scene = sphere_and_particle(0.25, {-8, 0, 0});
  scene.spheres = {0, 1};
  Cloth cloth = cloth_of(scene, on(backend, tight(1e-12)));
  CHECK(step(cloth, 0.01).contacts == 1);
  CHECK(distance(cloth.velocity(0), {-3 / 4.0, 0, 0}) < exactness(backend, 1e-9, 3));
}

/// Particles thrown from everywhere at a fixed and at a free sphere.
SceneDescription hail() {
  Random random(7);
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  for (int i = 0; i < 200; ++i) {
    const Vec3 start = random.in_box(2);
    if (length(start) < 0.7) continue;
    scene.positions.push_back(start);
    scene.velocities.push_back(-3.0 * start + random.in_box(0.5));
    scene.masses.push_back(random.between(0.01, 0.1));
    scene.radii.push_back(random.between(0, 0.05));
  }
  for (const double x : {-0.3, 0.3}) {
    scene.spheres.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    scene.positions.push_back({x, 0, 0});
    scene.velocities.push_back({0, 0, 0});
    scene.masses.push_back(1);
    scene.radii.push_back(0.25);
  }
  scene.fixed = {scene.spheres[0]};
  return scene;
}

TEST_CASE("no step ends with more penetration than the tolerance") {
  const SceneDescription scene = hail();
  for (const Method& method : kAllMethods) {
    CAPTURE(text(method));
    Settings settings = with(paper_settings(), method);
    settings.contact_tolerance = 1e-6;
    Cloth cloth = cloth_of(scene, settings);
    int most = 0;
    for (int k = 0; k < 100; ++k) {
      const StepReport report = step(cloth, 0.01);
      REQUIRE(report.status == Status::converged);
      const double deepest = max_penetration(scene, positions(cloth));
      REQUIRE(deepest <= 1e-6 * (1 + 1e-9));
      REQUIRE(report.max_penetration == doctest::Approx(deepest).epsilon(1e-9));
      most = std::max(most, report.contacts);
    }
    CHECK(most > 5);
  }
}

TEST_CASE("contacts that the direct solver leaves to sweeps are theirs in velocities too") {
  const Backend backend = each_backend();
  SceneDescription scene;  // more spheres than the direct solver takes, each with a particle to it
  scene.gravity = {0, 0, 0};
  constexpr std::uint32_t kSpheres = 20;
  for (std::uint32_t i = 0; i < kSpheres; ++i) {
    scene.spheres.push_back(2 * i);
    for (const double height : {0.0, 0.10005}) {
      scene.positions.push_back({static_cast<double>(i), height, 0});
      scene.velocities.push_back({0, height > 0 ? -0.02 : 0.0, 0});
      scene.masses.push_back(1);
      scene.radii.push_back(height > 0 ? 0 : 0.1);
    }
  }
  Settings settings = on(backend);
  settings.solver = Solver::direct;
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  const StepReport report = step(cloth, 1e-4);
  CHECK(report.status == Status::converged);
  CHECK(report.contacts == kSpheres);
  for (std::uint32_t i = 0; i < kSpheres; ++i) {
    const double approach = cloth.velocity(2 * i).y - cloth.velocity(2 * i + 1).y;
    CHECK(approach <= settings.velocity_tolerance * (1 + 1e-6));
  }
}

struct Pairs {
  std::vector<std::uint32_t> sphere, particle;
  double deepest = 0;
};

/// Those nearer than (1 + margin) r1 + r2, one by one.
Pairs pairs_of(const Model& m, const kernels::Vectors& x, double margin) {
  Pairs pairs;
  for (const std::uint32_t s : m.spheres) {
    for (std::uint32_t p = 0; p < m.slots(); ++p) {
      if (!may_touch(m, s, p)) continue;
      const double apart = kernels::length(x[s] - x[p]), surface = m.radius[s] + m.radius[p];
      pairs.deepest = std::max(pairs.deepest, surface - apart);
      if (apart >= surface + margin * m.radius[s]) continue;
      pairs.sphere.push_back(s);
      pairs.particle.push_back(p);
    }
  }
  return pairs;
}

TEST_CASE("among many spheres every pair within the margin is found, and in order") {
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    std::size_t found = 0;
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      CAPTURE(seed);
      const auto model = model_of(sheet_among_spheres(seed));
      kernels::Vectors x = model->initial_position;
      SphereContacts contacts = make_sphere_contacts(*model);
      Random random(seed);
      for (const double moved : {0.0, 0.01, 1.0, 100.0}) {
        for (std::size_t slot = 0; slot < model->slots(); ++slot) {
          const Vec3 by = random.in_box(moved);
          if (model->is_particle(slot)) x.set(slot, x[slot] + kernels::Vector{by.x, by.y, by.z});
        }
        const Pairs expected = pairs_of(*model, x, 0.05);
        find_contacts(*model, table, x.view(), contacts);
        CHECK(contacts.sphere == expected.sphere);
        CHECK(contacts.particle == expected.particle);
        found += contacts.count();
        CHECK(max_penetration(*model, table, x.view(), contacts) ==
              doctest::Approx(expected.deepest).epsilon(1e-14));
        CHECK(add_missed_contacts(*model, table, x.view(), 0, contacts) == 0);
        SphereContacts late = make_sphere_contacts(*model);
        add_missed_contacts(*model, table, x.view(), 0, late);
        const Pairs touching = pairs_of(*model, x, 0);
        CHECK(late.sphere == touching.sphere);
        CHECK(late.particle == touching.particle);
      }
    }
    CHECK(found > 1000);
  }
}

}  // namespace
}  // namespace weft::test::engine_spheres_sphere_contacts
