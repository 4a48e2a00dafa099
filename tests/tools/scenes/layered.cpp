/// The built-in scenes whose cloth touches itself.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "tests/support/crossing_triangles.h"
#include "tools/scenes/body_moves.h"
#include "tools/scenes/scenes.h"

namespace weft::scenes {
namespace {

constexpr double kTwoPi = 6.283185307179586;

Scene layered(std::string_view name, int size = 20) {
  return make_scene(name, {.size = size}).value();
}

TEST_CASE("scenes of layers have the self-contact of their material, others have none") {
  for (const std::string_view name : {"rings", "tunic", "stack", "fold", "crease", "curtain",
                                      "twist", "ribbon", "funnel", "outfit"}) {
    CAPTURE(name);
    const SelfContact contact = layered(name).description.self_contact;
    CHECK(contact.on);
    CHECK(contact.thickness == find_material(kFabric).value().thickness);
  }
  for (const std::string_view name : {"hang", "chain", "flag", "skirt", "mannequin"})
    CHECK(!layered(name).description.self_contact.on);
}

TEST_CASE("scenes of layers begin without a crossing, and have none as they begin to move") {
  constexpr double kFrame = 1.0 / 60;
  for (const BuiltIn& entry : list()) {
    CAPTURE(entry.name);
    const auto [description, mesh, bodies, moves] = layered(entry.name, entry.usual_size);
    if (!description.self_contact.on) continue;
    Cloth cloth = Cloth::create(build_model(description).value(), {.threads = 1}).value();
    const tools::MovedPins pins(moves, cloth);
    const auto moved = tools::MovedBodies::add(bodies, cloth);
    REQUIRE(moved);
    CHECK(test::count_self_crossings({description.positions, description.surface}) == 0);
    for (int frame = 1; frame <= 12; ++frame) {
      REQUIRE(pins.send(cloth, frame * kFrame));
      REQUIRE(moved.value().send(cloth, frame * kFrame));
      CHECK(cloth.step(kFrame).value().status == Status::converged);
    }
    const std::vector<Vec3> now = tools::particle_positions(cloth);
    CHECK(test::count_self_crossings({now, description.surface}) == 0);
  }
}

/// Where a moved pin of a scene comes to, from its beginning.
Vec3 end_of(const Scene& scene, std::size_t move, std::size_t pin) {
  const tools::PinMove& m = scene.moves[move];
  return place_at(m, 100, scene.description.positions[m.particles[pin]]);
}

TEST_CASE("the ends of the twisted sheet turn, and come nearer") {
  const Scene twist = layered("twist");
  REQUIRE(twist.moves.size() == 2);
  CHECK(end_of(twist, 0, 0).x == doctest::Approx(-0.4));
  CHECK(end_of(twist, 1, 0).x == doctest::Approx(0.4));
  for (const std::size_t side : {0, 1}) {  // one and a half turns each
    const Vec3 from = twist.description.positions[twist.moves[side].particles[0]];
    CHECK(end_of(twist, side, 0).z == doctest::Approx(-from.z));
    CHECK(std::abs(tools::rotation_at(twist.moves[side], 100).x) == doctest::Approx(1.5 * kTwoPi));
  }
}

TEST_CASE("what is lowered and drawn is fixed, and comes to where it should") {
  const Scene ribbon = layered("ribbon"), funnel = layered("funnel"), outfit = layered("outfit");
  CHECK(end_of(ribbon, 0, 0).y == doctest::Approx(0.12).epsilon(0.01));
  CHECK(end_of(funnel, 0, 0).y == doctest::Approx(-0.97));
  CHECK(end_of(outfit, 0, 0).z > 7);  // it walks for eight and a half seconds
  for (const Scene* scene : {&ribbon, &funnel, &outfit})
    CHECK(scene->description.fixed == scene->moves[0].particles);
}

}  // namespace
}  // namespace weft::scenes
