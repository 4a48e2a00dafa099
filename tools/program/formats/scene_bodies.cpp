#include "tools/program/formats/scene_bodies.h"

#include <fmt/format.h>
#include <weft/shape_fields.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/bodies/body_mass.h"
#include "engine/validation.h"
#include "tools/program/files/json_reading.h"
#include "tools/program/formats/body_files.h"

namespace weft::tools {
namespace {

/// The keys of an entry, of which each is to be asked for or is unknown.
class Entry {
 public:
  Entry(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json.is_object()) refuse(place_, "an object", json);
  }
  bool has(std::string_view key) {
    known_.emplace_back(key);
    return json_.contains(key);
  }
  const Json& needed(std::string_view key) {
    if (!has(key)) throw Refused{fmt::format("{}: the key '{}' is missing", place_, key)};
    return json_[std::string(key)];
  }
  std::string place(std::string_view key) const { return within(place_, key); }
  double number(std::string_view key) { return read_number(needed(key), place(key)); }
  double number(std::string_view key, double without) { return has(key) ? number(key) : without; }
  bool flag(std::string_view key) {
    const Json& value = needed(key);
    if (!value.is_boolean()) refuse(place(key), "true or false", value);
    return value.get<bool>();
  }
  Vec3 vector(std::string_view key) { return read_vector(needed(key), place(key)); }
  Vec3 vector(std::string_view key, Vec3 without) { return has(key) ? vector(key) : without; }
  void check_keys() const {
    for (const auto& [key, value] : json_.items()) {
      if (std::ranges::find(known_, key) == known_.end())
        throw Refused{fmt::format("{}: unknown key {}", place_, in_quotes(key))};
    }
  }

 private:
  const Json& json_;
  std::string place_;
  std::vector<std::string> known_;
};

std::vector<double> read_times(Entry& entry) {
  const Json& json = entry.needed("times");
  auto times = read_array(json, entry.place("times"), read_number);
  if (times.empty() || !std::ranges::is_sorted(times, std::ranges::less_equal()))
    refuse(entry.place("times"), "times, each after the one before", json);
  return times;
}

PinMove read_move(const Json& json, const std::string& place) {
  Entry entry(json, place);
  PinMove move;
  move.times = read_times(entry);
  move.translations =
      read_array(entry.needed("translations"), entry.place("translations"), read_vector);
  if (entry.has("rotations"))
    move.rotations = read_array(json["rotations"], entry.place("rotations"), read_vector);
  move.about = entry.vector("about", {});
  entry.check_keys();
  for (const auto& [key, count] : {std::pair{"translations", move.translations.size()},
                                   std::pair{"rotations", move.rotations.size()}}) {
    if (count == move.times.size() || (key == std::string_view("rotations") && count == 0))
      continue;
    throw Refused{fmt::format("{}: expected as many as times, {}, not {}", within(place, key),
                              move.times.size(), count)};
  }
  return move;
}

std::array<std::uint32_t, 3> read_corners(const Json& json, const std::string& place) {
  const auto corners = read_array(json, place, read_index);
  if (corners.size() != 3) refuse(place, "three vertices", json);
  return {corners[0], corners[1], corners[2]};
}

/// One that a message can repeat in its line.
bool is_file_name(const Json& json) {
  constexpr std::size_t kLongest = 500;
  if (!json.is_string()) return false;
  const auto name = json.get<std::string>();
  const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == 0x7f; };
  return name.size() <= kLongest && std::ranges::none_of(name, is_control);
}

TriangleMesh read_mesh(Entry& entry, const std::string& folder) {
  TriangleMesh mesh;
  if (entry.has("file")) {
    const Json& file = entry.needed("file");
    if (!is_file_name(file)) refuse(entry.place("file"), "the name of an .obj file", file);
    auto read = read_body_mesh(std::filesystem::path(folder) / file.get<std::string>(), 1);
    if (!read) throw Refused{fmt::format("{}: {}", entry.place("file"), read.error())};
    mesh = std::move(read.value());
  } else {
    mesh.vertices = read_array(entry.needed("vertices"), entry.place("vertices"), read_vector);
    mesh.triangles = read_array(entry.needed("triangles"), entry.place("triangles"), read_corners);
  }
  if (entry.has("two_sided")) mesh.two_sided = entry.flag("two_sided");
  return mesh;
}

