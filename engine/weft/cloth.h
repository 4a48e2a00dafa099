/// A cloth that moves, and what each of its steps reports. Part of weft.h.
#pragma once

#include <weft/body.h>
#include <weft/jobs.h>
#include <weft/result.h>
#include <weft/scene.h>
#include <weft/settings.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace weft {

struct State;

/// converged: every constraint is within its tolerance, and nothing crosses a body or is inside
///   of one. The state is committed.
/// fixed_iterations: Settings::iterations were done; the error is what the report says.
/// iteration_limit: max_iterations were done, or with small_steps all rounds or all that a given
///   number of substeps allows, and some constraint is still out of tolerance; or something
///   crosses a body or is inside of one. The state is committed.
/// infeasible: some constraint is out of tolerance and tens of thousands of iterations
///   (small_steps: sixteen rounds of a sweep and local passes) hardly reduce the error: constraints
///   contradict each other (a chain whose ends are too far apart), masses differ by far, or nothing
///   leads from the start to where they agree (a sheet of triangles whose pins turned by a right
///   angle in one step). The state is committed, with the error spread over the constraints.
/// passed_through: a particle went through a sphere within a substep (tunnelling): no contact was
///   found in time, or one pushed it out on the far side. The state is committed; shorter steps
///   would have held it.
/// non_finite_input: even without constraints, the positions, velocities, forces and dt lead to
///   numbers that are not finite. The state is unchanged.
/// non_finite: a position or velocity would have become NaN or infinite (yarns hold positions as
///   floats: none may be beyond 3e38 m). The state is unchanged.
enum class Status : std::uint8_t {
  converged,
  fixed_iterations,
  iteration_limit,
  infeasible,
  passed_through,
  non_finite_input,
  non_finite
};

/// Whether a step with this status changed the state.
constexpr bool committed(Status status) { return status < Status::non_finite_input; }

/// The stages of a step, in order.
enum class Stage : std::uint8_t {
  predict,  ///< also chooses the number of automatic substeps; small_steps: what begins a step
  find_contacts,
  solve_positions,  ///< small_steps: its substeps, all of them
  commit,
  correct_velocities,
  report
};
inline constexpr std::size_t kStageCount = 6;

WEFT_API std::string_view name(Status);
WEFT_API std::string_view name(Stage);

