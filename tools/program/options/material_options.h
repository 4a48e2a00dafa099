/// --material and what changes it: what a mesh is made of.
#pragma once

#include <weft/mesh.h>

#include <optional>
#include <string>
#include <string_view>

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

struct MaterialOptions {
  std::optional<std::string> material;  ///< a name, or a .json file of the fields of Material
  std::optional<double> stretch;        ///< N/m, of warp and weft
  std::optional<double> shear, bend, density;
  std::optional<double> damping;  ///< s, of stretch and bending
  std::optional<double> drag, lift, strength;
  std::optional<double> bend_yield, bend_friction;  ///< 1/m; N
  std::optional<std::string> wind;                  ///< x,y,z in m/s
};

void add_material_options(Verb verb, MaterialOptions& options);

/// The first that was given, for errors; empty if none was.
std::string_view given_option(const MaterialOptions& options);
bool is_given(const MaterialOptions& options);

/// None without options. What is given replaces what --material has; without that the cloth has
/// nothing else, so stretch and density are needed.
Result<std::optional<Material>> material_of(const MaterialOptions& options);
/// None where none is given.
Result<std::optional<Vec3>> wind_of(const MaterialOptions& options);

/// The text of a material file: an object of fields of Material, those that are left out having
/// their defaults.
Result<Material> parse_material(std::string_view text);

}  // namespace weft::tools
