/// What pictures and measurements of a cloth need beside its particles: which vertices and faces
/// they carry, and which cells they weave. A mesh keeps the numbering of the file that it came
/// from, so that saved frames fit that file.
#pragma once

#include <weft/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace weft::tools {

struct Mesh {
  std::vector<Vec3> vertices;  ///< where they start
  /// One per vertex; vertices of one particle move as one. kNoIndex: no particle, it stays.
  std::vector<std::uint32_t> particle_of_vertex;
  std::vector<std::vector<std::uint32_t>> faces;  ///< vertex numbers, in order around the face
  std::vector<std::vector<std::uint32_t>> lines;  ///< vertex numbers along each line
  std::vector<std::array<std::uint32_t, 4>> cells = {};  ///< of particles, as MeshCloth::cells
};

/// Vertices and faces alone.
MeshDescription describe_mesh(std::vector<Vec3> vertices,
                              const std::vector<std::vector<std::uint32_t>>& faces);

/// One vertex per particle and one line per constraint.
Mesh line_mesh(const SceneDescription& scene);
/// One vertex per particle, these faces, and lines where constraints lead to particles of no face.
Mesh face_mesh(const SceneDescription& scene, std::vector<std::vector<std::uint32_t>> faces);
/// Each face as a fan around its first corner, but for triangles with two equal corners.
std::vector<std::array<std::uint32_t, 3>> triangles_of(
    const std::vector<std::vector<std::uint32_t>>& faces);
/// The faces with their particles in place of the vertices.
std::vector<std::vector<std::uint32_t>> particle_faces(const Mesh& mesh);

std::vector<Vec3> particle_positions(const Cloth& cloth);
/// Where the mesh's vertices are if its particles are there.
std::vector<Vec3> vertex_positions(const Mesh& mesh, const std::vector<Vec3>& particles);

}  // namespace weft::tools
