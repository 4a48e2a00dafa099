/// What goes through a sphere within one step is prevented or reported.
#include <doctest/doctest.h>

#include <algorithm>

#include "engine/spheres/passages.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/random.h"

namespace weft::test::engine_spheres_passages {
namespace {

/// A sphere of radius 0.1 at the origin, fixed, and a free particle on its way along x, `aside` of
/// the line through the centre.
SceneDescription shot(double from, double speed, double aside) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {from, aside, 0}};
  scene.velocities = {{0, 0, 0}, {speed, 0, 0}};
  scene.masses = {1, 1};
  scene.fixed = {0};
  scene.spheres = {0};
  scene.radii = {0.1, 0};
  scene.gravity = {0, 0, 0};
  return scene;
}

TEST_CASE("a particle that crosses a sphere in one step is reported, and where it went") {
  const Backend backend = each_backend();
  for (const double aside : {0.0, 0.05, 0.09, 0.094}) {
    CAPTURE(aside);
    Cloth cloth = cloth_of(shot(-0.5, 100, aside), on(backend));
    const StepReport report = step(cloth, 0.01);
    CHECK(report.status == Status::passed_through);
    CHECK(report.passed_particle == 1);
    CHECK(report.failed_particle == kNoIndex);
    CHECK(cloth.position(1).x == doctest::Approx(0.5));
    CHECK(step(cloth, 0.01).status == Status::converged);
  }
}

TEST_CASE("so is one that a contact pushes out on the far side") {
  const Backend backend = each_backend();
  Cloth cloth = cloth_of(shot(-0.11, 15, 0.01), on(backend));
  CHECK(step(cloth, 0.01).status == Status::passed_through);
}

TEST_CASE("what is joined to a sphere may pass through it") {
  SceneDescription scene = shot(-0.5, 100, 0);
  scene.constraints = {{0, 1, 1, ConstraintKind::rope}};
  Cloth cloth = cloth_of(scene, on(each_backend()));
  CHECK(step(cloth, 0.01).status == Status::converged);
  CHECK(cloth.position(1).x == doctest::Approx(0.5));
}

TEST_CASE("a step that is refused names who failed, and nobody who crossed before that") {
  SceneDescription scene = shot(-0.5, 1, 0);
  scene.positions.push_back({0, 1, 0});
  scene.velocities.push_back({0, 9e149, 0});
  scene.masses.push_back(1);
  scene.radii.push_back(0);
  Settings settings = on(each_backend());
  settings.substeps = 2;
  Cloth cloth = cloth_of(scene, settings);
  const StepReport report = step(cloth, 2);
  CHECK(report.status == Status::non_finite_input);
  CHECK(report.failed_particle == 2);
  CHECK(report.passed_particle == kNoIndex);
}

TEST_CASE("what passes by, grazes, is stopped, or goes slowly enough is not") {
  const Backend backend = each_backend();
  const auto status = [&](double from, double speed, double aside) {
    Cloth cloth = cloth_of(shot(from, speed, aside), on(backend));
    return step(cloth, 0.01).status;
  };
  CHECK(status(-0.5, 100, 0.11) == Status::converged);   // beside it
  CHECK(status(-0.5, 100, 0.099) == Status::converged);  // through its outermost percent
  CHECK(status(-0.5, 35, 0) == Status::converged);       // ends before it
  CHECK(status(-0.11, 6, 0) == Status::converged);       // in contact, pushed back
  CHECK(status(-0.5, -100, 0) == Status::converged);     // away from it
}

TEST_CASE("a way not longer than the sphere's radius may cross it, too") {
  Cloth cloth = cloth_of(shot(-0.05, 10, 0.09), on(each_backend()));
  CHECK(step(cloth, 0.01).status == Status::passed_through);
}

TEST_CASE("what leaves a sphere that it was in, or stays in it, does not cross it") {
  Settings settings = on(each_backend());
  settings.contact_tolerance = 0.06;
  Cloth leaves = cloth_of(shot(-0.05, -100, 0), settings);
  CHECK(step(leaves, 0.01).status == Status::converged);
  Cloth stays = cloth_of(shot(-0.5, 45, 0), settings);
  CHECK(step(stays, 0.01).status == Status::converged);
  CHECK(stays.max_penetration() == doctest::Approx(0.05));
}

TEST_CASE("smaller steps see what a long one passes over") {
  const Backend backend = each_backend();
  Settings settings = on(backend);
  settings.substeps = 20;
  Cloth cloth = cloth_of(shot(-0.5, 100, 0), settings);
  CHECK(step(cloth, 0.01).status == Status::converged);
  CHECK(cloth.position(1).x < 0);
}

