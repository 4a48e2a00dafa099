/// Tuned numbers of small steps, each with its unit and what it trades; perf/tried.md has the
/// experiments.
#pragma once

#include <cstdint>

namespace weft::tuning {

/// Of a correction. At 1 a woven sheet of 41 x 41 gains 0.9 J in a second in 400 substeps a frame;
/// at 0.8 none, in 1600. Less is softer.
inline constexpr double kOmega = 0.8;
/// Of the tolerance, from which on local passes look at a constraint: what later corrections of its
/// neighbours may add.
inline constexpr double kLocalShare = 0.99;
/// Of the diagonal of a yarn's matrix, which is singular where the yarn is straight between pins.
inline constexpr double kCompliance = 3e-3;
/// s, the longest substep: what a sheet that hangs by yarns alone is off the true motion by.
inline constexpr double kLongestSubstep = 0.005;
/// Of the time in which what falls from its pins passes the length of a constraint: where a fold
/// runs through a yarn, its constraints turn over in that time.
inline constexpr double kPassing = 0.7;
/// A substep over the last one, beyond which nothing is made of the past: a longer one would carry
/// on what is noise beside it.
inline constexpr double kMostRatio = 4;
/// Substeps of a frame, at most.
inline constexpr int kMostSubsteps = 1024;
/// Constraints in a yarn, on average, from which on yarns are blocks. Random triangles have 3 or 4,
/// a woven sheet of n x n particles n - 1.
inline constexpr double kLeastLinks = 8;
/// Substeps between two renewals of the base: u is rounded to a 2^-24 part of the way in between.
inline constexpr int kRenewal = 16;
/// Of all constraints: where more are out of tolerance, another sweep is cheaper than local passes.
inline constexpr double kManyOut = 0.02;
/// s, in which what the motion has lost is forgotten: until then it may come back from constraints,
/// which are springs.
inline constexpr double kSpringTime = 0.1;
/// Visits of local passes in a substep, of the constraints.
inline constexpr std::int64_t kMostVisits = 1;
/// Rounds that follow the last substep of a frame, where it is out of tolerance: a sweep each, and
/// local passes of so many visits, of the constraints.
inline constexpr int kMostRounds = 32;
inline constexpr std::int64_t kMostRoundVisits = 32;
/// What a round must bring the error down to at least, and how many may not before the rest counts
/// as contradictions.
inline constexpr double kFall = 0.98;
inline constexpr int kPatience = 8;

}  // namespace weft::tuning
