/// Scenes and models: particles, and the constraints, fabric, anchors, seams, rails, air and forces
/// that join and move them. Part of weft.h.
///
///   weft::SceneDescription scene;                 // plain vectors, SI units
///   scene.positions = {{0, 0, 0}, {1, 0, 0}};     // m, one per particle
///   scene.masses = {1, 1};                        // kg, one per particle
///   scene.constraints = {{0, 1, 1.0}};            // particles 0 and 1 are 1 m apart
///   scene.fixed = {0};
///   auto model = weft::build_model(scene);        // checks all fields; the scene may go now
///   if (!model) std::puts(model.error().c_str()); // "masses[1]: ..."
///
/// A model is immutable: any number of cloths and threads may share it.
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

/// Stands for no particle, no constraint and no element where a number is expected.
inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// distance: |a - b| = rest_length.
/// rope: |a - b| <= rest_length; it only pulls.
enum class ConstraintKind : std::uint8_t { distance, rope };

/// With a compliance the constraint is a spring: its tension f obeys the law
///
///     |a - b| - rest_length = compliance f          (rope: f >= 0, and 0 where it is slack)
///
/// Its error is the difference of the two sides, as a fraction of rest_length. Without a compliance
/// the law is that of a rigid edge. (Macklin et al., "XPBD", 2016; Servin et al. 2006.)
struct Constraint {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double rest_length = 0;  ///< m, 1e-150 to 1e150; on the simd backend 1e-18 to 1e18
  ConstraintKind kind = ConstraintKind::distance;
  double compliance = 0;  ///< m/N, inverse stiffness; finite, at least 0. 0: rigid
  /// N, at least 0; infinite: it never breaks. 0: it is broken, and joins nothing (Tear).
  double strength = std::numeric_limits<double>::infinity();
};

/// Cloth that tears. A constraint, a triangle of fabric, a closed seam or an anchor may have a
/// strength. It breaks at the end of a step if its mean load in the step exceeds the strength. If
/// neighbours are overloaded, only the one with the largest ratio of load to strength breaks, since
/// that relieves the others: a crack grows by one edge per step.
///
/// constraint: its strength becomes 0. Ropes and threads break in this way.
/// seam: its strength becomes 0. Faces and edges at one of its two particles do not collide with
///   those at the other until they are apart (SelfContact).
///   Then it is gone, unless an unbroken seam follows it.
/// anchor: its particle is released, as by Cloth::limit_anchor with an infinite distance.
/// sheet: one of its particles becomes two, each with the triangles, constraints and the mass of
///   its side. The crack runs along edges of `surface`, as nearly across the largest tension as
///   they allow, but not along the diagonal of a four-sided cell. It starts where a constraint
///   along an edge of `surface` is overloaded, or where the mean tension of the triangles of fabric
///   around a particle is too large. The new particle has the next number, and a broken seam joins
///   it to the old one, which keeps its sliders and rails. A fixed particle keeps only fabric that
///   does not pull at it.
///
/// A break dissipates the elastic energy of the broken element, and adds none. Solver small_steps
/// only; `automatic` becomes small_steps. Tethers do not break. A gas whose triangles no longer
/// enclose it has lost its pressure.
enum class Tear : std::uint8_t { constraint, seam, anchor, sheet };

