/// What is simulated: particles, and what joins and moves them. Part of weft.h.
#pragma once

#include <weft/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace weft {

struct Vec3 {
  double x = 0, y = 0, z = 0;
};

/// In place of the number of a particle or constraint: none.
inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// distance: |a - b| = rest_length. rope: |a - b| <= rest_length (pulls only).
enum class ConstraintKind : std::uint8_t { distance, rope };

/// With a compliance the constraint is a spring: its tension f obeys the law
///
///     |a - b| - rest_length = compliance f          (rope: f >= 0, and 0 where it is slack)
///
/// and a tolerance is about what is left of this law, as a fraction of rest_length. Without one the
/// law is that of a rigid edge. (Macklin et al., "XPBD", 2016; Servin et al. 2006.)
struct Constraint {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double rest_length = 0;  ///< m, 1e-150 to 1e150; on the simd backend 1e-18 to 1e18
  ConstraintKind kind = ConstraintKind::distance;
  double compliance = 0;  ///< m/N, inverse stiffness; finite, at least 0. 0: rigid
};

/// A bending spring over three or four particles. Its weights sum to zero, so that
///
///     d = sum of weights[i] x[particles[i]]
///
/// does not change when the particles move as one, and its energy is (|d| - rest)^2 / (2
/// compliance). With cotangent weights, rest 0 and a compliance of (A0 + A1) / (3 k) this is the
/// isometric bending of two triangles with the areas A0 and A1 and the stiffness k (Bergou et al.,
/// "A Quadratic Bending Model for Inextensible Surfaces", 2006).
struct BendingElement {
  std::array<std::uint32_t, 4> particles{};  ///< all different; the last may be kNoIndex
  std::array<double, 4> weights{};           ///< the last is 0 where its particle is kNoIndex
  double rest = 0;                           ///< m, |d| of the shape at rest; 0: flat
  double compliance = 0;                     ///< m/N, > 0
};

/// A triangle of fabric. With F = [f_u f_v], what becomes of a unit of length along the warp and
/// along the weft, it obeys three laws:
///
///     |f_u| - 1 = T_u / warp,   |f_v| - 1 = T_v / weft,   f_u . f_v / (|f_u| |f_v|) = T_s / shear
///
/// T_u and T_v are tensions and T_s is the shear force, each per width; f_u and f_v follow from the
/// corners, since the deformation is the same in the whole triangle. Its energy is half of each
/// left side squared, times its stiffness, times the area at rest. This is exact for every affine
/// deformation. A tolerance is about what is left of each law. (Baraff and Witkin, "Large Steps in
/// Cloth Simulation", 1998; laws with compliances as of springs.)
struct MembraneElement {
  std::array<std::uint32_t, 3> particles{};  ///< all different
  /// m, where the corners lie at rest in the plane of the fabric: along the warp, along the weft.
  std::array<std::array<double, 2>, 3> rest{};
  double warp = 0;   ///< N/m, at least 0; 0: there is no such law
  double weft = 0;   ///< N/m, likewise
  double shear = 0;  ///< N/m per radian of shear, likewise
  /// rope: warp and weft only pull, so that the triangle may become narrower without a force.
  ConstraintKind kind = ConstraintKind::distance;
};

/// Times in which springs lose what they swing with, and the decay of all motion.
struct Damping {
  /// s. A spring resists its rate of change with its stiffness times this (Macklin et al. 2016,
  /// eq. 26). Constraints without a compliance have no such rate.
  double stretch = 0;
  double bending = 0;
  double motion = 0;  ///< 1/s; velocities fall by exp(-motion t), whatever the step
};

/// Drag and lift on triangles of the cloth. With v the mean velocity of its corners relative to the
/// wind, a triangle of area A and unit normal n feels the force
///
///     -1/2 density A |n . v| (drag v + lift (|v| n' - |n . v| v / |v|))
///
/// n' = n or -n, whichever has n' . v >= 0. The first part is against v, the second across it;
/// edge-on, and where v is 0, there is none. Each corner takes a third, of the force that is linear
/// in its own velocity and sums to this (engine/step/air.h). A triangle that moves along its normal
/// feels 1/2 density A drag |v|^2: of mass m it falls with v^2 = 2 m g / (density A drag) in the
/// end. The force is found once a step with small_steps, else once a substep, and in a way that
/// keeps it from making light cloth faster than the air, at any step.
struct Air {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double density = 1.2;  ///< kg/m^3
  double drag = 0;       ///< C_d, of the area that the triangle shows
  double lift = 0;       ///< C_l
  Vec3 wind;             ///< m/s; Cloth::set_wind changes it
};

