/// Many cloths at once. Part of weft.h.
///
///   std::vector<weft::ClothStep> steps;
///   for (weft::Cloth& cloth : cloths) steps.push_back({.cloth = &cloth, .dt = 1. / 60});
///   weft::step_all(steps);  // in each frame
///   for (const weft::ClothStep& step : steps) {
///     if (!step.result) std::puts(step.result.error().c_str());
///   }
///
/// Large cloths come first. A thread that finds no cloth left helps with a large one. So a batch
/// keeps its threads busy, whether it has a thousand small cloths or one large one.
#pragma once

#include <weft/cloth.h>
#include <weft/jobs.h>
#include <weft/result.h>

#include <span>

namespace weft {

/// A cloth of a batch, the time that it is to advance, and the result of its step.
struct ClothStep {
  Cloth* cloth = nullptr;  ///< owned by the caller; at most once in a batch
  double dt = 0;           ///< s, as for Cloth::step
  /// The result of Cloth::step. It is also an error if the cloth is null or moved from, if it is in
  /// the batch already (its first entry is stepped), or if memory ran out (the cloth is unchanged
  /// then).
  Result<StepReport> result = Error{"not stepped"};
};

/// Steps each of these cloths, of one or several models, as Cloth::step would, and bit for bit to
/// the same state. Results are in `steps`. If a cloth fails, the others are stepped all the same.
/// Settings::threads limits the threads that work on one cloth; `jobs` says how many work on the
/// batch. Allocates nothing once warm.
WEFT_API void step_all(std::span<ClothStep> steps, const JobSystem& jobs = {}) noexcept;

}  // namespace weft
