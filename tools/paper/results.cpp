#include "tools/paper/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/wording.h"

namespace weft::tools::paper {
namespace {

Gain measured_gain(std::string_view label, const std::vector<Row>& rows) {
  Gain gain{label};
  std::array<double, 2> runtimes{};
  std::array<int, 2> counts{};
  for (const Row& row : rows) {
    if (row.variant.label() != label) continue;
    const bool first = counts[0] + counts[1] == 0;
    gain.best = first ? row.times_faster : std::max(gain.best, row.times_faster);
    gain.worst = first ? row.times_faster : std::min(gain.worst, row.times_faster);
    const std::size_t half = row.cell.velocity_correction ? 1 : 0;
    runtimes[half] += 1 / row.times_faster;
    ++counts[half];
  }
  gain.average = (counts[0] + counts[1]) / (runtimes[0] + runtimes[1]);
  for (std::size_t half : {0u, 1u}) gain.runtime[half] = runtimes[half] / counts[half];
  return gain;
}

// --------------------------------------------------------------------------------------- JSON

Json row_json(const Row& row) {
  return {{"scene", row.cell.scene},
          {"strain", row.cell.strain},
          {"velocity_correction", row.cell.velocity_correction},
          {"method", row.variant.method},
          {"directions", name(row.variant.directions)},
          {"seconds", row.seconds},
          {"iterations_per_step", row.summary.iterations_per_step()},
          {"corrections", row.summary.corrections},
          {"times_faster", row.times_faster},
          {"max_strain", row.summary.max_strain},
          {"status", name(row.summary.status)}};
}

Json figure_4_json(const Row& row) {
  Json json = row_json(row);
  json["size"] = row.cell.size;
  return json;
}

/// The number of steps per strain: a quick study has fewer.
Json steps_json(const std::vector<Row>& rows) {
  Json steps = Json::array();
  std::set<double> seen;
  for (const Row& row : rows) {
    if (!seen.insert(row.cell.strain).second) continue;
    steps.push_back({{"strain", row.cell.strain}, {"steps", row.cell.steps}});
  }
  return steps;
}

// --------------------------------------------------------------------------------------- text

using Text = std::back_insert_iterator<std::string>;

void write_heading(Text out, const Study& study) {
  fmt::format_to(out, "Section 5 of the paper, scalar reference backend, steps of 0.01 s.\n");
  if (study.quick) {
    fmt::format_to(out,
                   "QUICK: 60 steps instead of 200 at 10 % and 1 %, 20 at 0.001 % (the sphere of "
                   "sphere_drop\nlands after the 24th), figure 4 up to 20 x 20. No substitute for "
                   "the whole.\n");
  }
  fmt::format_to(out,
                 "Seconds are those of the solver's stages without `report`, the fastest of up to "
                 "{} runs.\nThe sphere of sphere_drop weighs {:g} kg.\n\n",
                 study.repeat, study.sphere_mass);
}

void write_table_1(Text out, const Study& study) {
  fmt::format_to(out, "Table 1: times faster than the original\n");
  fmt::format_to(out, "{:13}{:^22}   {:^22}\n", "", "paper", "weft");
  fmt::format_to(out, "{0:13}{1:>6}{2:>7}{3:>9}   {1:>6}{2:>7}{3:>9}\n", "", "best", "worst",
                 "average");
  const auto published = published_gains();
  const auto measured = measured_gains(study.rows);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Gain &paper = published[i], &ours = measured[i];
    fmt::format_to(out, "{:13}{:6.2f}{:7.2f}{:9.2f}   {:6.2f}{:7.2f}{:9.2f}\n", ours.label,
                   paper.best, paper.worst, paper.average, ours.best, ours.worst, ours.average);
  }
  const auto reached = std::count_if(study.rows.begin(), study.rows.end(), [](const Row& row) {
    return row.summary.reached_tolerance();
  });
  fmt::format_to(out, "{} of {} runs reached their strain in every step.\n\n", reached,
                 study.rows.size());
}

void write_averages(Text out, const Study& study) {
  fmt::format_to(out,
                 "Figures 2 and 3: mean runtime in % of the original's, without / with velocity "
                 "correction\n{:13}{:>11}{:>13}\n",
                 "", "paper", "weft");
  const auto published = published_gains();
  const auto measured = measured_gains(study.rows);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const auto &paper = published[i].runtime, &ours = measured[i].runtime;
    fmt::format_to(out, "{:13}{:5.0f} /{:4.0f}{:7.0f} /{:4.0f}\n", measured[i].label,
                   100 * paper[0], 100 * paper[1], 100 * ours[0], 100 * ours[1]);
  }
  fmt::format_to(out, "\n");
}

