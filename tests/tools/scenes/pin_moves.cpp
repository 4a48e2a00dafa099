#include "tools/scenes/pin_moves.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace weft::tools {
namespace {

constexpr double kPi = std::numbers::pi;

double distance(Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

TEST_CASE("translations are linear between times, and still before the first and after the last") {
  const PinMove move{
      .particles = {0}, .times = {1, 2, 4}, .translations = {{0, 0, 1}, {4, 0, 1}, {4, -8, 1}}};
  const Vec3 x{0.5, 0.25, 0.125};
  const struct {
    double time;
    Vec3 to;
  } kPlaces[] = {{-9, {0, 0, 1}}, {1, {0, 0, 1}},    {1.25, {1, 0, 1}}, {2, {4, 0, 1}},
                 {3, {4, -4, 1}}, {3.5, {4, -6, 1}}, {4, {4, -8, 1}},   {1e9, {4, -8, 1}}};
  for (const auto& place : kPlaces) {
    CAPTURE(place.time);
    const Vec3 at = place_at(move, place.time, x);
    CHECK(distance(at, {x.x + place.to.x, x.y + place.to.y, x.z + place.to.z}) == 0);
  }
}

TEST_CASE("rotations turn about their vector through the point named, as far as it is long") {
  PinMove move{.particles = {0},
               .times = {0, 2},
               .translations = {{0, 0, 0}, {0, 0, 10}},
               .rotations = {{0, 0, 0}, {0, 0, kPi}},
               .about = {1, 1, 5}};
  CHECK(distance(place_at(move, 0, {3, 1, 0}), {3, 1, 0}) == 0);
  CHECK(distance(place_at(move, 1, {3, 1, 0}), {1, 3, 5}) < 1e-15 * 10);
  CHECK(distance(place_at(move, 2, {3, 1, 0}), {-1, 1, 10}) < 1e-15 * 10);
  CHECK(distance(place_at(move, 7, {1, 1, 0}), {1, 1, 10}) < 1e-15 * 10);  // on the axis
  move.rotations = {{0, 0, 0}, {2 * kPi / 3, 2 * kPi / 3, 2 * kPi / 3}};
  move.rotations[1].x /= std::sqrt(3), move.rotations[1].y /= std::sqrt(3);
  move.rotations[1].z /= std::sqrt(3);
  move.about = {};
  move.translations[1] = {};
  CHECK(distance(place_at(move, 2, {1, 2, 3}), {3, 1, 2}) < 1e-14);  // a third of a turn
}

TEST_CASE("whatever turns keeps its distances, and what does not turn keeps every bit") {
  const PinMove move{.particles = {0},
                     .times = {0, 1},
                     .translations = {{0, 0, 0}, {1, 2, 3}},
                     .rotations = {{0, 0, 0}, {30, -4, 1e-9}},
                     .about = {0.3, 1.0 / 3, -7}};
  const Vec3 a{0.1, 0.7, -1.0 / 3}, b{5, -2, 1e-3};
  for (const double time : {1e-12, 0.01, 0.3, 0.999}) {
    CHECK(distance(place_at(move, time, a), place_at(move, time, b)) ==
          doctest::Approx(distance(a, b)).epsilon(1e-14));
  }
  CHECK(distance(place_at(move, 0, a), a) == 0);
  CHECK(distance(place_at(move, -1, b), b) == 0);
}

/// Two pins and a particle that hangs by each.
SceneDescription two_lines() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {1, -1, 0}};
  scene.masses = {1, 1, 1, 1};
  scene.fixed = {0, 1};
  scene.constraints = {{0, 2, 1}, {1, 3, 1}};
  return scene;
}

Cloth cloth_of(const SceneDescription& scene) {
  auto cloth = Cloth::create(build_model(scene).value(), {});
  REQUIRE(cloth);
  return std::move(cloth.value());
}

TEST_CASE("pins are sent where their moves have them, each by its own") {
  const std::vector<PinMove> moves{
      {.particles = {1}, .times = {0, 1}, .translations = {{0, 0, 0}, {0, 1, 0}}},
      {.particles = {0}, .times = {0}, .translations = {{0, 0, 0}}, .from = {{0.5, 0, 0}}}};
  Cloth cloth = cloth_of(two_lines());
  const MovedPins pins(moves, cloth);
  for (const double time : {0.25, 0.5, 2.0}) {
    REQUIRE(pins.send(cloth, time));
    CHECK(distance(cloth.position(1), {1, std::min(time, 1.0), 0}) == 0);
    CHECK(distance(cloth.position(0), {0.5, 0, 0}) == 0);
  }
}

