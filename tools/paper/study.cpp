#include "tools/paper/study.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "tools/scenes/scenes.h"

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
  settings.anticipate = variant.anticipate;
  settings.skip = variant.skip;
  settings.directions = variant.directions;
  settings.renew_after = 0;  // as section 4.4 has it
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
  const auto on_frame = [&](int frame, const Cloth&, const StepReport&) {
    if (progress) progress(cell, variant, frame, cell.steps);
  };
  auto summary = run(model, settings_of(cell, variant), plan, on_frame);
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

Result<std::vector<Row>> measure(const Cell& cell, int repeat, const Progress& progress) {
  const auto model = model_of(cell);
  if (!model) return Error{model.error()};
  std::vector<Measured> variants;
  for (const Variant& variant : cell.variants) variants.push_back({{cell, variant, 0, 1, 0, {}}});

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

  std::vector<Row> rows;
  for (Measured& measured : variants) rows.push_back(std::move(measured.row));
  for (Row& row : rows) row.times_faster = rows.front().seconds / std::max(row.seconds, 1e-9);
  return rows;
}

}  // namespace weft::tools::paper
