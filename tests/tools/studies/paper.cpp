#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "tests/tools/slowness.h"
#include "tools/studies/paper/results.h"
#include "tools/studies/paper/study.h"

namespace weft::tools::paper {
namespace {

/// Rows of all cells and variants, every second cell four times as fast as the original, which is
/// 1.5 times as fast as the previewed one.
std::vector<Row> made_up_rows() {
  std::vector<Row> rows;
  bool fast = false;
  for (const Cell& cell : table_cells(false)) {
    for (const Variant& variant : cell.variants) {
      Row row{.cell = cell, .variant = variant, .seconds = 1, .runs = 1};
      if (!variant.is_original() && fast) row.times_faster = 4;
      row.times_faster_than_previewed = 1.5 * row.times_faster;
      rows.push_back(row);
    }
    fast = !fast;
  }
  return rows;
}

TEST_CASE("the paper's averages are 1 / the mean of its runtimes") {
  for (const Gain& gain : published_gains()) {
    CAPTURE(gain.label);
    // Every percentage is rounded to a whole one, and the average to two digits.
    const double mean = (gain.runtime[0] + gain.runtime[1]) / 2;
    CHECK(gain.average + 0.005 >= 1 / (mean + 0.005));
    CHECK(gain.average - 0.005 <= 1 / (mean - 0.005));
  }
}

TEST_CASE("gains: best, worst, and 1 / the mean of the runtimes") {
  for (const Gain& gain : measured_gains(made_up_rows())) {
    CAPTURE(gain.label);
    CHECK(gain.best == 4);
    CHECK(gain.worst == 1);
    CHECK(gain.average == doctest::Approx(1.6));
    // The cells alternate: velocity correction off is slow, on is fast.
    CHECK(gain.runtime[0] == doctest::Approx(1));
    CHECK(gain.runtime[1] == doctest::Approx(0.25));
  }
}

TEST_CASE("gains on the previewed original: the original's own first") {
  const auto gains = gains_on_previewed(made_up_rows());
  REQUIRE(gains.size() == published_gains().size() + 1);
  CHECK(gains.front().label == "original");
  CHECK(gains.front().best == 1.5);
  CHECK(gains.front().worst == 1.5);
  CHECK(gains.front().average == doctest::Approx(1.5));
  for (std::size_t i = 1; i < gains.size(); ++i) {
    CHECK(gains[i].label == published_gains()[i - 1].label);
    CHECK(gains[i].best == 6);
    CHECK(gains[i].worst == 1.5);
    CHECK(gains[i].average == doctest::Approx(2.4));
  }
}

TEST_CASE("Table 1 has 18 cells, each with the original first and eight variants, quick or not") {
  for (const bool quick : {false, true}) {
    const auto cells = table_cells(quick);
    CHECK(cells.size() == 18);
    for (const Cell& cell : cells) {
      CHECK(cell.variants.front().is_original());
      std::set<std::string> labels;
      for (const Variant& variant : cell.variants) labels.insert(variant.label());
      CHECK(labels.size() == 8);
      CHECK((quick ? cell.steps < 200 : cell.steps == 200));
    }
  }
}

TEST_CASE("a measured cell reaches its strain with every variant") {
  Cell cell = table_cells(true).front();
  cell.size = 5;
  cell.steps = 10;
  const auto measurement = measure(cell, 2, {});
  REQUIRE(measurement);
  const auto& [rows, previewed] = measurement.value();
  CHECK(rows.size() == 8);
  CHECK(rows.front().times_faster == 1);
  CHECK(previewed.variant.label() == "previewed");
  CHECK(previewed.times_faster_than_previewed == 1);
  auto all = rows;
  all.push_back(previewed);
  for (const Row& row : all) {
    CAPTURE(row.variant.label());
    CHECK(row.summary.total.status == Status::converged);
    CHECK(row.summary.max_strain <= cell.strain);
    CHECK(row.summary.frames == 10);
    CHECK(row.seconds > 0);
    CHECK(row.runs == 2);
    CHECK(row.seconds == row.summary.solver_seconds);
    CHECK(row.times_faster == rows.front().seconds / row.seconds);
    CHECK(row.times_faster_than_previewed == previewed.seconds / row.seconds);
    CHECK(row.summary.total.velocity_iterations == 0);
  }
}

TEST_CASE("the previewed original does what the original does, frame by frame") {
  for (Cell cell : table_cells(true)) {
    CAPTURE(std::string(cell.scene));
    CAPTURE(cell.strain);
    CAPTURE(cell.velocity_correction);
    cell.size = 6;
    cell.steps = 40;
    cell.variants = cell.variants.first(1);
    const auto measurement = measure(cell, 1, {});
    REQUIRE(measurement);
    const RunSummary& original = measurement.value().rows.front().summary;
    const RunSummary& previewed = measurement.value().previewed.summary;
    CHECK(previewed.total.status == Status::converged);
    CHECK(previewed.frames == original.frames);
    CHECK(previewed.total.iterations == original.total.iterations);
    CHECK(previewed.total.velocity_iterations == original.total.velocity_iterations);
    CHECK(previewed.total.direction_updates == original.total.direction_updates);
    CHECK(previewed.total.visits == original.total.visits);
    CHECK(previewed.total.corrections == original.total.corrections);
    CHECK(std::abs(previewed.max_strain - original.max_strain) <= 1e-9);
  }
}

TEST_CASE("velocities are corrected in the cells that say so") {
  Cell cell = table_cells(true)[1];
  REQUIRE(cell.velocity_correction);
  cell.size = 5;
  cell.steps = 10;
  const auto rows = measure(cell, 1, {});
  REQUIRE(rows);
  for (const Row& row : rows.value().rows) CHECK(row.summary.total.velocity_iterations > 0);
  CHECK(rows.value().previewed.summary.total.velocity_iterations > 0);
}

TEST_CASE("the fastest run of a row counts, not the last") {
  const Variant original{"original"};
  const Cell cell{"hang", 15, 1e-4, false, 30, std::span(&original, 1)};
  const auto start = std::chrono::steady_clock::now();
  std::chrono::duration<double> first_run{};
  std::optional<Slowness> slowness;
  const auto watch = [&](const Cell&, const Variant&, int done, int total) {
    if (done < total || slowness) return;
    first_run = std::chrono::steady_clock::now() - start;
    slowness.emplace();
  };
  const auto rows = measure(cell, 2, watch);
  slowness.reset();
  REQUIRE(rows);
  CHECK(rows.value().rows.front().seconds <= first_run.count());
}

TEST_CASE("a row that missed its tolerance is seen") {
  Study study;
  study.rows = made_up_rows();
  CHECK(first_missed(study) == nullptr);
  study.figure_4 = made_up_rows();
  study.figure_4.back().summary.first_miss = {.frame = 2};
  CHECK(first_missed(study) == &study.figure_4.back());
  study.rows.back().summary.first_miss = {.frame = 3};
  CHECK(first_missed(study) == &study.rows.back());

  Study previewed;
  previewed.previewed = made_up_rows();
  previewed.previewed.back().summary.first_miss = {.frame = 2};
  CHECK(first_missed(previewed) == &previewed.previewed.back());
}

TEST_CASE("the JSON has the rows and the six summaries of Table 1") {
  Study study;
  study.rows = made_up_rows();
  const Json json = to_json(study);
  CHECK(json["rows"].size() == 144);
  for (const char* key :
       {"scene", "strain", "velocity_correction", "method", "directions", "seconds",
        "iterations_per_step", "corrections", "times_faster", "max_strain", "status"}) {
    CAPTURE(key);
    CHECK(json["rows"][0].contains(key));
  }
  CHECK(json["summary"].size() == 6);
  for (const char* key : {"4.3", "4.2", "4.2+4.3", "4.3+4.4", "4.2+4.4", "4.2+4.3+4.4"}) {
    CAPTURE(key);
    CHECK(json["summary"][key]["average"].get<double>() == doctest::Approx(1.6));
    CHECK(json["summary"][key].size() == 3);
    CHECK(json["previewed"]["summary"][key]["best"] == 6);
    CHECK(json["previewed"]["summary"][key]["worst"] == 1.5);
    CHECK(json["previewed"]["summary"][key]["average"].get<double>() == doctest::Approx(2.4));
  }
  CHECK(json["previewed"]["summary"].size() == 7);
  CHECK(json["previewed"]["summary"]["original"]["best"] == 1.5);
}

/// With figures that are all different.
Row made_up_row() {
  Row row{.cell = {"hang", 7, 0.125, true, 40, {}},
          .variant = {"4.2", true, false, Directions::frozen},
          .seconds = 0.25,
          .times_faster = 1.5,
          .times_faster_than_previewed = 1.75,
          .runs = 3,
          .summary = {}};
  row.summary.frames = 4;
  row.summary.total.status = Status::iteration_limit;
  row.summary.step_seconds = 17;
  row.summary.solver_seconds = 18;
  row.summary.total.iterations = 10;
  row.summary.total.visits = 11;
  row.summary.total.corrections = 12;
  row.summary.max_strain = 0.0625;
  row.summary.mean_max_strain = 0.03125;
  row.summary.rms_strain = 0.015625;
  return row;
}

TEST_CASE("a row as JSON") {
  Study study;
  study.rows = study.figure_4 = study.previewed = {made_up_row()};
  Json expected = Json::parse(R"({
    "scene": "hang", "strain": 0.125, "velocity_correction": true, "method": "4.2",
    "directions": "frozen", "seconds": 0.25, "iterations_per_step": 2.5, "corrections": 12,
    "times_faster": 1.5, "times_faster_than_previewed": 1.75, "max_strain": 0.0625, "status": "iteration_limit"})");
  const Json json = to_json(study);
  CHECK(json["rows"] == Json::array({expected}));
  expected["size"] = 7;
  CHECK(json["figure4"] == Json::array({expected}));
  CHECK(json["previewed"]["rows"] == Json::array({expected}));
  CHECK(json["steps"] == Json::parse(R"([{"strain": 0.125, "steps": 40}])"));
}

TEST_CASE("a row as CSV and for a reader") {
  CHECK(
      rows_csv({made_up_row()}) ==
      "scene,size,strain,velocity_correction,method,directions,steps,runs,seconds,"
      "iterations_per_step,corrections,times_faster,max_strain,status,times_faster_than_previewed\n"
      "hang,7,0.125,on,4.2,frozen,40,3,0.25,2.5,12,1.5,0.0625,iteration_limit,1.75\n");
  Study study;
  study.figure_4 = {made_up_row()};
  CHECK(to_text(study).find(
            "hang           7 x 7   12.5 %  corrected 4.2+4.4        0.250000    1.50       1.75"
            "        2.5            12       6.25 %  iteration_limit\n") != std::string::npos);
}

TEST_CASE("the summary as CSV and for a reader: best, worst and average, the paper's beside it") {
  Study study;
  study.rows = made_up_rows();
  CHECK(summary_csv(study) ==
        "optimisation,best,worst,average,paper_best,paper_worst,paper_average,"
        "previewed_best,previewed_worst,previewed_average\n"
        "4.3,4,1,1.6,1.31,0.96,1.01,6,1.5,2.4\n"
        "4.2,4,1,1.6,1.83,1.31,1.46,6,1.5,2.4\n"
        "4.2+4.3,4,1,1.6,2.3,1.4,1.6,6,1.5,2.4\n"
        "4.3+4.4,4,1,1.6,4.4,1.01,1.66,6,1.5,2.4\n"
        "4.2+4.4,4,1,1.6,3.75,1.68,2.51,6,1.5,2.4\n"
        "4.2+4.3+4.4,4,1,1.6,11.35,2.16,3.44,6,1.5,2.4\n");
  const Json gain = to_json(study)["summary"]["4.2"];
  CHECK(gain["best"] == 4);
  CHECK(gain["worst"] == 1);
  const std::string text = to_text(study);
  CHECK(
      text.find(
          "\n4.2            1.83   1.31     1.46     4.00   1.00     1.60     6.00   1.50     2.40"
          "\n") != std::string::npos);
  CHECK(text.find("\noriginal" + std::string(57, ' ') + "1.50   1.50     1.50\n") !=
        std::string::npos);
  CHECK(text.find("\n4.2             72 /  66    100 /  25\n") != std::string::npos);
}

}  // namespace
}  // namespace weft::tools::paper
