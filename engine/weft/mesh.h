/// Meshes and materials: makes a SceneDescription of faces, seams and a fabric.
///
///   weft::MeshDescription mesh = ...;                 // positions and faces, as a file has them
///   mesh.material = weft::find_material("cotton").value();
///   auto cloth = weft::cloth_from_mesh(mesh);         // welds, sews, derives springs and masses
///   if (!cloth) std::puts(cloth.error().c_str());     // one line: field, index and value
///   auto model = weft::build_model(cloth.value().scene);
///
/// The scene is a plain SceneDescription, which may be changed before a model is built. Units are
/// m, kg, s and N. All functions may be called by any thread. This header includes weft.h; weft.h
/// does not include it.
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

/// Properties of a fabric, whatever mesh it has. Stiffnesses are forces per width: a strip of width
/// b that is stretched by the fraction e pulls with the force warp b e.
struct Material {
  double density = 0;     ///< kg/m^2; > 0
  double thickness = 0;   ///< m; at least 0. Above 0 it is SelfContact::thickness.
  double friction = 0.3;  ///< at least 0. It is SelfContact::friction.
  double warp = 0;        ///< N/m, of the yarns along the cloth; > 0
  double weft = 0;        ///< N/m, of the yarns across the cloth; > 0
  double shear = 0;       ///< N/m, per radian of shear; at least 0
  /// N m: a cylinder of curvature c, whatever its direction, stores bending c^2 / 2 per area.
  double bending = 0;          ///< at least 0
  double damping_stretch = 0;  ///< s, as Damping::stretch
  double damping_bending = 0;  ///< s, as Damping::bending
  double damping_motion = 0;   ///< 1/s, as Damping::motion
  double drag = 0;             ///< as Air::drag
  double lift = 0;             ///< as Air::lift
  double ram = 0;              ///< as Air::ram
  /// N/m, > 0: a strip of width b, pulled evenly, tears at the force strength b. Infinite: it never
  /// does (Tear).
  double strength = std::numeric_limits<double>::infinity();
  /// 1/m, > 0: cloth that is bent more keeps a crease. Once released it rests at the curvature
  /// to which it was bent, less this one. Infinite: it never yields (BendingElement).
  double bending_yield = std::numeric_limits<double>::infinity();
  /// At least 0. Beyond its yield the moment of bending rises by this times as much as the crease:
  /// bent to the curvature c, cloth keeps (c - bending_yield) / (1 + bending_hardening).
  double bending_hardening = 0;
  /// N, at least 0: the moment per width by which inner friction resists bending, beside the moment
  /// of `bending`. It is half of the width of the loop of moment against curvature. Kawabata
  /// measures that width as 2HB, in gf cm/cm: 0.01 of 2HB is 4.9e-5 N (Kawabata, The
  /// Standardization and Analysis of Hand Evaluation, 1980).
  double bending_friction = 0;
  /// 1/m, > 0: the change of curvature at which friction reaches its full value. Up to there the
  /// moment rises as that of a spring of the stiffness bending_friction / bending_slip, N m.
  double bending_slip = 10;
};

/// The error is one line that names the field and the value that were refused.
WEFT_API Result<void> check_material(const Material& material);

struct NamedMaterial {
  std::string_view name;
  Material material;
  std::string_view source;  ///< origin of the values
};

/// Common fabrics. Fabrics of one name differ by a factor of two and more; these are examples.
WEFT_API std::span<const NamedMaterial> materials();
/// The error lists the known names.
WEFT_API Result<Material> find_material(std::string_view name);

// ----------------------------------------------------------------------------------------- meshes

/// The constraints that only pull.
/// none: all constraints are distances.
/// diagonals: both diagonals of four-sided faces are ropes.
/// all: all constraints are ropes.
enum class Ropes : std::uint8_t { none, diagonals, all };

