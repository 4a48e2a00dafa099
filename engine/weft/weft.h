/// weft: a cloth simulation library. This header is the whole public interface of simulation;
/// mesh.h beside it makes a SceneDescription of a mesh and a material.
///
///   describe -> build -> create -> step -> read
///
///   weft::SceneDescription scene = ...;                   // plain vectors, SI units
///   auto model = weft::build_model(scene);                // validates; immutable, shareable
///   auto cloth = weft::Cloth::create(model.value(), {});  // mutable state and its workspace
///   auto report = cloth.value().step(0.01);               // one step, and the error it reached
///   cloth.value().read_positions(out);                    // in the description's numbering
///
/// Design:
///  1. The user asks for an error, not for an iteration count. Every step reports the error it
///     reached, recomputed from the positions that it committed.
///  2. Only what the scene needs runs: no spheres, no contact code; no velocity correction, no
///     velocity loop.
///  3. A Model is immutable and may be shared by any number of Cloths and threads. A Cloth is not
///     synchronised: one thread at a time, for functions that are const too.
///  4. weft owns no threads, and no globals that affect results but WEFT_ISA in the environment
///     (Isa). Parallel work runs in the caller's oneTBB arena, rounded as the calling thread
///     rounds. Threads go back to the arena when the step ends, as they were; weft changes neither
///     their priority nor the processors that they may run on. A task that the arena had no thread
///     for may start when its step is over, and returns at once. So a plugin that holds weft must
///     not be unloaded while tasks may still start: link it with -z nodelete.
///     Floating-point exceptions are to be masked: lanes compute what nobody takes (1 / 0).
///  5. A step allocates nothing once warm (contact lists grow to their largest size and stay).
///  6. Errors are values. Bad input yields one line that names the field, the index and the value,
///     and nothing is built or changed. weft throws only what the standard allocator throws.
///
/// Numbers of sections (3.2, 4.4) are those of Bayer, Diziol and Bender, "Optimized Impulse-Based
/// Dynamic Simulation" (2009), "the paper" here. Files that are named are in weft's sources.
///
/// Versions are major.minor.patch. While major is 0 a new minor version may change this interface
/// and the bits of results; a new patch changes neither, but for mistakes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#define WEFT_VERSION_MAJOR 0
#define WEFT_VERSION_MINOR 2
#define WEFT_VERSION_PATCH 0

/// What a shared library shows.
#define WEFT_API [[gnu::visibility("default")]]

namespace weft {

// ---------------------------------------------------------------------------------------- errors

/// One line that names the field, the index and the value that were refused.
struct Error {
  std::string message;
};

/// A value or an Error. Test it before use: value() of a failed result is undefined, and so is
/// error() of a successful one.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}
  explicit operator bool() const { return value_.has_value(); }
  T& value() & { return *value_; }
  const T& value() const& { return *value_; }
  T&& value() && { return *std::move(value_); }
  const std::string& error() const { return error_.message; }

 private:
  std::optional<T> value_;
  Error error_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}
  explicit operator bool() const { return !error_.has_value(); }
  const std::string& error() const { return error_->message; }

 private:
  std::optional<Error> error_;
};

// --------------------------------------------------------------------------------------- describe

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

