#include "tools/mesh.h"

#include <numeric>
#include <utility>

namespace weft::tools {

MeshDescription describe_mesh(std::vector<Vec3> vertices,
                              const std::vector<std::vector<std::uint32_t>>& faces) {
  MeshDescription description;
  description.positions = std::move(vertices);
  for (const auto& face : faces) {
    description.corners.insert(description.corners.end(), face.begin(), face.end());
    description.face_sizes.push_back(static_cast<std::uint32_t>(face.size()));
  }
  return description;
}

Mesh line_mesh(const SceneDescription& scene) {
  Mesh mesh;
  mesh.vertices = scene.positions;
  mesh.particle_of_vertex.resize(scene.positions.size());
  std::iota(mesh.particle_of_vertex.begin(), mesh.particle_of_vertex.end(), 0u);
  for (const Constraint& constraint : scene.constraints) {
    mesh.lines.push_back({constraint.a, constraint.b});
  }
  return mesh;
}

std::vector<Vec3> vertex_positions(const Mesh& mesh, const Cloth& cloth) {
  std::vector<Vec3> positions = mesh.vertices;
  for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) {
    const std::uint32_t particle = mesh.particle_of_vertex[vertex];
    if (particle != kNoIndex) positions[vertex] = cloth.position(particle);
  }
  return positions;
}

}  // namespace weft::tools
