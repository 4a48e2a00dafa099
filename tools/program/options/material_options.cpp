#include "tools/program/options/material_options.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/program/files/json_reading.h"
#include "tools/program/files/text_file.h"
#include "tools/program/text/file_ending.h"
#include "tools/program/text/parse.h"

namespace weft::tools {
namespace {

struct Field {
  std::string_view name;
  double Material::*value;
};
constexpr Field kFields[] = {{"density", &Material::density},
                             {"thickness", &Material::thickness},
                             {"friction", &Material::friction},
                             {"warp", &Material::warp},
                             {"weft", &Material::weft},
                             {"shear", &Material::shear},
                             {"bending", &Material::bending},
                             {"damping_stretch", &Material::damping_stretch},
                             {"damping_bending", &Material::damping_bending},
                             {"damping_motion", &Material::damping_motion},
                             {"drag", &Material::drag},
                             {"lift", &Material::lift},
                             {"ram", &Material::ram},
                             {"strength", &Material::strength},
                             {"bending_yield", &Material::bending_yield},
                             {"bending_hardening", &Material::bending_hardening},
                             {"bending_friction", &Material::bending_friction},
                             {"bending_slip", &Material::bending_slip}};

struct Change {
  std::string_view option;
  std::optional<double> MaterialOptions::*given;
  std::array<double Material::*, 2> values;  ///< what it sets; the second may be the first
};
constexpr Change kChanges[] = {
    {"--stretch", &MaterialOptions::stretch, {&Material::warp, &Material::weft}},
    {"--shear", &MaterialOptions::shear, {&Material::shear, &Material::shear}},
    {"--bend", &MaterialOptions::bend, {&Material::bending, &Material::bending}},
    {"--density", &MaterialOptions::density, {&Material::density, &Material::density}},
    {"--damping",
     &MaterialOptions::damping,
     {&Material::damping_stretch, &Material::damping_bending}},
    {"--drag", &MaterialOptions::drag, {&Material::drag, &Material::drag}},
    {"--lift", &MaterialOptions::lift, {&Material::lift, &Material::lift}},
    {"--strength", &MaterialOptions::strength, {&Material::strength, &Material::strength}},
    {"--bend-yield",
     &MaterialOptions::bend_yield,
     {&Material::bending_yield, &Material::bending_yield}},
    {"--bend-friction",
     &MaterialOptions::bend_friction,
     {&Material::bending_friction, &Material::bending_friction}}};

std::string names_of_materials() {
  std::string names;
  for (const NamedMaterial& named : materials()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", named.name);
  }
  return names;
}

Result<Material> read_material_file(const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  const auto material = parse_material(text.value());
  if (!material) return Error{fmt::format("{}: {}", path, material.error())};
  return material;
}

Result<Material> base_of(const MaterialOptions& options) {
  if (!options.material) return Material{};
  auto found = file_ending(*options.material) == ".json" ? read_material_file(*options.material)
                                                         : find_material(*options.material);
  if (!found) return Error{"--material: " + found.error()};
  return found;
}

/// Of two values for one key the parser would drop one in silence.
Json parse_flat_object(std::string_view text) {
  std::set<std::string> seen;
  return Json::parse(text, [&](int, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::key && !seen.insert(parsed.get<std::string>()).second) {
      throw Refused{fmt::format("the key {} is given twice", in_quotes(parsed))};
    }
    return true;
  });
}

Material read_material(const Json& json) {
  if (!json.is_object()) throw Refused{"expected an object with the fields of a material"};
  Material material;
  for (const auto& [key, value] : json.items()) {
    const auto field = std::ranges::find(kFields, key, &Field::name);
    if (field == std::end(kFields)) throw Refused{fmt::format("unknown key {}", in_quotes(key))};
    material.*(field->value) = read_number(value, key);
  }
  return material;
}

}  // namespace

void add_material_options(Verb verb, MaterialOptions& options) {
  verb.option(
      "--material", options.material,
      fmt::format(".obj and built-in cloth: edges are springs, and faces bend: {}, or a .json file "
                  "with the fields of Material in weft/mesh.h",
                  names_of_materials()));
  verb.option("--stretch", options.stretch, "material: N/m, of warp and weft");
  verb.option("--shear", options.shear, "material: N/m");
  verb.option("--bend", options.bend, "material: N m");
  verb.option("--density", options.density, "material: kg/m^2");
  verb.option("--damping", options.damping, "material: s, of stretch and bending");
  verb.option("--drag", options.drag, "material: drag of the air");
  verb.option("--lift", options.lift, "material: lift of the air");
  verb.option("--strength", options.strength, "material: N/m, at which it tears");
  verb.option("--bend-yield", options.bend_yield,
              "material: 1/m, the curvature beyond which it keeps a crease");
  verb.option("--bend-friction", options.bend_friction,
              "material: N, the friction of bending, half of Kawabata's 2HB");
  verb.option("--wind", options.wind, "with a material: x,y,z in m/s");
}

std::string_view given_option(const MaterialOptions& options) {
  if (options.material) return "--material";
  for (const Change& change : kChanges) {
    if (options.*(change.given)) return change.option;
  }
  return options.wind ? "--wind" : "";
}

bool is_given(const MaterialOptions& options) { return !given_option(options).empty(); }

Result<std::optional<Material>> material_of(const MaterialOptions& options) {
  if (!is_given(options) || given_option(options) == "--wind") return std::optional<Material>{};
  auto base = base_of(options);
  if (!base) return Error{base.error()};
  Material material = base.value();
  for (const Change& change : kChanges) {
    const auto& given = options.*(change.given);
    if (!given) continue;
    for (const auto value : change.values) material.*value = *given;
  }
  for (const std::string_view needed : {"--stretch", "--density"}) {
    const bool has =
        needed == "--stretch" ? options.stretch.has_value() : options.density.has_value();
    if (options.material || has) continue;
    return Error{fmt::format("{}: needs {} or --material", given_option(options), needed)};
  }
  if (auto checked = check_material(material); !checked) return Error{checked.error()};
  return std::optional(material);
}

Result<std::optional<Vec3>> wind_of(const MaterialOptions& options) {
  if (!options.wind) return std::optional<Vec3>{};
  const auto wind = parse_vector("--wind", *options.wind);
  if (!wind) return Error{wind.error()};
  return std::optional(wind.value());
}

Result<Material> parse_material(std::string_view text) {
  try {
    return read_material(parse_flat_object(text));
  } catch (const Refused& refused) {
    return Error{refused.message};
  } catch (const Json::exception& exception) {
    return Error{plain_message(exception, text)};
  }
}

}  // namespace weft::tools