/// A bending spring over three or four particles. Its weights sum to zero, so that
///
///     d = sum of weights[i] x[particles[i]]
///
/// does not change when the particles move as one. Its energy is (|d| - rest)^2 / (2 compliance).
/// With cotangent weights, rest 0 and a compliance of (A0 + A1) / (3 k) this is the isometric
/// bending of two triangles with the areas A0 and A1 and the stiffness k (Bergou et al.,
/// "A Quadratic Bending Model for Inextensible Surfaces", 2006).
///
/// rest has no sign: angles of 60 and -60 degrees have the same energy. A hinge of four particles
/// has a signed fold. Its edge joins particles 0 and 1, its faces reach from there to 2 and 3, and
/// its energy is |d - fold n|^2 / (2 compliance). The normal n of both faces is along
///
///     (x1 - x0) x (weights[3] (x3 - x0) - weights[2] (x2 - x0))
///
/// So fold is positive where 2 and 3 stand on the side from which the face (0, 1, 3) is seen
/// counter-clockwise, if their weights are positive. Beyond 147 degrees n is shorter than 1: a fold
/// that turns all the way over changes its sign without a jump.
///
/// A hinge may yield, as cloth does when it is folded and pressed. Let t be the angle between its
/// faces (0: flat), and t0 its angle at rest: fold = 2 arm sin(t0 / 2). Elements that meet at an
/// end of an edge yield together, since each sees only a part of the curvature there. With
///
///     r^2 = (sum of arm^2 (t - t0)^2 / compliance) / (sum of yield^2 / compliance)
///
/// over them, a hinge yields if r > 1 + hardening w. Then t0 follows t until r = 1 + hardening w.
/// Here w is the sum of all reductions of r by yielding so far. So a single hinge comes to rest at
/// the angle to which it was bent, less yield / arm. If several elements have the same particles,
/// the first ones yield together, and so do the second ones. Yielding dissipates energy.
/// Beyond 147 degrees a hinge that yields uses |d| in place of d . n: it folds flat like any other,
/// and rests there.
struct BendingElement {
  std::array<std::uint32_t, 4> particles{};  ///< all different; the last may be kNoIndex
  /// The last is 0 where its particle is kNoIndex. All are 0 where a tear has cut the element.
  std::array<double, 4> weights{};
  double rest = 0;        ///< m, |d| of the shape at rest; 0: flat
  double compliance = 0;  ///< m/N, > 0
  double fold = 0;        ///< m, d along n at rest, of hinges; 0: flat
  /// m, > 0, of hinges: how far d may be from its rest; infinite: it never yields.
  double yield = std::numeric_limits<double>::infinity();
  double hardening = 0;  ///< at least 0; used with a yield
  /// m, > 0 with a yield: d per radian where the hinge is nearly flat. |c_2| times the distance of
  /// particle 2 from the edge, and the same of particle 3.
  double arm = 0;
};

/// A triangle of fabric. The columns of its deformation F = [f_u f_v] are the images of a unit of
/// length along the warp and along the weft. It obeys three laws:
///
///     |f_u| - 1 = T_u / warp,   |f_v| - 1 = T_v / weft,   f_u . f_v / (|f_u| |f_v|) = T_s / shear
///
/// T_u and T_v are tensions and T_s is the shear force, each per width. f_u and f_v follow from the
/// corners, since the deformation is the same in the whole triangle. Each law stores half of its
/// left side squared, times its stiffness, times the area at rest. This is exact for every affine
/// deformation. The error of a law is the difference of its two sides. (Baraff and Witkin, "Large
/// Steps in Cloth Simulation", 1998; the laws have compliances as those of springs.)
struct MembraneElement {
  std::array<std::uint32_t, 3> particles{};  ///< all different
  /// m, where the corners lie at rest in the plane of the fabric: along the warp, along the weft.
  std::array<std::array<double, 2>, 3> rest{};
  double warp = 0;   ///< N/m, at least 0; 0: there is no such law
  double weft = 0;   ///< N/m, likewise
  double shear = 0;  ///< N/m per radian of shear, likewise
  /// rope: warp and weft only pull, so the triangle may become narrower without a force.
  ConstraintKind kind = ConstraintKind::distance;
  /// N/m, > 0, of the largest tension in any direction; infinite: it never tears (Tear).
  double strength = std::numeric_limits<double>::infinity();
};

/// Damping times of springs, and the decay of all motion.
struct Damping {
  /// s. A spring resists its rate of change with its stiffness times this time (Macklin et al.
  /// 2016, eq. 26). Constraints without a compliance are not damped.
  double stretch = 0;
  double bending = 0;  ///< s, the same for bending elements
  double motion = 0;   ///< 1/s; velocities fall by exp(-motion t), whatever the step
};

