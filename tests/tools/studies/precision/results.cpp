#include "tools/studies/precision/results.h"
#include "tools/studies/precision/bullet.h"
#include "tools/studies/precision/results_json.h"
#include "tools/studies/precision/results_tables.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
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
  chart.tightest = {{"direct", 1e-5}, {"gauss_seidel", 1e-4}, {"bullet", 1e-5}};
  study.orders = {{"hang 20 x 20", "paper", {{0.01, 0.04}, {0.005, 0.02}}, 1.0}};
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
  CHECK(json["order"]["rattle"].is_null());
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

/// With figures that are all different.
Outcome distinct_outcome() {
  return {.status = "converged",
          .frames = 50,
          .ms_per_frame = 0.5,
          .max_strain = 0.0625,
          .mean_max_strain = 0.015625,
          .energy_gain = 0.00025,
          .substeps = 3.5,
          .trajectory_error = 0.25};
}

Study distinct_study() {
  Study study;
  Chart& chart = study.charts.emplace_back();
  chart.task.scene = "corners";
  chart.task.size = 21;
  chart.points = {{"yarn", "rattle", "simd", {2, 0.03125, 0}, distinct_outcome()}};
  study.orders = {{"hang 20 x 20", "paper", {{0.01, 0.04}, {0.005, 0.02}}, 1.25}};
  study.sizes = SizeStudy{};
  study.sizes->curves = {{"direct", {{30, 4, distinct_outcome()}}, "the end", 1.5}};
  return study;
}

TEST_CASE("the JSON of a point, of an order and of a size") {
  const Json json = to_json(distinct_study());
  const Json point = Json::parse(R"({
    "scene": "corners", "size": 21, "contender": "yarn", "solver": "yarn", "scheme": "rattle",
    "backend": "simd", "substeps": 2, "tolerance": 0.03125, "iterations": 0, "ms_per_frame": 0.5,
    "max_strain": 0.0625, "trajectory_error": 0.25, "mean_max_strain": 0.015625,
    "energy_gain": 0.00025, "status": "converged", "frames": 50, "counts": true})");
  CHECK(json["points"] == Json::array({point}));
  CHECK(json["order"] ==
        Json::parse(R"({"paper": 1.25, "rattle": null, "implicit": null, "bdf2": null})"));
  CHECK(json["orders"] ==
        Json::parse(R"([{"scene": "hang 20 x 20", "scheme": "paper", "order": 1.25}])"));
  CHECK(json["order_points"][1] ==
        Json::parse(R"({"scene": "hang 20 x 20", "scheme": "paper", "dt": 0.005,
                        "trajectory_error": 0.02})"));
  CHECK(json["sizes"]["curves"] == Json::parse(R"([{
    "solver": "direct", "exponent": 1.5, "end": "the end",
    "points": [{
      "size": 30, "substeps": 4, "ms_per_frame": 0.5, "max_strain": 0.0625,
      "mean_max_strain": 0.015625, "energy_gain": 0.00025, "status": "converged", "frames": 50,
      "counts": true}]}])"));
}

TEST_CASE("of the motion is told what was asked for, got and estimated") {
  Study study = distinct_study();
  CHECK(to_json(study)["motion"] == Json::array());
  CHECK(to_text(study).find("motion_tolerance") == std::string::npos);
  study.charts.front().motion = {{0, 0.5, 0.25, 2, 0.125}, {0.0625, 0.03125, 0.25, 3, 0.75}};
  CHECK(to_json(study)["motion"][1] ==
        Json::parse(R"({"scene": "corners", "size": 21, "asked": 0.0625, "got": 0.03125,
                        "estimated": 0.25, "substeps": 3, "ms_per_frame": 0.75})"));
  const std::string text = to_text(study);
  CHECK(text.find(
            "\n             -           500           250         -         2         0.125\n") !=
        std::string::npos);
  CHECK(text.find(
            "\n          62.5          31.2           250      0.50         3          0.75\n") !=
        std::string::npos);
}

