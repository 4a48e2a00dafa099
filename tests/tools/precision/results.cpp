#include "tools/precision/results.h"
#include "tools/precision/results_json.h"
#include "tools/precision/results_tables.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

namespace weft::tools::precision {
namespace {

Point made_up(const char* solver, double ms, double strain, double gain = 0) {
  Point point{solver, "paper", "simd", {1, 0.01, 0}, {}};
  point.outcome = {.status = "converged",
                   .frames = 200,
                   .ms_per_frame = ms,
                   .max_strain = strain,
                   .energy_gain = gain};
  return point;
}

Study made_up_study() {
  Study study;
  Chart& chart = study.charts.emplace_back();
  chart.task.scene = "hang";
  chart.task.size = 20;
  chart.points = {made_up("direct", 0.4, 1e-5), made_up("gauss_seidel", 0.1, 0.01),
                  made_up("gauss_seidel", 0.05, 0.009, 0.5), made_up("gauss_seidel", 0.01, 0.1)};
  chart.points.push_back({"bullet", "", "", {5, {}, 16}, chart.points.front().outcome});
  study.orders = {{"paper", {{0.01, 0.04}, {0.005, 0.02}}, 1.0}};
  return study;
}

TEST_CASE("the cheapest point within a bound gains no energy") {
  const Study study = made_up_study();
  const Chart& chart = study.charts.front();
  CHECK(cheapest(chart, "gauss_seidel", 0.01)->outcome.ms_per_frame == 0.1);
  CHECK(cheapest(chart, "gauss_seidel", 0.1)->outcome.ms_per_frame == 0.01);
  CHECK(cheapest(chart, "gauss_seidel", 0.001) == nullptr);
  CHECK(cheapest(chart, "yarn", 0.1) == nullptr);
}

TEST_CASE("the JSON has the keys of the contract; peers are apart, failures are in it") {
  Study study = made_up_study();
  const Json json = to_json(study);
  REQUIRE(json["points"].size() == 4);
  for (const char* key : {"solver", "scheme", "substeps", "tolerance", "ms_per_frame", "max_strain",
                          "trajectory_error"}) {
    CAPTURE(key);
    CHECK(json["points"][0].contains(key));
  }
  CHECK(json["points"][2]["counts"] == false);
  CHECK(json["points"][0]["trajectory_error"].is_null());
  CHECK(json["order"]["paper"] == 1.0);
  CHECK(json["order"].contains("rattle"));
  REQUIRE(json["peers"].size() == 1);
  CHECK(json["peers"][0]["solver"] == "bullet");
  CHECK(json["bullet"] == "not built in");
  CHECK_FALSE(json.contains("sizes"));

  study.sizes = SizeStudy{};
  study.sizes->curves = {{"direct", {{20, 2, made_up("direct", 1, 0.01).outcome}}, "", 1.5}};
  const Json sizes = to_json(study)["sizes"];
  CHECK(sizes["curves"][0]["exponent"] == 1.5);
  CHECK(sizes["curves"][0]["points"][0]["size"] == 20);
}

TEST_CASE("CSV: a heading and a line for each point, peers too") {
  const std::string csv = points_csv(made_up_study());
  CHECK(std::ranges::count(csv, '\n') == 6);
}

TEST_CASE("markdown: a row for each bound, a column for each contender") {
  const std::string text = to_markdown(made_up_study());
  CHECK(text.starts_with("| hang 20², ms per frame | direct | gauss_seidel | bullet |"));
  CHECK(text.find("| 1 % | 0.4 | 0.1 | 0.4 |") != std::string::npos);
  CHECK(text.find("| 0.1 % | 0.4 | never | 0.4 |") != std::string::npos);
}

TEST_CASE("the text tells what does not count") {
  const std::string text = to_text(made_up_study());
  CHECK(text.find("Bullet: not built in") != std::string::npos);
  CHECK(text.find("1 gained energy") != std::string::npos);
  CHECK(text.find("not reached") != std::string::npos);
}

}  // namespace
}  // namespace weft::tools::precision
