/// The report of a step: its status, its work, its errors, and the elements that broke. Part of
/// weft.h.
///
///   const weft::StepReport report = cloth.step(1.0 / 60).value();
///   if (report.status != weft::Status::converged) std::puts(name(report.status).data());
///   std::printf("%d substeps, strain %g\n", report.substeps, report.max_strain);
///
/// Units are m, kg, s and N. A report is a value: it stays as it is while the cloth steps on.
#pragma once

#include <weft/result.h>
#include <weft/scene.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace weft {

/// converged: every constraint is within its tolerance, and so is bending; nothing crosses a
///   body or is inside one; no seam is late (StepReport::late_seams); the error of motion is within
///   Settings::motion_tolerance, if there is one. The state is committed.
///   Cloth at rest may be off its laws of tension all the same (StepReport::law_error).
/// fixed_iterations: Settings::iterations were done; the report has the error. The state is
///   committed.
/// iteration_limit: a constraint is still out of tolerance after max_iterations (with small_steps:
///   after all rounds, or all work that a given number of substeps allows), or bending is out of
///   tolerance (StepReport::max_bending_error), or something crosses a body or is inside one, or a
///   seam is late, or motion_error exceeds Settings::motion_tolerance. The state is committed.
/// infeasible: a constraint is out of tolerance, and tens of thousands of iterations (small_steps:
///   sixteen rounds of a sweep and local passes) hardly reduce the error. There are four causes:
///   constraints contradict each other (a chain whose ends are too far apart); two held particles
///   exclude what joins them (StepReport::held_apart); masses differ widely; or no way leads from
///   the start to a solution (a sheet of triangles whose pins turned by a right angle in one step).
///   The state is committed, with the error spread over the constraints.
/// passed_through: a particle went through a sphere within a substep (tunnelling). Either no
///   contact was found in time, or a contact pushed the particle out on the far side. The state is
///   committed; shorter steps would have held the particle.
/// non_finite_input: even without constraints, the positions, velocities, forces and dt lead to
///   numbers that are not finite. The state is unchanged.
/// non_finite: a position or velocity would have become NaN or infinite. (Yarns hold positions as
///   floats: none may be beyond 3e38 m.) The state is unchanged.
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
  predict,  ///< chooses the number of automatic substeps, too; small_steps: the start of a step
  find_contacts,    ///< with spheres, and with bodies (ContactMs::find)
  solve_positions,  ///< small_steps: all substeps
  commit,           ///< and work that belongs to no other stage
  correct_velocities,
  report
};
inline constexpr std::size_t kStageCount = 6;

WEFT_API std::string_view name(Status);
WEFT_API std::string_view name(Stage);

/// Times of contacts with bodies, in ms of the thread that called the step. Contacts within local
/// passes count as part of these passes, and are in none of the three figures.
struct ContactMs {
  double find = 0;    ///< the search for particles, faces and edges that may touch
  double sweep = 0;   ///< pushing contacts apart, after each sweep over the constraints
  double verify = 0;  ///< checks that nothing went through; stops what did; depth of contacts
  bool operator==(const ContactMs&) const = default;
};

