/// Wavefront OBJ meshes: read as cloth, and written.
///
/// What a file has becomes cloth as weft/mesh.h says. Vertices in no face or line are kept for
/// writing but are no particles. Any number of objects and groups may be in the file; together they
/// are one cloth.
///
/// Written are the mesh as object "cloth" with the file's own numbering and faces, without
/// materials and texture coordinates, and every sphere of the scene as an object
/// "sphere_<particle>".
#pragma once

#include <weft/mesh.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scenes/mesh.h"

namespace weft::tools {

struct ObjOptions {
  /// Which vertices are fixed, in the file's coordinates: "none", "top" (the topmost thousandth of
  /// the height), one comparison like "y>0.9" or "x<=-1", or vertex numbers from 0: "0,5,7-9";
  /// several of them with "and" and "or" between, where "and" binds more tightly.
  std::string pin = "none";
  double Vec3::*up = &Vec3::y;  ///< against gravity
  double weld_distance = 0;     ///< m, as that of MeshDescription
  /// Vertices that are sewn, in lists of the same length: "0-9:29-20" sews 0 to 29, 1 to 28, ...
  std::vector<std::string> seams = {};
  double seam_time = 0;                                      ///< s, as that of MeshDescription
  std::optional<double> seam_force = {};                     ///< N, likewise; none: no limit
  std::optional<std::string> rest = {};                      ///< as rest_and_warp.h says
  std::optional<std::string> warp = {};                      ///< likewise
  double thread_density = MeshDescription{}.thread_density;  ///< kg/m, of lines; with a material
  double mass = 1;   ///< kg, shared equally by all particles; without a material
  double scale = 1;  ///< multiplies all coordinates
  Ropes ropes = Ropes::none;
  std::optional<Material> material = std::nullopt;
};

struct ObjScene {
  SceneDescription description;
  Mesh mesh;
  MeshCounts counts;
};

Result<ObjScene> parse_obj(const std::string& text, const ObjOptions& options);
Result<ObjScene> read_obj_file(const std::string& path, const ObjOptions& options);

/// The OBJ text of the mesh and the scene's spheres where the particles are.
std::string obj_text(const Mesh& mesh, const SceneDescription& scene,
                     const std::vector<Vec3>& particles);

}  // namespace weft::tools
