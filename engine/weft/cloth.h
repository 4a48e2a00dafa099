/// A cloth that moves, and the report of each of its steps. Part of weft.h.
///
///   auto cloth = weft::Cloth::create(model, {});               // settings.h
///   cloth.value().move_fixed(pin, place);                      // in each frame: move pins, bodies
///   auto report = cloth.value().step(1.0 / 60);
///   if (!report) std::puts(report.error().c_str());            // dt was refused
///   if (report.value().status != weft::Status::converged) ...  // the tolerance was missed
///   cloth.value().read_positions({vertices, 8}, camera);       // floats, near an origin
///
/// Units are m, kg, s and N. One thread at a time may use a Cloth. Functions that return a Result
/// change nothing if they return an error.
#pragma once

#include <weft/body.h>
#include <weft/jobs.h>
#include <weft/report.h>
#include <weft/result.h>
#include <weft/scene.h>
#include <weft/settings.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weft {

class Recorder;
struct State;

/// Strain of all constraints, and of triangles of fabric | |f_u| - 1 | and | |f_v| - 1 |, for the
/// laws that they have (MembraneElement). A slack rope has none, and neither has a slack direction
/// of a triangle that only pulls.
struct Strain {
  double max = 0;
  double rms = 0;
  std::uint32_t worst_constraint = kNoIndex;  ///< its number in the description
  double max_shear = 0;                       ///< rad, |f_u . f_v| / (|f_u| |f_v|) of triangles
  std::uint32_t worst_element = kNoIndex;     ///< the triangle of the largest strain or shear
};

struct Energy {
  double kinetic = 0;    ///< J
  double potential = 0;  ///< J, of gravity, zero at the origin
  /// J, of springs, triangles and bending elements. Computed with the stiffness that the last
  /// substeps could resolve.
  double elastic = 0;
  double total() const { return kinetic + potential + elastic; }
};

/// A new value of one particle or constraint, by its number in the description.
struct ChangedValue {
  std::uint32_t index = 0;
  double value = 0;
};

/// New stiffnesses of a triangle of fabric (MembraneElement), by its number in the description.
struct ChangedMembrane {
  std::uint32_t index = 0;
  double warp = 0, weft = 0, shear = 0;  ///< N/m
};

/// New numbers of the air (Air).
struct ChangedAir {
  double density = 0;  ///< kg/m^3
  double drag = 0, lift = 0, ram = 0;
};

/// Changes of a cloth that moves. Anything that is not listed stays as it is.
struct Changes {
  std::vector<std::uint32_t> fix = {};      ///< particles: fixed where they are, at rest
  std::vector<std::uint32_t> release = {};  ///< fixed ones: freed, at the speed of their last move
  std::vector<ChangedValue> masses = {};    ///< kg, of particles
  std::vector<ChangedValue> rest_lengths = {};  ///< m, of constraints
  std::vector<ChangedValue> compliances = {};   ///< m/N, of constraints
  std::vector<ChangedMembrane> membrane = {};
  std::vector<ChangedValue> bending = {};  ///< m/N, compliances of bending elements
  std::optional<Damping> damping = {};
  std::optional<ChangedAir> air = {};  ///< of the triangles that the description has
};

/// A pressure (Pressure) of a cloth as it is.
struct PressureNow {
  double pressure = 0;  ///< Pa, above that of the air around it
  double volume = 0;    ///< m^3, enclosed by its triangles; 0 if they are not closed
};

/// New limits of an anchor.
struct AnchorLimit {
  double max_distance = 0;  ///< m, as Anchor::max_distance; infinite: the particle is released
  bool backstop = true;     ///< whether the backstop of the description, if there is one, counts
};

/// x -> about + R (x - about) + translation; R turns by |rotation| rad about the axis `rotation`.
struct RigidMotion {
  Vec3 translation{};  ///< m
  Vec3 rotation{};     ///< rad
  Vec3 about{};        ///< m
};

