#include "tools/scenes/mesh.h"

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

Mesh line_mesh(const SceneDescription& scene) { return face_mesh(scene, {}); }

Mesh face_mesh(const SceneDescription& scene, std::vector<std::vector<std::uint32_t>> faces) {
  Mesh mesh;
  mesh.vertices = scene.positions;
  mesh.particle_of_vertex.resize(scene.positions.size());
  std::iota(mesh.particle_of_vertex.begin(), mesh.particle_of_vertex.end(), 0u);
  mesh.faces = std::move(faces);
  std::vector<bool> in_face(scene.positions.size());
  for (const auto& face : mesh.faces) {
    for (const std::uint32_t particle : face) in_face[particle] = true;
  }
  const auto shown = [&](std::uint32_t particle) {  // a file may name one that there is not
    return particle < in_face.size() && in_face[particle];
  };
  for (const Constraint& constraint : scene.constraints) {
    if (shown(constraint.a) && shown(constraint.b)) continue;
    mesh.lines.push_back({constraint.a, constraint.b});
  }
  return mesh;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(
    const std::vector<std::vector<std::uint32_t>>& faces) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& face : faces) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const std::uint32_t a = face[0], b = face[i], c = face[i + 1];
      if (a != b && b != c && c != a) triangles.push_back({a, b, c});
    }
  }
  return triangles;
}

std::vector<std::vector<std::uint32_t>> particle_faces(const Mesh& mesh) {
  std::vector<std::vector<std::uint32_t>> faces = mesh.faces;
  for (auto& face : faces) {
    for (std::uint32_t& corner : face) corner = mesh.particle_of_vertex[corner];
  }
  return faces;
}

std::vector<Vec3> particle_positions(const Cloth& cloth) {
  std::vector<Vec3> positions;
  for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) positions.push_back(cloth.position(i));
  return positions;
}

std::vector<Vec3> vertex_positions(const Mesh& mesh, const std::vector<Vec3>& particles) {
  std::vector<Vec3> positions = mesh.vertices;
  for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) {
    const std::uint32_t particle = mesh.particle_of_vertex[vertex];
    if (particle != kNoIndex) positions[vertex] = particles[particle];
  }
  return positions;
}

}  // namespace weft::tools
