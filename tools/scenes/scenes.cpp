#include "tools/scenes/scenes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tools/scenes/irregular_mesh.h"
#include "tools/scenes/material_scenes.h"

namespace weft::scenes {
namespace {

constexpr int kLargestSize = 10'000;  // 10^8 particles
constexpr double kClothMass = 1;      // kg, shared equally

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

// --------------------------------------------------------------------------------------- grid

struct Grid {
  int size;
  double spacing() const { return 1.0 / (size - 1); }
  /// i * spacing, but the last one is 1 exactly.
  double fraction(int i) const { return static_cast<double>(i) / (size - 1); }
  std::uint32_t number(int i, int j) const { return static_cast<std::uint32_t>(i * size + j); }
};

/// Adds constraints, except where both ends are fixed: what is fixed must be known before.
class Joiner {
 public:
  explicit Joiner(SceneDescription& scene)
      : scene_(scene), is_fixed_(scene.positions.size(), false) {
    for (const std::uint32_t particle : scene.fixed) is_fixed_[particle] = true;
  }
  void join(std::uint32_t a, std::uint32_t b, double rest_length, ConstraintKind kind) {
    if (!is_fixed_[a] || !is_fixed_[b]) scene_.constraints.push_back({a, b, rest_length, kind});
  }

 private:
  SceneDescription& scene_;
  std::vector<bool> is_fixed_;
};

void add_structural_edges(const Grid& grid, Joiner& joiner) {
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    joiner.join(a, b, grid.spacing(), ConstraintKind::distance);
  };
  for (int i = 0; i < grid.size; ++i) {
    for (int j = 0; j < grid.size; ++j) {
      if (i + 1 < grid.size) join(grid.number(i, j), grid.number(i + 1, j));
      if (j + 1 < grid.size) join(grid.number(i, j), grid.number(i, j + 1));
    }
  }
}

void add_diagonals(const Grid& grid, Joiner& joiner) {
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    joiner.join(a, b, std::numbers::sqrt2 * grid.spacing(), ConstraintKind::rope);
  };
  for (int i = 0; i + 1 < grid.size; ++i) {
    for (int j = 0; j + 1 < grid.size; ++j) {
      join(grid.number(i, j), grid.number(i + 1, j + 1));
      join(grid.number(i + 1, j), grid.number(i, j + 1));
    }
  }
}

void add_edges(const Grid& grid, const Options& options, SceneDescription& scene) {
  Joiner joiner(scene);
  add_structural_edges(grid, joiner);
  if (options.diagonals) add_diagonals(grid, joiner);
}

void share_mass(SceneDescription& scene) {
  const std::size_t count = scene.positions.size();
  scene.masses.assign(count, kClothMass / static_cast<double>(count));
}

/// place(i, j) is the position of particle (i, j). Edges are added once it is known what is fixed.
template <class Place>
SceneDescription cloth(const Grid& grid, Place place) {
  SceneDescription scene;
  for (int i = 0; i < grid.size; ++i) {
    for (int j = 0; j < grid.size; ++j) scene.positions.push_back(place(i, j));
  }
  share_mass(scene);
  return scene;
}

SceneDescription level_sheet(const Grid& grid) {
  return cloth(grid, [&](int i, int j) { return Vec3{grid.fraction(i), 0, grid.fraction(j)}; });
}

/// The cloth's own particles have radius 0. Returns the sphere's number.
std::uint32_t add_sphere(SceneDescription& scene, Vec3 centre, double radius, double mass) {
  const auto number = static_cast<std::uint32_t>(scene.positions.size());
  scene.radii.assign(scene.positions.size(), 0.0);
  scene.positions.push_back(centre);
  scene.masses.push_back(mass);
  scene.radii.push_back(radius);
  scene.spheres.push_back(number);
  return number;
}

// --------------------------------------------------------------------------------------- hang

SceneDescription hanging_sheet(const Options& options) {
  const Grid grid{options.size};
  SceneDescription scene = level_sheet(grid);
  for (int j = 0; j < grid.size; ++j) scene.fixed.push_back(grid.number(0, j));
  add_edges(grid, options, scene);
  return scene;
}

Result<SceneDescription> make_hang(const Options& options) {
  if (const auto size = check_size("hang", options.size, 2); !size) return Error{size.error()};
  return hanging_sheet(options);
}

Result<SceneDescription> make_hang_sphere(const Options& options) {
  const auto size = check_size("hang_sphere", options.size, 2);
  if (!size) return Error{size.error()};
  SceneDescription scene = hanging_sheet(options);
  scene.fixed.push_back(add_sphere(scene, {0.5, -0.6, 0.5}, 0.25, 1));
  return scene;
}