/// What is simulated. Lengths in m, masses in kg, times in s.
/// At most one constraint may join the same two particles. A constraint between two fixed particles
/// is legal but inert: nothing can move it, so it is neither solved nor measured.
struct SceneDescription {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;      ///< empty: at rest; else one per particle
  std::vector<double> masses;        ///< one per particle, 1e-150 to 1e150, fixed ones too
  std::vector<std::uint32_t> fixed;  ///< particles of infinite inertia; move them with move_fixed()
  std::vector<Constraint> constraints;
  std::vector<BendingElement> bending;
  Damping damping;
  Air air;
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

// ------------------------------------------------------------------------------------------ build

/// Topology, colours, rest lengths, masses: all that does not change while the cloth moves.
class Model;

/// Checks the description and prepares it. On error nothing is built.
WEFT_API Result<std::shared_ptr<const Model>> build_model(const SceneDescription& description);

struct ModelInfo {
  std::size_t particles = 0;
  std::size_t constraints = 0;  ///< active ones, without contacts
  std::size_t inert_constraints = 0;
  std::size_t ropes = 0;
  std::size_t compliant = 0;  ///< constraints that are springs
  std::size_t bending_elements = 0;
  std::size_t air_triangles = 0;
  std::size_t spheres = 0;
  std::size_t colours = 0;
  std::size_t tiles = 0;  ///< groups of particles that threads may work on in parallel
  double run_share =
      0;  ///< of the constraints without a hub (engine/model/model.h): in contiguous runs
  std::size_t bytes = 0;
};
WEFT_API ModelInfo describe(const Model& model);

// ----------------------------------------------------------------------------------------- create

/// gauss_seidel: the paper's impulse loop (section 3.2), one constraint after the other.
/// direct: all impulses at once by sparse factorisation, repeated until the true errors are within
///   tolerance: two or three solves, at any tolerance. For mass ratios of a million. At most
///   16 bodies may take part, free spheres that touch or are joined to something and particles of
///   more than 64 constraints; with more its substeps fall back as below.
/// yarn: splits the cloth into chains of constraints that run straight on through it, as the yarns
///   of a woven one do. Each is solved exactly, many side by side in SIMD lanes; where sweeps over
///   them converge slowly, conjugate gradients solve all of them as one system. Ropes, hubs and
///   contacts are relaxed one by one after each sweep, and take part in that system. A yarn
///   between two fixed particles that is taut, and not braced by triangles, hangs by a strain: with
///   scheme paper it keeps most of what yarns may leave (0.3 %, or the tolerance if that is less),
///   in addition to the strain that the distance of its ends demands. simd only.
/// small_steps: one relaxed sweep in each of many short substeps, over yarns where the cloth has
///   them and over single constraints elsewhere, and then passes over what is out of tolerance
///   alone. A sweep leaves a strain that falls with the square of the substep; how long that may be
///   follows in closed form from what hangs on the pins, and from the tolerance
///   (engine/solvers/small_steps/small_steps_load.h). For any mesh, at tolerances of 0.1 % and
///   looser, and for a motion that is near the true one. Masses should not differ by more than a
///   hundred. Substeps of one length are best kept to: a change of it by half costs some energy.
///   It alone solves springs (Constraint::compliance) and bending.
/// automatic: by what the cloth is. small_steps for cloth, woven or a mesh, and for all springs.
/// direct for chains of
///   ropes, trees and bridges of them, and where masses are extremely unequal. yarn for all else:
///   cloth at a tolerance that small steps could not afford, with unequal masses or free spheres,
///   with scheme paper or rattle, or with velocity_correction. gauss_seidel on the reference
///   backend and with `iterations`. The thresholds are not part of the interface.
/// What yarn and direct do not bring within tolerance is done by others, in this order: the same
/// solver in shorter parts, halves of what was rejected down to a sixteenth of the substep
/// (StepReport::halvings counts what was rejected); and for the rest of the substep direct behind
/// yarn, where masses are unequal; small_steps; gauss_seidel, whose result is committed with its
/// error. For some steps afterwards substeps begin in about as many parts. Energy that
/// a substep gains by more than gravity, forces and moved pins explain is taken out by scaling its
/// velocities down, to rest at most, or to the rigid motion nearest to that of the pins
/// (engine/step/energy.h). So a step depends slightly on the ones before, until positions are
/// written. gauss_seidel is the paper's loop, and is guarded only where it is cut off.
enum class Solver : std::uint8_t { gauss_seidel, direct, yarn, small_steps, automatic };
/// paper: impulses along the directions at the predicted positions; first order, and dissipative.
/// rattle: along the directions at the start of the substep, always with velocity correction;
///   second order. This includes ropes that become taut within the substep. Contacts arise within
///   it and, in both schemes, act along their directions at its end. Where rattle does not
///   converge, or its impulses would add energy (engine/step/energy.h), the substep is redone from
///   the same state by the paper's scheme with velocity correction; StepReport::scheme_fallbacks
///   counts these. With Settings::iterations nothing is redone.
/// implicit, bdf2: of small_steps alone. The implicit Euler method, first order, and the second
///   order BDF2 with variable steps; particles that a contact or a local pass has moved go on from
///   there at first order. Whoever writes velocities changes the step before alike; written
///   positions have no past.
/// automatic: bdf2 with small_steps, else paper. Cloth::settings() tells.
enum class Scheme : std::uint8_t { paper, rattle, implicit, bdf2, automatic };
/// each: directions renewed before every iteration (sections 3.2, 4.1).
/// frozen: only once all errors along them are within tolerance (section 4.4), or after renew_after
///   iterations.
enum class Directions : std::uint8_t { each, frozen };
/// reference: scalar, double, the oracle for everything else.
/// simd: single precision in lanes inside the loop, refined from positions in double; reaches the
///   same tolerance.
enum class Backend : std::uint8_t { reference, simd };
/// What the simd backend runs on. automatic: what WEFT_ISA in the environment names, else the best
/// that the machine has. avx2 and avx512 give the same bits.
enum class Isa : std::uint8_t { automatic, sse2, avx2, avx512 };

inline constexpr int kMaxThreads = 64;
inline constexpr int kAutomaticSubsteps = 0;

/// How a cloth is solved. The defaults converge to 1 % the fastest way that is known here;
/// paper_settings() are the paper's.
struct Settings {
  /// Strain, | |a-b| - rest | / rest, that every step must reach; > 0. The simd backend works in
  /// floats: it takes rest lengths, tolerance * rest length, and the tolerances below that are
  /// used, from 1e-18 to 1e18, and Cloth::create refuses others.
  double tolerance = 0.01;
  /// Each step is done as this many substeps, each solved to the tolerances; with small_steps only
  /// the last is looked at, and the number bounds the time of a step. 0 (kAutomaticSubsteps): of
  /// small_steps by closed form, up to 1024; else chosen from the motion (rattle: up to 2.5 times
  /// as many as paper) and, with yarns, from the load that heavy particles and, with scheme paper,
  /// spheres are; no more than max_iterations / 8 then. 1 on the reference backend or with
  /// `iterations`. Fine meshes need small substeps.
  int substeps = kAutomaticSubsteps;
  /// 0: iterate to the tolerance. K > 0: exactly K iterations per substep whatever the error,
  /// nothing skipped; gauss_seidel renews frozen directions once per substep, the others in every
  /// iteration.
  int iterations = 0;
  /// frozen: most iterations along the same directions; 0: until all errors along them are within
  /// tolerance, as in the paper (section 4.4; simd: 1024, since between renewals errors in floats
  /// fall by seven digits at most). Solving exactly along directions that will change is wasted
  /// work: 32 saves a fifth of the iterations and more.
  int renew_after = 32;
  /// Of a whole step, whatever its substeps, attempts and schemes; > 0. It bounds the time of a
  /// step: a game sets it, to several times of what its frames take, for what one leaves undone the
  /// next finds. (For the same time in each frame: `iterations` and `substeps`, solver yarn.) Each
  /// substep may do half of what is left, the last one all; half of that is kept for the last
  /// attempt (see Solver), which does one at least. The velocity loop may do as many of its own.
  /// Where a substep that is cut off would gain energy, its velocities are scaled down.
  int max_iterations = 1'000'000;
  double contact_tolerance = 1e-4;   ///< m of penetration left; > 0
  double velocity_tolerance = 0.01;  ///< m/s along a constraint; > 0
  double impulse_limit = 0;          ///< N s, the largest impulse of one correction; 0: no limit;
                                     ///< gauss_seidel on the reference backend only
  Solver solver = Solver::automatic;
  Scheme scheme = Scheme::automatic;
  Backend backend = Backend::simd;
  Isa isa = Isa::automatic;
  /// Maximum threads of the caller's arena per step; 0: all that it offers, up to kMaxThreads.
  /// Yarns use at most 16, small cloths one. Does not affect the result.
  int threads = 0;
  Directions directions = Directions::frozen;
  /// Section 4.2: update errors instead of recomputing them. simd forms them from displacements
  /// either way, which is faster in lanes (perf/tried.md); there this selects how `skip` tracks
  /// satisfied constraints: true, by flags of chunks; false, by the paper's 64-bit masks.
  bool anticipate = true;
  /// simd, gauss_seidel, with `anticipate`: errors of distance constraints, in both loops, are
  /// kept, and updated through the stored products of neighbouring directions, as in section 4.2.
  /// Ropes, constraints at hubs and contacts still form theirs from displacements. An iteration
  /// takes 1.3 to 2 times as long as by displacements, on irregular meshes 3 times (perf/tried.md).
  /// The reference backend keeps products whenever it anticipates, and refuses this.
  bool anticipate_products = false;
  bool skip = true;  ///< section 4.3: satisfied constraints are passed over
  /// Sections 3.2, 3.3: a second loop, on velocities; rattle has it always. Without it gauss_seidel
  /// gains energy in steps of a millisecond and less: errors left within a loose tolerance come
  /// back as speed, error / dt (tests/README.md).
  bool velocity_correction = false;
};

/// The method of the paper, with all its optimisations: Gauss-Seidel, one substep.
inline Settings paper_settings() {
  Settings settings;
  settings.solver = Solver::gauss_seidel;
  settings.scheme = Scheme::paper;
  settings.substeps = 1;
  return settings;
}

/// converged: every constraint is within its tolerance.
/// fixed_iterations: Settings::iterations were done; the error is what the report says.
/// iteration_limit: max_iterations were done, or with small_steps all rounds, and some constraint
/// is
///   still out of tolerance. The state is committed.
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

WEFT_API std::string_view name(Solver);
WEFT_API std::string_view name(Scheme);
WEFT_API std::string_view name(Directions);
WEFT_API std::string_view name(Backend);
WEFT_API std::string_view name(Isa);
WEFT_API std::string_view name(Status);
WEFT_API std::string_view name(Stage);

/// What one step did and what it reached. Counts and seconds are summed over the substeps; status
/// is the worst of them; errors are those at the end.
struct StepReport {
  Status status = Status::converged;
  int substeps = 0;                      ///< done; 0 where nothing is committed
  int halvings = 0;                      ///< attempts at a substep that were rejected (Solver)
  std::int64_t iterations = 0;           ///< passes over the position constraints; yarn: sweeps and
                                         ///< conjugate gradient iterations; direct: solves;
                                         ///< small_steps: local passes by their visits
  std::int64_t direction_updates = 0;    ///< renewals of the constraint directions
  std::int64_t velocity_iterations = 0;  ///< passes of the velocity loop; direct: solves
  std::int64_t visits = 0;               ///< constraints whose error was looked at, both loops
  std::int64_t corrections = 0;          ///< impulses applied, both loops
  int scheme_fallbacks = 0;              ///< attempts that scheme rattle left to the paper's
  int contacts = 0;                      ///< candidate pairs, near enough to be watched
  double max_strain = 0;                 ///< over all constraints, recomputed from the positions
  double rms_strain = 0;
  /// What is left of the constraints' laws, the largest, as a fraction of rest_length: of rigid
  /// constraints the strain, of springs | |a-b| - rest_length - compliance f | / rest_length with
  /// the tension f that the solver applied in the last substep. This is what `tolerance` bounds.
  double max_error = 0;
  std::uint32_t worst_constraint = kNoIndex;  ///< the description's index
  double max_penetration = 0;                 ///< m, 0 without contacts
  double pin_work = 0;  ///< J, work that moved pins did in this step: exact where they move as one
                        ///< rigid body, else that of the rigid motion nearest to theirs. Jumps do
                        ///< none. Impulses of fixed spheres count as if they were the pins' own;
                        ///< what moved spheres do is not in it.
  std::uint32_t failed_particle = kNoIndex;  ///< non_finite, non_finite_input: one of those
  std::uint32_t passed_particle = kNoIndex;  ///< passed_through: one that did
  std::array<double, kStageCount> stage_seconds{};
};

struct Strain {
  double max = 0;
  double rms = 0;
  std::uint32_t worst_constraint = kNoIndex;  ///< the description's index
};

struct Energy {
  double kinetic = 0;    ///< J
  double potential = 0;  ///< J, of gravity, zero at the origin
  double elastic = 0;  ///< J, of springs and bending elements, no stiffer than the substeps of the
                       ///< last step can tell: what these leave of a law is no energy
  double total() const { return kinetic + potential + elastic; }
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
  /// Takes over from `from`, a cloth of the same Model: state, forces, gravity, wind, pending pin
  /// moves, and the solver's memory of its last steps. This cloth keeps its own settings. If
  /// solver, scheme, backend, iterations, tolerance or contact_tolerance differ, that memory is
  /// dropped, and positions out of tolerance are projected as if newly written.
  Result<void> copy_state(const Cloth& from);

