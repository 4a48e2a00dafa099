/// Pairs that are looked at in place of all, against a search of all.
#include "engine/spheres/nearby_pairs.h"

#include <doctest/doctest.h>

#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/random.h"

namespace weft::test::engine_spheres_nearby_pairs {
namespace {

/// Each particle goes to somewhere within `way` of where it is.
void move(const Model& model, double way, Random& random, kernels::Vectors& x) {
  for (std::size_t slot = 0; slot < model.slots(); ++slot) {
    const Vec3 to = random.in_box(1);
    const kernels::Vector by{to.x, to.y, to.z};
    const double part = random.between(0, 1) * way / kernels::length(by);
    if (model.is_particle(slot)) x.set(slot, x[slot] + part * by);
  }
}

TEST_CASE("until something has moved beyond their margin the pairs hold all contacts, in order") {
  const simd::Table& table = simd::table(supported_isas().back());
  std::size_t listed = 0, searches = 0, steps = 0;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    const auto model = model_of(sheet_among_spheres(seed));
    kernels::Vectors x = model->initial_position;
    SphereContacts contacts = make_sphere_contacts(*model), expected = make_sphere_contacts(*model);
    NearbySpherePairs nearby;
    Random random(seed);
    for (; steps < 40 * (seed + 1); ++steps) {
      const double way = random.between(0, 0.02);
      move(*model, way, random, x);
      if (!nearby.hold_after(way)) {
        nearby.find(*model, table, x.view(), 0.1, contacts);
        ++searches;
      }
      nearby.list_contacts(*model, x.view(), contacts);
      nearby.move(way);
      find_contacts(*model, table, x.view(), expected);
      CHECK(contacts.sphere == expected.sphere);
      CHECK(contacts.particle == expected.particle);
      CHECK(contacts.distance == expected.distance);
      CHECK(contacts.first == expected.first);
      CHECK(contacts.next == expected.next);
      listed += contacts.count();
    }
  }
  CHECK(listed > 1000);
  CHECK(searches < steps / 5);
}

TEST_CASE("the pairs know of no place but those of their slots") {
  const simd::Table& table = simd::table(supported_isas().back());
  const auto model = model_of(sheet_among_spheres(3));
  SphereContacts contacts = make_sphere_contacts(*model), expected = make_sphere_contacts(*model);
  NearbySpherePairs nearby;
  CHECK_FALSE(nearby.hold_after(0));
  kernels::Vectors all = model->initial_position;
  nearby.find(*model, table, all.view(), 0.1, contacts);
  kernels::Vectors x(model->slots());
  for (const std::uint32_t slot : nearby.slots()) x.set(slot, model->initial_position[slot]);
  nearby.list_contacts(*model, x.view(), contacts);
  find_contacts(*model, table, all.view(), expected);
  CHECK(contacts.particle == expected.particle);
  CHECK(nearby.hold_after(0.1));
  nearby.forget();
  CHECK_FALSE(nearby.hold_after(0));
}

}  // namespace
}  // namespace weft::test::engine_spheres_nearby_pairs
