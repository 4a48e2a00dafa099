#include "tools/program/formats/scene_parts.h"

#include <fmt/format.h>
#include <weft/scene_fields.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/program/files/json_reading.h"

namespace weft::tools {
namespace {

// --------------------------------------------------------------------------------------- reading

void read_value(const Json& json, const std::string& place, Values values, double& value) {
  const bool may_be_infinite =
      values == Values::positive_or_infinite || values == Values::not_negative_or_infinite;
  if (may_be_infinite && json.is_null())  // JSON has no number for it.
    value = std::numeric_limits<double>::infinity();
  else
    value = read_number(json, place);
}

void read_value(const Json& json, const std::string& place, Values, std::uint32_t& particle) {
  particle = read_index(json, place);
}

void read_value(const Json& json, const std::string& place, Values, Vec3& vector) {
  vector = read_vector(json, place);
}

void read_value(const Json& json, const std::string& place, Values, ConstraintKind& kind) {
  if (json != "distance" && json != "rope") refuse(place, "\"distance\" or \"rope\"", json);
  kind = json == "rope" ? ConstraintKind::rope : ConstraintKind::distance;
}

void read_value(const Json& json, const std::string& place, Values,
                std::array<std::uint32_t, 3>& triangle) {
  triangle = read_triangle(json, place);
}

void read_value(const Json& json, const std::string& place, Values, bool& value) {
  if (!json.is_boolean()) refuse(place, "true or false", json);
  value = json;
}

void read_value(const Json& json, const std::string& place, Values,
                std::vector<std::uint32_t>& list) {
  list = read_array(json, place, read_index);
}

void read_value(const Json& json, const std::string& place, Values,
                std::vector<std::array<std::uint32_t, 3>>& triangles) {
  triangles = read_array(json, place, read_triangle);
}

using Place = std::array<double, 2>;
Place read_pair(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() != 2) refuse(place, "[along warp, along weft]", json);
  return {read_number(json[0], place + "[0]"), read_number(json[1], place + "[1]")};
}

void read_value(const Json& json, const std::string& place, Values, std::array<Place, 3>& corners) {
  const auto given = read_array(json, place, read_pair);
  if (given.size() != corners.size()) refuse(place, "three corners", json);
  std::ranges::copy(given, corners.begin());
}

/// Three particles, or four.
using Four = std::array<std::uint32_t, 4>;
void read_value(const Json& json, const std::string& place, Values, Four& particles) {
  const auto given = read_array(json, place, read_index);
  if (given.size() != 3 && given.size() != 4) refuse(place, "three or four", json);
  particles[3] = kNoIndex;
  std::ranges::copy(given, particles.begin());
}

/// One for each particle of four.
void read_value(const Json& json, const std::string& place, Values,
                std::array<double, 4>& weights) {
  const auto given = read_array(json, place, read_number);
  if (given.size() > weights.size()) refuse(place, "as many as particles", json);
  std::ranges::copy(given, weights.begin());
}

void check(const Json&, const std::string&, const auto&) {}
void check(const Json& json, const std::string& place, const BendingElement&) {
  if (json["weights"].size() != json["particles"].size())
    refuse(within(place, "weights"), "as many as particles", json["weights"]);
}

/// visit(field) with each field.
template <class T, class Visit>
void for_each_field(Visit&& visit) {
  for_each_element_field<T>(visit);
  for_each_part_field<T>(visit);
}

/// What is left out is as in `value`.
template <class T>
T read_fields(const Json& json, const std::string& place, T value) {
  Keys known, needed;
  for_each_field<T>([&](const auto& field) {
    known.push_back(field.name);
    if (field.given == Given::always) needed.push_back(field.name);
  });
  check_keys(json, place, known, needed);
  for_each_field<T>([&](const auto& field) {
    if (!json.contains(field.name)) return;
    read_value(json[field.name], within(place, field.name), field.values, value.*field.member);
  });
  check(json, place, value);
  return value;
}

template <class T>
T read_fields_of(const Json& json, const std::string& place) {
  return read_fields(json, place, T{});
}

double read_rest_length(const Json& json, const std::string& place) {
  if (json.is_null()) return kMeasured;
  const double length = read_number(json, place);
  if (!(length > 0)) refuse(place, "a length above 0", json);
  return length;
}

/// There are many of them: their fields are a row.
template <>
Constraint read_fields_of(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() < 2 || json.size() > 6)
    refuse(place, "[a, b, rest length, kind, compliance, strength]", json);
  Constraint constraint;
  constraint.a = read_index(json[0], place + "[0]");
  constraint.b = read_index(json[1], place + "[1]");
  constraint.rest_length = json.size() > 2 ? read_rest_length(json[2], place + "[2]") : kMeasured;
  if (json.size() > 3) read_value(json[3], place + "[3]", Values::kind, constraint.kind);
  if (json.size() > 4) constraint.compliance = read_number(json[4], place + "[4]");
  if (json.size() > 5) {
    read_value(json[5], place + "[5]", Values::not_negative_or_infinite, constraint.strength);
  }
  return constraint;
}