TEST_CASE("automatic substeps are told as what they came to") {
  Study study = distinct_study();
  study.charts.front().points.front().knobs.substeps = kAutomaticSubsteps;
  CHECK(to_json(study)["points"][0]["substeps"] == 3.5);
}

TEST_CASE("CSV: a heading and a line for each point, peers too") {
  CHECK(points_csv(distinct_study()) ==
        "scene,size,contender,solver,scheme,backend,substeps,tolerance,iterations,ms_per_frame,"
        "max_strain,mean_max_strain,trajectory_error,energy_gain,status,frames,counts\n"
        "corners,21,yarn,yarn,rattle,simd,2,0.03125,0,0.5,0.0625,0.015625,0.25,0.00025,converged,"
        "50,true\n");
  CHECK(points_csv(made_up_study())
            .ends_with("\nhang,20,bullet,bullet,,,5,,16,0.4,1e-05,0,,0,converged,200,true\n"));
}

TEST_CASE("CSV: a line for each size") {
  CHECK(sizes_csv(*distinct_study().sizes) ==
        "scene,size,solver,substeps,ms_per_frame,max_strain,energy_gain,status\n"
        "hang,30,direct,4,0.5,0.0625,0.00025,converged\n");
}

TEST_CASE("costs are told as multiples of auto's") {
  Study study = made_up_study();
  study.charts.front().points.push_back(made_up("auto", 0.2, 0.01));
  const std::string markdown = to_markdown(study);
  CHECK(markdown.find(" auto | gauss_seidel / auto | bullet / auto |\n") != std::string::npos);
  CHECK(markdown.find("| 1 % | 0.4 | 0.1 | 0.4 | 0.2 | 0.5 | 2 |\n") != std::string::npos);
  const std::string text = to_text(study);
  CHECK(text.find("      1 %  direct                  0.4       2.0      0.001 %            -  "
                  "paper, 1 %, 1 substep\n") != std::string::npos);
}

TEST_CASE("the text tells orders in mm, and sizes") {
  const std::string text = to_text(distinct_study());
  CHECK(text.find("                  0.01       0.005    order\n"
                  "paper               40          20     1.25\n") != std::string::npos);
  CHECK(text.find("     30 x 30  direct                  0.5        3.5       6.25 %\n") !=
        std::string::npos);
  CHECK(text.find("direct        time ~ particles^1.50\n") != std::string::npos);
  CHECK(text.find("direct        the end\n") != std::string::npos);
}

TEST_CASE("orders are told scene by scene, where they were measured") {
  Study study = distinct_study();
  study.orders.push_back({"hang 20 x 20", "bdf2", {{0.005, 0.01}}, {}});
  study.orders.push_back({"corners 21 x 21", "bdf2", {{0.0025, 0.03}}, 2});
  const std::string text = to_text(study);
  CHECK(text.find("Order of convergence on hang 20 x 20, trajectory error in mm by dt\n"
                  "                  0.01       0.005    order\n"
                  "paper               40          20     1.25\n"
                  "bdf2                            10        -\n\n"
                  "Order of convergence on corners 21 x 21, trajectory error in mm by dt\n"
                  "                0.0025    order\n"
                  "bdf2                30     2.00\n") != std::string::npos);
  const Json json = to_json(study);
  CHECK(json["order"]["bdf2"].is_null());
  CHECK(json["orders"][2]["order"] == 2);
}

TEST_CASE("what is automatic has no scheme of its own in the tables") {
  Study study = distinct_study();
  study.charts.front().points.push_back({"auto", "auto", "simd", {0, 0.03125, 0}, {}});
  study.charts.front().points.back().outcome = distinct_outcome();
  CHECK(to_text(study).find("  3.125 %, automatic substeps\n") != std::string::npos);
  CHECK(to_text(study).find("  rattle, 3.125 %, 2 substeps\n") != std::string::npos);
}

