/// Sheets of several patterns of faces: what the closed forms are measured on.
#pragma once

#include <weft/mesh.h>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::tools::forms {

/// right_angled: cells cut in two, by chance; they are recognised as the grid that they were cut
/// from. equilateral: columns of triangles with edges along the sheet, and halves at its ends.
/// jittered: quads whose inner corners are moved by up to 8 % of a cell. irregular: cells cut by
/// chance whose inner corners are moved by up to a quarter of them. patchwork: irregular in the
/// middle, quads around.
enum class Pattern { quads, right_angled, jittered, equilateral, irregular, patchwork };
std::string_view name(Pattern);

/// Level, from x = 0 to `length` and from z = 0 to `width`.
struct Sheet {
  Pattern pattern = Pattern::quads;
  double length = 1;  ///< m
  double width = 1;   ///< m
  int along = 8;      ///< cells, along the length
  int across = 2;     ///< cells, or columns of triangles
};
/// As many columns as are nearly as wide as cells are long; equilateral ones make it a little wider
/// or narrower.
Sheet sheet_of(Pattern pattern, double length, double width, int along);
MeshDescription mesh_of(const Sheet& sheet, const Material& material);
/// "32 x 4 cells"
std::string size_of(const Sheet& sheet);

inline Material cotton() { return find_material("cotton").value(); }

using Place = std::function<bool(Vec3)>;
void pin(MeshDescription& mesh, const Place& is_pinned);
/// As cloth_from_mesh makes it. Throws where it refuses.
SceneDescription scene_of(const MeshDescription& mesh);
std::vector<std::uint32_t> particles_at(const SceneDescription& scene, const Place& is_there);

/// The level plane rolled up, without stretching, around an axis that is `angle` away from z.
Vec3 rolled(Vec3 p, double radius, double angle);

/// A sheet that is held at one end, and the particles of its other end.
struct Strip {
  Sheet sheet;
  SceneDescription scene{};
  std::vector<std::uint32_t> end{};
  double clamp = 0;  ///< m, from the sheet's beginning
};

/// From its upper end down, along -y, held by that end.
MeshDescription hanging_mesh(const Sheet& sheet, const Material& material);
Strip hanging_strip(const Sheet& sheet, const Material& material);

/// Level, `length` from the clamp to the free end, in so many cells and a half. Three rows of
/// vertices are fixed: the half cell behind the last of them is what bends there, so the clamp is
/// in the middle between the last two.
Strip clamped_strip(Pattern pattern, const Material& material, double length, double width,
                    int cells);

}  // namespace weft::tools::forms
