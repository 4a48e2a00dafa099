#include "tools/precision/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

namespace weft::tools::precision {
namespace {

constexpr std::array<double, 5> kBounds{0.1, 0.01, 1e-3, 1e-4, 1e-5};

/// A strain that is a hair above its bound by rounding alone is within it.
constexpr double kRounding = 1 + 1e-6;

std::string percent(double fraction) { return fmt::format("{:g} %", 100 * fraction); }

/// In the order of first appearance.
std::vector<std::string> contenders(const Chart& chart) {
  std::vector<std::string> names;
  for (const Point& point : chart.points) {
    const std::string name = contender(point);
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

// --------------------------------------------------------------------------------------- JSON

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

void add_outcome(Json& json, const Outcome& outcome) {
  json["ms_per_frame"] = outcome.ms_per_frame;
  json["max_strain"] = outcome.max_strain;
  json["trajectory_error"] = optional_json(outcome.trajectory_error);
  json["mean_max_strain"] = outcome.mean_max_strain;
  json["energy_gain"] = outcome.energy_gain;
  json["status"] = outcome.status;
  json["frames"] = outcome.frames;
  json["counts"] = outcome.counts();
}

Json point_json(const Task& task, const Point& point) {
  Json json{{"scene", task.scene},
            {"size", task.size},
            {"contender", contender(point)},
            {"solver", point.solver},
            {"scheme", point.scheme},
            {"backend", point.backend},
            {"substeps", point.knobs.substeps},
            {"tolerance", optional_json(point.knobs.tolerance)},
            {"iterations", point.knobs.iterations}};
  add_outcome(json, point.outcome);
  return json;
}

bool is_peer(const Point& point) { return point.backend.empty(); }

Json points_json(const Study& study, bool peers) {
  Json json = Json::array();
  for (const Chart& chart : study.charts) {
    for (const Point& point : chart.points) {
      if (is_peer(point) == peers) json.push_back(point_json(chart.task, point));
    }
  }
  return json;
}

Json scenes_json(const Study& study) {
  Json json = Json::array();
  for (const Chart& chart : study.charts) {
    json.push_back({{"scene", chart.task.scene},
                    {"size", chart.task.size},
                    {"frames", chart.task.frames},
                    {"threads", chart.task.threads},
                    {"reference_error", chart.task.reference_error}});
  }
  return json;
}

Json cheapest_json(const Study& study) {
  Json json = Json::array();
  for (const Chart& chart : study.charts) {
    for (const double bound : kBounds) {
      for (const std::string& name : contenders(chart)) {
        const Point* point = cheapest(chart, name, bound);
        if (!point) continue;
        Json row = point_json(chart.task, *point);
        row["bound"] = bound;
        json.push_back(std::move(row));
      }
    }
  }
  return json;
}

Json sizes_json(const SizeStudy& study) {
  Json json{{"scene", study.scene},
            {"tolerance", study.tolerance},
            {"frames", study.frames},
            {"threads", study.threads},
            {"curves", Json::array()}};
  for (const SizeCurve& curve : study.curves) {
    Json points = Json::array();
    for (const SizePoint& point : curve.points) {
      Json& row = points.emplace_back(Json{{"size", point.size}, {"substeps", point.substeps}});
      add_outcome(row, point.outcome);
      row.erase("trajectory_error");
    }
    json["curves"].push_back({{"solver", curve.solver},
                              {"exponent", optional_json(curve.exponent)},
                              {"end", curve.end},
                              {"points", std::move(points)}});
  }
  return json;
}

// --------------------------------------------------------------------------------------- text

using Text = std::back_insert_iterator<std::string>;

std::string knobs_text(const Knobs& knobs) {
  const std::string goal =
      knobs.tolerance ? percent(*knobs.tolerance) : fmt::format("{} iterations", knobs.iterations);
  return fmt::format("{}, {} substep{}", goal, knobs.substeps, knobs.substeps == 1 ? "" : "s");
}

std::string error_text(const std::optional<double>& error) {
  return error ? fmt::format("{:.3g} mm", 1000 * *error) : "-";
}

void write_cheapest(Text out, const Chart& chart) {
  const Task& task = chart.task;
  fmt::format_to(out,
                 "{0}, size {1}, {2} frames of {3} s, {4} thread{5}: the cheapest setting that "
                 "keeps every strain within the bound\nand gains no energy. Trajectory errors at "
                 "{6} s; the reference's own is about {7:.2g} mm.\n",
                 task.scene, task.size, task.frames, kFrame, task.threads,
                 task.threads == 1 ? "" : "s", kFrame * kReferenceFrame,
                 1000 * task.reference_error);
  fmt::format_to(out, "{:>9}  {:14}{:>13}{:>10}{:>13}{:>13}  {}\n", "bound", "", "ms per frame",
                 "x auto", "max strain", "trajectory", "setting");
  for (const double bound : kBounds) {
    const Point* plain = cheapest(chart, "auto", bound);
    for (const std::string& name : contenders(chart)) {
      const Point* point = cheapest(chart, name, bound);
      if (!point) {
        fmt::format_to(out, "{:>9}  {:14}{:>13}\n", percent(bound), name, "not reached");
        continue;
      }
      const double ms = point->outcome.ms_per_frame;
      fmt::format_to(out, "{:>9}  {:14}{:13.4g}{:>10}{:>13}{:>13}  {}{}\n", percent(bound), name,
                     ms, plain ? fmt::format("{:.1f}", ms / plain->outcome.ms_per_frame) : "-",
                     fmt::format("{:.3g} %", 100 * point->outcome.max_strain),
                     error_text(point->outcome.trajectory_error),
                     point->scheme.empty() ? "" : point->scheme + ", ", knobs_text(point->knobs));
    }
  }
  fmt::format_to(out, "\n");
}

void write_failures(Text out, const Chart& chart) {
  std::map<std::string, std::map<std::string, int>> failures;
  for (const Point& point : chart.points) {
    const Outcome& outcome = point.outcome;
    if (outcome.counts()) continue;
    const std::string curve = contender(point) + (point.scheme.empty() ? "" : ", " + point.scheme);
    ++failures[curve][outcome.is_complete() ? "gained energy" : outcome.status];
  }
  if (failures.empty()) return;
  fmt::format_to(out, "Settings of {} that do not count:\n", chart.task.scene);
  for (const auto& [curve, reasons] : failures) {
    fmt::format_to(out, "  {:24}", curve);
    const char* separator = "";
    for (const auto& [reason, count] : reasons) {
      fmt::format_to(out, "{}{} {}", separator, count, reason);
      separator = ", ";
    }
    fmt::format_to(out, "\n");
  }
  fmt::format_to(out, "\n");
}

void write_orders(Text out, const std::vector<Order>& orders) {
  fmt::format_to(out, "Order of convergence on hang 20 x 20, trajectory error in mm by dt\n{:10}",
                 "");
  for (const OrderPoint& point : orders.front().points) fmt::format_to(out, "{:>12g}", point.dt);
  fmt::format_to(out, "{:>9}\n", "order");
  for (const Order& order : orders) {
    fmt::format_to(out, "{:10}", order.scheme);
    for (const OrderPoint& point : order.points) {
      fmt::format_to(out, "{:12.4g}", 1000 * point.error);
    }
    fmt::format_to(out, "{:>9}\n", order.order ? fmt::format("{:.2f}", *order.order) : "-");
  }
  fmt::format_to(out, "\n");
}

void write_sizes(Text out, const SizeStudy& study) {
  fmt::format_to(out, "Cost against size: {}, {}, {} frames, {}\n{:>14}{:14}{:>13}{:>11}{:>13}\n",
                 study.scene, percent(study.tolerance), study.frames,
                 study.threads == 0 ? "all threads" : fmt::format("threads: {}", study.threads),
                 "size  ", "solver", "ms per frame", "substeps", "max strain");
  for (const SizeCurve& curve : study.curves) {
    for (const SizePoint& point : curve.points) {
      fmt::format_to(out, "{:>14}{:14}{:13.4g}{:11}{:>13}\n",
                     fmt::format("{0} x {0}  ", point.size), curve.solver,
                     point.outcome.ms_per_frame, point.substeps,
                     fmt::format("{:.3g} %", 100 * point.outcome.max_strain));
    }
    if (curve.exponent) {
      fmt::format_to(out, "{:>14}{:14}time ~ particles^{:.2f}\n", "", curve.solver,
                     *curve.exponent);
    }
    if (!curve.end.empty()) fmt::format_to(out, "{:>14}{:14}{}\n", "", curve.solver, curve.end);
  }
}

}  // namespace

std::string contender(const Point& point) {
  return point.backend == name(Backend::reference) ? "original" : point.solver;
}

const Point* cheapest(const Chart& chart, const std::string& name, double bound) {
  const Point* best = nullptr;
  for (const Point& point : chart.points) {
    const Outcome& outcome = point.outcome;
    if (contender(point) != name || !outcome.counts()) continue;
    if (outcome.max_strain > bound * kRounding) continue;
    if (!best || outcome.ms_per_frame < best->outcome.ms_per_frame) best = &point;
  }
  return best;
}

Json to_json(const Study& study) {
  Json json{{"points", points_json(study, false)}, {"order", Json::object()}};
  // A scheme that weft does not have yet has no order.
  for (const char* scheme : {"paper", "rattle"}) json["order"][scheme] = nullptr;
  json["order_points"] = Json::array();
  for (const Order& order : study.orders) {
    json["order"][order.scheme] = optional_json(order.order);
    for (const OrderPoint& point : order.points) {
      json["order_points"].push_back(
          {{"scheme", order.scheme}, {"dt", point.dt}, {"trajectory_error", point.error}});
    }
  }
  json["peers"] = points_json(study, true);
  json["bullet"] = study.bullet.empty() ? "not built in" : study.bullet;
  json["scenes"] = scenes_json(study);
  json["cheapest"] = cheapest_json(study);
  if (study.sizes) json["sizes"] = sizes_json(*study.sizes);
  json["quick"] = study.quick;
  return json;
}

std::string points_csv(const Study& study) {
  std::string csv =
      "scene,size,contender,solver,scheme,backend,substeps,tolerance,iterations,ms_per_frame,"
      "max_strain,mean_max_strain,trajectory_error,energy_gain,status,frames,counts\n";
  const auto field = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : "";
  };
  for (const Chart& chart : study.charts) {
    for (const Point& point : chart.points) {
      const Outcome& o = point.outcome;
      fmt::format_to(std::back_inserter(csv),
                     "{},{},{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{:.6g},{},{},{}\n",
                     chart.task.scene, chart.task.size, contender(point), point.solver,
                     point.scheme, point.backend, point.knobs.substeps,
                     field(point.knobs.tolerance), point.knobs.iterations, o.ms_per_frame,
                     o.max_strain, o.mean_max_strain, field(o.trajectory_error), o.energy_gain,
                     o.status, o.frames, o.counts());
    }
  }
  return csv;
}

std::string sizes_csv(const SizeStudy& study) {
  std::string csv = "scene,size,solver,substeps,ms_per_frame,max_strain,energy_gain,status\n";
  for (const SizeCurve& curve : study.curves) {
    for (const SizePoint& point : curve.points) {
      const Outcome& o = point.outcome;
      fmt::format_to(std::back_inserter(csv), "{},{},{},{},{:.6g},{:.6g},{:.6g},{}\n", study.scene,
                     point.size, curve.solver, point.substeps, o.ms_per_frame, o.max_strain,
                     o.energy_gain, o.status);
    }
  }
  return csv;
}

std::string to_text(const Study& study) {
  std::string text;
  const Text out = std::back_inserter(text);
  if (study.quick) fmt::format_to(out, "QUICK: few settings, small scenes.\n");
  fmt::format_to(out, "Bullet: {}\n\n",
                 study.bullet.empty() ? "not built in (tools/setup libbullet-dev)" : study.bullet);
  for (const Chart& chart : study.charts) {
    write_cheapest(out, chart);
    write_failures(out, chart);
  }
  if (!study.orders.empty()) write_orders(out, study.orders);
  if (study.sizes) write_sizes(out, *study.sizes);
  return text;
}

}  // namespace weft::tools::precision
