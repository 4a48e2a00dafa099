/// What changes make of a model is what is built from the changed description, and a model tells
/// its description.
#include "engine/model/change.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/bending.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_model_change {
namespace {

/// With constraints and bending elements between fixed particles in among the others.
SceneDescription with_inert(SceneDescription scene) {
  for (std::uint32_t j = 0; j + 1 < scene.fixed.size(); ++j) {
    const std::uint32_t a = scene.fixed[j], b = scene.fixed[j + 1];
    const double rest = distance(scene.positions[a], scene.positions[b]);
    scene.constraints.insert(scene.constraints.begin() + 5 * j, {b, a, rest});
  }
  return scene;
}

/// Something of everything, links turned around.
SceneDescription mixture() {
  SceneDescription scene = with_inert(with_rows(scene_of("hang_sphere", 9), 9, 1e-4));
  scene.velocities.assign(scene.positions.size(), {1, 2, 3});
  for (const std::uint32_t pin : scene.fixed) scene.velocities[pin] = {};
  for (std::size_t c = 0; c < scene.constraints.size(); ++c) {
    Constraint& constraint = scene.constraints[c];
    if (c % 3 == 0) std::swap(constraint.a, constraint.b);
    if (c % 5 == 0) constraint.kind = ConstraintKind::rope;
    if (c % 7 == 0) constraint.compliance = 1e-4;
  }
  scene.damping = {0.001, 0.002, 0.003};
  scene.anchors = {{60, {1, 2, 3}, {0, 1, 0}, 0.5, 0.01, 0.3}, {50, {4, 5, 6}, {}, 0.25, 0, 0}};
  scene.air = {{{0, 1, 10}, {20, 21, 30}}, 1.3, 0.5, 0.25, {1, 2, 3}};
  return scene;
}

std::vector<NamedScene> all_scenes() {
  return {{"woven", with_inert(scene_of("hang", 20))},
          {"corners", scene_of("corners", 21)},
          {"mesh", scene_of("cape", 30)},
          {"ropes", roped_sheet(12)},
          {"hub", hub_sheet(12)},
          {"chain", scene_of("chain", 8)},
          {"cotton", scene_of("flag", 9)},
          {"mixture", mixture()}};
}

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> list) {
  std::ranges::sort(list);
  return list;
}

bool same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
bool same(const Constraint& a, const Constraint& b) {
  return a.a == b.a && a.b == b.b && a.rest_length == b.rest_length && a.kind == b.kind &&
         a.compliance == b.compliance;
}
bool same(const BendingElement& a, const BendingElement& b) {
  return a.particles == b.particles && a.weights == b.weights && a.rest == b.rest &&
         a.compliance == b.compliance && a.fold == b.fold && a.yield == b.yield &&
         a.hardening == b.hardening && a.arm == b.arm;
}
bool same(const Anchor& a, const Anchor& b) {
  return a.particle == b.particle && same(a.point, b.point) && same(a.normal, b.normal) &&
         a.max_distance == b.max_distance && a.backstop_distance == b.backstop_distance &&
         a.backstop_radius == b.backstop_radius;
}
template <class T>
bool all_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::ranges::equal(a, b, [](const T& x, const T& y) { return same(x, y); });
}

void check_same(const SceneDescription& a, const SceneDescription& b) {
  CHECK(all_same(a.positions, b.positions));
  CHECK(all_same(a.velocities, b.velocities));
  CHECK(a.masses == b.masses);
  CHECK(sorted(a.fixed) == sorted(b.fixed));
  CHECK(all_same(a.constraints, b.constraints));
  CHECK(all_same(a.bending, b.bending));
  CHECK(all_same(a.anchors, b.anchors));
  CHECK(a.damping.stretch == b.damping.stretch);
  CHECK(a.damping.bending == b.damping.bending);
  CHECK(a.damping.motion == b.damping.motion);
  CHECK(a.air.triangles == b.air.triangles);
  CHECK(a.air.density == b.air.density);
  CHECK(a.air.drag == b.air.drag);
  CHECK(a.air.lift == b.air.lift);
  CHECK(a.air.ram == b.air.ram);
  CHECK(a.pressures == b.pressures);
  CHECK(same(a.air.wind, b.air.wind));
  CHECK(same(a.gravity, b.gravity));
  CHECK(sorted(a.spheres) == sorted(b.spheres));
  CHECK(a.radii == b.radii);
}

