/// Scenes that are written and read.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>

#include "tools/program/formats/scene_file.h"
#include "tools/scenes/scenes.h"

namespace weft::test::scene_texts {

inline bool same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

inline bool same(const Constraint& a, const Constraint& b) {
  return a.a == b.a && a.b == b.b && a.rest_length == b.rest_length && a.kind == b.kind;
}

template <class Value>
inline bool same(const std::vector<Value>& a, const std::vector<Value>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Value& x, const Value& y) { return same(x, y); });
}

inline void check_same_material(const SceneDescription& a, const SceneDescription& b) {
  REQUIRE(a.bending.size() == b.bending.size());
  for (std::size_t i = 0; i < a.bending.size(); ++i) {
    CHECK(a.bending[i].particles == b.bending[i].particles);
    CHECK(a.bending[i].weights == b.bending[i].weights);
    CHECK(a.bending[i].rest == b.bending[i].rest);
    CHECK(a.bending[i].fold == b.bending[i].fold);
    CHECK(a.bending[i].yield == b.bending[i].yield);
    CHECK(a.bending[i].hardening == b.bending[i].hardening);
    CHECK(a.bending[i].arm == b.bending[i].arm);
    CHECK(a.bending[i].compliance == b.bending[i].compliance);
  }
  CHECK(a.damping.stretch == b.damping.stretch);
  CHECK(a.damping.bending == b.damping.bending);
  REQUIRE(a.anchors.size() == b.anchors.size());
  for (std::size_t i = 0; i < a.anchors.size(); ++i) {
    CHECK(a.anchors[i].particle == b.anchors[i].particle);
    CHECK(same(a.anchors[i].point, b.anchors[i].point));
    CHECK(same(a.anchors[i].normal, b.anchors[i].normal));
    CHECK(a.anchors[i].max_distance == b.anchors[i].max_distance);
    CHECK(a.anchors[i].backstop_distance == b.anchors[i].backstop_distance);
    CHECK(a.anchors[i].backstop_radius == b.anchors[i].backstop_radius);
  }
  CHECK(a.damping.motion == b.damping.motion);
  CHECK(a.air.triangles == b.air.triangles);
  CHECK(a.air.density == b.air.density);
  CHECK(a.air.drag == b.air.drag);
  CHECK(a.air.lift == b.air.lift);
  CHECK(a.air.ram == b.air.ram);
  CHECK(a.pressures == b.pressures);
  CHECK(same(a.air.wind, b.air.wind));
}

inline void check_same(const SceneDescription& a, const SceneDescription& b) {
  check_same_material(a, b);
  CHECK(same(a.gravity, b.gravity));
  CHECK(same(a.positions, b.positions));
  CHECK(same(a.velocities, b.velocities));
  CHECK(same(a.constraints, b.constraints));
  CHECK(a.masses == b.masses);
  CHECK(a.fixed == b.fixed);
  CHECK(a.spheres == b.spheres);
  CHECK(a.radii == b.radii);
  CHECK(a.surface == b.surface);
}

/// The error of a scene of two particles with one more key, or with the text as it is.
inline std::string error_of(const std::string& text) {
  const auto scene = tools::parse_scene(text);
  REQUIRE_FALSE(scene);
  return scene.error();
}
inline std::string error_with(const std::string& more) {
  return error_of(R"({"positions": [[0,0,0],[3,4,0]], "total_mass": 1, )" + more + "}");
}

inline void check_same(const tools::PinMove& a, const tools::PinMove& b) {
  CHECK(a.particles == b.particles);
  CHECK(a.times == b.times);
  CHECK(same(a.translations, b.translations));
  CHECK(same(a.rotations, b.rotations));
  CHECK(same(a.about, b.about));
  CHECK(same(a.from, b.from));
}

}  // namespace weft::test::scene_texts
