/// weft: a cloth kernel. The whole public interface is this header.
///
///   describe -> validate -> create -> step -> read
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
///     synchronised: one thread at a time.
///  4. weft owns no threads, and no globals that a result depends on. Parallel work runs in the
///     caller's oneTBB arena; a worker that helped with a step waits for the next one for as long
///     as that took, 0.2 ms at most, and may be moved off the processor of the thread that steps.
///  5. A step allocates nothing once warm (contact lists grow to their largest size and stay).
///  6. Errors are values. Bad input yields one line that names the field, the index and the value,
///     and nothing is built or changed. weft throws only what the standard allocator throws.
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

namespace weft {

// ---------------------------------------------------------------------------------------- errors

/// One line that names the field, the index and the value that were refused.
struct Error {
  std::string message;
};

/// A value or an Error. Test it before use; value() of a failed result is undefined.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}
  explicit operator bool() const { return value_.has_value(); }
  T& value() { return *value_; }
  const T& value() const { return *value_; }
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

/// distance: |a - b| = rest_length. rope: |a - b| <= rest_length (pulls only).
enum class ConstraintKind : std::uint8_t { distance, rope };

struct Constraint {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double rest_length = 0;  ///< m, > 0
  ConstraintKind kind = ConstraintKind::distance;
};

/// What is simulated. Lengths in m, masses in kg, times in s.
/// At most one constraint may join the same two particles. A constraint between two fixed particles
/// is legal but inert: nothing can move it, so it is neither solved nor measured.
struct SceneDescription {
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;      ///< empty: at rest; else one per particle
  std::vector<double> masses;        ///< one per particle, > 0, fixed particles included
  std::vector<std::uint32_t> fixed;  ///< particles of infinite inertia; move them with move_fixed()
  std::vector<Constraint> constraints;
  Vec3 gravity{0, -10, 0};

