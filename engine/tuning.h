/// Tuned numbers of small steps. Each has its unit, what it trades, and the experiment that set it
/// in perf/tried.md.
#pragma once

#include <cstdint>

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
/// If more than this share of all constraints is out of tolerance a substep sweeps once more, which
/// is cheaper than local passes.
inline constexpr double kManyOut = 0.02;
/// s. Energy that the motion loses may come back for about this time, since constraints are
/// springs.
inline constexpr double kSpringTime = 0.1;
/// The largest number of visits of local passes in a substep, in units of all constraints.
inline constexpr std::int64_t kMostVisits = 1;
/// A frame that is out of tolerance after its last substep goes on for at most so many rounds. Each
/// is a sweep, and local passes of at most so many visits, in units of all constraints.
inline constexpr int kMostRounds = 64;
inline constexpr std::int64_t kMostRoundVisits = 32;
/// A round makes progress if it brings the error below this share of the least one so far. After
/// more than kPatience rounds without progress the constraints count as contradictory.
inline constexpr double kFall = 0.98;
inline constexpr int kPatience = 16;

}  // namespace weft::tuning
