/// Meshes and materials: what a cloth is described by before it is particles and constraints.
///
///   weft::MeshDescription mesh = ...;                 // positions and faces, as a file has them
///   mesh.material = weft::find_material("cotton").value();
///   auto cloth = weft::cloth_from_mesh(mesh);         // welds, sews, derives springs and masses
///   auto model = weft::build_model(cloth.value().scene);
///
/// weft.h does not include this header; this header includes weft.h. What it makes is a plain
/// SceneDescription, which may be changed before a model is built.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace weft {

// -------------------------------------------------------------------------------------- materials

/// A cloth's own properties, whatever mesh describes it. Stiffnesses are forces per width: a strip
/// of width b that is stretched by the fraction e pulls with warp b e.
struct Material {
  double density = 0;    ///< kg/m^2; > 0
  double thickness = 0;  ///< m; at least 0. Nothing that cloth_from_mesh makes depends on it.
  double warp = 0;       ///< N/m, of the yarns along the cloth; > 0
  double weft = 0;       ///< N/m, of those across; > 0
  double shear = 0;      ///< N/m, per radian of shear; at least 0
  /// N m: a cylinder of curvature c, whatever its direction, stores bending c^2 / 2 per area.
  double bending = 0;          ///< at least 0
  double damping_stretch = 0;  ///< s, as Damping::stretch
  double damping_bending = 0;  ///< s, as Damping::bending
  double damping_motion = 0;   ///< 1/s, as Damping::motion
  double drag = 0;             ///< as Air::drag
  double lift = 0;             ///< as Air::lift
};

/// One line that names the field and the value that were refused.
WEFT_API Result<void> check_material(const Material& material);

struct NamedMaterial {
  std::string_view name;
  Material material;
  std::string_view source;  ///< where the values come from
};

/// Common fabrics. Cloth of one name differs by a factor of two and more; these are examples.
WEFT_API std::span<const NamedMaterial> materials();
/// The error lists the names that there are.
WEFT_API Result<Material> find_material(std::string_view name);

// ----------------------------------------------------------------------------------------- meshes

/// Which constraints only pull.
/// none: all are distances.
/// diagonals: those along both diagonals of four-sided faces.
/// all: every one.
enum class Ropes : std::uint8_t { none, diagonals, all };