  /// Contacts exist only where `spheres` names particles. Each of those collides with every other
  /// particle that no constraint joins it to, at the distance radii[i] + radii[j]; particles
  /// outside the list do not collide among themselves. radii: empty without spheres, else one per
  /// particle, >= 0.
  std::vector<std::uint32_t> spheres;
  std::vector<double> radii;
};

// --------------------------------------------------------------------------------------- validate

/// Topology, colours, rest lengths, masses: all that does not change while the cloth moves.
class Model;

/// Checks the description and prepares it. On error nothing is built.
Result<std::shared_ptr<const Model>> build_model(const SceneDescription& description);

struct ModelInfo {
  std::size_t particles = 0;
  std::size_t constraints = 0;  ///< active ones, without contacts
  std::size_t inert_constraints = 0;
  std::size_t ropes = 0;
  std::size_t spheres = 0;
  std::size_t colours = 0;
  std::size_t tiles = 0;  ///< parts that threads may work on side by side
  double run_share = 0;   ///< constraints in contiguous runs / constraints
  std::size_t bytes = 0;
};
ModelInfo describe(const Model& model);

// ----------------------------------------------------------------------------------------- create

/// gauss_seidel: the impulse loop of the paper (section 3.2), one constraint after the other.
/// direct: all impulses at once, from the factors of their matrix, repeated until the true errors
///   are within tolerance: two or three solves, at any tolerance. The choice for masses that differ
///   by many thousands.
/// yarn: chains of constraints that run straight on through the cloth, as the yarns of a woven one
///   do, each solved exactly and many side by side in lanes; conjugate gradients over all of them
///   where such sweeps are slow. Ropes, hubs and contacts are relaxed one by one after each sweep,
///   and take part in the linear system. On the simd backend.
/// automatic: yarn; direct where the masses of joined particles differ by more than 10^4, and with
///   both scheme rattle and spheres; gauss_seidel on the reference backend, for fixed iterations.
/// Where yarn or direct give up, the substep is done in halves, and where that is no answer either,
/// Gauss-Seidel goes on; StepReport::iterations counts all of it. Such a substep gains no energy:
/// velocities are scaled down, all by one factor, if it would. For some steps after it automatic
/// substeps are shorter and yarns stop at a smaller error; where steps took yarns thousands of
/// passes, the tolerance is above 0.3 %, and there are no spheres, the next ones are done by
/// Gauss-Seidel alone. So the next step depends a little on how the state came about, until
/// positions are written.
enum class Solver : std::uint8_t { gauss_seidel, direct, yarn, automatic };
/// paper: impulses along the directions of the previewed state; first order, and dissipative.
/// rattle: along those at the start of the substep, and the velocity correction always: second
///   order. Ropes likewise, also those that become taut within the substep; contacts come about in
///   it and act along their directions at its end, in both schemes. A substep too large for it is
///   done again by the paper's scheme with velocity correction, from the same state: where rattle
///   does not converge, or its impulses would bring in energy (engine/rattle.h).
///   StepReport::scheme_fallbacks counts these. With Settings::iterations nothing is done again.
enum class Scheme : std::uint8_t { paper, rattle };
/// each: directions renewed before every iteration (sections 3.2, 4.1).
/// frozen: only once all errors along them are within tolerance (section 4.4).
enum class Directions : std::uint8_t { each, frozen };
/// reference: scalar, double, the oracle for everything else.
/// simd: float lanes inside the loop, refined from double; the same tolerance is reached.
enum class Backend : std::uint8_t { reference, simd };
/// What the simd backend runs on. automatic: what WEFT_ISA in the environment names, else the best
/// that the machine has. avx2 and avx512 give the same bits.
enum class Isa : std::uint8_t { automatic, sse2, avx2, avx512 };

inline constexpr int kMaxThreads = 64;
inline constexpr int kAutomaticSubsteps = 0;

/// How a cloth is solved. The defaults converge to 1 % the fastest way that is known here;
/// paper_settings() are the paper's.
struct Settings {
  double tolerance = 0.01;  ///< strain, | |a-b| - rest | / rest, that every step must reach; > 0
  /// A step of dt is done as so many steps of dt / substeps, each to the tolerances; 0
  /// (kAutomaticSubsteps): as many as the motion wants, of scheme rattle up to 2.5 times as
  /// many. A substep whose solver gives up before max_iterations is done again in halves, up to 16
  /// parts of it (StepReport::halvings). Fine meshes want small steps. Iterations, and their
  /// bounds, are those of one substep.
  int substeps = kAutomaticSubsteps;
  /// 0: iterate to the tolerance. K > 0: exactly K iterations per substep whatever the error,
  /// nothing skipped, frozen directions renewed once per substep.
  int iterations = 0;
  /// frozen: the same directions serve for at most so many iterations; 0: until all errors along
  /// them are within tolerance, as the paper has it (section 4.4). Exact solutions along directions
  /// that will change are wasted: 32 saves a fifth of the iterations and more.
  /// (simd: 0 is 1024, since floats see an error fall by seven digits at most between renewals.)
  int renew_after = 32;
  int max_iterations = 1'000'000;    ///< bound on the work of one substep, in iterations; > 0; half
                                     ///< as many besides for a start that is projected
  double contact_tolerance = 1e-4;   ///< m of penetration left; > 0
  double velocity_tolerance = 0.01;  ///< m/s along a constraint; > 0
  double impulse_limit = 0;          ///< N s, the largest impulse of one correction; 0: no limit;
                                     ///< gauss_seidel on the reference backend only
  Solver solver = Solver::automatic;
  Scheme scheme = Scheme::paper;
  Backend backend = Backend::simd;
  Isa isa = Isa::automatic;
  /// Most threads of the caller's arena that a step may use; 0: as many as it offers, up to
  /// kMaxThreads; yarns are shared out among 16 at most, and small cloths use one. The result does
  /// not depend on it.
  int threads = 0;
  Directions directions = Directions::frozen;
  /// Section 4.2: errors are updated, not recomputed. simd forms them from displacements either
  /// way, which is quicker in lanes (perf/README.md); there this chooses by what `skip` remembers:
  /// flags of chunks of constraints, or, off, the paper's 64-bit masks.
  bool anticipate = true;
  bool skip = true;                  ///< section 4.3: satisfied constraints are passed over
  bool velocity_correction = false;  ///< sections 3.2, 3.3: a second loop, on velocities; rattle
                                     ///< has it always
};

/// The method of the paper, with all its optimisations: Gauss-Seidel, one substep.
inline Settings paper_settings() {
  Settings settings;
  settings.solver = Solver::gauss_seidel;
  settings.substeps = 1;
  return settings;
}

/// converged: every constraint is within its tolerance.
/// fixed_iterations: Settings::iterations were done; the error is what the report says.
/// iteration_limit: max_iterations were done and some constraint is still out of tolerance. The
///   state is committed.
/// infeasible: some constraint is out of tolerance and thousands of iterations no longer change
///   that: the constraints contradict each other (a chain whose ends are too far apart), or masses
///   differ by more than 10^7. The state is committed, with the error shared out among them.
/// passed_through: a particle went through a sphere within the step, faster than contacts are
///   looked for. The state is committed; smaller steps would have seen it.
/// non_finite_input: positions, velocities, forces and dt were such that even without a constraint
///   a particle would have left the range of numbers. The state is unchanged.
/// non_finite: a position or velocity would have become NaN or infinite. The state is unchanged.
enum class Status : std::uint8_t {
  converged,
  fixed_iterations,
  iteration_limit,
  infeasible,
  passed_through,
  non_finite_input,
  non_finite
};

/// Whether a step that ended so changed the state.
constexpr bool committed(Status status) { return status < Status::non_finite_input; }

/// The stages of a step, in order.
enum class Stage : std::uint8_t {
  predict,  ///< and, with automatic substeps, how many of them the motion wants
  find_contacts,
  solve_positions,
  commit,
  correct_velocities,
  report
};
inline constexpr std::size_t kStageCount = 6;

std::string_view name(Solver);
std::string_view name(Scheme);
std::string_view name(Directions);
std::string_view name(Backend);
std::string_view name(Isa);
std::string_view name(Status);
std::string_view name(Stage);

inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// What one step did and what it reached. Counts and seconds are sums over its substeps, the status
/// is the worst of them, the errors are those at the end.
struct StepReport {
  Status status = Status::converged;
  int substeps = 0;              ///< that the step was done in
  int halvings = 0;              ///< substeps that were done again in halves
  int iterations = 0;            ///< passes over the position constraints, in which a yarn may be
                                 ///< solved several times; direct: solves
  int direction_updates = 0;     ///< renewals of the constraint directions
  int velocity_iterations = 0;   ///< passes of the velocity loop; direct: solves
  std::int64_t visits = 0;       ///< constraints whose error was looked at, both loops
  std::int64_t corrections = 0;  ///< impulses applied, both loops
  int scheme_fallbacks = 0;      ///< substeps that scheme rattle left to the paper's
  int contacts = 0;              ///< pairs near enough to be watched
  double max_strain = 0;         ///< over all constraints, recomputed from the positions
  double rms_strain = 0;
  std::uint32_t worst_constraint = kNoIndex;  ///< the description's index
  double max_penetration = 0;                 ///< m, 0 without contacts
  std::uint32_t failed_particle = kNoIndex;   ///< non_finite, non_finite_input: the first such
  std::uint32_t passed_particle = kNoIndex;   ///< passed_through: one that did
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
  double total() const { return kinetic + potential; }
};

/// One moving cloth: the state of a Model and the workspace of its solver. Particle numbers are
/// those of the description; position() and velocity() demand particle < particle_count(). A cloth
/// that was moved from can only be assigned to or destroyed.
class Cloth {
 public:
  /// Checks the settings. The state starts as described.
  static Result<Cloth> create(std::shared_ptr<const Model> model, const Settings& settings);
  Cloth(Cloth&&) noexcept;
  Cloth& operator=(Cloth&&) noexcept;
  ~Cloth();

