#include "tools/mesh.h"

#include <numeric>
#include <utility>

namespace weft::tools {
namespace {

/// The first `count` particles are the vertices, under their own numbers.
Mesh particle_mesh(const SceneDescription& scene, std::size_t count) {
  Mesh mesh;
  mesh.vertices.assign(scene.positions.begin(),
                       scene.positions.begin() + static_cast<std::ptrdiff_t>(count));
  mesh.particle_of_vertex.resize(count);
  std::iota(mesh.particle_of_vertex.begin(), mesh.particle_of_vertex.end(), 0u);
  return mesh;
}

}  // namespace

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

Mesh grid_mesh(const SceneDescription& scene, std::uint32_t size) {
  Mesh mesh = particle_mesh(scene, std::size_t{size} * size);
  for (std::uint32_t i = 0; i + 1 < size; ++i) {
    for (std::uint32_t j = 0; j + 1 < size; ++j) {
      const std::uint32_t corner = i * size + j;
      mesh.faces.push_back({corner, corner + 1, corner + size + 1, corner + size});
    }
  }
  return mesh;
}

Mesh face_mesh(const SceneDescription& scene, std::vector<std::vector<std::uint32_t>> faces) {
  Mesh mesh = particle_mesh(scene, scene.positions.size());
  mesh.faces = std::move(faces);
  return mesh;
}

Mesh line_mesh(const SceneDescription& scene) {
  Mesh mesh = particle_mesh(scene, scene.positions.size());
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
