#include "tools/program/formats/scene_moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "tools/program/files/json_reading.h"

namespace weft::tools {
namespace {

std::vector<double> read_times(const Json& json, const std::string& place) {
  std::vector<double> times = read_array(json, place, read_number);
  if (times.empty()) refuse(place, "one time at least", json);
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (times[k - 1] < times[k]) continue;
    refuse(fmt::format("{}[{}]", place, k), fmt::format("a time after {}", times[k - 1]), json[k]);
  }
  return times;
}

void read_key(const std::string& key, const Json& json, const std::string& place, PinMove& move) {
  if (key == "particles") {
    move.particles = read_array(json, place, read_index);
  } else if (key == "anchors") {
    move.anchors = read_array(json, place, read_index);
  } else if (key == "times") {
    move.times = read_times(json, place);
  } else if (key == "translations") {
    move.translations = read_array(json, place, read_vector);
  } else if (key == "rotations") {
    move.rotations = read_array(json, place, read_vector);
  } else if (key == "about") {
    move.about = read_vector(json, place);
  } else if (key == "from") {
    move.from = read_array(json, place, read_vector);
  }
}

void check_count(const Json& json, const std::string& place, std::string_view key,
                 std::string_view of) {
  if (!json.contains(key) || json[key].size() == json[of].size()) return;
  throw Refused{fmt::format("{}: expected as many as {}, {}, not {}", within(place, key), of,
                            json[of].size(), json[key].size())};
}

PinMove read_pin_move(const Json& json, const std::string& place) {
  const bool of_anchors = json.is_object() && json.contains("anchors");
  const char* who = of_anchors ? "anchors" : "particles";
  check_keys(json, place, {who, "times", "translations", "rotations", "about", "from"},
             {who, "times", "translations"});
  PinMove move;
  for (const auto& [key, value] : json.items()) read_key(key, value, within(place, key), move);
  check_count(json, place, "translations", "times");
  check_count(json, place, "rotations", "times");
  check_count(json, place, "from", who);
  return move;
}

/// What may be said of the particles of a scene.
enum class Pin : char { free, still, moved };

std::vector<Pin> pins_of(const SceneDescription& scene) {
  std::vector<Pin> pins(scene.positions.size(), Pin::free);
  for (const std::uint32_t particle : scene.fixed) {
    if (particle < pins.size()) pins[particle] = Pin::still;
  }
  return pins;
}

void take(std::uint32_t particle, const std::string& place, std::vector<Pin>& pins) {
  const auto refused = [&](std::string_view why) {
    throw Refused{fmt::format("{}: particle {} {}", place, particle, why)};
  };
  if (particle >= pins.size() || pins[particle] == Pin::free) refused("is not fixed");
  if (pins[particle] == Pin::moved) refused("is moved twice");
  pins[particle] = Pin::moved;
}

void take_anchor(std::uint32_t anchor, const std::string& place, std::vector<bool>& moved) {
  if (anchor >= moved.size())
    throw Refused{fmt::format("{}: there is no anchor {}", place, anchor)};
  if (moved[anchor]) throw Refused{fmt::format("{}: anchor {} is moved twice", place, anchor)};
  moved[anchor] = true;
}

Json vectors_json(const std::vector<Vec3>& vectors) {
  Json rows = Json::array();
  for (const Vec3& v : vectors) rows.push_back({v.x, v.y, v.z});
  return rows;
}

}  // namespace

std::vector<PinMove> read_moves(const Json& json, const SceneDescription& scene) {
  std::vector<PinMove> moves = read_array(json, "moves", read_pin_move);
  std::vector<Pin> pins = pins_of(scene);
  std::vector<bool> anchors(scene.anchors.size());
  for (std::size_t m = 0; m < moves.size(); ++m) {
    const std::vector<std::uint32_t>& particles = moves[m].particles;
    for (std::size_t k = 0; k < particles.size(); ++k) {
      take(particles[k], fmt::format("moves[{}].particles[{}]", m, k), pins);
    }
    for (std::size_t k = 0; k < moves[m].anchors.size(); ++k)
      take_anchor(moves[m].anchors[k], fmt::format("moves[{}].anchors[{}]", m, k), anchors);
  }
  return moves;
}

std::string move_row(const PinMove& move) {
  const bool of_anchors = !move.anchors.empty();
  Json row{{of_anchors ? "anchors" : "particles", of_anchors ? move.anchors : move.particles},
           {"times", move.times},
           {"translations", vectors_json(move.translations)}};
  if (!move.rotations.empty()) row["rotations"] = vectors_json(move.rotations);
  row["about"] = {move.about.x, move.about.y, move.about.z};
  if (!move.from.empty()) row["from"] = vectors_json(move.from);
  return row.dump();
}

RestScale read_rest_scale(const Json& json) {
  const std::string place = "rest_scale";
  check_keys(json, place, {"times", "scales"}, {"times", "scales"});
  check_count(json, place, "scales", "times");
  RestScale scale{read_times(json["times"], within(place, "times")),
                  read_array(json["scales"], within(place, "scales"), read_number)};
  for (std::size_t k = 0; k < scale.scales.size(); ++k) {
    if (scale.scales[k] > 0) continue;
    refuse(fmt::format("{}.scales[{}]", place, k), "a scale above 0", json["scales"][k]);
  }
  return scale;
}

std::string rest_scale_text(const RestScale& scale) {
  return Json{{"times", scale.times}, {"scales", scale.scales}}.dump();
}

}  // namespace weft::tools