  /// Another cloth of the same model and settings, which goes on bit for bit as this one does.
  Cloth clone() const;
  /// Goes on as `from` would, a cloth of the same Model: state, forces, gravity, pins under way,
  /// and what it remembers of its last steps. To step back to a clone; or, since the settings stay
  /// and may be others, to change the tolerance of a cloth under way: positions are then as if
  /// they had been written, and nothing is remembered.
  Result<void> copy_state(const Cloth& from);

  /// Advances by dt seconds (finite, > 0), all substeps of it or none: also where memory runs out
  /// and std::bad_alloc is thrown, the state stays as it was. An error means that dt was refused.
  /// Meant for frames, from 10 us to 0.1 s: of shorter ones the rounding of positions makes speeds,
  /// longer ones take as many substeps, and those as long, as they want.
  Result<StepReport> step(double dt);

  std::size_t particle_count() const;
  const Model& model() const;
  const Settings& settings() const;  ///< isa, solver, substeps, velocity_correction: what is used

  Vec3 position(std::uint32_t particle) const;
  /// m/s; 0 of fixed particles, whatever was written, also while move_fixed() moves them. By scheme
  /// paper without velocity correction what hangs still has half a step of gravity, g dt / 2, which
  /// the next step takes away again.
  Vec3 velocity(std::uint32_t particle) const;
  /// Copies one Vec3 per particle; out.size() must be particle_count() (else nothing is copied).
  Result<void> read_positions(std::span<Vec3> out) const;
  Result<void> read_velocities(std::span<Vec3> out) const;
  /// Packed x y z floats for a vertex buffer; out.size() must be 3 * particle_count().
  Result<void> read_positions(std::span<float> out) const;

  /// Replace the state; finite values, one per particle. Positions that were given, here or in the
  /// description, and violate constraints by more than the tolerance are put right as the next step
  /// begins, without a change of velocity (but not with Settings::iterations).
  Result<void> write_positions(std::span<const Vec3> in);
  Result<void> write_velocities(std::span<const Vec3> in);
  /// External forces in N besides gravity, kept until replaced. Empty: none.
  Result<void> write_forces(std::span<const Vec3> in);
  /// m/s^2, from the next step on.
  Result<void> set_gravity(Vec3 gravity);
  /// Sends a fixed particle elsewhere, where position() finds it from now on. It travels there in a
  /// straight line during the next step, and the cloth takes on its speed. But a move that takes
  /// more than 200 m/s^2, from the one in the last step to this one, is a jump: the particle is put
  /// down as the step begins, and the cloth follows without a change of velocity. The last move
  /// before a step counts, and write_positions ends all of them. (To teleport a whole cloth write
  /// all its positions: what moves as a whole need not be solved.)
  Result<void> move_fixed(std::uint32_t particle, Vec3 position);

  Strain strain() const;           ///< recomputed from the positions
  double max_penetration() const;  ///< m, over all sphere pairs; 0 without spheres
  Energy energy() const;           ///< of the particles that are not fixed
  /// FNV-1a over the bits of all positions and velocities, in the description's order.
  std::uint64_t state_hash() const;
  std::size_t bytes() const;  ///< held by this cloth, the shared model not included

 private:
  struct Impl;
  explicit Cloth(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
