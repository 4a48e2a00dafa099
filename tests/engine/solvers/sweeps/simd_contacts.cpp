/// Contacts in lanes, sphere by sphere, in whatever order they are listed.
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "engine/parallel/team.h"
#include "engine/solvers/sweeps/simd_solver.h"
#include "engine/spheres/sphere_contacts.h"
#include "tests/support/isas.h"

namespace weft::test::engine_solvers_sweeps_simd_contacts {
namespace {

constexpr std::uint32_t kSpheres = 9, kEach = 13;  // particles in each sphere, of radius 0.5

SceneDescription particles_in_fixed_spheres() {
  SceneDescription scene;
  const auto add = [&](Vec3 position, double radius) {
    scene.positions.push_back(position);
    scene.masses.push_back(1);
    scene.radii.push_back(radius);
    return static_cast<std::uint32_t>(scene.positions.size() - 1);
  };
  for (std::uint32_t i = 0; i < kSpheres; ++i) {
    const double x = 2.0 * i;
    for (std::uint32_t k = 0; k < kEach; ++k) add({x + 0.1 + 0.02 * k, 0.3 - 0.05 * k, 0.1}, 0);
    scene.spheres.push_back(add({x, 0, 0}, 0.5));
  }
  std::ranges::reverse(scene.spheres);
  scene.fixed = scene.spheres;
  return scene;
}

SphereContacts in_order(const SphereContacts& store, const std::vector<std::uint32_t>& order) {
  SphereContacts other = store;
  for (std::size_t k = 0; k < order.size(); ++k) {
    other.sphere[k] = store.sphere[order[k]];
    other.particle[k] = store.particle[order[k]];
    other.distance[k] = store.distance[order[k]];
  }
  return other;
}

TEST_CASE("contacts in any order push all the same") {
  const auto model = build_model(particles_in_fixed_spheres()).value();
  const simd::Table& table = simd::table(supported_isas().back());
  Team team;
  SphereContacts found = make_sphere_contacts(*model);
  kernels::Vectors start = model->initial_position;
  find_contacts(*model, table, start.view(), found);
  REQUIRE(found.count() == kSpheres * kEach);
  const auto solved = [&](const SphereContacts& contacts) {
    SimdSolver solver(*model, {}, table);
    kernels::Vectors x = start;
    CHECK(
        solver.solve_positions(x.view(), {}, contacts, nullptr, true, {.max_iterations = 100}, team)
            .converged);
    return x;
  };
  const kernels::Vectors expected = solved(found);
  CHECK(max_penetration(*model, table, start.view(), found) > 0.1);
  kernels::Vectors x = expected;
  CHECK(max_penetration(*model, table, x.view(), found) <= Settings{}.contact_tolerance);

  std::vector<std::uint32_t> order(found.count());
  std::iota(order.begin(), order.end(), 0u);
  std::mt19937 random(7);
  for (int k = 0; k < 5; ++k) {
    std::ranges::shuffle(order, random);
    x = solved(in_order(found, order));
    CHECK(x.x == expected.x);
    CHECK(x.y == expected.y);
    CHECK(x.z == expected.z);
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_sweeps_simd_contacts