/// Vectors in a buffer of floats that the caller owns, such as a vertex buffer: x, y and z of
/// vector i are floats[i * stride] and the two floats after it. The floats between vectors stay as
/// they are.
///
///   std::vector<float> packed(3 * count);       // x y z, x y z, ...
///   cloth.read_positions({packed});
///   std::vector<float> vertices(8 * count);     // position, normal, texture coordinates
///   cloth.read_positions({vertices, 8});
///   cloth.read_velocities({std::span(vertices).subspan(3), 8});   // in place of the normals
///
/// The buffer must hold exactly as many vectors as are read. Behind the last vector there may be
/// less than a stride.
struct FloatVectors {
  std::span<float> floats{};
  std::size_t stride = 3;  ///< floats from one vector to the next, at least 3
};

/// An axis-aligned box.
struct Bounds {
  Vec3 least{}, most{};  ///< m
};

/// One moving cloth: the state of a Model and the workspace of its solver. Particle numbers are
/// those of the description. position() and velocity() need particle < particle_count(). After a
/// move, the old object can only be assigned to or destroyed.
class WEFT_API Cloth {
 public:
  /// Checks the settings. The cloth starts as the description says.
  static Result<Cloth> create(std::shared_ptr<const Model> model, const Settings& settings);
  Cloth(Cloth&&) noexcept;
  Cloth& operator=(Cloth&&) noexcept;
  ~Cloth();

  /// A second cloth of the same model and settings, which continues bit for bit as this one does.
  Cloth clone() const;
  /// Takes over the model, state, forces, gravity, wind, pending pin moves and bodies of `from`,
  /// and its solver's memory of the last steps. `from` must be a cloth of the same Model, or of one
  /// derived from it by changes. Bodies make an automatic solver small_steps. This cloth keeps its
  /// settings, and refuses a state that does not fit them. If solver, scheme, backend, iterations
  /// or a tolerance (except velocity_tolerance) differ, the solver's memory is dropped, and
  /// positions out of tolerance are projected as if newly written.
  Result<void> copy_state(const Cloth& from);

  /// Everything that copy_state takes over, except the model, as bytes for a file. Numbers are
  /// little-endian. A checksum detects damage. The shapes of bodies are included. A cloth of an
  /// equal model (of the same description; load_model) that loads the bytes, in another program
  /// too, continues bit for bit as this one does, if its settings are the same.
  std::vector<std::byte> save_state() const;
  /// Continues from the saved state with the settings of this cloth, as copy_state does. It
  /// takes as long as creating a cloth, and hulls of bodies are built again. Bytes that are
  /// damaged, of another version of the format, or of another model are refused, and nothing is
  /// changed. change() and limit_anchors may replace the model: then save the model, too
  /// (save_model).
  Result<void> load_state(std::span<const std::byte> bytes);

  /// Advances by dt seconds (finite, > 0): all substeps or none. An error means that dt or
  /// jobs was refused. If memory runs out, std::bad_alloc is thrown and the state is unchanged.
  ///
  /// dt is meant to be 0.1 ms to 0.1 s. In shorter steps the rounding of the floats of yarns shows
  /// up as velocity and slows motion (rattle and velocity_correction undo that; direct works in
  /// double). The cost of longer steps is limited by 1024 automatic substeps and max_iterations.
  ///
  /// Large cloths use several threads of `jobs`. Any of them may lead the step while the calling
  /// thread waits.
  Result<StepReport> step(double dt, const JobSystem& jobs = {});

  std::size_t particle_count() const;
  const std::shared_ptr<const Model>& model() const;
  /// The settings in use: isa, solver, substeps and velocity_correction as they were chosen.
  const Settings& settings() const;

  Vec3 position(std::uint32_t particle) const;  ///< m
  /// m/s. It is always 0 for fixed particles, even while move_fixed() moves them. With scheme paper
  /// and no velocity correction, a particle that hangs at rest reports g h / 2 (h: the substep),
  /// which the next substep cancels.
  Vec3 velocity(std::uint32_t particle) const;
  /// Copies one Vec3 per particle. out.size() must be particle_count(), else nothing is copied.
  Result<void> read_positions(std::span<Vec3> out) const;
  Result<void> read_velocities(std::span<Vec3> out) const;
  /// The same as floats. Positions are relative to the origin (finite), which is subtracted before
  /// they are rounded. So positions near the origin keep their precision, however far the origin is
  /// from 0. surface.h reads by vertex, with normals.
  Result<void> read_positions(FloatVectors out, Vec3 origin = {}) const;
  Result<void> read_velocities(FloatVectors out) const;
  /// The box around all particles, fixed ones included.
  Bounds bounds() const;