/// A surface at the beginning, and its shape at rest. Vertices become particles, except those in no
/// face and no line.
///
/// Without a material every edge of a face becomes a rigid constraint of its length: first the
/// edges, in the order of the faces, then every line. Four-sided faces have diagonals only if
/// `ropes` asks for them.
///
/// With a material faces stretch, shear and bend as the material says, whatever their shape:
///
/// - A four-sided face that is nearly a rectangle, along warp and weft, becomes springs: its edges
///   carry warp and weft and its diagonals shear, within 3 % of the material. Chains of such edges
///   are solved as yarns, several times as fast as other cloth.
/// - Pairs of right-angled triangles that make up a grid of near-rectangles count as the four-sided
///   faces that they were cut from.
/// - All other faces become triangles, each a MembraneElement. An edge between two of them with
///   wide angles opposite to it is flipped, if the shape at rest and the warp stay nearly the same.
///
/// The warp, unless `warp` gives it: in four-sided faces two families of edges cross, from face to
/// face; opposite edges are of one family. The warp is the family that runs more along y or, if
/// both do so equally, more along x. This holds for each connected part that consists of
/// near-rectangles by more than half; the faces between them continue their warp. In other parts
/// the warp is the direction y within the plane of each face; in parts that lie level it is x.
///
/// Faces of five and more corners are cut into triangles around the first corner; they should be
/// convex. Lines are threads that do not stretch. A line along the edge of a face is ignored.
/// Threads may hang off the cloth, and a mesh may have threads alone. They collide as
/// cloth does, all along their length (SceneDescription::surface).
///
/// An edge of more than two faces stretches as the sum of them, and does not bend. Faces without
/// area are left out. If several faces have the same corners, as in files of two-sided surfaces,
/// all but the first are left out. (Corners count as the same only if their places at rest are the
/// same, so two layers of panels remain two.)
struct MeshDescription {
  std::vector<Vec3> positions;            ///< m, one per vertex
  std::vector<std::uint32_t> corners;     ///< vertices, face after face, in order around each
  std::vector<std::uint32_t> face_sizes;  ///< corners of each face, 3 or more; empty: triangles
  std::vector<std::array<std::uint32_t, 2>> lines;  ///< two vertices each
  /// The shape at rest, if it differs from `positions`: give one of these two, or neither. Lengths,
  /// areas, angles and masses are those of this shape; vertices are welded and pinned where they
  /// begin. A face that has an area at the beginning must have an area at rest. Angles between
  /// faces have a side (BendingElement::fold).
  ///
  /// In space: one place per vertex, m.
  std::vector<Vec3> rest_positions;
  /// Flat, as panels and texture coordinates are: one place per entry of `corners`, m along the
  /// weft and m along the warp. An edge whose two faces give it different places is a seam between
  /// two panels. Lines are as long as at the beginning.
  std::vector<std::array<double, 2>> rest_corners;
  /// Direction of the warp of a material, in the shape at rest (with flat places (u, v, 0)): one
  /// for all faces, or one per face, of any length. Only the part in the plane of the face counts.
  /// A face that has no direction, or one across its plane, continues the faces beside it. Empty:
  /// as said above; with flat places along v.
  std::vector<Vec3> warp;
  std::vector<std::uint32_t> pins;   ///< vertices whose particles are fixed
  std::optional<Material> material;  ///< none: rigid edges
  double mass = 1;                   ///< kg of the whole, shared equally; used without a material
  /// kg/m, of lines that are threads; used with a material. The default, 1 g/m or 1,000 tex, is a
  /// thick yarn as in fringes and tassels.
  double thread_density = 1e-3;
  /// m. Vertices that are this near become one particle, and so do vertices that a chain of such
  /// pairs joins. 0: only vertices at exactly equal positions, as files repeat them along seams of
  /// texture coordinates.
  double weld_distance = 0;
  /// Pairs of vertices that are sewn together, wherever they lie: each pair becomes one particle,
  /// at the mean of their positions. Lengths, areas and angles remain those of each face by itself.
  /// Across a seam (an edge whose faces lie apart at rest) the cloth bends as elsewhere, and is
  /// flat at rest.
  std::vector<std::array<std::uint32_t, 2>> seams;
  /// s. 0: pairs are sewn from the beginning, as above. Greater than 0, for panels that begin
  /// apart: the vertices of each pair remain two particles, and a seam of the scene draws them
  /// together in this time (Seam), with the force seam_force, N, at most. Across such a seam
  /// nothing bends.
  double seam_time = 0;
  double seam_force = std::numeric_limits<double>::infinity();  ///< N
  Ropes ropes = Ropes::none;
};

/// Counts of a mesh. Triangles and quads are counted after faces of more corners and concave faces
/// are cut, and faces without area are left out.
struct MeshCounts {
  std::size_t triangles = 0;
  std::size_t quads = 0;               ///< four-sided faces, with recognised_quads
  std::size_t recognised_quads = 0;    ///< pairs of triangles that are cells of a grid
  std::size_t welded_vertices = 0;     ///< vertices that share the particle of an earlier vertex
  std::size_t unused_vertices = 0;     ///< in no face and no line
  std::size_t degenerate_faces = 0;    ///< without area, left out
  std::size_t double_faces = 0;        ///< with all corners of an earlier face, left out
  std::size_t non_manifold_edges = 0;  ///< edges of more than two faces
  std::size_t thread_lines = 0;        ///< lines that became threads, with a material
  std::size_t pieces = 0;              ///< connected parts
  std::size_t loose_pieces = 0;        ///< pieces without a pin
  /// m, a power of ten. As weld_distance it would join loose pieces to the cloth that they lie
  /// against, across gaps of a twentieth of an edge at most. 0: there are no such gaps.
  double suggested_weld = 0;
};

/// The result of cloth_from_mesh.
struct MeshCloth {
  SceneDescription scene;  ///< particles in the order of their first vertices
  std::vector<std::uint32_t> particle_of_vertex;  ///< kNoIndex: vertex in no face and no line
  MeshCounts counts;
  /// Faces that became springs: particles in order around each, the first two along the warp.
  std::vector<std::array<std::uint32_t, 4>> cells;
};

/// Directions for MeshDescription::warp, one per face, in the shape at rest: v of the texture
/// coordinates grows along it, and u is constant. texture: one (u, v) per entry of `corners`, in
/// any unit; a face that has an area must have an area in the texture.
WEFT_API Result<std::vector<Vec3>> warp_from_texture(
    const MeshDescription& mesh, std::span<const std::array<double, 2>> texture);

/// Makes a scene of a mesh. On an error nothing is made; the error is one line that names the
/// field, the index and the value.
WEFT_API Result<MeshCloth> cloth_from_mesh(const MeshDescription& mesh);

}  // namespace weft
