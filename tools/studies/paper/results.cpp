#include "tools/studies/paper/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/program/text/wording.h"

namespace weft::tools::paper {
namespace {

/// factor: how many times faster a row is than what it is compared with.
Gain gain_of(std::string_view label, const std::vector<Row>& rows, double Row::*factor) {
  Gain gain{label};
  std::array<double, 2> runtimes{};
  std::array<int, 2> counts{};
  for (const Row& row : rows) {
    if (row.variant.label() != label) continue;
    const bool first = counts[0] + counts[1] == 0;
    const double times_faster = row.*factor;
    gain.best = first ? times_faster : std::max(gain.best, times_faster);
    gain.worst = first ? times_faster : std::min(gain.worst, times_faster);
    const std::size_t half = row.cell.velocity_correction ? 1 : 0;
    runtimes[half] += 1 / times_faster;
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
          {"corrections", row.summary.total.corrections},
          {"times_faster", row.times_faster},
          {"times_faster_than_previewed", row.times_faster_than_previewed},
          {"max_strain", row.summary.max_strain},
          {"status", name(row.summary.total.status)}};
}

Json sized_row_json(const Row& row) {
  Json json = row_json(row);
  json["size"] = row.cell.size;
  return json;
}

Json gains_json(const std::vector<Gain>& gains) {
  Json json = Json::object();
  for (const Gain& gain : gains) {
    json[std::string(gain.label)] = {
        {"best", gain.best}, {"worst", gain.worst}, {"average", gain.average}};
  }
  return json;
}

Json rows_json(const std::vector<Row>& rows, Json (*to_json)(const Row&)) {
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(to_json(row));
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

/// A line of Table 1: as printed, and as measured against either original.
struct Line {
  Gain paper, weft, on_previewed;
};

std::vector<Line> lines_of_table_1(const std::vector<Row>& rows) {
  const auto published = published_gains();
  const auto measured = measured_gains(rows), on_previewed = gains_on_previewed(rows);
  std::vector<Line> lines;
  for (std::size_t i = 0; i < published.size(); ++i) {
    lines.push_back({published[i], measured[i], on_previewed[i + 1]});
  }
  return lines;
}

std::string columns(const Gain& gain) {
  return fmt::format("{:6.2f}{:7.2f}{:9.2f}", gain.best, gain.worst, gain.average);
}

void write_table_1(Text out, const Study& study) {
  fmt::format_to(out,
                 "Table 1: times faster than the original. `previewed` is the paper's own, which "
                 "computes the\npreviewed positions of both particles at every visit; "
                 "weft's original keeps them.\n"
                 "{:13}{:^22}   {:^22}   {:^22}\n{:13}",
                 "", "paper", "weft", "weft, on previewed", "");
  fmt::format_to(out, "{0:>6}{1:>7}{2:>9}   {0:>6}{1:>7}{2:>9}   {0:>6}{1:>7}{2:>9}\n", "best",
                 "worst", "average");
  for (const Line& line : lines_of_table_1(study.rows)) {
    fmt::format_to(out, "{:13}{}   {}   {}\n", line.weft.label, columns(line.paper),
                   columns(line.weft), columns(line.on_previewed));
  }
  fmt::format_to(out, "{:13}{:50}{}\n", "original", "",
                 columns(gains_on_previewed(study.rows).front()));
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
  fmt::format_to(out, "{}\n{:12}{:>8}{:>9}  {:10}{:13}{:>10}{:>8}{:>11}{:>11}{:>14}{:>13}  {}\n",
                 title, "scene", "size", "strain", "velocity", "method", "seconds", "faster",
                 "previewed", "iter/step", "corrections", "max strain", "status");
  for (const Row& row : rows) {
    const Cell& cell = row.cell;
    fmt::format_to(out,
                   "{:12}{:>8}{:>9}  {:10}{:13}{:10.6f}{:8.2f}{:11.2f}{:11.1f}{:14}{:>13}  {}\n",
                   cell.scene, fmt::format("{0} x {0}", cell.size), percent(cell.strain),
                   cell.velocity_correction ? "corrected" : "-", row.variant.label(), row.seconds,
                   row.times_faster, row.times_faster_than_previewed,
                   row.summary.iterations_per_step(), row.summary.total.corrections,
                   measured_percent(row.summary.max_strain), name(row.summary.total.status));
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
    gains.push_back(gain_of(published.label, rows, &Row::times_faster));
  }
  return gains;
}

std::vector<Gain> gains_on_previewed(const std::vector<Row>& rows) {
  std::vector<Gain> gains{gain_of("original", rows, &Row::times_faster_than_previewed)};
  for (const Gain& published : published_gains()) {
    gains.push_back(gain_of(published.label, rows, &Row::times_faster_than_previewed));
  }
  return gains;
}

const Row* first_missed(const Study& study) {
  for (const auto* rows : {&study.rows, &study.figure_4, &study.previewed}) {
    for (const Row& row : *rows) {
      if (!row.summary.reached_tolerance()) return &row;
    }
  }
  return nullptr;
}

Json to_json(const Study& study) {
  return {{"rows", rows_json(study.rows, row_json)},
          {"summary", gains_json(measured_gains(study.rows))},
          {"figure4", rows_json(study.figure_4, sized_row_json)},
          {"previewed",
           {{"rows", rows_json(study.previewed, sized_row_json)},
            {"summary", gains_json(gains_on_previewed(study.rows))}}},
          {"sphere_mass", study.sphere_mass},
          {"quick", study.quick},
          {"steps", steps_json(study.rows)}};
}

std::string rows_csv(const std::vector<Row>& rows) {
  std::string csv =
      "scene,size,strain,velocity_correction,method,directions,steps,runs,seconds,"
      "iterations_per_step,corrections,times_faster,max_strain,status,"
      "times_faster_than_previewed\n";
  for (const Row& row : rows) {
    fmt::format_to(
        std::back_inserter(csv),
        "{},{},{},{},{},{},{},{},{:.6g},{:.6g},{},{:.6g},{:.6g},{},{:.6g}\n", row.cell.scene,
        row.cell.size, row.cell.strain, row.cell.velocity_correction ? "on" : "off",
        row.variant.method, name(row.variant.directions), row.cell.steps, row.runs, row.seconds,
        row.summary.iterations_per_step(), row.summary.total.corrections, row.times_faster,
        row.summary.max_strain, name(row.summary.total.status), row.times_faster_than_previewed);
  }
  return csv;
}

std::string summary_csv(const Study& study) {
  std::string csv =
      "optimisation,best,worst,average,paper_best,paper_worst,paper_average,"
      "previewed_best,previewed_worst,previewed_average\n";
  for (const Line& line : lines_of_table_1(study.rows)) {
    const auto &weft = line.weft, &paper = line.paper, &previewed = line.on_previewed;
    fmt::format_to(std::back_inserter(csv),
                   "{},{:.6g},{:.6g},{:.6g},{},{},{},{:.6g},{:.6g},{:.6g}\n", weft.label, weft.best,
                   weft.worst, weft.average, paper.best, paper.worst, paper.average, previewed.best,
                   previewed.worst, previewed.average);
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
  fmt::format_to(out, "\n");
  write_rows(out, study.previewed, "The previewed original in each of them");
  return text;
}

}  // namespace weft::tools::paper