TEST_CASE("a model tells what it was built from") {
  for (NamedScene& named : all_scenes()) {
    CAPTURE(named.name);
    SceneDescription& scene = named.scene;
    if (scene.velocities.empty()) scene.velocities.resize(scene.positions.size());
    check_same(description_of(*model_of(scene)), scene);
  }
}

struct Change {
  const char* what;
  Changes changes;
};

/// Of particles and constraints that all scenes have.
std::vector<Change> all_changes(const SceneDescription& scene) {
  std::uint32_t free = 0;
  while (std::ranges::count(scene.fixed, free) > 0) ++free;
  const std::uint32_t end = scene.constraints.back().b, pin = scene.fixed[0];
  std::vector<Change> all{
      {"fixed", {.fix = {free}}},
      {"released", {.release = {pin}}},
      {"all released", {.release = scene.fixed}},
      {"masses", {.masses = {{free, 3}, {pin, 2}}}},
      {"rest lengths", {.rest_lengths = {{0, 0.3}, {3, 0.4}}}},
      {"compliances", {.compliances = {{0, 0}, {3, 1e-5}}}},
      {"all at once",
       {.fix = {free}, .release = scene.fixed, .masses = {{end, 2}}, .rest_lengths = {{1, 0.2}}}}};
  return all;
}

/// Every list that the two are swept by.
void check_same(const Model& a, const Model& b) {
  CHECK(a.ordering.slot_of == b.ordering.slot_of);
  CHECK(a.ordering.a == b.ordering.a);
  CHECK(a.ordering.b == b.ordering.b);
  CHECK(a.inverse_mass == b.inverse_mass);
  CHECK(a.pins == b.pins);
  CHECK(a.holds == b.holds);
  CHECK(a.constraints.a == b.constraints.a);
  CHECK(a.constraints.b == b.constraints.b);
  CHECK(a.constraints.described == b.constraints.described);
  CHECK(a.constraints.slot == b.constraints.slot);
  CHECK(a.constraints.rest_length == b.constraints.rest_length);
  CHECK(a.constraints.compliance == b.constraints.compliance);
  CHECK(a.bending.slots == b.bending.slots);
  CHECK(a.uneven.ratio == b.uneven.ratio);
}

TEST_CASE("what changes make of a model is what is built from the changed description") {
  for (NamedScene& named : all_scenes()) {
    CAPTURE(named.name);
    SceneDescription& scene = named.scene;
    if (scene.velocities.empty()) scene.velocities.resize(scene.positions.size());
    const auto model = model_of(scene);
    for (const Change& change : all_changes(scene)) {
      CAPTURE(change.what);
      SceneDescription expected = with(scene, change.changes);
      for (const std::uint32_t i : expected.fixed) expected.velocities[i] = {};
      const auto made = changed(*model, change.changes), built = model_of(expected);
      check_same(description_of(*made), expected);
      check_same(*made, *built);
      CHECK(are_related(*made, *model));
      CHECK_FALSE(are_related(*built, *model));
    }
  }
}

TEST_CASE("what was changed and changed back is as it was") {
  for (const NamedScene& named : all_scenes()) {
    CAPTURE(named.name);
    const auto model = model_of(named.scene);
    const auto free = changed(*model, {.release = named.scene.fixed});
    const auto back = changed(*free, {.fix = named.scene.fixed});
    check_same(*back, *model);
    check_same(description_of(*back), description_of(*model));
  }
}

}  // namespace
}  // namespace weft::test::engine_model_change