/// What one step did and what it reached. Counts and seconds are summed over the substeps; status
/// is the worst of them; errors are those at the end.
struct StepReport {
  Status status = Status::converged;
  bool asleep = false;                   ///< the cloth slept (Settings::sleep): errors are those
                                         ///< of its last step, and no work was done
  int substeps = 0;                      ///< done; 0 where nothing is committed, and asleep
  int halvings = 0;                      ///< attempts at a substep that were rejected (Solver)
  std::int64_t iterations = 0;           ///< passes over the position constraints; yarn: sweeps and
                                         ///< conjugate gradient iterations; direct: solves;
                                         ///< small_steps: `substeps` sweeps, and what was done
                                         ///< beyond, sweeps and local passes by their visits
  std::int64_t direction_updates = 0;    ///< renewals of the constraint directions
  std::int64_t velocity_iterations = 0;  ///< passes of the velocity loop; direct: solves
  std::int64_t visits = 0;               ///< constraints whose error was looked at, both loops
  std::int64_t corrections = 0;          ///< impulses applied, both loops
  int scheme_fallbacks = 0;              ///< attempts that scheme rattle left to the paper's
  int contacts = 0;                      ///< candidate pairs, near enough to be watched
  double max_strain = 0;  ///< over all constraints and triangles of fabric, recomputed from the
                          ///< positions (Strain)
  double rms_strain = 0;
  double max_shear = 0;  ///< rad, over all triangles of fabric
  /// What is left of the constraints' laws, the largest, as a fraction of rest_length: of rigid
  /// constraints the strain, of springs | |a-b| - rest_length - compliance f | / rest_length with
  /// the tension f that the solver applied in the last substep. Of triangles of fabric likewise, in
  /// strains and in radians of shear. This is what `tolerance` bounds.
  double max_error = 0;
  /// What is left of the law of bending, in which all elements of a substep are solved at once: the
  /// largest share of their forces that a substep left unbalanced, in the mean over the cloth. With
  /// 0.01 it bends as if forces were a hundredth smaller or larger. `tolerance` bounds it; 0 by
  /// other solvers than small_steps. What constraints do after bending within a substep is not in
  /// it.
  double max_bending_error = 0;
  std::uint32_t worst_constraint = kNoIndex;  ///< the description's index
  std::uint32_t worst_element = kNoIndex;     ///< likewise, of the largest strain or shear
  double max_penetration = 0;                 ///< m, into spheres and bodies, beyond the thickness
  int body_contacts = 0;                      ///< pairs of a particle and a body that touch
  /// Pairs of features of the cloth and of bodies that are triangle meshes which would have met
  /// within the step and were caught by its verification.
  int contact_failures = 0;
  int zones = 0;  ///< of these, how many had to be taken along by the body as if they stuck to it
  /// Triangles of the cloth that cross such bodies when the step ends, and particles inside: 0,
  /// unless it began so, a body was put there, or bodies close on the cloth from both sides. Their
  /// edges and faces touch nothing until they have come apart; their particles are kept out.
  int intersecting = 0;
  double max_anchor_error = 0;  ///< m, by which an anchor's limits are exceeded; 0 without anchors
  int open_seams = 0;           ///< whose particles have not come together yet (Seam)
  double max_seam_gap = 0;  ///< m, between particles of closed seams: bounded by contact_tolerance
  double seam_work = 0;     ///< J, that open seams did in this step
  /// m/s, by which this step is estimated to lead a particle away from its true motion, at most:
  /// of small_steps (by the last substep alone without a motion_tolerance); by other solvers 0.
  double motion_error = 0;
  /// J, by which kinetic, potential and elastic energy fell, beyond the work of moved pins, seams,
  /// forces, air and Damping::motion: by the scheme, damped springs and contacts. 0 by
  /// gauss_seidel.
  double energy_lost = 0;
  double pin_work = 0;   ///< J, work that moved pins did in this step: exact where they move as one
                         ///< rigid body, else that of the rigid motion nearest to theirs. Jumps do
                         ///< none. Impulses of fixed spheres count as if they were the pins' own;
                         ///< what moved spheres do is not in it.
  double body_work = 0;  ///< J, that bodies which move did on the cloth in this step
  double friction_work = 0;                  ///< J, that friction with bodies took
  std::uint32_t failed_particle = kNoIndex;  ///< non_finite, non_finite_input: one of those
  std::uint32_t passed_particle = kNoIndex;  ///< passed_through: one that did
  std::array<double, kStageCount> stage_seconds{};
};

/// Of all constraints, and of triangles of fabric: | |f_u| - 1 | and | |f_v| - 1 | where they have
/// these laws (MembraneElement). What only pulls has none where it is slack.
struct Strain {
  double max = 0;
  double rms = 0;
  std::uint32_t worst_constraint = kNoIndex;  ///< the description's index
  double max_shear = 0;                       ///< rad, |f_u . f_v| / (|f_u| |f_v|) of triangles
  std::uint32_t worst_element = kNoIndex;     ///< the triangle of the largest strain or shear
};

struct Energy {
  double kinetic = 0;    ///< J
  double potential = 0;  ///< J, of gravity, zero at the origin
  double elastic =
      0;  ///< J, of springs, triangles and bending elements, no stiffer than the substeps of the
          ///< last step can tell: what these leave of a law is no energy
  double total() const { return kinetic + potential + elastic; }
};

/// A new value of one particle or constraint, by its number in the description.
struct ChangedValue {
  std::uint32_t index = 0;
  double value = 0;
};

/// New stiffnesses of a triangle of fabric, by its number in the description; as MembraneElement.
struct ChangedMembrane {
  std::uint32_t index = 0;
  double warp = 0, weft = 0, shear = 0;  ///< N/m
};

/// New numbers of the air; as in Air.
struct ChangedAir {
  double density = 0;  ///< kg/m^3
  double drag = 0, lift = 0;
};

