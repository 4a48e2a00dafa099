/// Tuned numbers of a step. Each has its unit and what it trades; the experiment that set it is in
/// perf/tried.md, and perf/ablation halves, doubles and disables each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace weft::tuning {

/// Relaxation factor of a correction. At 1 a woven sheet of 41 x 41 gains 0.9 J in a second in 400
/// substeps a frame; at 0.8 it gains none in 1600. A smaller factor makes softer constraints.
inline constexpr double kOmega = 0.8;
/// Local passes look at a constraint whose strain exceeds this share of the tolerance. The rest is
/// room for what corrections of its neighbours add.
inline constexpr double kLocalShare = 0.99;
/// Compliance of a yarn's constraints, relative to the diagonal of its matrix, which is singular
/// where the yarn is straight between two pins. A larger one is softer, and farther from the true
/// motion.
inline constexpr double kCompliance = 3e-3;
/// s. No substep is longer. It bounds the error of motion where nothing hangs on a pin.
inline constexpr double kLongestSubstep = 0.005;
/// A substep is no longer than this part of the time in which a falling particle passes the length
/// of a constraint. In about that time a fold that runs through a yarn turns a constraint over.
inline constexpr double kPassing = 0.7;
/// A substep that is more than this many times as long as the last one starts without a past: it
/// would extrapolate a change of velocity that is noise on its scale.
inline constexpr double kMostRatio = 4;
/// The largest number of substeps of a frame.
inline constexpr int kMostSubsteps = 1024;
/// Yarns are blocks if they have this many constraints on average. Random triangles make yarns of 3
/// or 4, a woven sheet of n x n particles makes yarns of n - 1.
inline constexpr double kLeastLinks = 8;
/// Substeps between two renewals of the base. Displacements are rounded to a 2^-24 part of what a
/// particle moves in between.
inline constexpr int kRenewal = 16;
/// The bound on n h (n h + tau) W / compliance where bending elements are visited in every n-th
/// substep (engine/solvers/small_steps/bending_pace.h), and the largest n. Fewer visits are
/// cheaper; more are closer to the true stiffness.
inline constexpr double kBendingPace = 0.05;
inline constexpr int kLongestGroup = 8;
/// The largest n h tau W / compliance that an element is damped with: beyond that its neighbours
/// and it would take from their motion more than there is.
inline constexpr double kMostBendingDamping = 0.2;
/// If more than this share of all constraints is out of tolerance a substep sweeps once more, which
/// is cheaper than local passes.
inline constexpr double kManyOut = 0.02;
/// s. Energy that the motion loses may come back for about this time, since constraints are
/// springs.
inline constexpr double kSpringTime = 0.1;
/// The largest number of visits of local passes in a substep, in units of all constraints.
inline constexpr int kMostVisits = 1;
/// A frame that is out of tolerance after its last substep goes on for at most so many rounds. Each
/// is a sweep, and local passes of at most so many visits, in units of all constraints.
inline constexpr int kMostRounds = 64;
inline constexpr std::int64_t kMostRoundVisits = 32;
/// A round makes progress if it brings the error below this share of the least one so far. After
/// more than kPatience rounds without progress the constraints count as contradictory.
inline constexpr double kFall = 0.999;
inline constexpr int kPatience = 16;

// ----------------------------------------------------------------------- the choice of a solver

/// The largest share of constraints that close a loop in chains, trees and bridges. Of a bridge a
/// third do, of a grid half.
inline constexpr double kChainLoops = 0.4;
/// Ropes to a distance constraint, beyond which a chain is one of ropes.
inline constexpr double kRopesEach = 1. / 3;
/// The tightest tolerance, and the largest ratio of masses, at which small steps are chosen.
inline constexpr double kLeastTolerance = 1e-3;
inline constexpr double kNearlyEqualMasses = 100;
/// The ratio of masses from which on the direct solver is chosen, and the one from which on it
/// stands by behind yarns.
inline constexpr double kExtremeMasses = 1e6;
inline constexpr double kUnequalMasses = 1e4;

// -------------------------------------------------------------------------------- the control

/// Slots of a particle that make another thread worth its meetings: two threads gain nothing at
/// 1,600 particles, and 1.7 times at 10,000.
inline constexpr std::size_t kLeastSlotsPerThread = 1000;
/// A substep that is rejected is tried in up to 2^kMostDoublings parts.
inline constexpr int kMostDoublings = 4;
/// The part of a doubling by which each step without a rejected attempt comes back to fewer, longer
/// substeps.
inline constexpr double kCoarsening = 0.125;
/// Strain that one substep of a motion without constraints may reach, and that strain times the
/// particles of its yarn. Less means more substeps; more means substeps that solvers give up.
struct Bend {
  double most;
  double longest;
};
inline constexpr Bend kYarnBend{0.06, 3};
inline constexpr Bend kUsualBend{0.04, std::numeric_limits<double>::infinity()};
/// Scheme rattle must resolve the motion: with half as many substeps half of them fall back.
inline constexpr Bend kRattleBend{0.01, 1.5};
/// 1/rad, by which an angular frequency times the substep is less than 1, and the ratio of masses
/// from which on a load decides about substeps.
inline constexpr double kLoad = 0.7;
inline constexpr double kLeastLoad = 1000;
/// The largest automatic number of substeps of a step by a prediction and a solver.
inline constexpr int kMostExactSubsteps = 256;
/// Iterations of a step for each automatic substep by yarns, at least.
inline constexpr int kLeastIterations = 8;
/// A step is far shorter than the last one below this share of its length, and then the strain that
/// is left before it is at least this share of the usual.
inline constexpr double kFarShorter = 0.125;
inline constexpr double kLeastShare = 0.01;
/// Passes of the paper's loop between two looks at the true errors: more than steps that go well
/// ever need.
inline constexpr int kPassesBetweenLooks = 4096;

// --------------------------------------------------------------------------------- the energy

/// Gain of energy, as a share of what the impulses are worth, up to which a substep is left alone.
inline constexpr double kMostGain = 0.5;
/// Gain of energy, as a share of what the impulses of its velocity loop are worth, from which on a
/// substep by scheme rattle is rejected; and as a share of the kinetic energy, since positions are
/// rounded.
inline constexpr double kRattleGain = 0.1;
inline constexpr double kEnergyRounding = 1e-9;

}  // namespace weft::tuning