// -------------------------------------------------------------------------------- sphere_drop

/// A circular arc of `edges` chords, each 1/edges long and turned by theta against the one before,
/// spans sin(edges * theta / 2) / (edges * sin(theta / 2)): 1 when straight, falling to 0 when the
/// arc has closed to a whole polygon at theta = 2 pi / edges.
double turning_angle(int edges, double span) {
  const auto spanned = [edges](double theta) {
    return std::sin(edges * theta / 2) / (edges * std::sin(theta / 2));
  };
  double straighter = 0;
  double rounder = 2 * std::numbers::pi / edges;
  for (;;) {
    const double theta = std::midpoint(straighter, rounder);
    if (theta == straighter || theta == rounder) return theta;
    (spanned(theta) > span ? straighter : rounder) = theta;
  }
}

/// The corners of the arc in the y-z plane, from z = 0 to z = 1 - slack, sagging towards -y.
std::vector<Vec3> sagging_arc(const Grid& grid, double slack) {
  const int edges = grid.size - 1;
  const double theta = slack > 0 ? turning_angle(edges, 1 - slack) : 0.0;
  std::vector<Vec3> corners{{0, 0, 0}};
  for (int k = 0; k < edges; ++k) {
    const double slope = (k - (edges - 1) / 2.0) * theta;
    const Vec3 last = corners.back();
    corners.push_back(
        {0, last.y + grid.spacing() * std::sin(slope), last.z + grid.spacing() * std::cos(slope)});
  }
  return corners;
}

Result<void> check_sphere_drop(const Options& options) {
  if (auto size = check_size("sphere_drop", options.size, 3); !size) return size;
  if (auto mass = check_mass("sphere_drop", "sphere_mass", options.sphere_mass); !mass) return mass;
  if (options.slack >= 0 && options.slack < 1) return {};
  return refused("sphere_drop", "slack", "at least 0 and below 1", options.slack);
}

/// The sphere's lowest point starts 0.3 m above the middle of the sheet, which is its lowest place.
Result<SceneDescription> make_sphere_drop(const Options& options) {
  if (const auto checked = check_sphere_drop(options); !checked) return Error{checked.error()};
  constexpr double kRadius = 0.15;
  constexpr double kDrop = 0.3;
  const Grid grid{options.size};
  const std::vector<Vec3> arc = sagging_arc(grid, options.slack);
  SceneDescription scene = cloth(grid, [&](int i, int j) {
    const Vec3 corner = arc[static_cast<std::size_t>(j)];
    return Vec3{grid.fraction(i), corner.y, corner.z};
  });
  for (int i = 0; i < grid.size; ++i) {
    scene.fixed.push_back(grid.number(i, 0));
    scene.fixed.push_back(grid.number(i, grid.size - 1));
  }
  add_edges(grid, options, scene);
  const double middle = arc[arc.size() / 2].y;
  add_sphere(scene, {0.5, middle + kDrop + kRadius, (1 - options.slack) / 2}, kRadius,
             options.sphere_mass);
  return scene;
}

// ----------------------------------------------------------------------------------- corners

/// The sheet starts folded along its middle row, every edge at its rest length, and hangs from two
/// corners: all of its weight runs through the whole sheet.
Result<SceneDescription> make_corners(const Options& options) {
  const auto size = check_size("corners", options.size, 3);
  if (!size) return Error{size.error()};
  if (options.size % 2 == 0) return refused("corners", "size", "odd", options.size);
  const Grid grid{options.size};
  constexpr double kSpan = 0.9;
  const double fall = std::sqrt(1 - kSpan * kSpan);
  SceneDescription scene = cloth(grid, [&](int i, int j) {
    const double along = grid.fraction(j);
    const double to_border = grid.fraction(std::min(j, grid.size - 1 - j));
    return Vec3{grid.fraction(i), -fall * to_border, kSpan * along};
  });
  scene.fixed = {grid.number(0, 0), grid.number(0, grid.size - 1)};
  add_edges(grid, options, scene);
  return scene;
}

// ------------------------------------------------------------------------------------ banner

Result<SceneDescription> make_banner(const Options& options) {
  if (const auto size = check_size("banner", options.size, 3); !size) return Error{size.error()};
  const Grid grid{options.size};
  SceneDescription scene = cloth(grid, [&](int i, int j) {
    return Vec3{0, -grid.fraction(i), grid.fraction(j)};
  });
  scene.fixed = {grid.number(0, 0), grid.number(0, grid.size - 1)};
  add_edges(grid, options, scene);
  return scene;
}