  /// Advances by dt seconds (finite, > 0): all substeps or none. If memory runs out, std::bad_alloc
  /// is thrown and the state is unchanged. An error means that dt was refused. Meant for frames of
  /// 0.1 ms to 0.1 s: in shorter ones the rounding of yarns' floats shows up as velocity, and slows
  /// motion (rattle and velocity_correction undo that, direct works in double); the cost of longer
  /// ones is limited by 256 automatic substeps and max_iterations. Before a step of less than an
  /// eighth of the last one, positions are projected onto the constraints, velocities unchanged
  /// (yarn, direct): what the last one left within tolerance would become speed.
  Result<StepReport> step(double dt);

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
  /// Packed x y z floats for a vertex buffer; out.size() must be 3 * particle_count().
  Result<void> read_positions(std::span<float> out) const;

  /// Replace the state; finite values, one per particle. Initial or written positions that are out
  /// of tolerance are projected onto the constraints as the next step begins, velocities unchanged
  /// (not with Settings::iterations). Fixed particles that moved in the last step are at rest after
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
  /// straight line during the next step, and the cloth takes on its speed. If its velocity would
  /// change by more than 200 m/s^2 * dt from that of its last step, it jumps instead: it is placed
  /// before the step, and the cloth is projected after it, velocities unchanged (with
  /// Settings::iterations nothing is projected: a jump becomes speed); what a sphere jumped over is
  /// not passed_through. The last move before a step counts; write_positions cancels all. (To
  /// teleport a whole cloth, or move the origin, write all its positions: then nothing needs
  /// solving, and pins go on at their speed.) A fixed particle that is not moved before a step
  /// stands still in it: where steps are shorter than the frames of an animation, interpolate.
  Result<void> move_fixed(std::uint32_t particle, Vec3 position);

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
  struct Impl;
  explicit Cloth(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
