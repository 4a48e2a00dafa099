#include "tools/studies/forms/sheets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "tools/scenes/splitmix.h"

namespace weft::tools::forms {
namespace {

constexpr std::uint64_t kSeed = 1697;
constexpr double kMoved = 0.25;  // of a cell
constexpr double kJitter = 0.08;
constexpr int kKept = 2;        // rows of vertices behind the first one are not moved
constexpr double kNear = 1e-9;  // m

/// The first diagonal of a cell joins its corners (row, column) and (row + 1, column + 1).
enum class Cut { none, first, second };

class Faces {
 public:
  Faces(MeshDescription& mesh, std::uint32_t columns) : mesh_(mesh), columns_(columns) {}
  void add(std::uint32_t row, std::uint32_t column, Cut cut) {
    const std::uint32_t a = row * columns_ + column, b = a + columns_, c = b + 1, d = a + 1;
    if (cut == Cut::none) return add({a, b, c, d});
    if (cut == Cut::first) return add({a, b, c}), add({a, c, d});
    add({a, b, d}), add({b, c, d});
  }

 private:
  void add(std::initializer_list<std::uint32_t> corners) {
    mesh_.corners.insert(mesh_.corners.end(), corners);
    mesh_.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  }
  MeshDescription& mesh_;
  std::uint32_t columns_;
};

/// Every other column begins with half a cell. There each column has one vertex more than cells;
/// the others have their last one twice, and what welding leaves of the face there has no area.
MeshDescription equilateral(const Sheet& sheet) {
  MeshDescription mesh;
  const double dx = sheet.length / sheet.along, dz = sheet.width / sheet.across;
  for (int i = 0; i <= sheet.along + 1; ++i) {
    for (int j = 0; j <= sheet.across; ++j) {
      const double at = j % 2 == 0 ? std::min(i, sheet.along)
                                   : std::clamp(i - 0.5, 0.0, static_cast<double>(sheet.along));
      mesh.positions.push_back({dx * at, 0, dz * j});
    }
  }
  Faces faces(mesh, static_cast<std::uint32_t>(sheet.across) + 1);
  for (std::uint32_t i = 0; i <= static_cast<std::uint32_t>(sheet.along); ++i) {
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(sheet.across); ++j)
      faces.add(i, j, j % 2 == 0 ? Cut::first : Cut::second);
  }
  return mesh;
}

bool is_in_the_middle(const Sheet& sheet, int i, int j) {
  return 4 * i > sheet.along && 4 * i < 3 * sheet.along && 4 * j > sheet.across &&
         4 * j < 3 * sheet.across;
}

bool is_moved(const Sheet& sheet, int i, int j) {
  switch (sheet.pattern) {
    case Pattern::jittered:
    case Pattern::irregular:
      return true;
    case Pattern::patchwork:
      return is_in_the_middle(sheet, i, j);
    default:
      return false;
  }
}

bool is_cut(const Sheet& sheet, int i, int j) {
  switch (sheet.pattern) {
    case Pattern::right_angled:
    case Pattern::irregular:
      return true;
    case Pattern::patchwork:
      return is_in_the_middle(sheet, i, j) || is_in_the_middle(sheet, i + 1, j + 1);
    default:
      return false;
  }
}

MeshDescription grid(const Sheet& sheet) {
  MeshDescription mesh;
  scenes::SplitMix random(kSeed);
  const double dx = sheet.length / sheet.along, dz = sheet.width / sheet.across;
  const double by = sheet.pattern == Pattern::jittered ? kJitter : kMoved;
  const auto moved = [&] { return by * (2 * random.unit() - 1); };
  for (int i = 0; i <= sheet.along; ++i) {
    for (int j = 0; j <= sheet.across; ++j) {
      const bool moves = is_moved(sheet, i, j);
      const double x = moves && i > kKept && i < sheet.along ? moved() : 0;
      const double z = moves && j > 0 && j < sheet.across ? moved() : 0;
      mesh.positions.push_back({dx * (i + x), 0, dz * (j + z)});
    }
  }
  Faces faces(mesh, static_cast<std::uint32_t>(sheet.across) + 1);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sheet.along); ++i) {
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(sheet.across); ++j) {
      const Cut cut = random.below(2) == 0 ? Cut::first : Cut::second;
      faces.add(i, j, is_cut(sheet, static_cast<int>(i), static_cast<int>(j)) ? cut : Cut::none);
    }
  }
  return mesh;
}

}  // namespace

