/// Many cloths at once. Part of weft.h.
///
///   std::vector<weft::ClothStep> steps;
///   for (weft::Cloth& cloth : cloths) steps.push_back({.cloth = &cloth, .dt = 1. / 60});
///   weft::step_all(steps);  // in each frame
///   for (const weft::ClothStep& step : steps) {
///     if (!step.result) std::puts(step.result.error().c_str());
///   }
///
/// Large cloths come first; threads that find no cloth left help with large ones. So a batch keeps
/// its threads busy whether it is of a thousand small cloths or of one large one.
#pragma once

#include <weft/cloth.h>
#include <weft/jobs.h>
#include <weft/result.h>

#include <span>

namespace weft {

/// A cloth of a batch: what it is to do, and what came of it.
struct ClothStep {
  Cloth* cloth = nullptr;  ///< the caller's; once in a batch
  double dt = 0;           ///< s, as of Cloth::step
  /// As of Cloth::step. An error, too, where the cloth is null, moved from, or in the batch already
  /// (the first one counts), and where memory ran out (the cloth is unchanged then).
  Result<StepReport> result = Error{"not stepped"};
};

/// Steps each of these cloths, of one or several models, as Cloth::step would, and bit for bit to
/// the same state. Results are in `steps`; a cloth that fails does not keep others from their step.
/// Settings::threads is how many threads may work on one cloth; how many work on the batch is up to
/// `jobs`. Allocates nothing once warm.
WEFT_API void step_all(std::span<ClothStep> steps, const JobSystem& jobs = {}) noexcept;

}  // namespace weft
