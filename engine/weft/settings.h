/// How it is solved, and to which error. Part of weft.h.
#pragma once

#include <weft/result.h>

#include <cstdint>
#include <string_view>

namespace weft {

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
///   in addition to the strain that the distance of its ends demands; not with springs. simd only.
/// small_steps: one relaxed sweep in each of many short substeps, over yarns where the cloth has
///   them and over single constraints elsewhere, and then passes over what is out of tolerance
///   alone. A sweep leaves a strain that falls with the square of the substep; how long that may be
///   follows in closed form from what hangs on the pins, and from the tolerance
///   (engine/solvers/small_steps/small_steps_load.h). For any mesh, at tolerances of 0.1 % and
///   looser, and for a motion that is near the true one. Masses should not differ by more than a
///   hundred. Substeps of one length are best kept to: a change of it by half costs some energy.
///   It alone solves bending.
/// automatic: by what the cloth is. small_steps for cloth, woven or a mesh, and for all springs but
///   with scheme paper. direct for chains of ropes, trees and bridges of them. yarn for all else:
///   cloth at a tolerance that small steps could not afford, with unequal masses or free spheres,
///   with scheme paper or rattle, or with velocity_correction. gauss_seidel on the reference
///   backend and with `iterations`. The thresholds are no part of the interface.
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
///   counts these. With Settings::iterations nothing is redone. Takes no springs.
/// implicit, bdf2: of small_steps alone. The implicit Euler method, first order, and the second
///   order BDF2 with variable steps; particles that a contact has moved go on from there at first
///   order. Whoever writes velocities changes the step before alike; written
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
/// that the machine has: sse2, avx2 or avx512 of x86-64, neon of aarch64. avx2, avx512 and neon
/// give the same bits.
enum class Isa : std::uint8_t { automatic, sse2, avx2, avx512, neon };

inline constexpr int kMaxThreads = 64;
inline constexpr int kAutomaticSubsteps = 0;

/// How a cloth is solved. The defaults converge to 1 % the fastest way that is known here;
/// paper_settings() are the paper's.
struct Settings {
  /// Strain, | |a-b| - rest | / rest, that every step must reach, of springs what is left of their
  /// law; > 0. The simd backend works in floats: it takes rest lengths, tolerance * rest length,
  /// and the tolerances below that are used, from 1e-18 to 1e18, and Cloth::create refuses others.
  double tolerance = 0.01;
  /// Each step is done as this many substeps, each solved to the tolerances; with small_steps only
  /// the last is looked at, and the number bounds the time of a step: n substeps are n sweeps, and
  /// what is done beyond takes as long as 6 n more, or as automatic substeps would if these are
  /// more. max_iterations lowers that bound. 0 (kAutomaticSubsteps): of
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
  /// next finds. (For the same time in each frame: `iterations` and `substeps`, solver yarn.) With
  /// small_steps and n `substeps` a step is n sweeps, and no more than max_iterations passes
  /// beyond, projections of a start included, whatever the state; it may be 0 then. A pass is a
  /// sweep, or as many visits of local passes as take about as long. With other solvers each
  /// substep may do half of what is left, the last one all; half of that is kept for the last
  /// attempt (see Solver), which does one at least. The velocity loop may do as many of its own.
  /// Where a substep that is cut off would gain energy, its velocities are scaled down.
  int max_iterations = 1'000'000;
  double contact_tolerance = 1e-4;   ///< m of penetration, and beyond an anchor's limits, left; > 0
  double velocity_tolerance = 0.01;  ///< m/s along a constraint; > 0
  /// m/s, by which particles may come away from their true motion; 0: not asked for. Of small_steps
  /// alone, which automatic then chooses at any tolerance, and not with `substeps`, `iterations` or
  /// velocity_correction. Held by the number of substeps, up to 1024, as far as rounding allows;
  /// StepReport::motion_error tells. What contacts do, and chaos, is not in that estimate.
  double motion_tolerance = 0;
  double impulse_limit = 0;  ///< N s, the largest impulse of one correction; 0: no limit;
                             ///< gauss_seidel on the reference backend only
  Solver solver = Solver::automatic;
  Scheme scheme = Scheme::automatic;
  Backend backend = Backend::simd;
  Isa isa = Isa::automatic;
  /// Maximum threads of the caller's arena or job system (jobs.h) per step; 0: all that it offers,
  /// up to kMaxThreads. Yarns use at most 16, small cloths one. Does not affect the result.
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
  /// The reference backend anticipates by products, and refuses this; models with springs do, too.
  bool anticipate_products = false;
  /// A cloth that rests sleeps: where for half a second no particle has come farther than a
  /// thousandth of the mean length of its constraints, velocities are set to zero, and steps do
  /// nothing but say so (StepReport::asleep), until it is given other positions, velocities,
  /// forces, gravity, wind, pins, anchors, rigid motions or properties than it has. The same values
  /// again do not wake it. A balance that is lost more slowly than that is kept. In steps of more
  /// than 1/8 s nothing falls asleep.
  bool sleep = false;
  bool skip = true;  ///< section 4.3: satisfied constraints are passed over
  /// Sections 3.2, 3.3: a second loop, on velocities; rattle has it always. Without it gauss_seidel
  /// gains energy in steps of a millisecond and less: errors left within a loose tolerance come
  /// back as speed, error / dt (tests/README.md). Takes no springs.
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

WEFT_API std::string_view name(Solver);
WEFT_API std::string_view name(Scheme);
WEFT_API std::string_view name(Directions);
WEFT_API std::string_view name(Backend);
WEFT_API std::string_view name(Isa);

}  // namespace weft
