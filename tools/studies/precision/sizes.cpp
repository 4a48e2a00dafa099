#include "tools/studies/precision/sizes.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "tools/program/text/enumerators.h"
#include "tools/program/text/wording.h"
#include "tools/studies/precision/order.h"
#include "tools/studies/precision/sweep.h"

namespace weft::tools::precision {
namespace {

Settings settings_of(const SizeStudy& study, Solver solver, int substeps) {
  Settings settings;
  settings.solver = solver;
  settings.tolerance = study.tolerance;
  settings.substeps = substeps;
  settings.threads = study.threads;
  return settings;
}

double particles(int size) { return static_cast<double>(size) * size; }

}  // namespace

std::optional<double> exponent(const SizeCurve& curve) {
  std::vector<double> counts, times;
  for (const SizePoint& point : curve.points) {
    counts.push_back(particles(point.size));
    times.push_back(point.outcome.ms_per_frame);
  }
  return fitted_exponent(counts, times);
}

namespace {

/// By the curve so far; one that has too few points is taken to be linear.
double predicted_seconds(const SizeStudy& study, const SizeCurve& curve, int size) {
  if (curve.points.empty()) return 0;
  const SizePoint& last = curve.points.back();
  const double growth = particles(size) / particles(last.size);
  return study.frames * last.outcome.ms_per_frame / 1000 *
         std::pow(growth, exponent(curve).value_or(1));
}

/// Where the search for substeps starts.
int first_substeps(Solver solver, const SizeCurve& curve) {
  const bool chooses = solver == Solver::automatic || solver == Solver::small_steps;
  if (chooses) return kAutomaticSubsteps;
  return curve.points.empty() ? 1 : curve.points.back().substeps;
}

/// Fine meshes want small steps: tried are the substeps of the size before, twice and four times
/// as many.
Result<std::optional<SizePoint>> cheapest(const SizeStudy& study, const Task& task, Solver solver,
                                          int first, const SizeWatch& watch) {
  const Effort effort{.repeat = 3, .seconds_limit = study.seconds_limit};
  std::optional<SizePoint> best;
  for (const int factor : {1, 2, 4}) {
    const int substeps = first * factor;
    if (factor > 1 && substeps == kAutomaticSubsteps) break;
    watch(fmt::format("{}, {}", name(solver), substeps_text(substeps)));
    const auto point = measure(task, settings_of(study, solver, substeps), effort);
    if (!point) return Error{point.error()};
    const Outcome& outcome = point.value().outcome;
    if (!outcome.counts()) continue;
    if (best && best->outcome.ms_per_frame <= outcome.ms_per_frame) break;
    best = SizePoint{task.size, substeps, outcome};
  }
  return best;
}

}  // namespace

SizeStudy size_study(bool quick) {
  SizeStudy study;
  study.sizes = {20, 30, 40, 60, 100, 200, 300, 500, 1000};
  if (quick) study.sizes = {20, 30, 40, 60};
  if (quick) study.seconds_limit = 2;
  return study;
}

Result<void> measure(SizeStudy& study, const SizeWatch& watch) {
  for (const Solver solver : enumerators<Solver>()) {
    study.curves.push_back({std::string(name(solver)), {}, {}, {}});
  }
  for (const int size : study.sizes) {
    auto task = make_task(study.scene, size);
    if (!task) return Error{task.error()};
    task.value().frames = study.frames;
    task.value().threads = study.threads;
    for (std::size_t k = 0; k < study.curves.size(); ++k) {
      SizeCurve& curve = study.curves[k];
      if (!curve.end.empty()) continue;
      if (predicted_seconds(study, curve, size) > study.seconds_limit) {
        curve.end =
            fmt::format("{0} x {0} would take more than {1:g} s", size, study.seconds_limit);
        continue;
      }
      const Solver solver = enumerators<Solver>()[k];
      const auto point =
          cheapest(study, task.value(), solver, first_substeps(solver, curve), watch);
      if (!point) return Error{point.error()};
      if (point.value()) {
        curve.points.push_back(*point.value());
      } else {
        curve.end = fmt::format("{0} x {0} did not reach {1} in {2:g} s", size,
                                percent(study.tolerance), study.seconds_limit);
      }
    }
  }
  for (SizeCurve& curve : study.curves) curve.exponent = exponent(curve);
  return {};
}

}  // namespace weft::tools::precision
