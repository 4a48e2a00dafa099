#include "tools/studies/precision/results_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "tools/program/text/wording.h"

namespace weft::tools::precision {
namespace {

using Text = std::back_insert_iterator<std::string>;

std::string knobs_text(const Knobs& knobs) {
  const std::string goal =
      knobs.tolerance ? percent(*knobs.tolerance) : counted(knobs.iterations, "iteration");
  return fmt::format("{}, {}", goal, substeps_text(knobs.substeps));
}

/// "rattle, "; nothing for peers and where it is automatic.
std::string scheme_text(const Point& point) {
  const bool named = !point.scheme.empty() && point.scheme != name(Scheme::automatic);
  return named ? point.scheme + ", " : "";
}

std::string error_text(const std::optional<double>& error) {
  return error ? fmt::format("{:.3g} mm", 1000 * *error) : "-";
}

std::string no_energy() {
  return fmt::format("never more than {:g} J above its start", kEnergyBound);
}

std::string limit(const Chart& chart) { return fmt::format("{:.3g} ms", chart.ms_limit()); }

std::string gap_text(const Chart& chart, const std::string& name, double bound) {
  switch (gap(chart, name, bound)) {
    case Gap::not_aimed_at:
      return "-";
    case Gap::out_of_time:
      return "over " + limit(chart);
    case Gap::failed:
      break;
  }
  return "never";
}

/// What stands where there is no setting. All charts of a study have the same limits.
std::string legend(const Chart& chart) {
  const std::string threads = chart.task.threads == 1 ? "" : ", all threads together";
  return fmt::format(
      "A run is cut at {:g} s of processor time{}: {} a frame over {}.\n"
      "'over {}': no setting kept the bound, and some were cut. '-': no setting of this sweep\n"
      "aims at the bound. 'never': all that aim at it failed.\n",
      chart.seconds_limit, threads, limit(chart), counted(chart.task.frames, "frame"),
      limit(chart));
}

void write_cheapest(Text out, const Chart& chart) {
  const Task& task = chart.task;
  fmt::format_to(out,
                 "{}, size {}, {} of {} s, {}: the cheapest setting that keeps every strain within "
                 "the bound\nand gains no energy ({}). Trajectory errors at {} s; the reference's "
                 "own is about {:.2g} mm ({}).\n",
                 task.scene, task.size, counted(task.frames, "frame"), kFrame,
                 counted(task.threads, "thread"), no_energy(), kFrame * kReferenceFrame,
                 1000 * task.reference_error, task.reference_by);
  fmt::format_to(out, "{:>9}  {:14}{:>13}{:>10}{:>13}{:>13}  {}\n", "bound", "", "ms per frame",
                 "x auto", "max strain", "trajectory", "setting");
  for (const double bound : kBounds) {
    const Point* plain = cheapest(chart, "auto", bound);
    for (const std::string& name : contenders(chart)) {
      const Point* point = cheapest(chart, name, bound);
      if (!point) {
        fmt::format_to(out, "{:>9}  {:14}{:>13}\n", percent(bound), name,
                       gap_text(chart, name, bound));
        continue;
      }
      const double ms = point->outcome.ms_per_frame;
      fmt::format_to(out, "{:>9}  {:14}{:13.4g}{:>10}{:>13}{:>13}  {}{}\n", percent(bound), name,
                     ms, plain ? fmt::format("{:.1f}", ms / plain->outcome.ms_per_frame) : "-",
                     measured_percent(point->outcome.max_strain),
                     error_text(point->outcome.trajectory_error), scheme_text(*point),
                     knobs_text(point->knobs));
    }
  }
  fmt::format_to(out, "\n");
}

/// "0.023 (43 mm)": ms per frame, and how far from the true motion.
std::string markdown_cell(const Chart& chart, const std::string& name, double bound) {
  const Point* point = cheapest(chart, name, bound);
  if (!point) return gap_text(chart, name, bound);
  const auto& error = point->outcome.trajectory_error;
  const std::string cost = fmt::format("{:.3g}", point->outcome.ms_per_frame);
  if (!error) return cost;
  const double mm = 1000 * *error;
  return mm < 10 ? fmt::format("{} ({:.2g} mm)", cost, mm)
                 : fmt::format("{} ({:.0f} mm)", cost, mm);
}

void write_markdown_row(Text out, const Chart& chart, double bound) {
  const auto ms = [&](const std::string& name) -> std::optional<double> {
    const Point* point = cheapest(chart, name, bound);
    return point ? std::optional(point->outcome.ms_per_frame) : std::nullopt;
  };
  fmt::format_to(out, "| {} |", percent(bound));
  for (const std::string& name : contenders(chart)) {
    fmt::format_to(out, " {} |", markdown_cell(chart, name, bound));
  }
  const auto plain = ms("auto");
  for (const char* other : {"gauss_seidel", "bullet"}) {
    const auto cost = ms(other);
    fmt::format_to(out, " {} |", plain && cost ? factor_text(*cost / *plain) : "");
  }
  fmt::format_to(out, "\n");
}

void write_markdown(Text out, const Chart& chart) {
  fmt::format_to(out, "| {} {}, ms per frame |", chart.task.scene,
                 chart.task.is_line() ? fmt::format("of {}", chart.task.size)
                                      : fmt::format("{}²", chart.task.size));
  std::string rule = "|---|---|---|";
  for (const std::string& name : contenders(chart)) {
    fmt::format_to(out, " {} |", name);
    rule += "---|";
  }
  fmt::format_to(out, " gauss_seidel / auto | bullet / auto |\n{}\n", rule);
  for (const double bound : kBounds) write_markdown_row(out, chart, bound);
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

/// The largest distance from the true motion over time, beside what was asked for.
void write_motion(Text out, const Chart& chart) {
  if (chart.motion.empty()) return;
  fmt::format_to(
      out,
      "{}, size {}: motion_tolerance and the largest distance from the true motion after "
      "{:g} s, over that time\n{:>14}{:>14}{:>14}{:>10}{:>10}{:>14}\n",
      chart.task.scene, chart.task.size, kFrame * kReferenceFrame, "asked, mm/s", "got",
      "estimated", "got/asked", "substeps", "ms per frame");
  for (const MotionPoint& point : chart.motion) {
    const bool any = point.asked > 0;
    fmt::format_to(out, "{:>14}{:14.3g}{:14.3g}{:>10}{:10.3g}{:14.3g}\n",
                   any ? fmt::format("{:g}", 1000 * point.asked) : "-", 1000 * point.got,
                   1000 * point.estimated,
                   any ? fmt::format("{:.2f}", point.got / point.asked) : "-", point.substeps,
                   point.ms_per_frame);
  }
  fmt::format_to(out, "\n");
}

/// Of all orders of a scene, the longest first.
std::vector<double> steps_of(std::span<const Order> orders) {
  std::set<double, std::greater<>> steps;
  for (const Order& order : orders) {
    for (const OrderPoint& point : order.points) steps.insert(point.dt);
  }
  return {steps.begin(), steps.end()};
}

void write_orders_of_scene(Text out, std::span<const Order> orders) {
  const std::vector<double> steps = steps_of(orders);
  fmt::format_to(out, "Order of convergence on {}, trajectory error in mm by dt\n{:10}",
                 orders.front().scene, "");
  for (const double step : steps) fmt::format_to(out, "{:>12g}", step);
  fmt::format_to(out, "{:>9}\n", "order");
  for (const Order& order : orders) {
    fmt::format_to(out, "{:10}", order.scheme);
    for (const double step : steps) {
      const auto point = std::ranges::find(order.points, step, &OrderPoint::dt);
      const bool measured = point != order.points.end();
      fmt::format_to(out, "{:>12}", measured ? fmt::format("{:.4g}", 1000 * point->error) : "");
    }
    fmt::format_to(out, "{:>9}\n", order.order ? fmt::format("{:.2f}", *order.order) : "-");
  }
  fmt::format_to(out, "\n");
}

void write_orders(Text out, std::span<const Order> orders) {
  while (!orders.empty()) {
    const auto other = std::ranges::find_if(
        orders, [&](const Order& order) { return order.scene != orders.front().scene; });
    const auto count = static_cast<std::size_t>(other - orders.begin());
    write_orders_of_scene(out, orders.first(count));
    orders = orders.subspan(count);
  }
}

void write_sizes(Text out, const SizeStudy& study) {
  fmt::format_to(out, "Cost against size: {}, {}, {} frames, {}\n{:>14}{:14}{:>13}{:>11}{:>13}\n",
                 study.scene, percent(study.tolerance), study.frames,
                 study.threads == 0 ? "all threads" : fmt::format("threads: {}", study.threads),
                 "size  ", "solver", "ms per frame", "substeps", "max strain");
  for (const SizeCurve& curve : study.curves) {
    for (const SizePoint& point : curve.points) {
      fmt::format_to(out, "{:>14}{:14}{:13.4g}{:11.3g}{:>13}\n",
                     fmt::format("{0} x {0}  ", point.size), curve.solver,
                     point.outcome.ms_per_frame, point.outcome.substeps,
                     measured_percent(point.outcome.max_strain));
    }
    if (curve.exponent) {
      fmt::format_to(out, "{:>14}{:14}time ~ particles^{:.2f}\n", "", curve.solver,
                     *curve.exponent);
    }
    if (!curve.end.empty()) fmt::format_to(out, "{:>14}{:14}{}\n", "", curve.solver, curve.end);
  }
}

}  // namespace

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

std::string to_markdown(const Study& study) {
  std::string text;
  const Text out = std::back_inserter(text);
  for (const Chart& chart : study.charts) write_markdown(out, chart);
  if (study.charts.empty()) return text;
  fmt::format_to(
      out,
      "ms per frame of the cheapest setting that keeps every strain within the bound and gains no\n"
      "energy ({}), in brackets how far a particle is from\n"
      "the true motion after {:g} s at most.\n{}",
      no_energy(), kFrame * kReferenceFrame, legend(study.charts.front()));
  return text;
}

std::string to_text(const Study& study) {
  std::string text;
  const Text out = std::back_inserter(text);
  if (study.quick) fmt::format_to(out, "QUICK: few settings, small scenes.\n");
  fmt::format_to(out, "Bullet: {}\n\n",
                 study.bullet.empty() ? "not built in (tools/setup libbullet-dev)" : study.bullet);
  if (!study.charts.empty()) fmt::format_to(out, "{}\n", legend(study.charts.front()));
  for (const Chart& chart : study.charts) {
    write_cheapest(out, chart);
    write_failures(out, chart);
    write_motion(out, chart);
  }
  write_orders(out, study.orders);
  if (study.sizes) write_sizes(out, *study.sizes);
  return text;
}

}  // namespace weft::tools::precision
