#include "tools/scenes/scenes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/scenes/cloth.h"
#include "tools/scenes/garments.h"
#include "tools/scenes/grid_layouts.h"
#include "tools/scenes/irregular_mesh.h"
#include "tools/scenes/layered_layouts.h"
#include "tools/scenes/mannequin.h"

namespace weft::scenes {
namespace {

constexpr int kLargestSize = 10'000;  // 10^8 particles

// ------------------------------------------------------------------------------------- errors

template <class Number>
std::string text(Number value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

template <class Number>
Error refused(std::string_view scene, std::string_view option, std::string_view allowed,
              Number value) {
  return {std::string(scene) + ": " + std::string(option) + " must be " + std::string(allowed) +
          ", not " + text(value)};
}

Result<void> check_size(std::string_view scene, int size, int smallest) {
  if (size >= smallest && size <= kLargestSize) return {};
  return refused(scene, "size", "from " + text(smallest) + " to " + text(kLargestSize), size);
}

Result<void> check_mass(std::string_view scene, std::string_view option, double mass) {
  if (std::isfinite(mass) && mass > 0) return {};
  return refused(scene, option, "positive and finite", mass);
}

Result<void> anything(const Options&) { return {}; }

Result<void> check_sphere_drop(const Options& options) {
  if (auto mass = check_mass("sphere_drop", "sphere_mass", options.sphere_mass); !mass) return mass;
  if (options.slack >= 0 && options.slack < 1) return {};
  return refused("sphere_drop", "slack", "at least 0 and below 1", options.slack);
}

Result<void> check_corners(const Options& options) {
  if (options.size % 2 == 0) return refused("corners", "size", "odd", options.size);
  return {};
}

Result<void> check_chain(const Options& options) {
  return check_mass("chain", "end_mass", options.end_mass);
}

// -------------------------------------------------------------------------------------- cape

/// Its upper seam is uneven: what is pinned is a strip, not a row of cells.
Layout cape(const Options& options) {
  IrregularMesh mesh = irregular_mesh(options.size);
  Layout layout;
  layout.start = std::move(mesh.points);
  layout.faces = std::move(mesh.faces);
  const double seam = 1.19 * Grid{options.size}.spacing();
  for (std::uint32_t i = 0; i < layout.start.size(); ++i) {
    if (layout.start[i].x < seam) layout.pins.push_back(i);
  }
  return layout;
}

// ------------------------------------------------------------------------------------- chain

/// Starts level, along x.
Result<Scene> chain(const Options& options) {
  if (options.material) return Error{"chain: a line of particles has no material"};
  constexpr double kSpacing = 0.01;
  SceneDescription description;
  for (int i = 0; i < options.size; ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    description.positions.push_back({kSpacing * i, 0, 0});
    description.masses.push_back(1);
    if (i > 0) description.constraints.push_back({number - 1, number, kSpacing});
  }
  description.masses.back() = options.end_mass;
  description.fixed = {0};
  tools::Mesh mesh = tools::line_mesh(description);
  return Scene{std::move(description), std::move(mesh)};
}

// -------------------------------------------------------------------------------------- names

template <Layout (*kLayout)(const Options&)>
Result<Scene> cloth(const Options& options) {
  return cloth_of(kLayout(options), options);
}

template <Result<Layout> (*kLayout)(const Options&)>
Result<Scene> garment(const Options& options) {
  const auto layout = kLayout(options);
  if (!layout) return Error{layout.error()};
  return cloth_of(layout.value(), options);
}

struct Entry {
  BuiltIn built_in;
  int smallest;  ///< size
  Result<void> (*check)(const Options&);
  Result<Scene> (*make)(const Options&);
};

constexpr std::array<Entry, 24> kEntries{{
    {{"hang", "a sheet with one fixed side swings down"}, 2, anything, cloth<hang>},
    {{"hang_sphere", "the same, swinging into a fixed sphere"}, 2, anything, cloth<hang_sphere>},
    {{"sphere_drop", "a heavy sphere drops into a sagging sheet"},
     3,
     check_sphere_drop,
     cloth<sphere_drop>},
    {{"corners", "a folded sheet hangs from two corners"}, 3, check_corners, cloth<corners>},
    {{"banner", "a sheet hangs from two corners at its own width"}, 3, anything, cloth<banner>},
    {{"four_pins", "a level sheet sinks between its four fixed corners"},
     3,
     anything,
     cloth<four_pins>},
    {{"cape", "an irregular mesh hangs from an uneven seam"}, 3, anything, cloth<cape>},
    {{"chain", "a line of particles with a heavy end"}, 2, check_chain, chain},
    {{"flag", "a sheet of cotton flies from a pole", true}, 2, anything, cloth<flag>},
    {{"drape", "a sheet of cotton falls over a fixed sphere", true}, 2, anything, cloth<drape>},
    {{"table", "a sheet of cotton slides off a table", true}, 3, anything, cloth<table>},
    {{"cushion", "a ball is pressed into a taut sheet, rolls and slides", true},
     3,
     anything,
     cloth<cushion>},
    {{"rings", "a curtain of cotton on rings is drawn along a rod, and back", true},
     9,
     anything,
     cloth<rings>},
    {{"tunic", "a sewn tunic of cotton hangs from two pegs", true}, 20, anything, garment<tunic>},
    {{"skirt", "a flared skirt of cotton falls from its waist", true},
     20,
     anything,
     garment<skirt>},
    {{"mannequin", "a tunic of cotton on a body that walks", true},
     20,
     anything,
     garment<mannequin>},
    {{"mannequin_mesh", "the same on a body of triangle meshes", true},
     20,
     anything,
     garment<mannequin_mesh>},
    {{"stack", "five sheets of cotton fall on a floor, one on another", true},
     3,
     anything,
     cloth<stack>},
    {{"fold", "a sheet of cotton in four layers falls on a floor", true},
     20,
     anything,
     cloth<fold>},
    {{"curtain", "a sheet of cotton slides off a table onto the floor", true},
     3,
     anything,
     cloth<curtain>},
    {{"twist", "the ends of a sheet of cotton turn against each other", true},
     5,
     anything,
     cloth<twist>},
    {{"ribbon", "a ribbon of cotton is lowered on a floor", true}, 20, anything, cloth<ribbon>},
    {{"funnel", "a sheet of cotton is drawn through a ring", true}, 20, anything, cloth<funnel>},
    {{"outfit", "a skirt over a tunic, of cotton, on a body that walks", true},
     20,
     anything,
     garment<outfit>},
}};

constexpr auto kList = [] {
  std::array<BuiltIn, kEntries.size()> names{};
  for (std::size_t i = 0; i < kEntries.size(); ++i) names[i] = kEntries[i].built_in;
  return names;
}();

Result<Scene> make_entry(const Entry& entry, const Options& options) {
  const auto size = check_size(entry.built_in.name, options.size, entry.smallest);
  if (!size) return Error{size.error()};
  if (const auto checked = entry.check(options); !checked) return Error{checked.error()};
  Options all = options;
  if (entry.built_in.is_fabric && !all.material) all.material = find_material(kFabric).value();
  return entry.make(all);
}

}  // namespace

std::span<const BuiltIn> list() { return kList; }

Result<Scene> make_scene(std::string_view name, const Options& options) {
  for (const Entry& entry : kEntries) {
    if (entry.built_in.name == name) return make_entry(entry, options);
  }
  std::string known;
  for (const BuiltIn& scene : kList) known += (known.empty() ? "" : ", ") + std::string(scene.name);
  return Error{"unknown scene '" + std::string(name) + "'; known: " + known};
}

Result<SceneDescription> make(std::string_view name, const Options& options) {
  auto scene = make_scene(name, options);
  if (!scene) return Error{scene.error()};
  return std::move(scene.value().description);
}

}  // namespace weft::scenes