/// So many vertices.
VertexMove read_vertex_move(const Json& json, const std::string& place, std::size_t vertices) {
  Entry entry(json, place);
  VertexMove move;
  move.times = read_times(entry);
  move.vertices = read_array(
      entry.needed("vertices"), entry.place("vertices"),
      [](const Json& row, const std::string& at) { return read_array(row, at, read_vector); });
  entry.check_keys();
  if (move.vertices.size() != move.times.size()) {
    throw Refused{fmt::format("{}: expected as many as times, {}, not {}", entry.place("vertices"),
                              move.times.size(), move.vertices.size())};
  }
  for (std::size_t i = 0; i < move.vertices.size(); ++i) {
    if (move.vertices[i].size() == vertices) continue;
    throw Refused{fmt::format("{}[{}]: expected the vertices of the mesh, {}, not {}",
                              entry.place("vertices"), i, vertices, move.vertices[i].size())};
  }
  return move;
}

// The fields of shapes, by their types.

void read_field(const Json& json, const std::string& place, double& to) {
  to = read_number(json, place);
}
void read_field(const Json& json, const std::string& place, std::uint32_t& to) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > UINT32_MAX)
    refuse(place, "a whole number", json);
  to = json.get<std::uint32_t>();
}
void read_field(const Json& json, const std::string& place, Vec3& to) {
  to = read_vector(json, place);
}
void read_field(const Json& json, const std::string& place, std::vector<double>& to) {
  to = read_array(json, place, read_number);
}
void read_field(const Json& json, const std::string& place, std::vector<Vec3>& to) {
  to = read_array(json, place, read_vector);
}

template <class Shape>
Shape read_fields(Entry& entry) {
  Shape shape;
  for_each_part_field<Shape>([&](const auto& field) {
    if constexpr (requires { read_field(Json(), "", shape.*field.member); }) {
      if (field.given == Given::always || entry.has(field.name))
        read_field(entry.needed(field.name), entry.place(field.name), shape.*field.member);
    }
  });
  return shape;
}

ShapeDescription read_shape(Entry& entry, const std::string& folder) {
  const Json& name = entry.needed("shape");
  if (name == "box") return box(entry.vector("size"));
  if (name == kShapeKind<TriangleMesh>.name) return read_mesh(entry, folder);
  if (name == kShapeKind<Capsule>.name && entry.has("radius")) {
    const double radius = entry.number("radius");
    return Capsule{entry.vector("a"), entry.vector("b"), radius, radius};
  }
  std::optional<ShapeDescription> shape;
  std::string names;
  for_each_shape([&]<class Shape> {
    names += std::string(kShapeKind<Shape>.name) + ", ";
    if (name == kShapeKind<Shape>.name) shape = read_fields<Shape>(entry);
  });
  if (!shape) refuse(entry.place("shape"), names + "or box", name);
  return *shape;
}

/// One that is full, of a mass in kg.
BodyMass full_body(const BodyShape& shape, double mass, const std::string& place) {
  const auto of_one = mass_of(shape, 1);
  if (!of_one) throw Refused{fmt::format("{}.{}", place, of_one.error())};
  if (auto r = validate_positive("mass", mass); !r)
    throw Refused{fmt::format("{}.{}", place, r.error())};
  BodyMass full = of_one.value();
  const double times = mass / full.mass;
  for (double& element : full.inertia) element *= times;
  full.mass = mass;
  return full;
}

/// place: of the body.
BodyMass read_spread_mass(const Json& json, const BodyShape& shape, const std::string& place) {
  Entry entry(json, within(place, "mass"));
  BodyMass mass = full_body(shape, entry.number("mass"), place);
  mass.centre = entry.vector("centre", mass.centre);
  const auto inertia = read_array(entry.needed("inertia"), entry.place("inertia"), read_number);
  if (inertia.size() != mass.inertia.size())
    refuse(entry.place("inertia"), "xx, yy, zz, yz, zx and xy", json["inertia"]);
  std::ranges::copy(inertia, mass.inertia.begin());
  entry.check_keys();
  return mass;
}

