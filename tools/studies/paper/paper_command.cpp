#include "tools/studies/paper/paper_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/program/files/pending_file.h"
#include "tools/program/files/text_file.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/terminal/progress.h"
#include "tools/scenes/scenes.h"
#include "tools/studies/paper/results.h"
#include "tools/studies/paper/study.h"
#include "tools/studies/plots/plotting.h"
#include "tools/studies/study_outputs.h"

namespace weft::tools {
namespace {

struct PaperOptions : StudyOptions {
  std::optional<int> repeat;  // 5; 2 if quick
};

std::string describe(const paper::Cell& cell) {
  return fmt::format("{0} {1}x{1} {2:g}%{3}", cell.scene, cell.size, 100 * cell.strain,
                     cell.velocity_correction ? " +velocity" : "");
}

Result<paper::Study> carry_out(const PaperOptions& options) {
  paper::Study study;
  study.quick = options.quick;
  study.repeat = options.repeat.value_or(options.quick ? 2 : 5);
  study.sphere_mass = scenes::Options{}.sphere_mass;
  const auto table = paper::table_cells(options.quick);
  const auto figure_4 = paper::figure_4_cells(options.quick);
  TaskLine line(table.size() + figure_4.size());
  const auto progress = [&](const paper::Cell&, const paper::Variant& variant, int done,
                            int total) {
    line.show(fmt::format("{} {}/{}", variant.label(), done, total));
  };

  for (const auto& [cells, rows] : {std::pair{&table, &study.rows}, {&figure_4, &study.figure_4}}) {
    for (const paper::Cell& cell : *cells) {
      line.next(describe(cell));
      auto measured = paper::measure(cell, study.repeat, progress);
      if (!measured) return Error{measured.error()};
      for (paper::Row& row : measured.value().rows) rows->push_back(std::move(row));
      study.previewed.push_back(std::move(measured.value().previewed));
    }
  }
  return study;
}

/// The data first: the pictures are drawn from it, and a machine without matplotlib keeps it.
Result<void> write_folder(const std::filesystem::path& folder, const paper::Study& study) {
  if (auto done = write_file(folder / "rows.csv", paper::rows_csv(study.rows)); !done) return done;
  if (auto done = write_file(folder / "figure4.csv", paper::rows_csv(study.figure_4)); !done) {
    return done;
  }
  if (auto done = write_file(folder / "previewed.csv", paper::rows_csv(study.previewed)); !done) {
    return done;
  }
  if (auto done = write_file(folder / "summary.csv", paper::summary_csv(study)); !done) return done;
  const std::string json = folder / "paper.json";
  if (auto done = write_json(json, paper::to_json(study)); !done) return done;
  const auto drawn = plot("paper_figures.py", {json, "--out", folder});
  if (!drawn)
    print_message(fmt::format("weft: {}; the data is in {}\n", drawn.error(), folder.c_str()));
  return {};
}

int run_paper(const PaperOptions& options) {
  auto outputs = StudyOutputs::open(options);
  if (!outputs) return refuse(outputs.error());
  const auto study = carry_out(options);
  if (!study) return refuse(study.error());
  const auto done = outputs.value().write(
      paper::to_text(study.value()), paper::to_json(study.value()),
      [&](const std::filesystem::path& folder) { return write_folder(folder, study.value()); });
  if (!done) return refuse(done.error());
  const paper::Row* missed = paper::first_missed(study.value());
  if (!missed) return kDone;
  return missed_tolerance(fmt::format("{}, {}, {}", describe(missed->cell), missed->variant.label(),
                                      text(*missed->summary.first_miss)));
}

}  // namespace

void add_paper_command(CommandLine& line) {
  const auto options = std::make_shared<PaperOptions>();
  Verb verb = line.add_verb(
      "paper", "Measure every combination of the paper's section 5 and print its Table 1",
      [options] { return run_paper(*options); });
  add_study_options(verb, *options, "write CSV, JSON and the figures 2, 3, 4 into a folder",
                    "fewer steps: under a minute, less to be trusted");
  verb.within(1, 1000, "--repeat", options->repeat,
              "most runs of one combination, fastest counts (default 5, quick 2)");
}

}  // namespace weft::tools