/// What becomes different while a cloth moves; what is not listed stays as it is.
struct Changes {
  std::vector<std::uint32_t> fix = {};      ///< particles: fixed where they are, at rest
  std::vector<std::uint32_t> release = {};  ///< fixed ones: free, at the speed of their last move
  std::vector<ChangedValue> masses = {};    ///< kg, of particles
  std::vector<ChangedValue> rest_lengths = {};  ///< m, of constraints
  std::vector<ChangedValue> compliances = {};   ///< m/N, of constraints
  std::vector<ChangedMembrane> membrane = {};
  std::vector<ChangedValue> bending = {};  ///< m/N, compliances of bending elements
  std::optional<Damping> damping = {};
  std::optional<ChangedAir> air = {};  ///< of the triangles that the description has
};

/// What an anchor asks for from now on.
struct AnchorLimit {
  double max_distance = 0;  ///< m, as Anchor::max_distance; infinite: the particle is let go
  bool backstop = true;     ///< whether the backstop of the description, if it has one, counts
};

/// x -> about + R (x - about) + translation; R turns by |rotation| rad about the axis `rotation`.
struct RigidMotion {
  Vec3 translation{};  ///< m
  Vec3 rotation{};     ///< rad
  Vec3 about{};        ///< m
};

/// Vectors in a buffer of floats that the caller owns, as vertex buffers have them: x, y and z of
/// vector i are floats[i * stride] and the two after it. What lies between is left as it is.
///
///   std::vector<float> packed(3 * count);       // x y z, x y z, ...
///   cloth.read_positions({packed});
///   std::vector<float> vertices(8 * count);     // position, normal, texture coordinates
///   cloth.read_positions({vertices, 8});
///   cloth.read_velocities({std::span(vertices).subspan(3), 8});   // where normals are
///
/// The buffer must hold as many vectors as are read, and not one more. Behind the last vector there
/// may be less than a stride.
struct FloatVectors {
  std::span<float> floats{};
  std::size_t stride = 3;  ///< floats from one vector to the next, at least 3
};

/// An axis-aligned box.
struct Bounds {
  Vec3 least{}, most{};  ///< m
};

/// One moving cloth: the state of a Model and the workspace of its solver. Particle numbers are
/// those of the description; position() and velocity() demand particle < particle_count(). A cloth
/// that was moved from can only be assigned to or destroyed.
class WEFT_API Cloth {
 public:
  /// Checks the settings. The state starts as described.
  static Result<Cloth> create(std::shared_ptr<const Model> model, const Settings& settings);
  Cloth(Cloth&&) noexcept;
  Cloth& operator=(Cloth&&) noexcept;
  ~Cloth();

  /// A second cloth of the same model and settings, which continues bit for bit as this one does.
  Cloth clone() const;
  /// Takes over from `from`, a cloth of the same Model or of one that changes made of the same:
  /// that model, state, forces, gravity, wind, pending pin moves, bodies (which make an automatic
  /// solver small_steps), and the solver's memory of its last steps. This cloth keeps its settings,
  /// and refuses what they do not go with. If solver, scheme, backend, iterations or a tolerance
  /// (but for velocity_tolerance) differ, that memory is dropped, and positions out of tolerance
  /// are projected as if newly written.
  Result<void> copy_state(const Cloth& from);

  /// All that copy_state takes over but the model, as bytes for a file: numbers are little-endian,
  /// a checksum says whether they are whole, and shapes of bodies are among them. A cloth of an
  /// equal model (of the same description; load_model) that loads them, in another program too,
  /// continues bit for bit as this one does, if its settings are the same.
  std::vector<std::byte> save_state() const;
  /// Goes on where the saved cloth was, as copy_state does: with this cloth's settings. Takes as
  /// long as to create a cloth, and hulls of bodies are built again. Bytes that are damaged, of
  /// another version of the format, or of another model are refused, and nothing is changed; after
  /// change() and limit_anchors the model may be another one: save it, too (save_model).
  Result<void> load_state(std::span<const std::byte> bytes);

  /// Advances by dt seconds (finite, > 0): all substeps or none. If memory runs out, std::bad_alloc
  /// is thrown and the state is unchanged. An error means that dt was refused. Meant for frames of
  /// 0.1 ms to 0.1 s: in shorter ones the rounding of yarns' floats shows up as velocity, and slows
  /// motion (rattle and velocity_correction undo that, direct works in double); the cost of longer
  /// ones is limited by 1024 automatic substeps and max_iterations. Large cloths are worth several
  /// threads, which are those of `jobs`: any of them may lead the step, while this one waits.
  Result<StepReport> step(double dt, const JobSystem& jobs = {});