// --------------------------------------------------------------------------------- four_pins

Result<SceneDescription> make_four_pins(const Options& options) {
  const auto size = check_size("four_pins", options.size, 3);
  if (!size) return Error{size.error()};
  const Grid grid{options.size};
  const int last = grid.size - 1;
  SceneDescription scene = level_sheet(grid);
  scene.fixed = {grid.number(0, 0), grid.number(0, last), grid.number(last, 0),
                 grid.number(last, last)};
  add_edges(grid, options, scene);
  return scene;
}

// -------------------------------------------------------------------------------------- cape

double distance(Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

/// Its upper seam is uneven: what is pinned is a strip, not a row of cells.
Result<SceneDescription> make_cape(const Options& options) {
  if (const auto size = check_size("cape", options.size, 3); !size) return Error{size.error()};
  const Grid grid{options.size};
  IrregularMesh mesh = irregular_mesh(options.size);
  SceneDescription scene;
  scene.positions = std::move(mesh.points);
  share_mass(scene);
  const double seam = 1.19 * grid.spacing();
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    if (scene.positions[i].x < seam) scene.fixed.push_back(i);
  }
  Joiner joiner(scene);
  const auto kind = options.ropes ? ConstraintKind::rope : ConstraintKind::distance;
  for (const auto& [a, b] : edges_of(mesh.faces)) {
    joiner.join(a, b, distance(scene.positions[a], scene.positions[b]), kind);
  }
  return scene;
}

// ------------------------------------------------------------------------------------- chain

Result<void> check_chain(const Options& options) {
  if (auto size = check_size("chain", options.size, 2); !size) return size;
  return check_mass("chain", "end_mass", options.end_mass);
}

/// Starts level, along x.
Result<SceneDescription> make_chain(const Options& options) {
  if (const auto checked = check_chain(options); !checked) return Error{checked.error()};
  constexpr double kSpacing = 0.01;
  SceneDescription scene;
  for (int i = 0; i < options.size; ++i) {
    const auto number = static_cast<std::uint32_t>(i);
    scene.positions.push_back({kSpacing * i, 0, 0});
    scene.masses.push_back(1);
    if (i > 0) scene.constraints.push_back({number - 1, number, kSpacing});
  }
  scene.masses.back() = options.end_mass;
  scene.fixed = {0};
  return scene;
}

// -------------------------------------------------------------------------------- materials

Material material_of(const Options& options) {
  return options.material ? *options.material : find_material("cotton").value();
}

Result<SceneDescription> make_flag(const Options& options) {
  if (const auto size = check_size("flag", options.size, 2); !size) return Error{size.error()};
  return flag_of(options.size, material_of(options));
}

Result<SceneDescription> make_drape(const Options& options) {
  if (const auto size = check_size("drape", options.size, 2); !size) return Error{size.error()};
  return drape_of(options.size, material_of(options));
}

// -------------------------------------------------------------------------------------- names

struct Entry {
  BuiltIn built_in;
  Result<SceneDescription> (*make)(const Options&);
};

constexpr std::array<Entry, 10> kEntries{{
    {{"hang", "a sheet with one fixed side swings down"}, make_hang},
    {{"hang_sphere", "the same, swinging into a fixed sphere"}, make_hang_sphere},
    {{"sphere_drop", "a heavy sphere drops into a sagging sheet"}, make_sphere_drop},
    {{"corners", "a folded sheet hangs from two corners"}, make_corners},
    {{"banner", "a sheet hangs from two corners at its own width"}, make_banner},
    {{"four_pins", "a level sheet sinks between its four fixed corners"}, make_four_pins},
    {{"cape", "an irregular mesh hangs from an uneven seam"}, make_cape},
    {{"chain", "a line of particles with a heavy end"}, make_chain},
    {{"flag", "a sheet of cotton flies from a pole"}, make_flag},
    {{"drape", "a sheet of cotton falls over a fixed sphere"}, make_drape},
}};

constexpr auto kList = [] {
  std::array<BuiltIn, kEntries.size()> names{};
  for (std::size_t i = 0; i < kEntries.size(); ++i) names[i] = kEntries[i].built_in;
  return names;
}();

}  // namespace

std::span<const BuiltIn> list() { return kList; }

Result<SceneDescription> make(std::string_view name, const Options& options) {
  for (const Entry& entry : kEntries) {
    if (entry.built_in.name == name) return entry.make(options);
  }
  std::string known;
  for (const BuiltIn& scene : kList) known += (known.empty() ? "" : ", ") + std::string(scene.name);
  return Error{"unknown scene '" + std::string(name) + "'; known: " + known};
}

}  // namespace weft::scenes