// --------------------------------------------------------------------------------------- writing

Json json_of(double value) { return std::isinf(value) ? Json() : Json(value); }
Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }
Json json_of(ConstraintKind kind) { return kind == ConstraintKind::rope ? "rope" : "distance"; }
Json json_of(const auto& value) { return value; }

void shorten(Json&, const auto&) {}
void shorten(Json& row, const BendingElement& element) {
  if (element.particles[3] != kNoIndex) return;
  for (const char* key : {"particles", "weights"}) row[key].erase(3);
}

/// With the fields that must be given, or are not as in `without`.
template <class T>
std::string fields_text(const T& value, const T& without) {
  Json row = Json::object();
  for_each_field<T>([&](const auto& field) {
    Json its = json_of(value.*field.member);
    if (field.given == Given::always || its != json_of(without.*field.member))
      row[field.name] = std::move(its);
  });
  shorten(row, value);
  return row.dump();
}

template <class T>
std::string row_of(const T& value) {
  return fields_text(value, T{});
}

template <>
std::string row_of(const Constraint& constraint) {
  Json row{constraint.a, constraint.b, constraint.rest_length};
  const bool may_break = !std::isinf(constraint.strength);
  const bool is_spring = constraint.compliance > 0 || may_break;
  if (constraint.kind == ConstraintKind::rope || is_spring) row.push_back(json_of(constraint.kind));
  if (is_spring) row.push_back(constraint.compliance);
  if (may_break) row.push_back(constraint.strength);
  return row.dump();
}

template <class T>
bool is_usual(const T& part) {
  return fields_text(part, T{}) == "{}";
}

/// What a file says of the contact of cloth with itself turns it on.
constexpr SelfContact kTouchesItself{.on = true};

bool read_elements(const std::string& key, const Json& json, SceneDescription& scene) {
  bool is_known = false;
  for_each_element_kind([&]<class Element>(const ElementKind<Element>& kind) {
    if (key != kind.name) return;
    scene.*kind.list = read_array(json, key, read_fields_of<Element>);
    is_known = true;
  });
  return is_known;
}

bool read_field_of_scene(const std::string& key, const Json& json, SceneDescription& scene) {
  bool is_known = false;
  for_each_part_field<SceneDescription>([&](const auto& field) {
    if (key != field.name) return;
    read_value(json, key, field.values, scene.*field.member);
    is_known = true;
  });
  return is_known;
}

}  // namespace

std::array<std::uint32_t, 3> read_triangle(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() != 3) refuse(place, "[a, b, c]", json);
  const auto corners = read_array(json, place, read_index);
  return {corners[0], corners[1], corners[2]};
}

bool read_part(const std::string& key, const Json& json, SceneDescription& scene) {
  if (key == "damping")
    scene.damping = read_fields_of<Damping>(json, key);
  else if (key == "air")
    scene.air = read_fields_of<Air>(json, key);
  else if (key == "pressures")
    scene.pressures = read_array(json, key, read_fields_of<Pressure>);
  else if (key == "self_contact")
    scene.self_contact = read_fields(json, key, kTouchesItself);
  else
    return read_elements(key, json, scene) || read_field_of_scene(key, json, scene);
  return true;
}

std::string parts_text(const SceneDescription& scene) {
  std::string text;
  const auto add = [&](std::string_view key, const std::string& value) {
    text += fmt::format(",\n\"{}\": {}", key, value);
  };
  for_each_element_kind([&]<class Element>(const ElementKind<Element>& kind) {
    add_rows(text, kind.name, scene.*kind.list, row_of<Element>);
  });
  if (!is_usual(scene.damping)) add("damping", row_of(scene.damping));
  if (!is_usual(scene.air)) add("air", row_of(scene.air));
  add_rows(text, "pressures", scene.pressures, row_of<Pressure>);
  if (!is_usual(scene.self_contact))
    add("self_contact", fields_text(scene.self_contact, kTouchesItself));
  for_each_part_field<SceneDescription>([&](const auto& field) {
    const Json its = json_of(scene.*field.member);
    if (field.given == Given::always || its != json_of(SceneDescription{}.*field.member))
      add(field.name, its.dump());
  });
  return text;
}

}  // namespace weft::tools
