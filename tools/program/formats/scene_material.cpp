#include "tools/program/formats/scene_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/program/files/json_reading.h"

namespace weft::tools {
namespace {

void check_keys(const Json& json, const std::string& place,
                std::initializer_list<std::string_view> known) {
  if (!json.is_object()) refuse(place, "an object", json);
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(known, std::string_view(key)) != known.end()) continue;
    throw Refused{fmt::format("{}: unknown key {}", place, in_quotes(key))};
  }
}

void check_given(const Json& json, const std::string& place,
                 std::initializer_list<std::string_view> needed) {
  for (const std::string_view key : needed) {
    if (json.contains(key)) continue;
    throw Refused{fmt::format("{}: the key '{}' is missing", place, key)};
  }
}

/// What is left out keeps its value.
void read_if_given(const Json& json, const std::string& place, const char* key, bool& value) {
  if (!json.contains(key)) return;
  if (!json[key].is_boolean()) refuse(within(place, key), "true or false", json[key]);
  value = json[key];
}

void read_if_given(const Json& json, const std::string& place, const char* key, double& value) {
  if (json.contains(key)) value = read_number(json[key], within(place, key));
}

/// null: infinite, for which JSON has no number.
void read_distance_if_given(const Json& json, const std::string& place, const char* key,
                            double& value) {
  if (json.contains(key) && json[key].is_null())
    value = std::numeric_limits<double>::infinity();
  else
    read_if_given(json, place, key, value);
}
Json distance_json(double value) { return std::isinf(value) ? Json() : Json(value); }

std::array<std::uint32_t, 3> read_triangle(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() != 3) refuse(place, "[a, b, c]", json);
  const auto corner = [&](std::size_t i) {
    return read_index(json[i], fmt::format("{}[{}]", place, i));
  };
  return {corner(0), corner(1), corner(2)};
}

std::array<double, 2> read_pair(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() != 2) refuse(place, "[along warp, along weft]", json);
  return {read_number(json[0], place + "[0]"), read_number(json[1], place + "[1]")};
}

}  // namespace

ConstraintKind read_kind(const Json& json, const std::string& place) {
  if (json == "distance") return ConstraintKind::distance;
  if (json == "rope") return ConstraintKind::rope;
  refuse(place, "\"distance\" or \"rope\"", json);
}

MembraneElement read_membrane(const Json& json, const std::string& place) {
  check_keys(json, place, {"particles", "rest", "warp", "weft", "shear", "kind"});
  check_given(json, place, {"particles", "rest"});
  MembraneElement element;
  element.particles = read_triangle(json["particles"], within(place, "particles"));
  const auto rest = read_array(json["rest"], within(place, "rest"), read_pair);
  if (rest.size() != 3) refuse(within(place, "rest"), "three corners", json["rest"]);
  std::ranges::copy(rest, element.rest.begin());
  read_if_given(json, place, "warp", element.warp);
  read_if_given(json, place, "weft", element.weft);
  read_if_given(json, place, "shear", element.shear);
  if (json.contains("kind")) element.kind = read_kind(json["kind"], within(place, "kind"));
  return element;
}

BendingElement read_bending(const Json& json, const std::string& place) {
  check_keys(json, place, {"particles", "weights", "rest", "compliance", "fold"});
  check_given(json, place, {"particles", "weights", "compliance"});
  const auto particles = read_array(json["particles"], within(place, "particles"), read_index);
  const auto weights = read_array(json["weights"], within(place, "weights"), read_number);
  if (particles.size() != 3 && particles.size() != 4) {
    refuse(within(place, "particles"), "three or four", json["particles"]);
  }
  if (weights.size() != particles.size()) {
    refuse(within(place, "weights"), "as many as particles", json["weights"]);
  }
  BendingElement element;
  element.particles[3] = kNoIndex;
  std::ranges::copy(particles, element.particles.begin());
  std::ranges::copy(weights, element.weights.begin());
  read_if_given(json, place, "rest", element.rest);
  read_if_given(json, place, "compliance", element.compliance);
  read_if_given(json, place, "fold", element.fold);
  return element;
}

Damping read_damping(const Json& json, const std::string& place) {
  check_keys(json, place, {"stretch", "bending", "motion"});
  Damping damping;
  read_if_given(json, place, "stretch", damping.stretch);
  read_if_given(json, place, "bending", damping.bending);
  read_if_given(json, place, "motion", damping.motion);
  return damping;
}

Air read_air(const Json& json, const std::string& place) {
  check_keys(json, place, {"triangles", "density", "drag", "lift", "ram", "wind"});
  Air air;
  if (json.contains("triangles")) {
    air.triangles = read_array(json["triangles"], within(place, "triangles"), read_triangle);
  }
  read_if_given(json, place, "density", air.density);
  read_if_given(json, place, "drag", air.drag);
  read_if_given(json, place, "lift", air.lift);
  read_if_given(json, place, "ram", air.ram);
  if (json.contains("wind")) air.wind = read_vector(json["wind"], within(place, "wind"));
  return air;
}

SelfContact read_self_contact(const Json& json, const std::string& place) {
  check_keys(json, place, {"on", "thickness", "friction", "untangle"});
  SelfContact contact{.on = true};
  read_if_given(json, place, "on", contact.on);
  read_if_given(json, place, "thickness", contact.thickness);
  read_if_given(json, place, "friction", contact.friction);
  read_if_given(json, place, "untangle", contact.untangle);
  return contact;
}

