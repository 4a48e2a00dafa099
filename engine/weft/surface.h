/// Vertices and normals for a renderer: of the mesh that a cloth was made of, or of another mesh,
/// finer or coarser, that follows the cloth.
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
///   near.value().copy_shape(far_cloth, near_cloth);                   // near_cloth goes on there
///
///   if (skirt.value().follow(cloth).value()) { ... }              // it tears: larger buffers
///
/// The buffers are the caller's. Errors are one line, and then nothing is written. This header
/// includes mesh.h; weft.h does not include it.
#pragma once

#include <weft/mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace weft {

/// Computes the vertices of a mesh from the particles of a cloth. Each call names the cloth. A
/// Surface holds the workspace of its reads, so one thread at a time may use it. clone() makes a
/// copy for another thread, which shares all data that do not change. After a move, the old object
/// can only be assigned to or destroyed.
class WEFT_API Surface {
 public:
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;
  ~Surface();
  Surface clone() const;

  std::size_t vertex_count() const;    ///< of the mesh, and those that tears have added
  std::size_t particle_count() const;  ///< of the cloths that it reads
  /// Triangles for an index buffer: the faces of the mesh, in their order and as they are wound.
  /// Four-sided faces are cut along the diagonal that is shorter at the beginning; faces of more
  /// corners are cut around the first corner. Faces of cloth that may tear are cut as its fabric
  /// is (SceneDescription::surface), and those that have to be cut across others come last.
  std::span<const std::array<std::uint32_t, 3>> triangles() const;

  /// Takes on the tears of a cloth, after a step with StepReport::torn: where a sheet is split,
  /// vertices along the tear become several, and triangles() has the new ones. A mapped mesh splits
  /// along its own edges that are next to the tear. Returns whether vertex_count() and triangles()
  /// differ from those before. A cloth that has not torn gives the surface as it was made, so one
  /// surface may follow several cloths in turns. Nothing is done, and at no cost, where the cloth
  /// has not torn since.
  ///
  /// On a cloth that tears, something must have a strength in MeshCloth::scene when the surface is
  /// made. The reads refuse a cloth whose tears are not followed.
  Result<bool> follow(const Cloth& from);
  /// For each vertex behind those of the mesh: the vertex of the mesh that it was split from, whose
  /// texture coordinates it has. The next tear may number them otherwise.
  std::span<const std::uint32_t> split_from() const;

  /// Writes one position (m, relative to the origin, as Cloth::read_positions) and one normal per
  /// vertex. Either buffer may be left out: {}. Nothing is allocated. The buffers are only written,
  /// never read, so they may be memory of a graphics card.
  ///
  /// Normals are smooth and of length 1; there are no hard edges. The normal of a vertex is the sum
  /// of the normals of the faces around it, weighted by their areas. A face counts at all vertices
  /// of one particle (for map_surface: at vertices of one place, or nearer than weld_distance, or
  /// sewn), so edges of texture coordinates do not show. Vertices of a seam that has closed
  /// (MeshDescription::seam_time) have one place, their mean, and one normal, except with
  /// map_surface. If the areas sum to zero (threads, collapsed faces) the normal is (0, 0, 1).
  /// If several faces have the same corners, as in files of two-sided surfaces, the first
  /// counts. A vertex of the other faces alone, which are wound the other way, has the opposite
  /// normal.
  ///
  /// Vertices in no face and no line have no particle (MeshCloth::particle_of_vertex is kNoIndex)
  /// and are not drawn: their floats in the buffers stay as they are.
  Result<void> read_vertices(const Cloth& from, FloatVectors positions, FloatVectors normals = {},
                             Vec3 origin = {});

  /// Gives `to`, a cloth of another level of detail, the shape and the velocities of `from`: its
  /// particles are written where this surface has them (Cloth::write_positions, write_velocities).
  /// The surface must come from map_surface(mesh, cloth, other), and `to` must be made from
  /// `other`.
  ///
  /// Positions out of tolerance are projected when the next step of `to` begins. This takes long
  /// where the coarse cloth is folded between its vertices; Settings::max_iterations bounds it. (A
  /// skirt of 1,800 particles from one of 288 took 12 ms with a max_iterations of 60 and 1.8 s with
  /// the default, each within 1 %.) Fixed particles move as all others do: place_fixed() puts them
  /// where they belong. `to` keeps its bodies, anchors, forces and gravity. A cloth that is split
  /// by a tear has no shape for another one, and is refused.
  Result<void> copy_shape(const Cloth& from, Cloth& to);

  std::size_t bytes() const;  ///< held by this surface, with the data that clones share

 private:
  struct Impl;
  explicit Surface(std::unique_ptr<Impl> impl);
  friend Result<Surface> surface_of_mesh(const MeshDescription&, const MeshCloth&);
  friend Result<Surface> map_surface(const MeshDescription&, const MeshCloth&,
                                     const MeshDescription&, double);
  std::unique_ptr<Impl> impl_;
};

/// The surface of the mesh itself. cloth: the result of cloth_from_mesh for this mesh.
WEFT_API Result<Surface> surface_of_mesh(const MeshDescription& mesh, const MeshCloth& cloth);

/// Another mesh that follows the faces of `mesh`. Both are used as they lie at the beginning, in
/// `positions`. Each vertex of the other mesh belongs to the nearest triangle of the mesh
/// (Surface::triangles). Its place is three shares of the corners of that triangle, and a distance
/// along the smooth normal there (along the triangle's own normal, if the two differ by more than
/// 60 degrees). So
///
/// - at the beginning the other mesh lies where its description says, to the precision of floats,
///   and it follows every rigid motion of the cloth;
/// - vertices that lie in the triangles move with them, and vertices beside the border of the cloth
///   move with the plane of their triangle: every affine map of the cloth is an affine map of the
///   other mesh;
/// - vertices at a distance keep that distance, however the cloth stretches.
///
/// copy_shape gives the velocities of this motion. Vertices of the other mesh at one place, or
/// nearer than its weld_distance, or sewn, are one point. A vertex that is farther than
/// max_distance, m, from the mesh is refused. The positions, faces, lines, seams and welds of the
/// other mesh count; its material and its pins do not.
WEFT_API Result<Surface> map_surface(const MeshDescription& mesh, const MeshCloth& cloth,
                                     const MeshDescription& other,
                                     double max_distance = std::numeric_limits<double>::infinity());

}  // namespace weft