/// The mass of a body that moves by itself, and its velocity.
void read_mass(Entry& entry, const BodyShape& shape, const std::string& place, SceneBody& body) {
  const bool has_mass = entry.has("mass"), has_density = entry.has("density");
  if (!has_mass && !has_density) {
    for (const char* key : {"velocity", "spin"}) {
      if (entry.has(key)) throw Refused{entry.place(key) + ": is of a body with a mass alone"};
    }
    return;
  }
  if (has_mass && has_density)
    throw Refused{fmt::format("{}: expected one of the keys 'mass' and 'density'", place)};
  if (body.move) throw Refused{entry.place("moves") + ": a body with a mass moves by itself"};
  if (has_density) {
    const auto mass = mass_of(shape, entry.number("density"));
    if (!mass) throw Refused{fmt::format("{}.{}", place, mass.error())};
    body.mass = mass.value();
  } else if (const Json& mass = entry.needed("mass"); mass.is_object()) {
    body.mass = read_spread_mass(mass, shape, place);
  } else {
    body.mass = full_body(shape, entry.number("mass"), place);
  }
  if (const auto valid = validate(*body.mass); !valid)
    throw Refused{fmt::format("{}.{}", place, valid.error())};
  body.velocity = {entry.vector("velocity", {}), entry.vector("spin", {})};
}

SceneBody read_body(const Json& json, const std::string& place, const std::string& folder) {
  Entry entry(json, place);
  SceneBody body;
  body.shape = read_shape(entry, folder);
  const auto built = build_shape(body.shape);
  if (!built) throw Refused{fmt::format("{}.{}", place, built.error())};
  body.position = entry.vector("position", {});
  body.rotation = entry.vector("rotation", {});
  body.thickness = entry.number("thickness", body.thickness);
  body.friction = entry.number("friction", body.friction);
  if (entry.has("moves")) body.move = read_move(json["moves"], entry.place("moves"));
  read_mass(entry, *built.value(), place, body);
  const auto* mesh = std::get_if<TriangleMesh>(&body.shape);
  if (mesh && entry.has("vertex_moves")) {
    body.vertex_move =
        read_vertex_move(json["vertex_moves"], entry.place("vertex_moves"), mesh->vertices.size());
  }
  entry.check_keys();
  return body;
}

Json row(Vec3 v) { return {v.x, v.y, v.z}; }
Json rows(const std::vector<Vec3>& vectors) {
  Json array = Json::array();
  for (const Vec3 v : vectors) array.push_back(row(v));
  return array;
}

Json value_json(Vec3 v) { return row(v); }
Json value_json(const std::vector<Vec3>& vectors) { return rows(vectors); }
Json value_json(const auto& value) { return value; }

template <class Shape>
Json shape_json(const Shape& shape) {
  Json json{{"shape", kShapeKind<Shape>.name}};
  for_each_part_field<Shape>(
      [&](const auto& field) { json[field.name] = value_json(shape.*field.member); });
  return json;
}

}  // namespace

std::vector<SceneBody> read_bodies(const Json& json, const std::string& folder) {
  return read_array(json, "bodies", [&](const Json& entry, const std::string& place) {
    return read_body(entry, place, folder);
  });
}

std::string body_row(const SceneBody& body) {
  Json json = std::visit([](const auto& shape) { return shape_json(shape); }, body.shape);
  json["position"] = row(body.position);
  json["rotation"] = row(body.rotation);
  json["thickness"] = body.thickness;
  json["friction"] = body.friction;
  if (body.move) {
    json["moves"] = {{"times", body.move->times},
                     {"translations", rows(body.move->translations)},
                     {"about", row(body.move->about)}};
    if (!body.move->rotations.empty()) json["moves"]["rotations"] = rows(body.move->rotations);
  }
  if (body.mass) {
    json["mass"] = {{"mass", body.mass->mass},
                    {"centre", row(body.mass->centre)},
                    {"inertia", body.mass->inertia}};
    json["velocity"] = row(body.velocity.linear);
    json["spin"] = row(body.velocity.angular);
  }
  if (body.vertex_move) {
    Json& moves = json["vertex_moves"];
    moves["times"] = body.vertex_move->times;
    moves["vertices"] = Json::array();
    for (const auto& vertices : body.vertex_move->vertices)
      moves["vertices"].push_back(rows(vertices));
  }
  return json.dump();
}

}  // namespace weft::tools
