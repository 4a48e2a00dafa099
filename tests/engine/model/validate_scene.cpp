/// Every description that build_model refuses, and that it says which field, index and value.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>

#include "tests/support/clothes.h"

namespace weft::test::engine_model_validate_scene {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Spoil = std::function<void(SceneDescription&)>;

/// A scene with something in every field; it builds.
SceneDescription full_scene() {
  SceneDescription scene = scene_of("hang_sphere", 4);
  scene.velocities.assign(scene.positions.size(), Vec3{});
  scene.constraints.push_back({5, 15, 1.0, ConstraintKind::rope, 1e-3});
  scene.membrane.push_back({{0, 1, 4}, {{{0, 0}, {1, 0}, {0, 1}}}, 4000, 3000, 60});
  scene.bending.push_back({{0, 1, 2, kNoIndex}, {1, -2, 1, 0}, 0, 1});
  scene.damping = {0.01, 0.01, 0.1};
  scene.air = {{{0, 1, 4}}, 1.2, 1, 0.5, {1, 0, 0}};
  for (const std::uint32_t i : {7u, 9u})
    scene.anchors.push_back({i, scene.positions[i], {0, 1, 0}, 0.1, 0.01, 0.2});
  return scene;
}

/// One line, with every one of `parts` in it.
void check_refused(const Spoil& spoil, std::initializer_list<const char*> parts) {
  SceneDescription scene = full_scene();
  spoil(scene);
  const auto model = build_model(scene);
  REQUIRE_FALSE(model);
  const std::string& message = model.error();
  CAPTURE(message);
  CHECK(message.find('\n') == std::string::npos);
  for (const char* part : parts) {
    CAPTURE(std::string(part));
    CHECK(message.find(part) != std::string::npos);
  }
}

TEST_CASE("the scene to be spoilt is a good one") { CHECK(build_model(full_scene())); }

TEST_CASE("a scene without particles is refused") {
  const auto model = build_model({});
  REQUIRE_FALSE(model);
  CHECK(model.error().find("positions") != std::string::npos);
}

TEST_CASE("vectors that are not finite are refused, whichever component it is") {
  using Member = double Vec3::*;
  for (const Member component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    check_refused([=](auto& s) { s.positions[3].*component = kNan; }, {"positions[3]", "nan"});
    check_refused([=](auto& s) { s.positions[16].*component = -kInfinity; },
                  {"positions[16]", "-inf"});
    check_refused([=](auto& s) { s.velocities[9].*component = kNan; }, {"velocities[9]", "nan"});
    check_refused([=](auto& s) { s.velocities[0].*component = kInfinity; },
                  {"velocities[0]", "inf"});
    check_refused([=](auto& s) { s.gravity.*component = kNan; }, {"gravity", "nan"});
    check_refused([=](auto& s) { s.gravity.*component = kInfinity; }, {"gravity", "inf"});
  }
}

TEST_CASE("masses must be finite and positive, one per particle") {
  check_refused([](auto& s) { s.masses[7] = 0; }, {"masses[7]", "0"});
  check_refused([](auto& s) { s.masses[7] = -2.5; }, {"masses[7]", "-2.5"});
  check_refused([](auto& s) { s.masses[7] = kNan; }, {"masses[7]", "nan"});
  check_refused([](auto& s) { s.masses[0] = kInfinity; }, {"masses[0]", "inf"});
  check_refused([](auto& s) { s.masses.pop_back(); }, {"masses", "17", "16"});
  check_refused([](auto& s) { s.masses.push_back(1); }, {"masses", "17", "18"});
  check_refused([](auto& s) { s.masses.clear(); }, {"masses", "17", "0"});
}

TEST_CASE("masses whose inverses cannot be added or squared are refused") {
  for (const double mass : {1e-310, 1e-308, 1e-160, 0.9e-150, 1.1e150, 1e160, 1e308}) {
    check_refused([&](auto& s) { s.masses[7] = mass; }, {"masses[7]", "squared"});
  }
  SceneDescription scene = full_scene();
  scene.masses[6] = 1e-150;
  scene.masses[7] = 1e150;
  CHECK(build_model(scene));
}

TEST_CASE("velocities are none or one per particle") {
  check_refused([](auto& s) { s.velocities.pop_back(); }, {"velocities", "17", "16"});
  check_refused([](auto& s) { s.velocities.push_back({}); }, {"velocities", "17", "18"});
  SceneDescription scene = full_scene();
  scene.velocities.clear();
  CHECK(build_model(scene));
}

TEST_CASE("fixed particles must exist, once") {
  check_refused([](auto& s) { s.fixed[2] = 17; }, {"fixed[2]", "17"});
  check_refused([](auto& s) { s.fixed[2] = 0xffffffffu; }, {"fixed[2]", "4294967295"});
  check_refused([](auto& s) { s.fixed.push_back(3); }, {"fixed[5]", "3"});
}

TEST_CASE("constraints must join two particles that exist") {
  check_refused([](auto& s) { s.constraints[4].a = 17; }, {"constraints[4]", ".a", "17"});
  check_refused([](auto& s) { s.constraints[4].b = 99; }, {"constraints[4]", ".b", "99"});
  check_refused([](auto& s) { s.constraints[4].b = s.constraints[4].a = 6; },
                {"constraints[4]", "6"});
}

TEST_CASE("rest lengths must be finite and positive") {
  check_refused([](auto& s) { s.constraints[4].rest_length = 0; },
                {"constraints[4]", "rest_length", "0"});
  check_refused([](auto& s) { s.constraints[4].rest_length = -0.5; },
                {"constraints[4]", "rest_length", "-0.5"});
  check_refused([](auto& s) { s.constraints[4].rest_length = kNan; },
                {"constraints[4]", "rest_length", "nan"});
  check_refused([](auto& s) { s.constraints[4].rest_length = kInfinity; },
                {"constraints[4]", "rest_length", "inf"});
}

TEST_CASE("rest lengths must have squares, and radii, all digits of them") {
  for (const double length : {1e-160, 0.9e-150, 1.1e150, 1e160}) {
    check_refused([&](auto& s) { s.constraints[4].rest_length = length; },
                  {"constraints[4]", "rest_length", "squared"});
  }
  check_refused([](auto& s) { s.radii[8] = 1e155; }, {"radii[8]", "1e+155", "1e+150"});
}

TEST_CASE("unknown kinds are refused") {
  check_refused([](auto& s) { s.constraints[4].kind = static_cast<ConstraintKind>(9); },
                {"constraints[4]", "kind", "9"});
}

TEST_CASE("only one constraint may join the same two particles, in whatever order") {
  const auto repeat = [](std::size_t which, bool swapped, ConstraintKind kind) {
    return [=](SceneDescription& s) {
      Constraint c = s.constraints[which];
      if (swapped) std::swap(c.a, c.b);
      c.kind = kind;
      s.constraints.push_back(c);
    };
  };
  for (const bool swapped : {false, true}) {
    for (const auto kind : {ConstraintKind::distance, ConstraintKind::rope}) {
      check_refused(repeat(4, swapped, kind), {"constraints[22]: ", "as constraints[4]"});
      check_refused(repeat(21, swapped, kind), {"constraints[22]: ", "as constraints[21]"});
    }
  }
}

TEST_CASE("radii come with spheres, one per particle, finite and not negative") {
  check_refused([](auto& s) { s.radii.pop_back(); }, {"radii", "17", "16"});
  check_refused([](auto& s) { s.radii.clear(); }, {"radii", "17", "0"});
  check_refused([](auto& s) { s.spheres.clear(); }, {"radii", "spheres", "17"});
  check_refused([](auto& s) { s.radii[8] = -0.1; }, {"radii[8]", "-0.1"});
  check_refused([](auto& s) { s.radii[8] = kNan; }, {"radii[8]", "nan"});
  check_refused([](auto& s) { s.radii[16] = kInfinity; }, {"radii[16]", "inf"});
}

TEST_CASE("spheres must exist, once") {
  check_refused([](auto& s) { s.spheres[0] = 17; }, {"spheres[0]", "17"});
  check_refused([](auto& s) { s.spheres.push_back(16); }, {"spheres[1]", "16"});
}

TEST_CASE("a material that is no material is refused by name, index and value") {
  check_refused([](auto& s) { s.constraints[3].compliance = -1; },
                {"constraints[3].compliance", "(-1)"});
  check_refused([](auto& s) { s.constraints[3].compliance = kNan; },
                {"constraints[3].compliance", "nan"});
  check_refused([](auto& s) { s.constraints[3].strength = -1; },
                {"constraints[3].strength", "(-1)"});
  check_refused([](auto& s) { s.constraints[3].strength = kNan; },
                {"constraints[3].strength", "nan"});
  check_refused([](auto& s) { s.bending[0].particles[1] = 999; },
                {"bending[0].particles[1]", "(999)"});
  check_refused([](auto& s) { s.bending[0].particles[1] = 0; },
                {"bending[0].particles[1]", "twice", "(0)"});
  check_refused([](auto& s) { s.bending[0].weights[1] = -1.9; }, {"bending[0].weights", "sum"});
  check_refused([](auto& s) { s.bending[0].weights = {}; }, {"bending[0].weights", "(0)"});
  check_refused([](auto& s) { s.bending[0].weights[2] = kInfinity; },
                {"bending[0].weights[2]", "(inf)"});
  check_refused([](auto& s) { s.bending[0].weights[3] = 1; },
                {"bending[0].weights[3]", "no particle", "(1)"});
  check_refused([](auto& s) { s.bending[0].rest = -1; }, {"bending[0].rest", "(-1)"});
  check_refused([](auto& s) { s.bending[0].fold = 1; },
                {"bending[0].fold", "three particles have no side", "(1)"});
  check_refused([](auto& s) { s.bending[0].fold = kNan; }, {"bending[0].fold", "nan"});
  check_refused([](auto& s) { s.bending[0].compliance = 0; }, {"bending[0].compliance", "(0)"});
  check_refused([](auto& s) { s.membrane[0].particles[2] = 999; },
                {"membrane[0].particles[2]", "(999)"});
  check_refused([](auto& s) { s.membrane[0].particles[2] = s.membrane[0].particles[0]; },
                {"membrane[0].particles[2]", "twice"});
  check_refused([](auto& s) { s.membrane[0].rest[1][0] = kNan; },
                {"membrane[0].rest[1]", "finite", "nan"});
  check_refused([](auto& s) { s.membrane[0].rest[1] = s.membrane[0].rest[0]; },
                {"membrane[0].rest[0]", "next corner", "(0)"});
  check_refused(
      [](auto& s) {
        s.membrane[0].rest = {{{0, 0}, {1, 1}, {3, 3}}};
      },
      {"membrane[0].rest", "area", "(0)"});
  check_refused([](auto& s) { s.membrane[0].warp = -1; }, {"membrane[0].warp", "(-1)"});
  check_refused([](auto& s) { s.membrane[0].weft = kInfinity; }, {"membrane[0].weft", "(inf)"});
  check_refused([](auto& s) { s.membrane[0].shear = kNan; }, {"membrane[0].shear", "(nan)"});
  check_refused([](auto& s) { s.membrane[0].kind = static_cast<ConstraintKind>(7); },
                {"membrane[0].kind", "unknown", "(7)"});
  check_refused([](auto& s) { s.damping.stretch = -1; }, {"damping.stretch", "(-1)"});
  check_refused([](auto& s) { s.damping.bending = kNan; }, {"damping.bending", "nan"});
  check_refused([](auto& s) { s.damping.motion = -2; }, {"damping.motion", "(-2)"});
  check_refused([](auto& s) { s.air.triangles[0][2] = 999; }, {"air.triangles[0][2]", "(999)"});
  check_refused([](auto& s) { s.air.triangles[0][2] = 0; }, {"air.triangles[0][2]", "twice"});
  check_refused([](auto& s) { s.air.density = -1; }, {"air.density", "(-1)"});
  check_refused([](auto& s) { s.air.lift = -1; }, {"air.lift", "(-1)"});
  check_refused([](auto& s) { s.air.triangles.clear(); }, {"air.drag", "air.triangles", "(1)"});
  check_refused([](auto& s) { s.air.wind.y = kInfinity; }, {"air.wind", "inf"});
}

TEST_CASE("anchors hold one free particle each, within limits that can be") {
  check_refused([](auto& s) { s.anchors[1].particle = 17; }, {"anchors[1].particle", "(17)"});
  check_refused([](auto& s) { s.anchors[1].particle = 7; },
                {"anchors[1].particle", "already", "(7)"});
  check_refused([](auto& s) { s.anchors[1].particle = 2; },
                {"anchors[1].particle", "fixed", "(2)"});
  check_refused([](auto& s) { s.anchors[0].point.y = kNan; }, {"anchors[0].point", "nan"});
  check_refused([](auto& s) { s.anchors[0].max_distance = -0.5; },
                {"anchors[0].max_distance", "(-0.5)"});
  check_refused([](auto& s) { s.anchors[0].max_distance = kNan; },
                {"anchors[0].max_distance", "nan"});
  check_refused([](auto& s) { s.anchors[0].backstop_distance = -1; },
                {"anchors[0].backstop_distance", "(-1)"});
  check_refused([](auto& s) { s.anchors[0].backstop_distance = kInfinity; },
                {"anchors[0].backstop_distance", "inf"});
  check_refused([](auto& s) { s.anchors[0].backstop_radius = -1; },
                {"anchors[0].backstop_radius", "(-1)"});
  check_refused([](auto& s) { s.anchors[0].backstop_radius = 1e-200; },
                {"anchors[0].backstop_radius", "1e-200"});
  check_refused([](auto& s) { s.anchors[0].normal = {}; }, {"anchors[0].normal", "a length"});
  check_refused([](auto& s) { s.anchors[0].normal.z = kNan; }, {"anchors[0].normal", "nan"});
  SceneDescription scene = full_scene();
  scene.anchors[0].normal = {0, 1.7, 0};
  scene.anchors[0].backstop_radius = scene.anchors[0].max_distance = kInfinity;
  scene.anchors[1].normal = {};
  scene.anchors[1].backstop_radius = 0;
  CHECK(build_model(scene));
}

}  // namespace
}  // namespace weft::test::engine_model_validate_scene