/// Drag, lift and ram pressure on triangles of the cloth. With v the mean velocity of its corners
/// relative to the wind, a triangle of area A and unit normal n is subject to the force
///
///     -1/2 density A |n . v| (drag v + lift (|v| n' - |n . v| v / |v|))
///
/// n' is n or -n, whichever has n' . v >= 0. The first part is against v, the second across it.
/// There is no force edge-on, and none where v is 0. Each corner takes a third of the force: a
/// share that is linear in its own velocity, so that the three sum to the formula
/// (engine/step/air.h). The force on a triangle that moves along its normal is 1/2 density A drag
/// |v|^2. So with the mass m its terminal velocity is v^2 = 2 m g / (density A drag). With
/// small_steps the force is found once or a few times a step, else once a substep. However long the
/// step, it cannot make light cloth faster than the air.
///
/// Drag and lift act on single triangles, and do not hold a canopy open: where its skirt is
/// parallel to the flow they have no component along the normal. The air inside a canopy or a sail
/// is at rest, and its pressure is the same everywhere. So each connected piece of the triangles is
/// subject to the pressure
///
///     -1/2 density ram |u| u      along the normals,   u = v . S / |S|
///
/// S is the sum of the triangles' areas times normals, which is that of the mouth of a canopy, and
/// v the mean velocity of the piece relative to the wind, weighted by area. The pressure acts from
/// the side that faces the flow, whichever way the triangles face. The force is 1/2 density A ram
/// u^2 on a flat plate, besides its drag, and 0 on a closed surface. With small_steps it follows
/// the normals.
struct Air {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double density = 1.2;  ///< kg/m^3
  double drag = 0;       ///< C_d, of the area that the triangle shows
  double lift = 0;       ///< C_l
  Vec3 wind;             ///< m/s; Cloth::set_wind changes it
  double ram = 0;        ///< C_p, of the flow that a piece catches; 1.2 for a canopy
};

/// A difference of pressure across triangles of `surface`. It pushes them along their normals,
/// towards the side from which their corners are seen counter-clockwise; a negative one pushes the
/// other way. Its direction follows the normals in every substep. Its work is the pressure times
/// the volume that the triangles sweep. Several pressures on one triangle add up. Solver
/// small_steps only; `automatic` becomes small_steps.
///
/// The pressure of a gas falls as its volume grows, at a constant temperature:
///
///     (ambient + pressure now) (volume now) = (ambient + pressure) volume
///
/// Its triangles must enclose it: as many of them run along an edge in one direction as in the
/// other, and their normals point outwards. A given pressure above k / 2 R inflates a ball of
/// threads of k N/m without limit.
struct Pressure {
  double pressure = 0;                        ///< Pa, above that of the air around it
  std::vector<std::uint32_t> triangles = {};  ///< by their numbers in `surface`; empty: all
  bool gas = false;                           ///< else the pressure stays as it is
  double volume = 0;         ///< m^3, at which the gas has this pressure; 0: its present volume
  double ambient = 101'325;  ///< Pa, of the air around a gas, > 0

  bool operator==(const Pressure&) const = default;
};

/// Keeps a particle near a point that an animation moves (Cloth::move_anchors), such as a point of
/// a character's skin:
///
///     |x - point| <= max_distance
///     |x - centre| >= backstop_radius,
///         centre = point - (backstop_distance + backstop_radius) normal
///
/// Each limit holds one particle alone, and costs far less than a constraint. The particle is kept
/// within its limits, to Settings::contact_tolerance. The part of its velocity that points out of
/// the limits is removed (relative to the moving limits). So the first limit is a rope that becomes
/// taut, and the second a floor without bounce and friction. A max_distance of 0 attaches the
/// particle to the point, as a fixed particle that is moved. Constraints between attached particles
/// are inert, as between fixed ones. Cloth::limit_anchors changes limits later. Solver small_steps
/// only.
struct Anchor {
  std::uint32_t particle = 0;    ///< must not be fixed; in at most one anchor
  Vec3 point{};                  ///< m, where the point begins
  Vec3 normal{};                 ///< out of the backstop, of any length but 0; used with a backstop
  double max_distance = 0;       ///< m, at least 0; infinite: no limit
  double backstop_distance = 0;  ///< m, of the surface of the backstop behind the point; >= 0
  double backstop_radius = 0;    ///< m; 0: there is no backstop; infinite: it is a plane
  /// N, > 0; infinite: it never breaks. Its load is the force of constraints, fabric and seams
  /// on the particle, and the particle's weight, while the particle is at max_distance (Tear).
  double strength = std::numeric_limits<double>::infinity();
};

/// A largest distance from a particle to a fixed one, its pin:
///
///     |x - pin| <= length
///
/// It acts as max_distance of an Anchor whose point is the pin, wherever the pin is moved
/// (StepReport::max_anchor_error). A tether as long as the cloth between the two adds no
/// restriction, since the cloth is as long. But it transmits load to the pin at once, while the
/// constraints between them need many substeps (Kim, Chentanez and Mueller-Fischer, "Long Range
/// Attachments", 2012). A tether is off while its pin is not fixed or its particle is. Solver
/// small_steps only.
struct Tether {
  std::uint32_t particle = 0;  ///< in at most one tether, and in no anchor
  std::uint32_t pin = 0;
  double length = 0;  ///< m, 1e-150 to 1e150
};

