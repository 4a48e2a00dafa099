#include "tools/program/formats/scene_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "engine/model/change.h"
#include "engine/model/model.h"
#include "engine/model/pressures.h"
#include "tools/program/files/json_reading.h"
#include "tools/program/files/text_file.h"
#include "tools/program/formats/scene_bodies.h"
#include "tools/program/formats/scene_events.h"
#include "tools/program/formats/scene_moves.h"
#include "tools/program/formats/scene_parts.h"
#include "tools/scenes/mesh.h"

namespace weft::tools {
namespace {

// --------------------------------------------------------------------------------------- reading

void measure_rest_lengths(SceneDescription& scene) {
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    Constraint& constraint = scene.constraints[i];
    if (constraint.rest_length != kMeasured) continue;
    for (const std::uint32_t end : {constraint.a, constraint.b}) {
      if (end < scene.positions.size()) continue;
      throw Refused{fmt::format("constraints[{}]: there is no particle {}", i, end)};
    }
    const Vec3 a = scene.positions[constraint.a];
    const Vec3 b = scene.positions[constraint.b];
    constraint.rest_length = std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
  }
}

void share_total_mass(SceneDescription& scene, const Json& json) {
  const double total = read_number(json, "total_mass");
  if (!(total > 0)) refuse("total_mass", "a mass above 0", json);
  const auto count = static_cast<double>(scene.positions.size());
  scene.masses.assign(scene.positions.size(), total / count);
}

std::vector<std::uint32_t> read_face(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() < 3) refuse(place, "three particles or more", json);
  return read_array(json, place, read_index);
}

Faces read_faces(const Json& json, std::size_t particles) {
  Faces faces = read_array(json, "faces", read_face);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t k = 0; k < faces[i].size(); ++k) {
      if (faces[i][k] < particles) continue;
      throw Refused{fmt::format("faces[{}][{}]: there is no particle {}", i, k, faces[i][k])};
    }
  }
  return faces;
}

void read_key(const std::string& key, const Json& json, SceneDescription& scene) {
  if (key == "positions") {
    scene.positions = read_array(json, key, read_vector);
  } else if (key == "velocities") {
    scene.velocities = read_array(json, key, read_vector);
  } else if (key == "masses") {
    scene.masses = read_array(json, key, read_number);
  } else if (key == "fixed") {
    scene.fixed = read_array(json, key, read_index);
  } else if (key == "rail_particles") {
    scene.rail_particles = read_array(json, key, read_index);
  } else if (key == "surface") {
    scene.surface = read_array(json, key, read_triangle);
  } else if (key == "spheres") {
    scene.spheres = read_array(json, key, read_index);
  } else if (key == "radii") {
    scene.radii = read_array(json, key, read_number);
  } else if (key != "total_mass" && key != "moves" && key != "faces" && key != "bodies" &&
             key != "events" && key != "rest_scale" && !read_part(key, json, scene)) {
    throw Refused{fmt::format("unknown key {}", in_quotes(key))};
  }
}

SceneFile read_scene(const Json& json, const std::string& folder) {
  if (!json.is_object()) throw Refused{"expected an object with the key 'positions'"};
  SceneDescription scene;
  for (const auto& [key, value] : json.items()) read_key(key, value, scene);
  if (!json.contains("positions")) throw Refused{"the key 'positions' is missing"};
  if (json.contains("masses") == json.contains("total_mass")) {
    throw Refused{"expected one of the keys 'masses' and 'total_mass'"};
  }
  if (json.contains("total_mass")) {
    share_total_mass(scene, json["total_mass"]);
  }
  measure_rest_lengths(scene);
  SceneFile file;
  if (json.contains("moves")) file.moves = read_moves(json["moves"], scene);
  if (json.contains("rest_scale")) file.rest_scale = read_rest_scale(json["rest_scale"]);
  if (json.contains("events")) file.events = read_events(json["events"], scene);
  if (json.contains("faces")) file.faces = read_faces(json["faces"], scene.positions.size());
  if (!json.contains("surface")) scene.surface = triangles_of(file.faces);
  if (json.contains("bodies")) file.bodies = read_bodies(json["bodies"], folder);
  file.description = std::move(scene);
  return file;
}

