/// What a renderer draws of a cloth: vertices with normals, of the mesh that the cloth was made of
/// or of another, finer or coarser one that follows it.
///
///   auto made = weft::cloth_from_mesh(mesh);                          // as mesh.h says
///   auto skirt = weft::surface_of_mesh(mesh, made.value());           // once
///   std::vector<float> buffer(8 * mesh.positions.size());             // position, normal, texture
///
///   cloth.step(1.0 / 60);                                             // each frame
///   skirt.value().read_vertices(cloth, {buffer, 8}, {std::span(buffer).subspan(3), 8}, camera);
///
///   auto fine = weft::map_surface(mesh, made.value(), render_mesh);   // another mesh for the eye
///   fine.value().read_vertices(cloth, ...);                           // vertices of render_mesh
///
///   auto near = weft::map_surface(far_mesh, far_made, near_mesh);     // a level of detail
///   near.value().copy_shape(far_cloth, near_cloth);                   // near_cloth goes on from
///   there
///
/// weft.h does not include this header; this header includes mesh.h.
#pragma once

#include <weft/mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace weft {

/// The vertices of a mesh, as they follow from the particles of a cloth. Copies made by clone()
/// share what does not change. Each belongs to one thread at a time, since it holds the workspace
/// of its reads; which cloth it reads is said at each call. A surface that was moved from can only
/// be assigned to or destroyed.
class WEFT_API Surface {
 public:
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;
  ~Surface();
  Surface clone() const;

  std::size_t vertex_count() const;    ///< of the mesh
  std::size_t particle_count() const;  ///< of the cloths that it reads
  /// For an index buffer: vertices of the faces of the mesh, in their order and as they are wound.
  /// Four-sided faces are cut along the diagonal that is shorter at the beginning, those of more
  /// corners around the first.
  std::span<const std::array<std::uint32_t, 3>> triangles() const;

  /// Writes one position, m, relative to the origin (Cloth::read_positions), and one normal per
  /// vertex. One of the two may be left out: {}. Nothing is allocated, and nothing of the buffers
  /// is read, so that they may be memory of a graphics card.
  ///
  /// Normals are smooth and of length 1. That of a vertex is the sum of the normals of the faces
  /// around it, each as much as its area. Faces count at all vertices of one particle (of the
  /// followed cloth's mesh: vertices at one place, or nearer than weld_distance, or sewn), so that
  /// edges of texture coordinates do not show; there are no hard edges. Where the areas sum to
  /// nothing (threads, faces that have collapsed) the normal is (0, 0, 1). Of faces with the same
  /// corners, as files of two-sided surfaces have them, the first counts; vertices that only
  /// others of them have, wound the other way, have its normals turned around.
  ///
  /// Vertices in no face and no line have no particle (MeshCloth::particle_of_vertex is kNoIndex)
  /// and are not drawn: what stands in the buffers for them is left as it is.
  Result<void> read_vertices(const Cloth& from, FloatVectors positions, FloatVectors normals = {},
                             Vec3 origin = {});

  /// `to`, a cloth of another level of detail, takes the shape and the velocities of `from`: its
  /// particles are written where this surface has them (Cloth::write_positions, write_velocities).
  /// This surface must be one of map_surface whose `other` is the mesh that `to` was made of. What
  /// is out of tolerance then is projected as the next step of `to` begins. That takes long where
  /// the coarse cloth is folded between its vertices: Settings::max_iterations bounds it (a skirt
  /// of 1,800 particles from one of 288: 12 ms by 60 of them, 1.8 s by the default, each within 1
  /// %). Fixed particles move as all others: place_fixed() puts them where they belong. Bodies,
  /// anchors, forces and gravity stay those of `to`.
  Result<void> copy_shape(const Cloth& from, Cloth& to);

  std::size_t bytes() const;  ///< held by this surface, with what clones share

 private:
  struct Impl;
  explicit Surface(std::unique_ptr<Impl> impl);
  friend Result<Surface> surface_of_mesh(const MeshDescription&, const MeshCloth&);
  friend Result<Surface> map_surface(const MeshDescription&, const MeshCloth&,
                                     const MeshDescription&, double);
  std::unique_ptr<Impl> impl_;
};

/// The mesh itself, whose particles the cloth has. cloth: what cloth_from_mesh made of it.
WEFT_API Result<Surface> surface_of_mesh(const MeshDescription& mesh, const MeshCloth& cloth);

/// Another mesh that follows the faces of `mesh`. Both are taken as they lie at the beginning, in
/// `positions`. Each vertex of the other belongs to the nearest triangle of the mesh
/// (Surface::triangles), and stays where it is as three shares of the corners of that triangle, and
/// a distance along the smooth normal there (along the triangle's own, where the two differ by more
/// than 60 degrees). So
///
/// - every rigid motion of the cloth is that of the other mesh, and at the beginning it lies where
///   its description says, to the precision of floats;
/// - what lies in the triangles moves with them, and so does, in their planes, what lies beside the
///   border of the cloth: every affine map of the cloth is one of the other mesh;
/// - what lies at a distance keeps that, however the cloth stretches.
///
/// The velocities of copy_shape are those of this motion. Vertices of the other mesh at one place,
/// or nearer than its weld_distance, or sewn, are one point. A vertex that is farther than
/// max_distance, m, from the mesh is refused. Of the other mesh positions, faces, lines, seams and
/// welds count, but neither material nor pins.
WEFT_API Result<Surface> map_surface(const MeshDescription& mesh, const MeshCloth& cloth,
                                     const MeshDescription& other,
                                     double max_distance = std::numeric_limits<double>::infinity());

}  // namespace weft
