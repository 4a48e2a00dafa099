#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tools/paper/results.h"
#include "tools/paper/study.h"

namespace weft::tools::paper {
namespace {

/// Rows of all cells and variants, every second cell four times as fast as the original.
std::vector<Row> made_up_rows() {
  std::vector<Row> rows;
  bool fast = false;
  for (const Cell& cell : table_cells(false)) {
    for (const Variant& variant : cell.variants) {
      Row row{cell, variant, 1, 1, 1, {}};
      if (!variant.is_original() && fast) row.times_faster = 4;
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
  const auto rows = measure(cell, 2, {});
  REQUIRE(rows);
  CHECK(rows.value().size() == 8);
  CHECK(rows.value().front().times_faster == 1);
  for (const Row& row : rows.value()) {
    CAPTURE(row.variant.label());
    CHECK(row.summary.status == Status::converged);
    CHECK(row.summary.max_strain <= cell.strain);
    CHECK(row.summary.frames == 10);
    CHECK(row.seconds > 0);
    CHECK(row.runs == 2);
  }
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
  }
}

TEST_CASE("rows as CSV: a heading and one line each") {
  const auto rows = made_up_rows();
  const std::string csv = rows_csv(rows);
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  CHECK(static_cast<std::size_t>(lines) == rows.size() + 1);
}

}  // namespace
}  // namespace weft::tools::paper
