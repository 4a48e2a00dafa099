#include "tools/program/recording/settings_json.h"

#include <fmt/format.h>

#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <type_traits>

#include "tools/program/files/json_reading.h"
#include "tools/program/text/parse.h"

namespace weft::tools {
namespace {

/// visit(name, field) for all fields: a new one has to be thought of.
void for_each_setting(auto& settings, const auto& visit) {
  auto& [tolerance, substeps, iterations, renew_after, max_iterations, contact_tolerance,
         velocity_tolerance, motion_tolerance, impulse_limit, solver, scheme, backend, isa, threads,
         directions, anticipate, anticipate_products, sleep, skip, velocity_correction] = settings;
  visit("tolerance", tolerance);
  visit("substeps", substeps);
  visit("iterations", iterations);
  visit("renew_after", renew_after);
  visit("max_iterations", max_iterations);
  visit("contact_tolerance", contact_tolerance);
  visit("velocity_tolerance", velocity_tolerance);
  visit("motion_tolerance", motion_tolerance);
  visit("impulse_limit", impulse_limit);
  visit("solver", solver);
  visit("scheme", scheme);
  visit("backend", backend);
  visit("isa", isa);
  visit("threads", threads);
  visit("directions", directions);
  visit("anticipate", anticipate);
  visit("anticipate_products", anticipate_products);
  visit("sleep", sleep);
  visit("skip", skip);
  visit("velocity_correction", velocity_correction);
}

void read(const Json& json, const std::string& place, double& value) {
  value = read_number(json, place);
}
void read(const Json& json, const std::string& place, bool& value) {
  if (!json.is_boolean()) refuse(place, "true or false", json);
  value = json.get<bool>();
}
void read(const Json& json, const std::string& place, int& value) {
  constexpr auto kMost = std::numeric_limits<int>::max();
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > kMost)
    refuse(place, "a whole number", json);
  value = json.get<int>();
}
template <class Enum>
requires std::is_enum_v<Enum>
void read(const Json& json, const std::string& place, Enum& value) {
  if (!json.is_string()) refuse(place, "a name", json);
  const auto parsed = parse_choice<Enum>(place, json.get<std::string>());
  if (!parsed) throw Refused{parsed.error()};
  value = parsed.value();
}

}  // namespace

Json settings_json(const Settings& settings) {
  Json json = Json::object();
  for_each_setting(settings, [&](const char* key, const auto& value) {
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>) {
      json[key] = name(value);
    } else {
      json[key] = value;
    }
  });
  return json;
}

Settings read_settings(const Json& json, const std::string& place) {
  if (!json.is_object()) refuse(place, "an object", json);
  Settings settings;
  std::set<std::string> known;
  for_each_setting(settings, [&](const char* key, auto& value) {
    known.insert(key);
    if (!json.contains(key)) throw Refused{fmt::format("{}: is missing", within(place, key))};
    read(json[key], within(place, key), value);
  });
  for (const auto& [key, value] : json.items()) {
    if (!known.contains(key))
      throw Refused{fmt::format("{}: unknown key {}", place, in_quotes(key))};
  }
  return settings;
}

}  // namespace weft::tools