/// A point that an animation moves (Cloth::move_anchors) and a particle that is to stay near it, as
/// with characters whose skin carries the cloth:
///
///     |x - point| <= max_distance
///     |x - centre| >= backstop_radius,
///         centre = point - (backstop_distance + backstop_radius) normal
///
/// Both hold one particle alone and cost far less than a constraint: the particle is put within its
/// limits, to Settings::contact_tolerance, and loses what of its velocity leads out of them as they
/// move. That is a rope which becomes taut, and a floor without bounce and friction. A max_distance
/// of 0 attaches the particle to the point, as a fixed particle that is moved is.
/// Constraints between such particles are inert, as between fixed ones. Cloth::limit_anchors
/// changes limits later. Solver small_steps only.
struct Anchor {
  std::uint32_t particle = 0;    ///< one that is not fixed, in at most one anchor
  Vec3 point{};                  ///< m, where it begins
  Vec3 normal{};                 ///< out of the backstop, of any length but 0; used with one
  double max_distance = 0;       ///< m, at least 0; infinite: no limit
  double backstop_distance = 0;  ///< m, of the surface of the backstop behind the point; >= 0
  double backstop_radius = 0;    ///< m; 0: there is no backstop; infinite: it is a plane
};

/// Two particles that are sewn together while the cloth moves, wherever they begin. They come
/// together along the straight line between them, in the time `time` or, where max_force is too
/// little for that, later, but never faster. Then they are held together whatever the force, for
/// good. Until then the seam is open, which breaks no law (StepReport::open_seams). Positions that
/// are written apart from each other open it again. Solver small_steps only.
struct Seam {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double time = 1;                                             ///< s, > 0
  double max_force = std::numeric_limits<double>::infinity();  ///< N, > 0, while it is open
};

/// What is simulated. Lengths in m, masses in kg, times in s.
/// At most one constraint may join the same two particles. A constraint between two fixed particles
/// is legal but inert: nothing can move it, so it is neither solved nor measured until one of them
/// is released (Cloth::change).
struct SceneDescription {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;      ///< empty: at rest; else one per particle
  std::vector<double> masses;        ///< one per particle, 1e-150 to 1e150, fixed ones too
  std::vector<std::uint32_t> fixed;  ///< particles of infinite inertia; move them with move_fixed()
  std::vector<Constraint> constraints;
  std::vector<MembraneElement> membrane;
  std::vector<BendingElement> bending;
  std::vector<Anchor> anchors;
  std::vector<Seam> seams;
  /// Triangles of the cloth, by their particles. Bodies that are triangle meshes touch its faces
  /// and edges (body.h); without these they touch particles alone. cloth_from_mesh fills it.
  std::vector<std::array<std::uint32_t, 3>> surface;
  Damping damping;
  Air air;
  double friction = 0.3;  ///< Coulomb's, of the cloth beside bodies (body.h); at least 0
  Vec3 gravity{0, -10, 0};

  /// Contacts exist only for the particles listed in `spheres`. Each collides with every other
  /// particle that no constraint joins it to, at the distance radii[i] + radii[j]; unlisted
  /// particles do not collide with each other. radii: empty without spheres, else one per
  /// particle, >= 0. What they cost: three or four times a substep each sphere is held against one
  /// box per 256 particles, and against the particles of those boxes that it comes near (one or two
  /// spheres: against all particles).
  std::vector<std::uint32_t> spheres;
  std::vector<double> radii;
};

/// Topology, colours, rest lengths, masses: all that does not change from step to step.
class Model;

/// Checks the description and prepares it. On error nothing is built.
WEFT_API Result<std::shared_ptr<const Model>> build_model(const SceneDescription& description);

/// The model as bytes for a file: all that it was built from, with a version and a checksum.
WEFT_API std::vector<std::byte> save_model(const Model& model);
/// Builds it again. Bytes that are damaged, or of another version of the format, are refused.
WEFT_API Result<std::shared_ptr<const Model>> load_model(std::span<const std::byte> bytes);

struct ModelInfo {
  std::size_t particles = 0;
  std::size_t constraints = 0;  ///< active ones, without contacts
  std::size_t inert_constraints = 0;
  std::size_t ropes = 0;
  std::size_t compliant = 0;          ///< constraints that are springs
  std::size_t membrane_elements = 0;  ///< active ones, likewise
  std::size_t bending_elements = 0;
  std::size_t anchors = 0;
  std::size_t seams = 0;
  std::size_t surface_triangles = 0;
  std::size_t air_triangles = 0;
  std::size_t spheres = 0;
  std::size_t colours = 0;
  std::size_t tiles = 0;  ///< groups of particles that threads may work on in parallel
  double run_share =
      0;  ///< of the constraints without a hub (engine/model/model.h): in contiguous runs
  std::size_t bytes = 0;
};
WEFT_API ModelInfo describe(const Model& model);

}  // namespace weft