  /// Replaces all positions (m); finite, one per particle. Positions out of tolerance, initial ones
  /// too, are projected onto the constraints when the next step begins; velocities are unchanged.
  /// (With Settings::iterations nothing is projected.)
  ///
  /// Fabrics, and all springs with a natural frequency above 200 rad/s, are projected too if these
  /// positions would at once set them in fast motion. They come to the nearby equilibrium, and lose
  /// their stored energy. Slower springs keep their stretch, because their swings are visible.
  ///
  /// A fixed particle that moved in the last step keeps its speed.
  Result<void> write_positions(std::span<const Vec3> in);
  /// Replaces all velocities (m/s); finite, one per particle. Fixed particles are then at rest.
  Result<void> write_velocities(std::span<const Vec3> in);
  /// External forces in N besides gravity, one per particle, kept until replaced. Empty: none.
  Result<void> write_forces(std::span<const Vec3> in);
  /// m/s^2, from the next step on.
  Result<void> set_gravity(Vec3 gravity);
  /// m/s, Air::wind from the next step on.
  Result<void> set_wind(Vec3 wind);
  /// Pa, on all triangles of SceneDescription::surface from the next step on (Pressure); 0: none.
  /// It replaces all pressures. It may be another one in each frame, and does not change within
  /// one. Other solvers than small_steps refuse pressures. An automatic solver becomes small_steps,
  /// at the cost of a change().
  Result<void> set_pressure(double pressure);
  /// The same for parts of the surface, and for gas that they enclose; empty: none. A gas of volume
  /// 0 has its pressure at the volume of the present positions.
  Result<void> set_pressure(std::span<const Pressure> pressures);
  /// At the present positions, in the order in which they were set.
  std::vector<PressureNow> pressures() const;
  /// Moves a fixed particle. It travels to the position in a straight line during the next step,
  /// however far that is, and the cloth takes on its speed; position() returns the new place at
  /// once. The last move before a step counts; write_positions cancels all moves. A fixed particle
  /// that is not moved before a step stands still in it. So interpolate if steps are shorter than
  /// the frames of an animation.
  Result<void> move_fixed(std::uint32_t particle, Vec3 position);
  /// Moves many, in their order: particles[i] to positions[i]. On an error none is moved.
  Result<void> move_fixed(std::span<const std::uint32_t> particles,
                          std::span<const Vec3> positions);
  /// Teleports a fixed particle: it is at the new position before the next step begins. The cloth
  /// is then projected to follow it, fabrics too (write_positions); velocities, and the load that
  /// the fabric carries, are unchanged. (With Settings::iterations nothing is projected: the jump
  /// becomes a velocity.) Particles that a teleported sphere jumps over do not set
  /// passed_through.
  Result<void> place_fixed(std::uint32_t particle, Vec3 position);
  /// Places many, as move_fixed does. If memory runs out, nothing is changed.
  Result<void> place_fixed(std::span<const std::uint32_t> particles,
                           std::span<const Vec3> positions);
  /// Moves the points of all anchors, in the order of the description. They travel there in
  /// straight lines, and normals turn evenly, during the next step. The last move before a step
  /// counts. Call move_anchors before write_positions, and anchors jump instead of travelling; so
  /// do limits.
  /// normals: one per anchor, of any length but 0 if there is a backstop; empty: as they are.
  Result<void> move_anchors(std::span<const Vec3> points, std::span<const Vec3> normals = {});
  /// Sets the limits of all anchors, in the order of the description: it loosens or tightens them,
  /// releases particles or holds them again. A largest distance changes evenly during the
  /// next step, so no particle is set in motion; from infinity it begins at the particle's present
  /// distance. An anchor of distance 0 holds as a fixed particle does: a change from 0 to more, and
  /// back, takes as long as change().
  Result<void> limit_anchors(std::span<const AnchorLimit> limits);
  /// Sets the limits of one anchor.
  Result<void> limit_anchor(std::uint32_t anchor, const AnchorLimit& limit);
  /// Multiplies all largest distances by `scale` (finite, at least 0) from the next step on: a
  /// smaller scale keeps the cloth of a character closer to its body. Distances of 0 and infinite
  /// ones stay.
  Result<void> scale_anchors(double scale);