/// A particle that slides along a rail: curtain rings on a rod, beads on a wire, eyelets along a
/// drawstring, a cord in a hem. The rail leads through the particles
/// SceneDescription::rail_particles[first] to [last]. Its particles may be fixed: then it moves
/// only where they are moved. They may be free: then sliding particles act on the rail with equal
/// and opposite forces. It is a smooth curve through them, and closed where the first particle is
/// the last one, too. Its ends are stops.
///
/// The particle is kept on the rail to Settings::contact_tolerance (StepReport::max_rail_gap).
/// Coulomb friction acts along the rail, up to `friction` times the force across it. So a cord
/// whose particles all slide on one rail, around a drum, holds e^(friction angle) times the tension
/// at its other end. So does a cord that is the rail, where it turns over a particle by up to 30
/// degrees; at sharper turns its links catch there.
///
/// It begins at the nearest point of the rail, and is moved there when the first step begins. With
/// SelfContact the cloth, sliders included, stays one thickness away from the constraints of a
/// rail. Solver small_steps only.
struct Slider {
  std::uint32_t particle = 0;         ///< in at most one slider, and not on its rail
  std::uint32_t first = 0, last = 0;  ///< first < last, in SceneDescription::rail_particles
  double friction = 0;                ///< Coulomb's coefficient, at least 0
};

/// Two particles that are sewn together while the cloth moves, wherever they begin. They come
/// together along the straight line between them in the time `time`, never faster. If max_force is
/// too small for that, they take longer. Then the seam is closed: it holds any force up to its
/// strength. An open seam does not count as an error until its time is over
/// (StepReport::open_seams, late_seams). It opens again if its particles are written to places
/// apart. Cloth::release_seams undoes it. Faces and edges of the cloth at one of the two particles
/// do not collide with those at the other (SelfContact). Solver small_steps only.
struct Seam {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double time = 1;                                             ///< s, > 0
  double max_force = std::numeric_limits<double>::infinity();  ///< N, > 0, while it is open
  /// N, at least 0, of the closed seam; infinite: it never breaks. 0: it is broken, and pulls
  /// nothing together (Tear).
  double strength = std::numeric_limits<double>::infinity();
};

/// Contact of the cloth with itself: of all cloths and pieces of a scene, by the triangles of
/// `surface` and by threads (SceneDescription::surface). Layers stay one thickness apart, with
/// friction. Features that are nearer than that in the shape at rest keep nearly the distance that
/// they have there. So a thickness may be larger than an edge; but then all neighbours are in
/// contact, folds are stiffer, and a step takes long. Use at most half an edge (perf/tried.md has
/// figures).
/// Seams join the cloth in the shape at rest, whether they are open or closed.
///
/// A cloth that does not cross itself when a step begins does not cross itself when it ends,
/// however fast it is: each step verifies this, and stops features that would go through each
/// other. Layers that rest on each other may be nearer than the thickness by a twentieth, and by
/// more for a while after an impact; StepReport::max_penetration does not count that. Triangles
/// that cross at the start do not collide with each other until they are apart
/// (StepReport::tangled).
///
/// With `untangle` triangles that cross are pulled apart at 0.2 m/s. If the line of intersection
/// cuts off a part of the cloth, the part with the fewest fixed particles is pulled through, or the
/// lightest of several such parts. Otherwise the line becomes shorter. StepReport::untangling_work
/// is the work of this. Triangles beside those that cross may cross, too, for a while; all others
/// are kept apart as always. If pins hold both sides, the crossing may stay.
/// Cloth that does not cross itself has the same bits with `untangle` and without.
///
/// Layers that begin exactly in one plane, or whose positions are written so, are moved apart by
/// micrometres when the next step begins. Each piece of the cloth moves to its front: the side from
/// which the corners of its first triangle in `surface` are seen counterclockwise. Pieces whose
/// triangles come later move farther, and so do layers of one piece that was folded flat. Fixed
/// particles stay.
///
/// Solver small_steps only; `automatic` becomes small_steps.
struct SelfContact {
  bool on = false;
  double thickness = 1e-3;  ///< m, between the middles of two layers; > 0 if it is on
  double friction = 0.3;    ///< Coulomb's coefficient between layers; at least 0
  bool untangle = false;    ///< whether triangles that cross are pulled apart

  bool operator==(const SelfContact&) const = default;
};

