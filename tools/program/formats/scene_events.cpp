#include "tools/program/formats/scene_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/program/files/json_reading.h"

namespace weft::tools {
namespace {

// --------------------------------------------------------------------------------------- reading

double read_distance(const Json& json, const std::string& place) {
  if (json.is_null()) return std::numeric_limits<double>::infinity();
  const double distance = read_number(json, place);
  if (!(distance >= 0)) refuse(place, "a distance of at least 0, or null", json);
  return distance;
}

LimitedAnchor read_limit(const Json& json, const std::string& place) {
  check_keys(json, place, {"anchor", "max_distance", "backstop"}, {"anchor", "max_distance"});
  LimitedAnchor limited{read_index(json["anchor"], within(place, "anchor")),
                        {read_distance(json["max_distance"], within(place, "max_distance"))}};
  if (!json.contains("backstop")) return limited;
  const Json& backstop = json["backstop"];
  if (!backstop.is_boolean()) refuse(within(place, "backstop"), "true or false", backstop);
  limited.limit.backstop = backstop.get<bool>();
  return limited;
}

void read_key(const std::string& key, const Json& json, const std::string& place,
              SceneEvent& event) {
  if (key == "time") {
    event.time = read_number(json, place);
  } else if (key == "release") {
    event.release = read_array(json, place, read_index);
  } else if (key == "fix") {
    event.fix = read_array(json, place, read_index);
  } else if (key == "release_seams") {
    event.release_seams = read_array(json, place, read_index);
  } else if (key == "close_seams") {
    event.close_seams = read_array(json, place, read_index);
  } else if (key == "anchors") {
    event.anchors = read_array(json, place, read_limit);
  } else if (key == "anchor_scale") {
    event.anchor_scale = read_distance(json, place);
  } else if (key == "gravity") {
    event.gravity = read_vector(json, place);
  } else if (key == "wind") {
    event.wind = read_vector(json, place);
  }
}

SceneEvent read_event(const Json& json, const std::string& place) {
  check_keys(json, place,
             {"time", "release", "fix", "release_seams", "close_seams", "anchors", "anchor_scale",
              "gravity", "wind"},
             {"time"});
  SceneEvent event;
  for (const auto& [key, value] : json.items()) read_key(key, value, within(place, key), event);
  return event;
}

/// Which particles are fixed as events happen.
class FixedThen {
 public:
  explicit FixedThen(const SceneDescription& scene)
      : is_fixed_(scene.positions.size()), has_anchor_(scene.positions.size()) {
    for (const std::uint32_t particle : scene.fixed) {
      if (particle < is_fixed_.size()) is_fixed_[particle] = true;
    }
    for (const Anchor& anchor : scene.anchors) {
      if (anchor.particle < has_anchor_.size()) has_anchor_[anchor.particle] = true;
    }
  }
  void turn(const std::vector<std::uint32_t>& particles, bool fixes, const std::string& place) {
    for (std::size_t k = 0; k < particles.size(); ++k) {
      const std::uint32_t particle = particles[k];
      const auto refused = [&](std::string_view why) {
        throw Refused{fmt::format("{}[{}]: particle {} {}", place, k, particle, why)};
      };
      if (particle >= is_fixed_.size()) refused("is not there");
      if (fixes && has_anchor_[particle]) refused("has an anchor");
      if (is_fixed_[particle] == fixes) refused(fixes ? "is fixed already" : "is not fixed");
      is_fixed_[particle] = fixes;
    }
  }

 private:
  std::vector<bool> is_fixed_, has_anchor_;
};

void check_numbers(const std::vector<std::uint32_t>& numbers, std::size_t count,
                   std::string_view noun, const std::string& place) {
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (numbers[k] < count) continue;
    throw Refused{fmt::format("{}[{}]: there is no {} {}", place, k, noun, numbers[k])};
  }
}

void check_event(const SceneEvent& event, const std::string& place, const SceneDescription& scene,
                 FixedThen& fixed) {
  fixed.turn(event.release, false, within(place, "release"));
  fixed.turn(event.fix, true, within(place, "fix"));
  const std::size_t seams = scene.seams.size(), anchors = scene.anchors.size();
  check_numbers(event.release_seams, seams, "seam", within(place, "release_seams"));
  check_numbers(event.close_seams, seams, "seam", within(place, "close_seams"));
  std::vector<std::uint32_t> limited;
  for (const LimitedAnchor& each : event.anchors) limited.push_back(each.anchor);
  check_numbers(limited, anchors, "anchor", within(place, "anchors"));
}

// --------------------------------------------------------------------------------------- writing

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

Json limit_json(const LimitedAnchor& limited) {
  const double distance = limited.limit.max_distance;
  Json row{{"anchor", limited.anchor}};
  row["max_distance"] = std::isinf(distance) ? Json() : Json(distance);
  if (!limited.limit.backstop) row["backstop"] = false;
  return row;
}

}  // namespace

std::vector<SceneEvent> read_events(const Json& json, const SceneDescription& scene) {
  std::vector<SceneEvent> events = read_array(json, "events", read_event);
  FixedThen fixed(scene);
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::string place = fmt::format("events[{}]", i);
    if (i > 0 && events[i].time < events[i - 1].time) {
      refuse(within(place, "time"), fmt::format("{} or later", events[i - 1].time),
             json[i]["time"]);
    }
    check_event(events[i], place, scene, fixed);
  }
  return events;
}

std::string event_row(const SceneEvent& event) {
  Json row{{"time", event.time}};
  const auto add = [&](const char* key, const std::vector<std::uint32_t>& numbers) {
    if (!numbers.empty()) row[key] = numbers;
  };
  add("release", event.release);
  add("fix", event.fix);
  add("release_seams", event.release_seams);
  add("close_seams", event.close_seams);
  for (const LimitedAnchor& limited : event.anchors) row["anchors"].push_back(limit_json(limited));
  if (event.anchor_scale) row["anchor_scale"] = *event.anchor_scale;
  if (event.gravity) row["gravity"] = vector_json(*event.gravity);
  if (event.wind) row["wind"] = vector_json(*event.wind);
  return row.dump();
}

}  // namespace weft::tools