std::string_view name(Pattern pattern) {
  switch (pattern) {
    case Pattern::quads:
      return "quads";
    case Pattern::right_angled:
      return "right-angled triangles";
    case Pattern::jittered:
      return "jittered quads";
    case Pattern::equilateral:
      return "equilateral triangles";
    case Pattern::irregular:
      return "irregular triangles";
    case Pattern::patchwork:
      return "a patchwork";
  }
  return {};
}

MeshDescription mesh_of(const Sheet& sheet, const Material& material) {
  MeshDescription mesh = sheet.pattern == Pattern::equilateral ? equilateral(sheet) : grid(sheet);
  mesh.material = material;
  return mesh;
}

Vec3 rolled(Vec3 p, double radius, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double along = c * p.x + s * p.z, across = c * p.z - s * p.x;
  const double u = radius * std::sin(along / radius);
  return {c * u - s * across, radius * (1 - std::cos(along / radius)), s * u + c * across};
}

Sheet sheet_of(Pattern pattern, double length, double width, int along) {
  const double cells = width * along / length;
  const bool narrow = pattern == Pattern::equilateral;
  Sheet sheet{.pattern = pattern, .length = length, .width = width, .along = along};
  sheet.across =
      std::max(1, static_cast<int>(std::round(narrow ? 2 * cells / std::numbers::sqrt3 : cells)));
  if (narrow) sheet.width = sheet.across * length / along * std::numbers::sqrt3 / 2;
  return sheet;
}

std::string size_of(const Sheet& sheet) {
  return fmt::format("{} x {} cells", sheet.along, sheet.across);
}

void pin(MeshDescription& mesh, const Place& is_pinned) {
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    if (is_pinned(mesh.positions[i])) mesh.pins.push_back(i);
  }
}

SceneDescription scene_of(const MeshDescription& mesh) {
  auto cloth = cloth_from_mesh(mesh);
  if (!cloth) throw std::runtime_error(cloth.error());
  return std::move(cloth.value().scene);
}

std::vector<std::uint32_t> particles_at(const SceneDescription& scene, const Place& is_there) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    if (is_there(scene.positions[i])) found.push_back(i);
  }
  return found;
}

MeshDescription hanging_mesh(const Sheet& sheet, const Material& material) {
  MeshDescription mesh = mesh_of(sheet, material);
  for (Vec3& p : mesh.positions) p = {p.z, -p.x, 0};
  pin(mesh, [](Vec3 p) { return p.y > -kNear; });
  return mesh;
}

Strip hanging_strip(const Sheet& sheet, const Material& material) {
  Strip strip{.sheet = sheet, .scene = scene_of(hanging_mesh(sheet, material))};
  strip.end = particles_at(strip.scene, [&](Vec3 p) { return p.y < kNear - sheet.length; });
  return strip;
}

Strip clamped_strip(Pattern pattern, const Material& material, double length, double width,
                    int cells) {
  const double cell = length / (cells + 0.5);
  Strip strip{.sheet = sheet_of(pattern, (cells + 2) * cell, width, cells + 2),
              .clamp = 1.5 * cell};
  MeshDescription mesh = mesh_of(strip.sheet, material);
  pin(mesh, [&](Vec3 p) { return p.x < 2 * cell + kNear; });
  strip.scene = scene_of(mesh);
  const double end = strip.sheet.length - kNear;
  strip.end = particles_at(strip.scene, [&](Vec3 p) { return p.x > end; });
  return strip;
}

}  // namespace weft::tools::forms