  /// Releases seams, by their numbers in the description: from the next step on they have no
  /// effect, open or closed. Edges and faces at the two particles still do not collide
  /// (SelfContact). Seams that were released already stay so. On an error none is released.
  Result<void> release_seams(std::span<const std::uint32_t> seams);
  /// Closes seams that were released: each pulls its particles together again, from where they are,
  /// in its time and by its force. Other seams stay as they are. On an error none is closed.
  Result<void> close_seams(std::span<const std::uint32_t> seams);

  /// Moves the whole cloth at once by a share, 0 to 1, of a rigid motion (of its translation and
  /// its angle), without accelerating it: positions, fixed particles, anchors and the solver's
  /// memory move and turn; velocities turn and gain nothing. Gravity, forces and wind belong to the
  /// world and stay. The drag of the next step is that of a cloth which moves this way during
  /// that step.
  ///
  /// To reduce the effect of a character's acceleration on its cloth to the fraction s, call
  /// carry(motion, 1 - s) before the step, then move pins and anchors. Velocities are then relative
  /// to the character.
  Result<void> carry(const RigidMotion& motion, double share);
  /// carry with share 1, but without the drag of this motion.
  Result<void> teleport(const RigidMotion& motion);

  /// Adds a body, which is there from the next step on, and returns its id; ids are not used again.
  /// Other solvers than small_steps refuse bodies. An automatic solver becomes small_steps, at the
  /// cost of a change().
  Result<std::uint32_t> add_body(const Body& body);
  /// Gives a body another pose. It travels there during the next step, in a straight line, turning
  /// evenly about one axis by half a turn at most, and takes cloth along. The last move before a
  /// step counts. A body that is not moved before a step stands still in it.
  Result<void> move_body(std::uint32_t id, const Pose& pose);
  /// Teleports a body. Cloth that is then inside the body comes out slowly. A body with a mass
  /// keeps its velocity.
  Result<void> place_body(std::uint32_t id, const Pose& pose);
  /// Gives a triangle mesh other vertices, in its own coordinates. They travel there in straight
  /// lines during the next step, while the pose travels too. The last move before a step counts.
  /// Vertices that are not moved before a step stand still in it.
  Result<void> move_body_vertices(std::uint32_t id, std::span<const Vec3> vertices);
  /// Teleports the vertices.
  Result<void> place_body_vertices(std::uint32_t id, std::span<const Vec3> vertices);
  /// Switches a body on or off. A body that is off touches nothing.
  Result<void> switch_body(std::uint32_t id, bool on);
  Result<void> remove_body(std::uint32_t id);
  Result<BodyLoad> body_load(std::uint32_t id) const;
  /// Where a body is: where the last step ended, or where it was put since.
  Result<Pose> body_pose(std::uint32_t id) const;
  /// The velocity of a body with a mass; the two below are of one, too.
  Result<BodyVelocity> body_velocity(std::uint32_t id) const;
  Result<void> set_body_velocity(std::uint32_t id, const BodyVelocity& velocity);
  /// N, at its centre of mass, and N m. They act in every step until others are set.
  Result<void> set_body_force(std::uint32_t id, Vec3 force, Vec3 moment);
  /// The contacts when the last step of this cloth ended; an empty list after clone() and change().
  std::vector<BodyContact> body_contacts() const;

  /// The breaks at the end of the last step; an empty list after clone(), change(), load_state().
  /// The cloth then has a model of its own, as after change(), which takes about as long. Where a
  /// sheet is torn it has more particles: particle_count() grows, and numbers stay. If memory runs
  /// out nothing breaks before the next step.
  std::vector<Torn> torn() const;
  /// SceneDescription::surface as tears have left it: triangles keep their numbers, and have new
  /// particles as corners where they were split.
  std::vector<std::array<std::uint32_t, 3>> surface() const;