/// Of two values for one key the parser would drop one in silence. Only keys of the scene itself,
/// of what it has and of what is in its arrays, and theirs, are looked at: other objects are
/// refused anyway.
Json parse_once_each(std::string_view text) {
  constexpr std::size_t kDepths = 6;
  std::array<std::set<std::string>, kDepths> seen;
  return Json::parse(text, [&](int depth, Json::parse_event_t event, const Json& parsed) {
    const auto at = static_cast<std::size_t>(depth);
    if (event == Json::parse_event_t::object_start && at + 1 < kDepths) seen[at + 1].clear();
    if (event != Json::parse_event_t::key || at >= kDepths) return true;
    if (!seen[at].insert(parsed.get<std::string>()).second) {
      throw Refused{fmt::format("the key {} is given twice", in_quotes(parsed))};
    }
    return true;
  });
}

// --------------------------------------------------------------------------------------- writing

std::string vector_row(const Vec3& v) { return Json{v.x, v.y, v.z}.dump(); }

template <class Number>
void add_numbers(std::string& text, std::string_view key, const std::vector<Number>& values) {
  if (!values.empty()) text += fmt::format(",\n\"{}\": {}", key, Json(values).dump());
}

}  // namespace

Result<SceneFile> parse_scene(std::string_view text, const std::string& folder) {
  try {
    return read_scene(parse_once_each(text), folder);
  } catch (const Refused& refused) {
    return Error{refused.message};
  } catch (const Json::exception& exception) {
    return Error{plain_message(exception, text)};
  }
}

Result<SceneFile> read_scene_file(const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  auto scene = parse_scene(text.value(), std::filesystem::path(path).parent_path().string());
  if (!scene) return Error{fmt::format("{}: {}", path, scene.error())};
  return scene;
}

std::string scene_text(const SceneDescription& scene, const std::vector<PinMove>& moves,
                       const Faces& faces, const std::vector<SceneBody>& bodies,
                       const std::vector<SceneEvent>& events, const RestScale& rest_scale) {
  std::string text;
  add_rows(text, "positions", scene.positions, vector_row);
  add_rows(text, "velocities", scene.velocities, vector_row);
  add_numbers(text, "masses", scene.masses);
  add_numbers(text, "fixed", scene.fixed);
  text += parts_text(scene);
  add_numbers(text, "rail_particles", scene.rail_particles);
  add_rows(text, "surface", scene.surface, [](const auto& t) { return Json(t).dump(); });
  if (scene.surface.empty() && !faces.empty()) text += ",\n\"surface\": []";
  add_numbers(text, "spheres", scene.spheres);
  add_numbers(text, "radii", scene.radii);
  add_rows(text, "bodies", bodies, body_row);
  add_rows(text, "moves", moves, move_row);
  add_rows(text, "events", events, event_row);
  if (!rest_scale.times.empty())
    text += fmt::format(",\n\"rest_scale\": {}", rest_scale_text(rest_scale));
  add_rows(text, "faces", faces, [](const auto& face) { return Json(face).dump(); });
  return "{" + text.substr(1) + "\n}\n";  // without the first comma
}

SceneDescription present_scene(const SceneDescription& scene, const Cloth& cloth) {
  const bool is_torn = cloth.model()->tears > 0;
  SceneDescription present = is_torn ? description_of(*cloth.model()) : scene;
  if (!is_torn)
    present.pressures = with_volumes(scene.pressures, scene.surface, [&](std::uint32_t i) {
      return kernels::Vector{scene.positions[i].x, scene.positions[i].y, scene.positions[i].z};
    });
  present.velocities.resize(present.positions.size());
  for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
    present.positions[i] = cloth.position(i);
    present.velocities[i] = cloth.velocity(i);
  }
  return present;
}

}  // namespace weft::tools
