#include "tools/studies/precision/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "tools/program/run/runner.h"
#include "tools/program/text/wording.h"
#include "tools/studies/methods.h"
#include "tools/studies/precision/reference_solution.h"

namespace weft::tools::precision {
namespace {

struct KnobSet {
  std::vector<double> tolerances;
  std::vector<int> substeps;  // of the rows of tolerances
  std::vector<int> iterations;
  std::vector<int> many_substeps;  // of the rows of iterations
};

KnobSet knob_set(bool quick) {
  if (quick) return {{0.1, 0.01, 1e-3, 1e-4}, {kAutomaticSubsteps, 1, 4}, {1, 8}, {8, 32}};
  return {{0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5},
          {kAutomaticSubsteps, 1, 2, 4, 8, 16},
          {1, 4, 16, 64},
          {4, 16, 64}};
}

/// One sweep to a substep: what takes the place of iterations is their number.
KnobSet small_steps_knob_set(bool quick) {
  if (quick) return {{0.1, 0.01, 1e-3}, {kAutomaticSubsteps, 4, 16, 64}, {}, {}};
  return {
      {0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4}, {kAutomaticSubsteps, 2, 4, 8, 16, 32, 64, 128}, {}, {}};
}

/// The plain call: nothing but the tolerance is chosen by the user.
KnobSet plain_knob_set(bool quick) {
  if (quick) return {{0.1, 0.01, 1e-3, 1e-4}, {kAutomaticSubsteps}, {}, {}};
  return {{0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5}, {kAutomaticSubsteps}, {}, {}};
}

KnobSet knob_set_of(Solver solver, bool quick) {
  if (solver == Solver::automatic) return plain_knob_set(quick);
  return solver == Solver::small_steps ? small_steps_knob_set(quick) : knob_set(quick);
}

bool is_known(const Task& task, const Settings& settings) {
  return static_cast<bool>(Cloth::create(task.model, settings));
}

std::vector<Row> rows_of(const Task& task, Settings base, const KnobSet& knobs) {
  std::vector<Row> rows;
  for (const int substeps : knobs.substeps) {
    base.substeps = substeps;
    if (!is_known(task, base)) continue;
    Row& row = rows.emplace_back();
    for (const double tolerance : knobs.tolerances) {
      row.push_back(base);
      row.back().tolerance = tolerance;
    }
  }
  if (!is_known(task, base)) return rows;
  for (const int substeps : knobs.many_substeps) {
    Row& row = rows.emplace_back();
    for (const int iterations : knobs.iterations) {
      row.push_back(base);
      row.back().substeps = substeps;
      row.back().iterations = iterations;
    }
  }
  return rows;
}

/// Section 3.2 with the formulation of 4.1, as printed: scalar, every constraint in every
/// iteration.
Curve original(const Task& task, const KnobSet& knobs) {
  Settings settings;
  settings.solver = Solver::gauss_seidel;
  settings.scheme = Scheme::paper;
  settings.backend = Backend::reference;
  settings.measuring.directions = Directions::each;
  settings.measuring.anticipate = false;
  settings.measuring.skip = false;
  settings.threads = task.threads;
  return {"original", rows_of(task, settings, {knobs.tolerances, {1}, {}, {}})};
}

/// On one thread what other programs do on the machine should not be seen.
double seconds_of(const Task& task, const RunSummary& summary) {
  return task.threads == 1 ? summary.cpu_seconds : summary.step_seconds;
}

Outcome outcome_of(const Task& task, const RunSummary& summary) {
  Outcome outcome;
  outcome.frames = summary.frames;
  outcome.ms_per_frame = 1000 * seconds_of(task, summary) / std::max(summary.frames, 1);
  outcome.max_strain = task.has_material() ? summary.total.max_error : summary.max_strain;
  outcome.motion_error = summary.mean_motion_error;
  outcome.mean_max_strain = summary.mean_max_strain;
  outcome.energy_gain = summary.energy_gain;
  outcome.substeps = static_cast<double>(summary.total.substeps) / std::max(summary.frames, 1);
  const bool out_of_time = summary.frames < task.frames && committed(summary.total.status);
  outcome.status = out_of_time ? "out_of_time" : name(summary.total.status);
  return outcome;
}

std::vector<Vec3> positions_of(const Cloth& cloth) {
  std::vector<Vec3> positions(cloth.particle_count());
  static_cast<void>(cloth.read_positions(positions));  // fails for a wrong size alone
  return positions;
}

}  // namespace

std::vector<Curve> weft_curves(const Task& task, bool quick) {
  std::vector<Curve> curves{original(task, knob_set(quick))};
  for (const Method& method : all_methods()) {
    const bool plain = method.solver == Solver::automatic;
    if (plain && method.scheme != Scheme::automatic) continue;
    Settings settings;
    settings.solver = method.solver;
    settings.scheme = method.scheme;
    settings.threads = task.threads;
    const std::string label(name(method.solver));
    curves.push_back({plain ? label : fmt::format("{}, {}", label, name(method.scheme)),
                      rows_of(task, settings, knob_set_of(method.solver, quick))});
  }
  return curves;
}

Result<Point> measure(const Task& task, const Settings& settings, const Effort& effort) {
  std::optional<double> error;
  const auto compare = [&](int frame, const Cloth& cloth, const StepReport&) {
    if (frame != kReferenceFrame || task.reference.empty()) return;
    error = trajectory_error(positions_of(cloth), task.reference);
  };
  RunPlan plan;
  plan.dt = kFrame;
  plan.steps = task.frames;
  plan.seconds_limit = effort.seconds_limit;

  auto best = run(task.model, settings, plan, compare);
  if (!best) return Error{best.error()};
  double total = best.value().cpu_seconds;
  for (int i = 1; i < effort.repeat && total < effort.enough_seconds; ++i) {
    auto next = run(task.model, settings, plan);
    if (!next) return Error{next.error()};
    total += next.value().cpu_seconds;
    if (seconds_of(task, next.value()) < seconds_of(task, best.value())) best = std::move(next);
  }

  Point point{std::string(name(settings.solver)),
              std::string(name(settings.scheme)),
              std::string(name(settings.backend)),
              {settings.substeps, {}, settings.iterations},
              outcome_of(task, best.value())};
  if (settings.iterations == 0) point.knobs.tolerance = settings.tolerance;
  point.outcome.trajectory_error = error;
  return point;
}

Result<std::vector<Point>> sweep(const Task& task, const Curve& curve, const Effort& effort,
                                 const Watch& watch) {
  std::vector<Point> points;
  for (const Row& row : curve.rows) {
    for (const Settings& settings : row) {
      watch(fmt::format("{}, {}", substeps_text(settings.substeps),
                        settings.iterations > 0 ? counted(settings.iterations, "iteration")
                                                : percent(settings.tolerance)));
      auto point = measure(task, settings, effort);
      if (!point) break;  // refused
      points.push_back(std::move(point.value()));
      if (points.back().outcome.status == "out_of_time") break;
    }
  }
  return points;
}

}  // namespace weft::tools::precision