/// A surface, where it begins and in its shape at rest. Vertices become particles; what is in no
/// face and no line does not.
///
/// Without a material every edge of a face becomes a rigid constraint at its length, faces in their
/// order, and then every line. Diagonals join four-sided faces only where they are asked for.
///
/// With a material faces stretch, shear and bend as it says, whatever their shapes and sizes.
///
/// Four-sided faces that are nearly rectangles, along warp and weft, become springs: edges carry
/// warp and weft, and diagonals shear, within 3 % of the material. Chains of such edges are solved
/// as yarns, several times as fast as other cloth. All other faces become triangles, each a
/// MembraneElement; where the angles against an edge between two of them are wide, the edge is
/// flipped if the shape at rest and the warp stay nearly the same. Pairs of right-angled triangles
/// that make up a grid of near-rectangles are taken as the four-sided faces that they were cut
/// from.
///
/// In four-sided faces two families of edges cross, from face to face: opposite edges are of one
/// family. The warp is the family that runs more along y; where both do alike, more along x. It is
/// so in each connected part that consists of near-rectangles by more than half, and what lies
/// between those continues them. In other parts the warp runs along y, as far as y lies in the
/// plane of each face; in parts that lie level, along x.
///
/// Faces of five and more corners are cut into triangles around the first; they should be convex.
/// Lines are threads that do not stretch. A line along the edge of a face counts for nothing.
/// Threads may hang off the cloth, and may be all that there is.
///
/// An edge of more than two faces stretches as the sum of them, and does not bend. Faces without
/// area are left out, and of faces with the same corners, as files of two-sided surfaces have them,
/// all but the first: corners at other places at rest are others, so that two layers of panels
/// remain two.
struct MeshDescription {
  std::vector<Vec3> positions;            ///< m, one per vertex
  std::vector<std::uint32_t> corners;     ///< vertices, face after face, in order around each
  std::vector<std::uint32_t> face_sizes;  ///< corners of each face, 3 or more; empty: triangles
  std::vector<std::array<std::uint32_t, 2>> lines;  ///< two vertices each
  /// The shape at rest, where it differs from `positions`: one of these two, or neither. Lengths,
  /// areas, angles and masses are those of this shape; vertices are welded and pinned where they
  /// begin. A face that has an area at the beginning must have one at rest.
  ///
  /// In space: one place per vertex, m.
  std::vector<Vec3> rest_positions;
  /// Flat, as panels and texture coordinates are: one place per entry of `corners`, m along the
  /// weft and m along the warp. Where two faces have an edge in different places there is a seam
  /// between two panels. Lines are as long as at the beginning.
  std::vector<std::array<double, 2>> rest_corners;
  /// Where the warp of a material runs, in the shape at rest (with flat places (u, v, 0)): one
  /// direction for all faces, or one per face, of any length. What lies in the plane of the face
  /// counts. A face to which no direction is given, or one across it, continues what is beside it.
  /// Empty: as said above; with flat places along v.
  std::vector<Vec3> warp;
  std::vector<std::uint32_t> pins;   ///< vertices whose particles are fixed
  std::optional<Material> material;  ///< none: rigid edges
  double mass = 1;                   ///< kg of the whole, shared equally; used without a material
  /// kg/m, of lines that are threads; with a material. The default is that of a thick yarn, as
  /// fringes and tassels have it: 1 g/m, or 1,000 tex.
  double thread_density = 1e-3;
  /// m. Vertices as near as this become one particle, and so do those that a chain of such
  /// vertices joins. 0: those at exactly equal positions, as files repeat them along seams of
  /// texture coordinates.
  double weld_distance = 0;
  /// Pairs of vertices that are sewn together, wherever they lie: they become one particle, at the
  /// mean of their positions. Lengths, areas and angles remain those of each face by itself. Across
  /// a seam, that is an edge whose faces lie apart at rest, the cloth bends as elsewhere and is
  /// flat at rest.
  std::vector<std::array<std::uint32_t, 2>> seams;
  /// s. Greater than 0: the vertices of each pair remain two particles, which a seam of the scene
  /// draws together in this time (Seam), with seam_force, N, at most. For panels that begin apart.
  /// Across such a seam nothing bends. 0: sewn from the beginning, as above.
  double seam_time = 0;
  double seam_force = std::numeric_limits<double>::infinity();
  Ropes ropes = Ropes::none;
};

/// What was found in a mesh. Triangles and quads are those that are left when faces of more
/// corners, concave ones and those without area are dealt with.
struct MeshCounts {
  std::size_t triangles = 0;
  std::size_t quads = 0;               ///< four-sided faces, recognised ones too
  std::size_t recognised_quads = 0;    ///< pairs of triangles that are cells of a grid
  std::size_t welded_vertices = 0;     ///< that share the particle of an earlier vertex
  std::size_t unused_vertices = 0;     ///< in no face and no line
  std::size_t degenerate_faces = 0;    ///< without area, left out
  std::size_t double_faces = 0;        ///< that an earlier face has all corners of, left out
  std::size_t non_manifold_edges = 0;  ///< of more than two faces
  std::size_t thread_lines = 0;        ///< that became threads beside a material
  std::size_t pieces = 0;              ///< that nothing joins to one another
  std::size_t loose_pieces = 0;        ///< of these, without a pin
  /// m, a power of ten: as weld_distance it would join loose pieces to what they lie against, with
  /// gaps of a twentieth of an edge at most. 0: there are no such gaps.
  double suggested_weld = 0;
};

struct MeshCloth {
  SceneDescription scene;  ///< particles in the order of their first vertices
  std::vector<std::uint32_t> particle_of_vertex;  ///< kNoIndex: none, in no face and no line
  MeshCounts counts;
  /// Faces that became springs: particles in order around each, the first two along the warp.
  std::vector<std::array<std::uint32_t, 4>> cells;
};

/// Per face, for MeshDescription::warp: the direction in which v of texture coordinates grows and u
/// stays, in the shape at rest. texture: one (u, v) per entry of `corners`, in any unit; a face
/// that has an area must have one in it.
WEFT_API Result<std::vector<Vec3>> warp_from_texture(
    const MeshDescription& mesh, std::span<const std::array<double, 2>> texture);

/// On error, one line that names the field, the index and the value, nothing is made.
WEFT_API Result<MeshCloth> cloth_from_mesh(const MeshDescription& mesh);

}  // namespace weft
