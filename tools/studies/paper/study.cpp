#include "tools/studies/paper/study.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "tools/scenes/scenes.h"
#include "tools/studies/paper/previewed_run.h"

namespace weft::tools::paper {
namespace {

constexpr std::array<Variant, 8> kVariants{{
    {"original", false, false, Directions::each},
    {"4.3", false, true, Directions::each},
    {"4.2", true, false, Directions::each},
    {"4.2+4.3", true, true, Directions::each},
    {"original", false, false, Directions::frozen},
    {"4.3", false, true, Directions::frozen},
    {"4.2", true, false, Directions::frozen},
    {"4.2+4.3", true, true, Directions::frozen},
}};

constexpr std::array<Variant, 2> kFigure4Variants{kVariants.front(), kVariants.back()};
constexpr Variant kPreviewed{"previewed", false, false, Directions::each, true};

constexpr std::array<std::string_view, 3> kScenes{"hang", "hang_sphere", "sphere_drop"};
constexpr std::array<double, 3> kStrains{0.1, 0.01, 0.00001};
constexpr int kSteps = 200;
constexpr double kDt = 0.01;  // s

/// Runs of one variant stop when they have taken this long together.
constexpr double kEnoughSeconds = 0.3;

/// The sphere lands after 0.24 s: 60 steps show every scene at work. At 0.001 % the time goes into
/// the landing, so there the quick version stops before it.
int steps_of(double strain, bool quick) {
  if (!quick) return kSteps;
  return strain < 0.001 ? 20 : 60;
}

Settings settings_of(const Cell& cell, const Variant& variant) {
  Settings settings = paper_settings();
  settings.tolerance = cell.strain;
  settings.velocity_correction = cell.velocity_correction;
  settings.scheme = Scheme::paper;
  settings.backend = Backend::reference;
  settings.measuring.anticipate = variant.anticipate;
  settings.measuring.skip = variant.skip;
  settings.measuring.directions = variant.directions;
  settings.measuring.renew_after = 0;  // as section 4.4 has it
  return settings;
}

Result<std::shared_ptr<const Model>> model_of(const Cell& cell) {
  scenes::Options options;
  options.size = cell.size;
  const auto scene = scenes::make(cell.scene, options);
  if (!scene) return Error{scene.error()};
  return build_model(scene.value());
}

/// A row under measurement.
struct Measured {
  Row row;
  double total_seconds = 0;
  bool wants_more(int repeat) const { return row.runs < repeat && total_seconds < kEnoughSeconds; }
};

Result<void> run_once(const std::shared_ptr<const Model>& model, Measured& measured,
                      const Progress& progress) {
  const Cell& cell = measured.row.cell;
  const Variant& variant = measured.row.variant;
  RunPlan plan;
  plan.dt = kDt;
  plan.steps = cell.steps;
  const auto show = [&](int frame) {
    if (progress) progress(cell, variant, frame, cell.steps);
  };
  const auto on_frame = [&](int frame, const Cloth&, const StepReport&) { show(frame); };
  const Settings settings = settings_of(cell, variant);
  auto summary = variant.previews ? run_previewed(model, settings, plan, show)
                                  : run(model, settings, plan, on_frame);
  if (!summary) return Error{summary.error()};
  const double seconds = summary.value().solver_seconds;
  if (measured.row.runs == 0 || seconds < measured.row.seconds) {
    measured.row.seconds = seconds;
    measured.row.summary = std::move(summary.value());
  }
  ++measured.row.runs;
  measured.total_seconds += seconds;
  return {};
}

/// The original is the first of them, the previewed one the last.
Measurement compare(std::vector<Measured>& variants) {
  const double original = variants.front().row.seconds, previewed = variants.back().row.seconds;
  Measurement measurement;
  for (Measured& measured : variants) {
    Row& row = measured.row;
    const double seconds = std::max(row.seconds, 1e-9);
    row.times_faster = original / seconds;
    row.times_faster_than_previewed = previewed / seconds;
    measurement.rows.push_back(std::move(row));
  }
  measurement.previewed = std::move(measurement.rows.back());
  measurement.rows.pop_back();
  return measurement;
}

}  // namespace

std::string Variant::label() const {
  if (directions == Directions::each) return std::string(method);
  return anticipate || skip ? std::string(method) + "+4.4" : "4.4";
}

std::vector<Cell> table_cells(bool quick) {
  std::vector<Cell> cells;
  for (const std::string_view scene : kScenes) {
    for (const double strain : kStrains) {
      for (const bool correction : {false, true}) {
        cells.push_back({scene, 20, strain, correction, steps_of(strain, quick), kVariants});
      }
    }
  }
  return cells;
}

std::vector<Cell> figure_4_cells(bool quick) {
  std::vector<Cell> cells;
  for (const int size : {5, 10, 20, 30, 40}) {
    if (quick && size > 20) break;
    for (const double strain : kStrains) {
      cells.push_back({"hang", size, strain, false, steps_of(strain, quick), kFigure4Variants});
    }
  }
  return cells;
}

Result<Measurement> measure(const Cell& cell, int repeat, const Progress& progress) {
  const auto model = model_of(cell);
  if (!model) return Error{model.error()};
  std::vector<Measured> variants;
  const auto add = [&](const Variant& variant) {
    variants.push_back({.row = {.cell = cell, .variant = variant}});
  };
  for (const Variant& variant : cell.variants) add(variant);
  add(kPreviewed);

  for (bool again = true; again;) {
    again = false;
    for (Measured& measured : variants) {
      if (!measured.wants_more(repeat)) continue;
      if (const auto done = run_once(model.value(), measured, progress); !done) {
        return Error{done.error()};
      }
      again = again || measured.wants_more(repeat);
    }
  }
  return compare(variants);
}

}  // namespace weft::tools::paper