  std::size_t particle_count() const;
  const std::shared_ptr<const Model>& model() const;
  const Settings& settings() const;  ///< isa, solver, substeps, velocity_correction: what is used

  Vec3 position(std::uint32_t particle) const;
  /// m/s; always 0 for fixed particles, even while move_fixed() moves them. With scheme paper and
  /// no velocity correction, a particle that hangs at rest reports g h / 2 (h: the substep), which
  /// the next substep cancels.
  Vec3 velocity(std::uint32_t particle) const;
  /// Copies one Vec3 per particle; out.size() must be particle_count() (else nothing is copied).
  Result<void> read_positions(std::span<Vec3> out) const;
  Result<void> read_velocities(std::span<Vec3> out) const;
  /// The same as floats. Positions are relative to the origin (finite), which is subtracted before
  /// they are rounded: near it they keep their precision, however far from 0 it is. To read by
  /// vertex, with normals: surface.h.
  Result<void> read_positions(FloatVectors out, Vec3 origin = {}) const;
  Result<void> read_velocities(FloatVectors out) const;
  /// Of all positions, of fixed particles too.
  Bounds bounds() const;

  /// Replace the state; finite values, one per particle. Initial or written positions that are out
  /// of tolerance are projected onto the constraints as the next step begins, velocities unchanged
  /// (not with Settings::iterations). So are fabrics, and all springs that by themselves swing
  /// faster than 200 rad/s, if at these positions they would at once become fast: they come to the
  /// equilibrium that is near, and what they stored is gone. Slower springs keep their stretch, for
  /// their swings are seen. Fixed particles that moved in the last step are at rest after
  /// write_velocities, not after write_positions.
  Result<void> write_positions(std::span<const Vec3> in);
  Result<void> write_velocities(std::span<const Vec3> in);
  /// External forces in N besides gravity, kept until replaced. Empty: none.
  Result<void> write_forces(std::span<const Vec3> in);
  /// m/s^2, from the next step on.
  Result<void> set_gravity(Vec3 gravity);
  /// m/s, of Air::wind, from the next step on.
  Result<void> set_wind(Vec3 wind);
  /// Moves a fixed particle; position() returns the new place at once. It travels there in a
  /// straight line during the next step, however far that is, and the cloth takes on its speed. The
  /// last move before a step counts; write_positions cancels all. A fixed particle that is not
  /// moved before a step stands still in it: where steps are shorter than the frames of an
  /// animation, interpolate.
  Result<void> move_fixed(std::uint32_t particle, Vec3 position);
  /// The same of many, in their order: particles[i] to positions[i]. All or, on an error, none.
  Result<void> move_fixed(std::span<const std::uint32_t> particles,
                          std::span<const Vec3> positions);
  /// Puts a fixed particle down somewhere else, without a way between: it is there before the next
  /// step begins, and the cloth is projected after it, fabrics too (write_positions), velocities
  /// and what the fabric carries unchanged (with Settings::iterations nothing is projected: the
  /// jump becomes speed). What a sphere jumped over is not passed_through.
  Result<void> place_fixed(std::uint32_t particle, Vec3 position);
  /// The same of many, as move_fixed. If memory runs out, nothing is changed.
  Result<void> place_fixed(std::span<const std::uint32_t> particles,
                           std::span<const Vec3> positions);
  /// Moves the points of all anchors, in the order of the description: they travel there in
  /// straight lines during the next step, as evenly as normals turn. The last move before a step
  /// counts. Call move_anchors before write_positions, and anchors jump instead of travelling.
  /// normals: one per anchor, of any length but 0 where there is a backstop; empty: as they are.
  Result<void> move_anchors(std::span<const Vec3> points, std::span<const Vec3> normals = {});
  /// Loosens, tightens, lets go or takes hold again of all anchors, in the order of the
  /// description. A largest distance changes evenly during the next step, and puts nobody in
  /// motion; one that was infinite begins where the particle is. From 0, which holds as a fixed
  /// particle does, to more, and back, takes as long as change().
  Result<void> limit_anchors(std::span<const AnchorLimit> limits);
  /// The same of one of them.
  Result<void> limit_anchor(std::uint32_t anchor, const AnchorLimit& limit);
  /// From the next step on all largest distances count `scale` times (finite, at least 0): how much
  /// of a character's cloth moves by itself. 0 and infinite ones stay.
  Result<void> scale_anchors(double scale);