Pressure read_pressure(const Json& json, const std::string& place) {
  check_keys(json, place, {"pressure", "triangles", "gas", "volume", "ambient"});
  check_given(json, place, {"pressure"});
  Pressure part;
  read_if_given(json, place, "pressure", part.pressure);
  if (json.contains("triangles"))
    part.triangles = read_array(json["triangles"], within(place, "triangles"), read_index);
  read_if_given(json, place, "gas", part.gas);
  read_if_given(json, place, "volume", part.volume);
  read_if_given(json, place, "ambient", part.ambient);
  return part;
}

Anchor read_anchor(const Json& json, const std::string& place) {
  check_keys(
      json, place,
      {"particle", "point", "normal", "max_distance", "backstop_distance", "backstop_radius"});
  check_given(json, place, {"particle", "point"});
  Anchor anchor;
  anchor.particle = read_index(json["particle"], within(place, "particle"));
  anchor.point = read_vector(json["point"], within(place, "point"));
  if (json.contains("normal")) anchor.normal = read_vector(json["normal"], within(place, "normal"));
  read_distance_if_given(json, place, "max_distance", anchor.max_distance);
  read_if_given(json, place, "backstop_distance", anchor.backstop_distance);
  read_distance_if_given(json, place, "backstop_radius", anchor.backstop_radius);
  return anchor;
}

Seam read_seam(const Json& json, const std::string& place) {
  check_keys(json, place, {"a", "b", "time", "max_force"});
  check_given(json, place, {"a", "b"});
  Seam seam;
  seam.a = read_index(json["a"], within(place, "a"));
  seam.b = read_index(json["b"], within(place, "b"));
  read_if_given(json, place, "time", seam.time);
  read_distance_if_given(json, place, "max_force", seam.max_force);
  return seam;
}

std::string pressure_row(const Pressure& part) {
  Json row{{"pressure", part.pressure}};
  if (!part.triangles.empty()) row["triangles"] = part.triangles;
  if (part.gas) row["gas"] = true;
  if (part.volume != 0) row["volume"] = part.volume;
  if (part.ambient != Pressure{}.ambient) row["ambient"] = part.ambient;
  return row.dump();
}

std::string seam_row(const Seam& seam) {
  Json row{{"a", seam.a}, {"b", seam.b}, {"time", seam.time}};
  if (std::isfinite(seam.max_force)) row["max_force"] = seam.max_force;
  return row.dump();
}

std::string anchor_row(const Anchor& anchor) {
  const auto vector = [](Vec3 v) { return Json{v.x, v.y, v.z}; };
  Json row{{"particle", anchor.particle},
           {"point", vector(anchor.point)},
           {"max_distance", distance_json(anchor.max_distance)}};
  const Vec3 n = anchor.normal;
  if (n.x != 0 || n.y != 0 || n.z != 0) row["normal"] = vector(n);
  if (anchor.backstop_distance > 0) row["backstop_distance"] = anchor.backstop_distance;
  if (anchor.backstop_radius > 0) row["backstop_radius"] = distance_json(anchor.backstop_radius);
  return row.dump();
}

std::string membrane_row(const MembraneElement& element) {
  Json row{{"particles", element.particles}, {"rest", element.rest}};
  if (element.warp > 0) row["warp"] = element.warp;
  if (element.weft > 0) row["weft"] = element.weft;
  if (element.shear > 0) row["shear"] = element.shear;
  if (element.kind == ConstraintKind::rope) row["kind"] = "rope";
  return row.dump();
}

std::string bending_row(const BendingElement& element) {
  const std::ptrdiff_t size = element.particles[3] == kNoIndex ? 3 : 4;
  const auto first = [size](const auto& values) {
    return Json(std::vector(values.begin(), values.begin() + size));
  };
  Json row{{"particles", first(element.particles)}, {"weights", first(element.weights)}};
  if (element.rest > 0) row["rest"] = element.rest;
  row["compliance"] = element.compliance;
  if (element.fold != 0) row["fold"] = element.fold;
  return row.dump();
}

bool has_damping(const Damping& damping) {
  return damping.stretch > 0 || damping.bending > 0 || damping.motion > 0;
}

bool has_air(const Air& air) {
  const Air plain;
  return !air.triangles.empty() || air.density != plain.density || air.drag > 0 || air.lift > 0 ||
         air.ram > 0 || air.wind.x != 0 || air.wind.y != 0 || air.wind.z != 0;
}

std::string damping_text(const Damping& damping) {
  return Json{
      {"stretch", damping.stretch}, {"bending", damping.bending}, {"motion", damping.motion}}
      .dump();
}

std::string air_text(const Air& air) {
  return Json{{"triangles", air.triangles},
              {"density", air.density},
              {"drag", air.drag},
              {"lift", air.lift},
              {"ram", air.ram},
              {"wind", Json{air.wind.x, air.wind.y, air.wind.z}}}
      .dump();
}

std::string self_contact_text(const SelfContact& contact) {
  Json json{{"on", contact.on}, {"thickness", contact.thickness}, {"friction", contact.friction}};
  if (contact.untangle) json["untangle"] = true;
  return json.dump();
}

}  // namespace weft::tools