/// The work of one step and the errors at its end. Counts and seconds are summed over the substeps;
/// the status is the worst of all.
struct StepReport {
  Status status = Status::converged;
  /// The cloth slept (Settings::sleep): no work was done, and the errors are those of its last
  /// step.
  bool asleep = false;
  int substeps = 0;  ///< done; 0 if nothing is committed, or asleep
  int halvings = 0;  ///< attempts at a substep that were rejected (Solver)
  /// Passes over the position constraints. yarn: sweeps and conjugate gradient iterations. direct:
  /// solves. small_steps: `substeps` sweeps, further sweeps, and local passes, counted by their
  /// visits.
  std::int64_t iterations = 0;
  std::int64_t direction_updates = 0;    ///< renewals of the constraint directions
  std::int64_t velocity_iterations = 0;  ///< passes of the velocity loop; direct: solves
  std::int64_t visits = 0;               ///< constraints whose error was looked at, both loops
  std::int64_t corrections = 0;          ///< impulses applied, both loops
  int scheme_fallbacks = 0;  ///< attempts that scheme rattle left to scheme paper (Scheme)
  int contacts = 0;          ///< candidate pairs of spheres and particles
  /// The largest strain of all constraints and triangles of fabric, recomputed from the positions
  /// (Strain).
  double max_strain = 0;
  double rms_strain = 0;
  double max_shear = 0;  ///< rad, the largest of all triangles of fabric
  /// The largest error of a law, which `tolerance` bounds. For a rigid constraint it is the strain.
  /// For a spring it is | |a-b| - rest_length - compliance f | / rest_length, with the tension f
  /// that the solver applied in the last substep. For a triangle of fabric it is the difference of
  /// the two sides of a law (MembraneElement), in strain and in radians of shear.
  double max_error = 0;
  /// The share of the forces of bending that a solution left unbalanced, the largest of all
  /// substeps (small_steps). It is a ratio of root mean squares over the particles; the weight
  /// counts in place of the bending forces where it is larger. With 0.01 a cloth bends as if its
  /// load were a hundredth more or less. `tolerance` bounds it. Bending is solved before
  /// constraints and contacts; how these move particles within a substep is not in it, and the next
  /// substep bends from there.
  double max_bending_error = 0;
  std::uint32_t worst_constraint = kNoIndex;  ///< of the largest strain, in the description
  std::uint32_t worst_element = kNoIndex;     ///< triangle of the largest strain or shear
  double max_penetration = 0;                 ///< m, into spheres and bodies, beyond the thickness
  int body_contacts = 0;                      ///< pairs of a particle and a body that touch
  /// Pairs of features that would have gone through each other within the step and were stopped by
  /// its verification: of the cloth and a triangle mesh, and of the cloth and itself (SelfContact).
  int contact_failures = 0;
  /// How many of these pairs had to be moved as one, as if glued: with the body, or layers with
  /// each other.
  int zones = 0;
  /// Triangles and threads of the cloth that cross a triangle mesh when the step ends, and
  /// particles inside one. It is 0 unless the step began so, a body was teleported there, or bodies
  /// close on the cloth from both sides. The edges and faces of these triangles do not collide
  /// until they are out; their particles do.
  int intersecting = 0;
  int self_contacts = 0;  ///< pairs of features of the cloth that touch each other (SelfContact)
  /// Pairs of triangles of the cloth that cross each other when the step ends, and of a triangle
  /// and a thread that crosses it. It is 0 with SelfContact, unless the step began so, or more came
  /// together than could be kept apart. They do not collide with each other until they are apart. A
  /// step that began without any and ends with some has not converged.
  int tangled = 0;
  double max_anchor_error = 0;  ///< m, by which an anchor's limits, or a tether's, are exceeded
  /// Seams whose particles have not come together yet (Seam), without released ones.
  int open_seams = 0;
  double max_seam_gap = 0;  ///< m, between particles of closed seams: bounded by contact_tolerance
  double seam_work = 0;     ///< J, work of open seams in this step
  /// m/s, an estimate of the largest error of motion that this step adds to a particle. Without a
  /// motion_tolerance it is that of the last substep alone. 0 with other solvers than
  /// small_steps.
  double motion_error = 0;
  /// J, dissipated by the scheme, damped springs and contacts: the fall of kinetic, potential and
  /// elastic energy beyond the work of moved pins, seams, forces, air, Damping::motion and
  /// untangling. 0 with gauss_seidel.
  double energy_lost = 0;
  /// J, work of moved pins in this step. It is exact if they move as one rigid body, else it is the
  /// work of the rigid motion nearest to theirs. Jumps do no work. Impulses of fixed spheres count
  /// as those of pins; moved spheres are left out.
  double pin_work = 0;
  double body_work = 0;      ///< J, work of moving bodies on the cloth; those with a mass lose it
  double friction_work = 0;  ///< J, lost to friction with bodies; out of tolerance <= energy_lost
  std::uint32_t failed_particle = kNoIndex;  ///< with non_finite, non_finite_input: one of them
  std::uint32_t passed_particle = kNoIndex;  ///< with passed_through: one of them
  /// Their sum is the time of the step, to a few microseconds.
  std::array<double, kStageCount> stage_seconds{};
  ContactMs contact_ms{};  ///< part of stage_seconds
  /// Seams that are open although their time is over: they pull with too small a force, or
  /// something holds their ends apart. A step that ends with one has not converged.
  int late_seams = 0;
  /// The number in the description of the seam with the widest gap: among late seams or, if there
  /// are none, among those in `held_apart`.
  std::uint32_t worst_seam = kNoIndex;
  /// Seams that are open, and rigid constraints out of tolerance, between two held particles: both
  /// are fixed, or anchored without a limit to move within. Only the caller can mend that: by
  /// moving a pin, or by releasing it. A step that ends with such a constraint, or with such a seam
  /// that is late, is `infeasible`.
  int held_apart = 0;
  std::uint32_t worst_held = kNoIndex;  ///< of these, the constraint with the largest strain
  double untangling_work = 0;           ///< J, work of SelfContact::untangle
  /// m, of sliders from their rails: bounded by contact_tolerance (Slider).
  double max_rail_gap = 0;
  int torn = 0;  ///< elements that broke when this step ended (Cloth::torn)
  /// The largest error of a law, as in `max_error`, with the tension that carried the load in the
  /// last substep; small_steps, with springs or triangles of fabric. Corrections at the end of a
  /// step bring tensions to their laws, and `max_error` is the error after that; but they do not
  /// move cloth at rest. So this error tells whether substeps that you give are short enough for
  /// the load of cloth at rest: the whole sheet is off by a quarter of it at most, a chain of
  /// elastic ropes by half. The status does not depend on it: in single steps of correct motion it
  /// may exceed ten tolerances.
  double law_error = 0;
};

/// An element that broke when a step ended (Tear).
struct Torn {
  Tear kind = Tear::constraint;
  std::uint32_t index = 0;  ///< of the constraint, the seam, the anchor, or the particle of a sheet
  std::uint32_t particle = kNoIndex;  ///< of a sheet: the new one
  double load = 0;                    ///< N, of triangles of fabric N/m: the mean over the step

  bool operator==(const Torn&) const = default;
};

}  // namespace weft
