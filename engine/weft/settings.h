/// Settings of a cloth: how it is solved, and to which error. Part of weft.h.
///
///   auto cloth = weft::Cloth::create(model, {.tolerance = 0.001});  // 0.1 %; the rest by default
///
/// The defaults are right for most cloth. Everyday settings (Settings says more of each):
///
///   tolerance         the largest error that a step may leave
///   motion_tolerance  the allowed error of motion
///   substeps          a fixed number, to bound the time of a step
///   max_iterations    an upper bound on the work of a step
///   threads           how many threads a step may use
///   sleep             steps of a cloth at rest cost next to nothing
///
/// Advanced settings, and when to use them:
///
///   solver               if the automatic choice is not the best one for your scene (Solver)
///   scheme               for a scheme of a given order, or `rattle`, which keeps the energy
///   velocity_correction  with gauss_seidel, direct or yarn, for steps of 1 ms and less
///   contact_tolerance    if 0.1 mm is too much or too little for your scene
///   velocity_tolerance   with velocity_correction or `rattle`
///   backend              `reference`, to check a result in double precision; slow
///   isa                  to compare instruction sets, or to use fewer than the machine has
///   iterations           for the same number of iterations in each step, whatever the error
///   measuring            to measure the method of the paper; not needed otherwise (measuring.h)
///
/// Cloth::create checks the settings. An error names the field and the value.
#pragma once

#include <weft/measuring.h>
#include <weft/result.h>

#include <cstdint>
#include <string_view>