  /// Changes the description of a moving cloth. If memory runs out, or on an error, nothing is
  /// changed. model() is then another one, as build_model makes it of the changed description;
  /// other cloths of the old model keep that. Numbers of particles and constraints stay the same.
  /// So do positions, and velocities except of particles that are fixed or released. The solver
  /// keeps its memory, unless Solver::automatic, which chooses anew, chooses another solver.
  ///
  /// Constraints that are then longer or shorter than they may be, and those of pins that are
  /// released, are corrected when the next step begins; velocities are unchanged. So are fabrics
  /// (write_positions) whose rest lengths change by more than the tolerance. A particle is released
  /// at the speed that move_fixed gave it in the last step, and no energy is gained.
  ///
  /// New damping and air take less than half of a frame of fabric that rests, new bending about
  /// three such frames. Other changes take as long as to build a model and create a cloth: up to
  /// six such frames, or three to fifteen steps of a rigid woven sheet, whose steps are the
  /// cheapest. Make all changes of a frame in one call. References from model() and settings() may
  /// be invalid after this call, and after copy_state.
  Result<void> change(const Changes& changes);

  /// Gives the cloth another shape at rest, for cloth that shrinks, grows or is inflated, and for
  /// garments on bodies that grow. It takes from `scene`, times `scale`: rest lengths of
  /// constraints, corners of triangles of fabric, lengths of tethers, and of bending elements the
  /// weights (over `scale`, so angles stay), rest, fold and yield; and compliances of constraints
  /// and bending elements. Creases are forgotten. Its elements must be those of this cloth, with
  /// the same particles, as torn; all else in it is ignored. cloth_from_mesh makes such a scene of
  /// the same mesh with other rest_positions. Strain, areas and distances of contacts are then
  /// those of the new shape. Stiffnesses of triangles, masses, positions and velocities stay.
  ///
  /// The shape is given as a whole, so a scale does not add up over calls. It is part of the model,
  /// as what change() changes is (load_state), and takes about as long as that. Where a length
  /// changes by more than the tolerance, the cloth is projected when the next step begins
  /// (write_positions). To let it grow, give it a slightly larger scale before each step.
  Result<void> set_rest_shape(const SceneDescription& scene, double scale = 1);

  /// Recomputed from the positions by this thread alone. The report of the last step has its strain
  /// already, which may differ in the last bits.
  Strain strain() const;
  /// m, the largest over all pairs of a sphere and a particle or sphere, except two fixed ones; 0
  /// without spheres.
  double max_penetration() const;
  Energy energy() const;  ///< J, of the particles that are not fixed
  /// FNV-1a over the bits of all positions and velocities, in the description's order.
  std::uint64_t state_hash() const;
  std::size_t bytes() const;  ///< held by this cloth, without the shared model

  /// Records all that this cloth does from now on in a file, for a bug report: its settings, model
  /// and state, and of each step the changes before it and the hash of the state that it reached.
  /// `weft replay FILE` repeats these steps elsewhere, and names the first one with other bits.
  /// Each step is in the file before it begins, so after a crash the file has everything up to that
  /// step. `weft replay` shows the note. A step takes longer, and allocates. The recording moves
  /// with this cloth; a clone has none. An error means that the file cannot be written, or that
  /// this cloth is being recorded already. An existing file is replaced.
  Result<void> begin_recording(const std::string& path, std::string_view note = {});
  /// Completes the file. If the cloth is destroyed first, the file ends there and is not marked as
  /// complete. An error means that nothing was recorded, or that something could not be written.
  Result<void> end_recording();

 private:
  friend class ClothBatch;
  struct Impl;
  State* state();  // null where it was moved from
  explicit Cloth(std::unique_ptr<Impl> impl);
  Result<void> prepare_for(std::string_view what);
  std::unique_ptr<Impl> impl_;
  std::unique_ptr<Recorder> recorder_;  // null: nothing is recorded
};

}  // namespace weft