TEST_CASE("a fixed number of iterations hides no crossing") {
  const Backend backend = each_backend();
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
    CAPTURE(name(scheme));
    Settings settings = on(backend);
    settings.scheme = scheme;
    settings.iterations = 3;
    Cloth cloth = cloth_of(shot(-0.5, 100, 0), settings);
    const StepReport crossing = step(cloth, 0.01);
    CHECK(crossing.status == Status::passed_through);
    CHECK(crossing.iterations == 3);
    CHECK(crossing.scheme_fallbacks == 0);
    CHECK(step(cloth, 0.01).status == Status::fixed_iterations);
    settings.substeps = 2;
    Cloth in_the_first = cloth_of(shot(-0.2, 100, 0), settings);
    CHECK(step(in_the_first, 0.01).status == Status::passed_through);
  }
}

TEST_CASE("a crossing is no reason to leave scheme rattle") {
  Settings settings = on(each_backend());
  settings.scheme = Scheme::rattle;
  Cloth cloth = cloth_of(shot(-0.5, 100, 0), settings);
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::passed_through);
  CHECK(report.scheme_fallbacks == 0);
  settings.substeps = 2;
  Cloth in_the_first = cloth_of(shot(-0.2, 100, 0), settings);
  CHECK(step(in_the_first, 0.01).status == Status::passed_through);
}

TEST_CASE("nor does it hide velocities that rattle did not bring to their tolerance") {
  SceneDescription scene = shot(-0.5, 100, 0);
  for (std::uint32_t i = 0; i < 12; ++i) {  // a chain that begins to turn, far from the sphere
    scene.positions.push_back({0.1 * i, 5, 0});
    scene.velocities.push_back({0, 0.1 * i, 0});
    scene.masses.push_back(1);
    scene.radii.push_back(0);
    if (i > 0) scene.constraints.push_back({i + 1, i + 2, 0.1});
  }
  Settings settings = on(each_backend());
  settings.scheme = Scheme::rattle;
  settings.velocity_tolerance = 1e-9;
  settings.max_iterations = 40;
  Cloth cloth = cloth_of(scene, settings);
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::passed_through);
  CHECK(report.scheme_fallbacks == 1);
}

TEST_CASE("who is so far away that a step of the sphere is rounded off has not crossed it") {
  SceneDescription scene = shot(1e16, 0, 0);
  scene.fixed.clear();
  scene.velocities[0] = {10, 0, 0};
  Cloth cloth = cloth_of(scene, on(each_backend()));
  CHECK(step(cloth, 0.01).status == Status::converged);
}

/// Whether a way begins and ends outside of what it passes through, and is not too short for that.
bool crosses(kernels::Vector from, kernels::Vector way, double distance) {
  const double part = std::clamp(-dot(from, way) / dot(way, way), 0.0, 1.0);
  const double surface = 0.95 * distance;
  return length(way) > 0.62 * distance && length(from) >= surface &&
         length(from + way) >= surface && length(from + part * way) < surface;
}

/// The first of them, one by one.
std::uint32_t crossing_of(const Model& m, const kernels::Vectors& before,
                          const kernels::Vectors& after) {
  for (const std::uint32_t s : m.spheres) {
    for (std::uint32_t p = 0; p < m.slots(); ++p) {
      const kernels::Vector along = after[s] - before[s], way = after[p] - before[p] - along;
      if (may_touch(m, s, p) && crosses(before[p] - before[s], way, m.radius[s] + m.radius[p])) {
        return p;
      }
    }
  }
  return kNoIndex;
}

TEST_CASE("among many spheres the first crossing is found, however far all moved") {
  for (const simd::Isa isa : supported_isas()) {
    int crossed = 0, not_crossed = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
      CAPTURE(seed);
      const auto model = model_of(sheet_among_spheres(seed));
      SphereContacts contacts = make_sphere_contacts(*model);
      kernels::Vectors before = model->initial_position, after = before;
      Random random(seed);
      for (const double moved : {1e-3, 3e-2, 0.3, 10.0, 1e3, 1e9}) {
        const Vec3 together = random.in_box(moved);
        const double apart = seed % 2 == 0 ? moved : 0.01 * moved;
        for (std::size_t slot = 0; slot < model->slots(); ++slot) {
          if (!model->is_particle(slot)) continue;
          const Vec3 by = random.in_box(apart);
          after.set(slot, before[slot] + kernels::Vector{together.x + by.x, together.y + by.y,
                                                         together.z + by.z});
        }
        const std::uint32_t expected = crossing_of(*model, before, after);
        (expected == kNoIndex ? not_crossed : crossed) += 1;
        CHECK(find_passage(*model, simd::table(isa), before.view(), after.view(), contacts) ==
              expected);
      }
    }
    CHECK(crossed > 30);
    CHECK(not_crossed > 30);
  }
}

}  // namespace
}  // namespace weft::test::engine_spheres_passages