namespace weft {

/// automatic: chosen for the cloth, by the first line that is true:
///   small_steps   triangles of fabric, bending, anchors, seams or bodies; scheme implicit or bdf2;
///                 a motion_tolerance; springs, if the scheme is automatic
///   gauss_seidel  the reference backend, or `iterations`
///   small_steps   with an automatic scheme, without heavy free spheres and velocity_correction:
///                 chains and trees that hang from one particle, if they are ropes, have unequal
///                 masses or few links; at 0.1 % and looser also those of bars, and cloth, woven or
///                 a mesh, with nearly equal masses
///   direct        other chains, trees and bridges of ropes
///   yarn          all else
///   The thresholds are not part of the interface.
/// small_steps: many short substeps of one relaxed sweep each, over yarns where the cloth has them
///   and over single constraints elsewhere. Then come passes over the constraints that are still
///   out of tolerance. A sweep leaves a strain that falls with the square of the substep. The
///   length of a substep follows in closed form from the load that hangs on the pins and from the
///   tolerance (engine/solvers/small_steps/small_steps_load.h). Use it for any mesh at 0.1 % and
///   looser, and for accurate motion. Chains and trees of rigid links and ropes that hang from one
///   particle are solved as one system, at any tolerance and for masses that differ by a hundred
///   thousand. In other cloth masses should not differ by more than a hundred. Keep the length of
///   substeps constant: a change by half costs some energy. Only small_steps solves triangles of
///   fabric, bending, anchors, seams and bodies. A frame of fabric that misses by far is repeated.
/// yarn: splits the cloth into yarns, chains of constraints that run straight on through it, as
///   the yarns of a woven cloth do. Each yarn is solved exactly, many side by side in SIMD lanes.
///   If sweeps over the yarns converge slowly, conjugate gradients solve all of them as one system.
///   Ropes, hubs and contacts are relaxed one by one after each sweep, and take part in that
///   system. A taut yarn between two fixed particles sags by its strain, unless triangles brace it.
///   With scheme paper and without springs it keeps most of the strain that yarns may leave (0.3 %,
///   or the tolerance if that is less), in addition to the strain that the distance of its ends
///   demands. simd backend only.
/// direct: computes all impulses at once by sparse factorisation, and repeats this until the true
///   errors are within tolerance: two or three times, at any tolerance. Use it for mass ratios of a
///   million. At most 16 bodies may take part: free spheres that touch something or are joined to
///   something, and particles of more than 64 constraints. With more than that its substeps fall
///   back as below.
/// gauss_seidel: the impulse loop of the paper (section 3.2), one constraint after the other.
///
/// If yarn or direct fails, these are tried in this order:
///   1. the same solver in shorter parts: the part that was rejected is halved, down to a sixteenth
///      of the substep (StepReport::halvings counts rejected attempts);
///   2. direct, after yarn, if masses are unequal: it does the rest of the substep;
///   3. small_steps;
///   4. gauss_seidel, whose result is committed with its error.
/// For some steps after that, substeps begin in about as many parts.
///
/// Gravity, forces and moved pins explain a change of energy. If a substep gains more, its
/// velocities are scaled down: to rest at most, or to the rigid motion nearest to that of the pins
/// (engine/step/energy.h). So a step depends slightly on the steps before it, until positions are
/// written. gauss_seidel is guarded in this way only where it is cut off.
enum class Solver : std::uint8_t { gauss_seidel, direct, yarn, small_steps, automatic };
/// automatic: bdf2 with small_steps, else paper. Cloth::settings() says which.
/// bdf2, implicit: schemes of small_steps alone. bdf2 is BDF2 with variable steps, of second order;
///   implicit is the implicit Euler method, of first order. A particle that a contact has moved
///   goes on from there at first order. If you write velocities, the stored previous velocities
///   change by the same amount. If you write positions, the history is dropped.
/// paper: impulses along the directions at the predicted positions. First order, and dissipative.
/// rattle: impulses along the directions at the start of the substep, always with velocity
///   correction. Second order, also for ropes that become taut within the substep. Contacts that
///   arise within the substep act, in both schemes, along their directions at its end. If rattle
///   does not converge, or if its impulses would add energy (engine/step/energy.h), the substep is
///   redone from the same state by scheme paper with velocity correction;
///   StepReport::scheme_fallbacks counts these. With Settings::iterations nothing is redone. rattle
///   refuses springs.
enum class Scheme : std::uint8_t { paper, rattle, implicit, bdf2, automatic };
/// reference: scalar code in double precision, against which everything else is tested.
/// simd: single precision in lanes inside the loop, refined from positions in double. It reaches
///   the same tolerance.
enum class Backend : std::uint8_t { reference, simd };
/// The instruction set of the simd backend. automatic: the one that WEFT_ISA in the environment
/// names, else the best of the machine: sse2, avx2 or avx512 on x86-64, neon on aarch64. avx2,
/// avx512 and neon give the same bits.
enum class Isa : std::uint8_t { automatic, sse2, avx2, avx512, neon };

inline constexpr int kMaxThreads = 64;
inline constexpr int kAutomaticSubsteps = 0;

/// How a cloth is solved. The defaults are the fastest known way to 1 %. Each comment says whether
/// a field is for everyday use.
struct Settings {
  /// Everyday. The largest strain, | |a-b| - rest | / rest, that a step may leave; for a spring,
  /// the largest error of its law; and the fraction of the bending forces that may stay unbalanced
  /// (StepReport::max_bending_error). > 0. The simd backend works in floats. So Cloth::create
  /// refuses rest lengths, tolerance * rest length, and those of the tolerances below that are
  /// used, outside 1e-18 to 1e18.
  double tolerance = 0.01;
  /// Everyday. Number of substeps of a step; 0 (kAutomaticSubsteps): chosen. Fine meshes need small
  /// substeps.
  ///
  /// A given number, with small_steps: the errors are checked after the last substep. There is one
  /// sweep per substep. The corrections after that take at most the time of 6 further sweeps per
  /// substep, or of automatic substeps if that is longer; max_iterations lowers this bound. A
  /// quarter of the time of contacts with meshes during these corrections counts towards the bound.
  /// The search for contacts and their verification do not count. Only StepReport::law_error tells
  /// whether a given number is enough for the load of fabric at rest. With other solvers each
  /// substep is solved to the tolerances.
  ///
  /// A chosen number: with small_steps it follows in closed form, up to 1024. With other solvers it
  /// follows from the motion (rattle takes up to 2.5 times as many as paper) and, with yarn, from
  /// the load of heavy particles and, with scheme paper, of spheres; then at most max_iterations
  /// / 8. On the reference backend, and with `iterations`: 1.
  int substeps = kAutomaticSubsteps;
  /// Advanced. 0: iterate to the tolerance. K > 0: exactly K iterations per substep, whatever the
  /// error; nothing is skipped. gauss_seidel then renews frozen directions once per substep, other
  /// solvers in every iteration.
  int iterations = 0;
  /// Everyday. > 0, an upper bound on the work of a step: substeps, attempts and schemes together.
  /// Games should set it to a few times the usual work: the next frame does the work that is left.
  /// (For the same time in each frame: `iterations` and `substeps`, solver yarn.)
  ///
  /// With small_steps and given substeps: passes in addition to one sweep per substep, in any
  /// state, projections of a start included; 0 is allowed. A pass is a sweep, or as many visits of
  /// local passes as take about as long.
  ///
  /// With other solvers: each substep may do half of what is left, and the last one all. Half of
  /// that is kept for the last attempt (Solver), which does at least one iteration. The velocity
  /// loop may do as many of its own. If a substep that is cut off would gain energy, its velocities
  /// are scaled down.
  int max_iterations = 1'000'000;
  /// Advanced. m, > 0: the allowed penetration, and excess over the limits of an anchor.
  double contact_tolerance = 1e-4;
  double velocity_tolerance = 0.01;  ///< Advanced. m/s along a constraint, > 0
  /// Everyday. m/s, the allowed error of motion of a particle; 0: off. weft uses more substeps (up
  /// to 1024) until the error is small enough, as far as rounding allows: of fabric in the same
  /// step, of other cloth in the next ones. A step whose StepReport::motion_error exceeds it has
  /// not converged. The estimate leaves out contacts, chaos, and what `tolerance` allows a fabric.
  /// Only small_steps has it, and automatic then chooses small_steps at any tolerance. It is
  /// refused with `substeps`, `iterations` or velocity_correction.
  double motion_tolerance = 0;
  Solver solver = Solver::automatic;  ///< Advanced.
  Scheme scheme = Scheme::automatic;  ///< Advanced.
  Backend backend = Backend::simd;    ///< Advanced.
  Isa isa = Isa::automatic;           ///< Advanced.
  /// Everyday. The largest number of threads of the caller's arena or job system (jobs.h) per step.
  /// 0: all that it offers, up to kMaxThreads. Yarns use at most 16 threads, small cloths one. The
  /// number does not affect the result.
  int threads = 0;
  /// Everyday. A cloth that rests falls asleep: its velocities are set to zero, and its steps do
  /// nothing but say so (StepReport::asleep). It rests if for half a second no particle has moved
  /// farther than a thousandth of the mean length of its constraints. Positions, velocities,
  /// forces, gravity, wind, pins, anchors, rigid motions or properties that differ from those it
  /// has wake it; the same values again do not. A cloth that tips over more slowly than this falls
  /// asleep too. In steps of more than 1/8 s nothing falls asleep.
  bool sleep = false;
  /// Advanced. Sections 3.2, 3.3: a second loop, on velocities; rattle always has it. Without it
  /// gauss_seidel gains energy in steps of a millisecond and less: an error that is left within a
  /// loose tolerance comes back as speed, error / dt (tests/README.md). It refuses springs.
  bool velocity_correction = false;
  Measuring measuring{};  ///< For measurements alone (measuring.h).
};

WEFT_API std::string_view name(Solver);
WEFT_API std::string_view name(Scheme);
WEFT_API std::string_view name(Backend);
WEFT_API std::string_view name(Isa);

}  // namespace weft