TEST_CASE("markdown: a row for each bound, a column for each contender") {
  const std::string text = to_markdown(made_up_study());
  CHECK(text.starts_with("| hang 20², ms per frame | direct | gauss_seidel | bullet |"));
  CHECK(text.find("| 1 % | 0.4 | 0.1 | 0.4 |") != std::string::npos);
  CHECK(text.find("| 0.1 % | 0.4 | never | 0.4 |") != std::string::npos);
}

TEST_CASE("markdown: the trajectory error is in brackets") {
  Study study = made_up_study();
  std::vector<Point>& points = study.charts.front().points;
  points[0].outcome.trajectory_error = 0.0000934;
  points[1].outcome.trajectory_error = 0.0434;
  const std::string text = to_markdown(study);
  CHECK(text.find("| 1 % | 0.4 (0.093 mm) | 0.1 (43 mm) | 0.4 |") != std::string::npos);
  CHECK(text.find("after 0.4 s") != std::string::npos);
  CHECK(text.find("never more than 0.001 J above its start") != std::string::npos);
}

TEST_CASE("a bound that is not kept: all failed, some were cut, or none aims at it") {
  Study study = made_up_study();
  Chart& chart = study.charts.front();
  CHECK(gap(chart, "gauss_seidel", 1e-4) == Gap::failed);
  CHECK(gap(chart, "gauss_seidel", 1e-5) == Gap::not_aimed_at);
  CHECK(gap(chart, "yarn", 0.1) == Gap::not_aimed_at);

  Point cut = made_up("gauss_seidel", 30, 0.002);
  cut.outcome.status = "out_of_time";
  Point fixed = cut;
  fixed.knobs = {1, {}, 64};
  chart.points.push_back(fixed);
  CHECK(gap(chart, "gauss_seidel", 1e-4) == Gap::failed);
  chart.points.push_back(cut);
  CHECK(gap(chart, "gauss_seidel", 1e-4) == Gap::out_of_time);
  CHECK(gap(chart, "gauss_seidel", 1e-5) == Gap::not_aimed_at);

  const std::string text = to_markdown(study);
  CHECK(text.find("| 0.1 % | 0.4 | over 20 ms | 0.4 |") != std::string::npos);
  CHECK(text.find("| 0.001 % | 0.4 | - | 0.4 |") != std::string::npos);
  CHECK(text.find("4 s of processor time: 20 ms a frame over 200 frames") != std::string::npos);
  chart.task.frames = 100;
  chart.task.threads = 2;
  chart.seconds_limit = 0.5;
  CHECK(to_markdown(study).find("over 2.5 ms |") != std::string::npos);
}

TEST_CASE("what a curve aims at is the tightest of its tolerances") {
  Chart chart;
  note_aims(chart, {"auto, paper", {{{.tolerance = 0.1}, {.tolerance = 0.01}}}});
  CHECK(chart.tightest == std::map<std::string, double>{{"auto", 0.01}});
  note_aims(chart, {"auto, rattle", {{{.tolerance = 1e-3}}}});
  CHECK(chart.tightest == std::map<std::string, double>{{"auto", 1e-3}});
  note_aims(chart, {"direct", {{{.iterations = 4, .solver = Solver::direct}}}});
  note_aims(chart, {"original", {{{.tolerance = 0.1, .backend = Backend::reference}}}});
  CHECK(chart.tightest == std::map<std::string, double>{{"auto", 1e-3}, {"original", 0.1}});
}

TEST_CASE("a line of particles is no square") {
  Study study = made_up_study();
  study.charts.front().task.scene = "chain";
  CHECK(to_markdown(study).starts_with("| chain of 20, ms per frame |"));
}

TEST_CASE("Bullet is searched as far as the tables ask") {
  CHECK(kBulletTightest <= kBounds.back());
}

TEST_CASE("the text tells what does not count") {
  const std::string text = to_text(made_up_study());
  CHECK(text.find("Bullet: not built in") != std::string::npos);
  CHECK(text.find("1 gained energy") != std::string::npos);
  CHECK(text.find("never more than 0.001 J above its start") != std::string::npos);
  CHECK(text.find("gauss_seidel          never\n") != std::string::npos);
}

}  // namespace
}  // namespace weft::tools::precision
