/// A description's numbering is the user's business: it names particles, it does not steer them.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_numbering {
namespace {

/// Particle i becomes particle to[i].
SceneDescription renumbered(const SceneDescription& scene, const std::vector<std::uint32_t>& to) {
  SceneDescription out = scene;
  for (std::size_t i = 0; i < to.size(); ++i) {
    out.positions[to[i]] = scene.positions[i];
    out.masses[to[i]] = scene.masses[i];
    if (!scene.velocities.empty()) out.velocities[to[i]] = scene.velocities[i];
    if (!scene.radii.empty()) out.radii[to[i]] = scene.radii[i];
  }
  for (std::uint32_t& particle : out.fixed) particle = to[particle];
  for (std::uint32_t& particle : out.spheres) particle = to[particle];
  for (Constraint& c : out.constraints) {
    c.a = to[c.a];
    c.b = to[c.b];
  }
  return out;
}

std::vector<Vec3> taken_back(const std::vector<Vec3>& moved, const std::vector<std::uint32_t>& to) {
  std::vector<Vec3> out;
  for (const std::uint32_t number : to) out.push_back(moved[number]);
  return out;
}

/// The constraints in another order, each with its ends swapped or not.
void shuffle_constraints(SceneDescription& scene, Random& random) {
  const std::vector<Constraint> before = scene.constraints;
  const std::vector<std::uint32_t> order = random.permutation(before.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    Constraint c = before[order[i]];
    if (random.below(2) == 1) std::swap(c.a, c.b);
    scene.constraints[i] = c;
  }
}

TEST_CASE("renumbered particles move the same, with every method") {
  for (const char* name : {"hang", "hang_sphere", "corners"}) {
    const SceneDescription scene = scene_of(name, 9);
    Random random(11);
    const std::vector<std::uint32_t> to = random.permutation(scene.positions.size());
    for (const Method& method : kMethods) {
      CAPTURE(std::string(name));
      CAPTURE(text(method));
      Cloth plain = cloth_of(scene, with(paper_settings(), method));
      Cloth permuted = cloth_of(renumbered(scene, to), with(paper_settings(), method));
      run(plain, 0.01, 100);
      run(permuted, 0.01, 100);
      CHECK(largest_distance(positions(plain), taken_back(positions(permuted), to)) < 1e-9);
    }
  }
}

// Contacts are visited in the order in which they are found, so a sphere that is free, and joins
// its contacts, may end elsewhere within the tolerance: there is one motion only where that is
// small.
TEST_CASE("renumbered particles make the same motion of contacts that push one another") {
  const SceneDescription scene = scene_of("sphere_drop", 6);
  Random random(14);
  const std::vector<std::uint32_t> to = random.permutation(scene.positions.size());
  for (const bool anticipate : {false, true}) {
    CAPTURE(anticipate);
    Settings settings = on(Backend::reference, tight(1e-12));
    settings.measuring.anticipate = anticipate;
    Cloth plain = cloth_of(scene, settings);
    Cloth permuted = cloth_of(renumbered(scene, to), settings);
    int most_contacts = 0;
    for (int k = 0; k < 40; ++k) {
      most_contacts = std::max(most_contacts, step(plain, 0.01).contacts);
      step(permuted, 0.01);
    }
    CHECK(most_contacts > 2);
    CHECK(largest_distance(positions(plain), taken_back(positions(permuted), to)) < 1e-9);
  }
}

TEST_CASE("what a step converges to does not depend on the order of the constraints") {
  const SceneDescription scene = drifting_sheet(5, 12);
  SceneDescription shuffled = scene;
  Random random(13);
  shuffle_constraints(shuffled, random);
  for (const bool anticipate : {false, true}) {
    CAPTURE(anticipate);
    Settings settings = on(Backend::reference, tight(1e-13));
    settings.measuring.renew_after = 0;  // else the order decides how far the first directions lead
    settings.measuring.anticipate = anticipate;
    Cloth plain = cloth_of(scene, settings);
    Cloth other = cloth_of(shuffled, settings);
    run(plain, 0.01, 10);
    run(other, 0.01, 10);
    CHECK(largest_distance(positions(plain), positions(other)) < 1e-9);
  }
}

}  // namespace
}  // namespace weft::test::engine_step_numbering
