/// glTF 2.0 in one binary file (.glb): the cloth as it starts, each frame as a morph target, and an
/// animation that goes from one to the next in straight lines.
///
/// Vertices are those of the object "cloth" in the OBJ file that the same run writes, in its order,
/// with faces cut into triangles. There are no normals: readers make them. Vertices in no face and
/// no line are there, too.
#pragma once

#include <weft/weft.h>

#include <string>
#include <vector>

#include "tools/scenes/mesh.h"

namespace weft::tools {

class GltfMotion {
 public:
  /// up_is_z: a node turns the cloth, since y is up in glTF. The mesh must outlive this.
  GltfMotion(const Mesh& mesh, bool up_is_z) : mesh_(&mesh), up_is_z_(up_is_z) {}
  /// Vertices, `seconds` after the start; the first sample is the start.
  void add_sample(const std::vector<Vec3>& vertices, double seconds);
  /// The file. An error if it has no place in a .glb of 4 GB.
  Result<std::string> bytes() const;

 private:
  const Mesh* mesh_;
  bool up_is_z_;
  std::vector<float> times_;
  std::vector<std::vector<float>> samples_;  ///< the first one, then differences from it
};

}  // namespace weft::tools