/// A scene. Lengths in m, masses in kg, times in s. Vectors hold one entry per particle, or per
/// constraint, element, anchor, seam or triangle; particles are numbered from 0.
///
/// At most one constraint may join the same two particles. A constraint between two fixed particles
/// is legal but inert: it is neither solved nor part of the strain until one of them is released
/// (Cloth::change). A step reports it if it is out of tolerance (StepReport::held_apart).
struct SceneDescription {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;      ///< empty: at rest; else one per particle
  std::vector<double> masses;        ///< kg, one per particle, 1e-150 to 1e150, fixed ones too
  std::vector<std::uint32_t> fixed;  ///< particles of infinite inertia; move them with move_fixed()
  std::vector<Constraint> constraints;
  std::vector<MembraneElement> membrane;
  std::vector<BendingElement> bending;
  std::vector<Anchor> anchors;
  std::vector<Seam> seams;
  /// Triangles of the cloth, by their particles. Bodies that are triangle meshes touch the faces
  /// and edges of these triangles (body.h). cloth_from_mesh fills this.
  ///
  /// Constraints between other particles are threads: they touch such bodies, and the cloth if it
  /// touches itself, all along their length. Cords, laces and fringes are chains of them. A
  /// constraint between two particles of one piece of this surface is no thread: it braces the
  /// piece. Nor is one that is longer than two constraints that lead from one of its ends to the
  /// other, as braces of nets and of stiff cords are. Particles that have neither a triangle nor a
  /// thread touch as points.
  std::vector<std::array<std::uint32_t, 3>> surface;
  Damping damping;
  Air air;
  std::vector<Pressure> pressures;  ///< Cloth::set_pressure changes them
  double friction = 0.3;  ///< Coulomb's coefficient of the cloth on bodies (body.h); at least 0
  SelfContact self_contact;
  Vec3 gravity{0, -10, 0};  ///< m/s^2

  /// Spheres of the paper: particles that collide with other particles. A sphere collides with
  /// every particle that no constraint joins it to, at the distance radii[i] + radii[j]. Particles
  /// that are not listed do not collide with each other. radii: m, empty without spheres, else one
  /// per particle, >= 0. Cost: each sphere is compared with one box per 256 particles, three or
  /// four times per substep, and with the particles of the boxes that it comes near. (One or two
  /// spheres are compared with all particles.)
  std::vector<std::uint32_t> spheres;
  std::vector<double> radii;

  std::vector<Tether> tethers;
  /// At least 0. Finite: each free particle that has neither an anchor nor a tether has a tether to
  /// its nearest pin along constraints and sides of triangles of fabric. It is longer than the path
  /// to it, at rest, by this share. When pins are released or fixed (Cloth::change) the nearest
  /// ones count. Infinite: there are none but `tethers`.
  double tether_slack = std::numeric_limits<double>::infinity();

  std::vector<Slider> sliders;
  std::vector<std::uint32_t> rail_particles;  ///< of all rails, each in its order (Slider)
};

/// A scene that is checked and prepared: topology, colours, rest lengths, masses. It never
/// changes.
class Model;

/// Checks the description and prepares it. On an error nothing is built; the error names the field,
/// the index and the value.
WEFT_API Result<std::shared_ptr<const Model>> build_model(const SceneDescription& description);

/// The model as bytes for a file: its description, a version and a checksum.
WEFT_API std::vector<std::byte> save_model(const Model& model);
/// Builds a saved model again. Bytes that are damaged, or of another version of the format, are
/// refused.
WEFT_API Result<std::shared_ptr<const Model>> load_model(std::span<const std::byte> bytes);

/// Counts of a model.
struct ModelInfo {
  std::size_t particles = 0;
  std::size_t constraints = 0;  ///< active ones, without contacts
  std::size_t inert_constraints = 0;
  std::size_t ropes = 0;
  std::size_t compliant = 0;          ///< constraints that are springs
  std::size_t membrane_elements = 0;  ///< active ones
  std::size_t bending_elements = 0;
  std::size_t anchors = 0;
  std::size_t seams = 0;
  std::size_t surface_triangles = 0;
  std::size_t air_triangles = 0;
  std::size_t spheres = 0;
  std::size_t colours = 0;
  std::size_t tiles = 0;  ///< groups of particles that threads may work on in parallel
  /// Share of the constraints without a hub (engine/model/model.h) that stand in contiguous runs.
  double run_share = 0;
  std::size_t bytes = 0;    ///< held by the model
  std::size_t tethers = 0;  ///< those that act
};
WEFT_API ModelInfo describe(const Model& model);

}  // namespace weft