  /// Takes the whole cloth along by the share of a rigid motion (of its translation and its angle),
  /// 0 to 1, at once and without its feeling the acceleration: positions, fixed particles, anchors,
  /// and what the solver remembers move and turn, velocities turn and gain nothing. Gravity,
  /// forces, wind and the air are the world's, and stay: the next step drags at the cloth as if it
  /// had come this way in its time. To let the cloth feel only the fraction s of its character's
  /// acceleration, call carry(motion, 1 - s) before each step, then move pins and anchors to where
  /// they really are. (Velocities are then relative to the character.)
  Result<void> carry(const RigidMotion& motion, double share);
  /// The same with share 1 and without a way through the air.
  Result<void> teleport(const RigidMotion& motion);

  /// Adds a body, which is there from the next step on, and returns its id; ids are not used again.
  /// Other solvers than small_steps refuse bodies; an automatic one becomes small_steps, at the
  /// cost of a change().
  Result<std::uint32_t> add_body(const Body& body);
  /// Gives a body another pose: it travels there during the next step, in a straight line, turning
  /// evenly about one axis by half a turn at most, and takes cloth along. A body that is not moved
  /// before a step stands still in it. The last move before a step counts.
  Result<void> move_body(std::uint32_t id, const Pose& pose);
  /// The same without a way between: cloth that it is put into comes out slowly.
  Result<void> place_body(std::uint32_t id, const Pose& pose);
  /// Gives a body that is a triangle mesh other vertices, in its own coordinates: they travel there
  /// in straight lines during the next step, while its pose travels too. Vertices that are not
  /// moved before a step stand still in it. The last move before a step counts.
  Result<void> move_body_vertices(std::uint32_t id, std::span<const Vec3> vertices);
  /// The same without a way between.
  Result<void> place_body_vertices(std::uint32_t id, std::span<const Vec3> vertices);
  /// A body that is off is not there.
  Result<void> switch_body(std::uint32_t id, bool on);
  Result<void> remove_body(std::uint32_t id);
  Result<BodyLoad> body_load(std::uint32_t id) const;
  /// Those that were in contact when the last step of this cloth ended; an empty list after clone()
  /// and change().
  std::vector<BodyContact> body_contacts() const;

  /// Changes what was described: all of it or, on an error and where memory runs out, nothing.
  /// model() is another one from then on, as build_model makes it of the changed description; other
  /// cloths of the old one keep that. Numbers stay the same. So do positions, velocities but of
  /// those that are fixed and released, what solvers remember, and the settings that were asked
  /// for: Solver::automatic is chosen anew, and where another one is chosen nothing is remembered.
  ///
  /// Constraints that are then longer or shorter than they may be, and those of pins that are
  /// released, are put right as the next step begins, velocities unchanged; so are fabrics
  /// (write_positions) whose rest lengths change by more than the tolerance. A particle
  /// is released at the speed that move_fixed gave it in the last step, and no energy is gained.
  ///
  /// New damping and air take less than half of a frame of fabric that rests, new bending about
  /// three such frames. All else takes as long as to prepare a model and create a cloth, up to six
  /// such frames, and three to fifteen steps of a rigid woven sheet, whose steps are the cheapest.
  /// Make all changes of a frame in one call. What model() and settings() referred to may be gone
  /// after it, and after copy_state.
  Result<void> change(const Changes& changes);

  /// Recomputed from the positions by this thread alone. The last step's is in its report already,
  /// and may differ in the last bits.
  Strain strain() const;
  /// m, over all pairs of a sphere and a particle or sphere, but for two fixed ones; 0 without
  /// spheres.
  double max_penetration() const;
  Energy energy() const;  ///< of the particles that are not fixed
  /// FNV-1a over the bits of all positions and velocities, in the description's order.
  std::uint64_t state_hash() const;
  std::size_t bytes() const;  ///< held by this cloth, the shared model not included

 private:
  friend class ClothBatch;
  struct Impl;
  State* state();  // null where it was moved from
  explicit Cloth(std::unique_ptr<Impl> impl);
  Result<void> prepare_for_bodies();
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