TEST_CASE("who does not stand in the first pose is placed there, and moves no cloth by that") {
  const std::vector<PinMove> moves{
      {.particles = {1}, .times = {0, 1}, .translations = {{0, 2, 0}, {0, 3, 0}}},
      {.particles = {0}, .times = {-1, 1}, .translations = {{0, 0, 0}, {0, 1, 0}}}};
  Cloth cloth = cloth_of(two_lines());
  REQUIRE(cloth.set_gravity({0, 0, 0}));
  const MovedPins pins(moves, cloth);
  REQUIRE(pins.place(cloth));
  CHECK(distance(cloth.position(1), {1, 2, 0}) == 0);
  CHECK(distance(cloth.position(0), {0, 0.5, 0}) == 0);
  const auto report = cloth.step(0.01);
  REQUIRE(report);
  CHECK(report.value().pin_work == 0);
  CHECK(distance(cloth.velocity(2), {}) < 1e-3);
  CHECK(distance(cloth.velocity(3), {}) < 1e-3);
}

TEST_CASE("what does not move is not sent") {
  const std::vector<PinMove> moves{{.particles = {0, 1},
                                    .times = {0, 1},
                                    .translations = {{0, 0, 0}, {0, 0, 0}},
                                    .rotations = {{0, 0, 0}, {0, 0, 0}},
                                    .about = {0.1, 0.2, 0.3}}};
  Cloth cloth = cloth_of(two_lines());
  const std::size_t bytes = cloth.bytes();
  REQUIRE(MovedPins(moves, cloth).send(cloth, 0.5));
  CHECK(cloth.bytes() == bytes);  // no pin is watched
}

TEST_CASE("who cannot be sent is told") {
  Cloth cloth = cloth_of(two_lines());
  const std::vector<PinMove> free{{.particles = {2}, .times = {0}, .translations = {{1, 0, 0}}}};
  CHECK(MovedPins(free, cloth).send(cloth, 1).error() == "particle: is not fixed (2)");
  const std::vector<PinMove> far{
      {.particles = {0}, .times = {0, 1}, .translations = {{-1e308, 0, 0}, {1e308, 0, 0}}}};
  CHECK_FALSE(MovedPins(far, cloth).send(cloth, 0.5));
}

TEST_CASE("moves of a later start lead through the same places") {
  const SceneDescription scene = two_lines();
  const std::vector<PinMove> moves{{.particles = {1, 0},
                                    .times = {0, 1, 3},
                                    .translations = {{0, 0, 0}, {1, 0, 0}, {1, 5, 0}},
                                    .rotations = {{0, 0, 0}, {0, 1, 0}, {2, 0, 0}},
                                    .about = {0, 3, 0}}};
  const std::vector<PinMove> later = present_moves(moves, scene, 0.75);
  REQUIRE(later.size() == 1);
  CHECK(later[0].times == std::vector<double>{-0.75, 0.25, 2.25});
  REQUIRE(later[0].from.size() == 2);
  CHECK(distance(later[0].from[0], {1, 0, 0}) == 0);
  CHECK(distance(later[0].from[1], {0, 0, 0}) == 0);
  for (const double time : {0.75, 0.875, 1.5, 2.75, 9.0}) {
    const Vec3 x = scene.positions[1];
    CHECK(distance(place_at(moves[0], time, x), place_at(later[0], time - 0.75, x)) == 0);
  }
  const std::vector<PinMove> last = present_moves(later, {}, 0.25);  // from is known
  CHECK(last[0].times == std::vector<double>{-1, 0, 2});
  CHECK(distance(last[0].from[0], {1, 0, 0}) == 0);
}

TEST_CASE("of times that a long run brings together the later stays") {
  const std::vector<PinMove> moves{{.particles = {0},
                                    .times = {0, 1e-9, 2e-9, 1e9},
                                    .translations = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}},
                                    .rotations = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}}};
  const PinMove later = present_moves(moves, two_lines(), 5e8)[0];
  CHECK(later.times == std::vector<double>{-5e8, 5e8});
  REQUIRE(later.translations.size() == 2);
  REQUIRE(later.rotations.size() == 2);
  CHECK(later.translations[0].x == 3);
  CHECK(later.rotations[0].x == 3);
  CHECK(later.translations[1].x == 4);
}

}  // namespace
}  // namespace weft::tools