void write_rows(Text out, const std::vector<Row>& rows, std::string_view title) {
  fmt::format_to(out, "{}\n{:12}{:>8}{:>9}  {:10}{:13}{:>10}{:>8}{:>11}{:>14}{:>13}  {}\n", title,
                 "scene", "size", "strain", "velocity", "method", "seconds", "faster", "iter/step",
                 "corrections", "max strain", "status");
  for (const Row& row : rows) {
    const Cell& cell = row.cell;
    fmt::format_to(out, "{:12}{:>8}{:>9}  {:10}{:13}{:10.6f}{:8.2f}{:11.1f}{:14}{:>13}  {}\n",
                   cell.scene, fmt::format("{0} x {0}", cell.size), percent(cell.strain),
                   cell.velocity_correction ? "corrected" : "-", row.variant.label(), row.seconds,
                   row.times_faster, row.summary.iterations_per_step(), row.summary.corrections,
                   measured_percent(row.summary.max_strain), name(row.summary.status));
  }
}

}  // namespace

std::vector<Gain> published_gains() {
  return {{"4.3", 1.31, 0.96, 1.01, {1.03, 0.95}},
          {"4.2", 1.83, 1.31, 1.46, {0.72, 0.66}},
          {"4.2+4.3", 2.30, 1.40, 1.60, {0.66, 0.59}},
          {"4.3+4.4", 4.40, 1.01, 1.66, {0.59, 0.62}},
          {"4.2+4.4", 3.75, 1.68, 2.51, {0.40, 0.40}},
          {"4.2+4.3+4.4", 11.35, 2.16, 3.44, {0.28, 0.30}}};
}

std::vector<Gain> measured_gains(const std::vector<Row>& rows) {
  std::vector<Gain> gains;
  for (const Gain& published : published_gains()) {
    gains.push_back(measured_gain(published.label, rows));
  }
  return gains;
}

const Row* first_missed(const Study& study) {
  for (const auto* rows : {&study.rows, &study.figure_4}) {
    for (const Row& row : *rows) {
      if (!row.summary.reached_tolerance()) return &row;
    }
  }
  return nullptr;
}

Json to_json(const Study& study) {
  Json json{{"rows", Json::array()}, {"summary", Json::object()}};
  for (const Row& row : study.rows) json["rows"].push_back(row_json(row));
  for (const Gain& gain : measured_gains(study.rows)) {
    json["summary"][std::string(gain.label)] = {
        {"best", gain.best}, {"worst", gain.worst}, {"average", gain.average}};
  }
  json["figure4"] = Json::array();
  for (const Row& row : study.figure_4) json["figure4"].push_back(figure_4_json(row));
  json["sphere_mass"] = study.sphere_mass;
  json["quick"] = study.quick;
  json["steps"] = steps_json(study.rows);
  return json;
}

std::string rows_csv(const std::vector<Row>& rows) {
  std::string csv =
      "scene,size,strain,velocity_correction,method,directions,steps,runs,seconds,"
      "iterations_per_step,corrections,times_faster,max_strain,status\n";
  for (const Row& row : rows) {
    fmt::format_to(std::back_inserter(csv),
                   "{},{},{},{},{},{},{},{},{:.6g},{:.6g},{},{:.6g},{:.6g},{}\n", row.cell.scene,
                   row.cell.size, row.cell.strain, row.cell.velocity_correction ? "on" : "off",
                   row.variant.method, name(row.variant.directions), row.cell.steps, row.runs,
                   row.seconds, row.summary.iterations_per_step(), row.summary.corrections,
                   row.times_faster, row.summary.max_strain, name(row.summary.status));
  }
  return csv;
}

std::string summary_csv(const Study& study) {
  std::string csv = "optimisation,best,worst,average,paper_best,paper_worst,paper_average\n";
  const auto published = published_gains();
  const auto measured = measured_gains(study.rows);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    fmt::format_to(std::back_inserter(csv), "{},{:.6g},{:.6g},{:.6g},{},{},{}\n", measured[i].label,
                   measured[i].best, measured[i].worst, measured[i].average, published[i].best,
                   published[i].worst, published[i].average);
  }
  return csv;
}

std::string to_text(const Study& study) {
  std::string text;
  const Text out = std::back_inserter(text);
  write_heading(out, study);
  write_table_1(out, study);
  write_averages(out, study);
  write_rows(out, study.figure_4, "Figure 4: seconds by size");
  fmt::format_to(out, "\n");
  write_rows(out, study.rows, "All runs of Table 1");
  return text;
}

}  // namespace weft::tools::paper
