#include "tools/studies/precision/precision_command.h"

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
#include "tools/studies/plots/plotting.h"
#include "tools/studies/precision/bullet.h"
#include "tools/studies/precision/motion.h"
#include "tools/studies/precision/results.h"
#include "tools/studies/precision/results_json.h"
#include "tools/studies/precision/results_tables.h"
#include "tools/studies/precision/sweep.h"
#include "tools/studies/study_outputs.h"

namespace weft::tools {
namespace {

using namespace precision;

struct PrecisionOptions : StudyOptions {
  std::optional<std::string> scene;
  std::optional<int> size;
  std::optional<int> threads;  // charts: 1; cost against size: all
  std::optional<std::string> material;

  bool names_scene() const { return scene || size || material; }
};

/// `corners` has a middle row, and `four_pins` a middle, so their sizes are odd.
int default_size(const std::string& scene, bool quick) {
  const bool odd = scene == "corners" || scene == "four_pins";
  return (quick ? 20 : 40) + (odd ? 1 : 0);
}

Result<std::vector<Task>> tasks_of(const PrecisionOptions& options) {
  std::vector<std::string> scenes{"hang", "corners", "cape", "four_pins"};
  if (options.names_scene()) scenes = {options.scene.value_or(options.material ? "cape" : "hang")};
  std::vector<Task> tasks;
  for (const std::string& scene : scenes) {
    auto task = make_task(scene, options.size.value_or(default_size(scene, options.quick)),
                          options.material.value_or(""));
    if (!task) return Error{task.error()};
    if (!task.value().description.spheres.empty()) {
      return Error{
          fmt::format("--scene {}: has contacts, which the reference solution has not", scene)};
    }
    if (options.quick) task.value().frames = 100;
    task.value().threads = options.threads.value_or(1);
    tasks.push_back(std::move(task.value()));
  }
  return tasks;
}

/// The reference's step is a frame / 128 (quick: / 64).
int reference_parts(bool quick) { return quick ? 32 : 64; }

std::string size_text(const Task& task) {
  return task.is_line() ? fmt::format("of {}", task.size) : fmt::format("{0}x{0}", task.size);
}

Result<Chart> measure_chart(Task task, const PrecisionOptions& options, TaskLine& line) {
  Effort effort;
  if (options.quick) effort = {.repeat = 2, .seconds_limit = 0.5, .enough_seconds = 0.05};
  const auto watch = [&](const std::string& detail) { line.show(detail); };
  const std::string scene = fmt::format("{} {}", task.scene, size_text(task));

  line.next(scene + " reference solution");
  if (const auto done = add_reference(task, reference_parts(options.quick)); !done) {
    return Error{scene + ": " + done.error()};
  }
  Chart chart{std::move(task), {}, {}, effort.seconds_limit, {}};
  line.next(scene + " weft");
  for (const Curve& curve : weft_curves(chart.task, options.quick)) {
    auto points = sweep(chart.task, curve, effort,
                        [&](const std::string& detail) { watch(curve.label + ", " + detail); });
    if (!points) return Error{points.error()};
    for (Point& point : points.value()) chart.points.push_back(std::move(point));
    note_aims(chart, curve);
  }
  auto motion = measure_motion(chart.task, watch);
  if (!motion) return Error{motion.error()};
  chart.motion = std::move(motion.value());
  line.next(scene + " Bullet");
  if (chart.task.has_material()) return chart;  // it has no such springs
  for (Point& point : sweep_bullet(chart.task, effort, options.quick, watch)) {
    chart.points.push_back(std::move(point));
    chart.tightest["bullet"] = kBulletTightest;
  }
  return chart;
}

Result<std::vector<Order>> orders_of(bool quick, TaskLine& line) {
  std::vector<Order> orders;
  for (const std::string scene : {"hang", "corners"}) {
    auto task = make_task(scene, default_size(scene, true));
    if (!task) return Error{task.error()};
    line.next(fmt::format("orders of convergence, {} {}", scene, size_text(task.value())));
    task.value().frames = kReferenceFrame;
    if (const auto done = add_reference(task.value(), reference_parts(quick)); !done) {
      return Error{done.error()};
    }
    for (Order& order : measure_orders(task.value())) orders.push_back(std::move(order));
  }
  return orders;
}

Result<Study> carry_out(const std::vector<Task>& tasks, const PrecisionOptions& options) {
  const bool has_sizes = !options.names_scene();
  TaskLine line(3 * tasks.size() + 2 + (has_sizes ? 1 : 0));
  Study study;
  study.quick = options.quick;
  study.bullet = bullet_version();
  for (const Task& task : tasks) {
    auto chart = measure_chart(task, options, line);
    if (!chart) return Error{chart.error()};
    study.charts.push_back(std::move(chart.value()));
  }
  auto orders = orders_of(options.quick, line);
  if (!orders) return Error{orders.error()};
  study.orders = std::move(orders.value());
  if (has_sizes) {
    line.next("cost against size");
    study.sizes = size_study(options.quick);
    study.sizes->threads = options.threads.value_or(0);
    const auto done = measure(*study.sizes, [&](const std::string& detail) { line.show(detail); });
    if (!done) return Error{done.error()};
  }
  return study;
}

/// The data first: the pictures are drawn from it, and a machine without matplotlib keeps it.
Result<void> write_folder(const std::filesystem::path& folder, const Study& study) {
  if (auto done = write_file(folder / "points.csv", points_csv(study)); !done) return done;
  if (study.sizes) {
    if (auto done = write_file(folder / "sizes.csv", sizes_csv(*study.sizes)); !done) return done;
  }
  if (auto done = write_file(folder / "precision.md", to_markdown(study)); !done) return done;
  const std::string json = folder / "precision.json";
  if (auto done = write_json(json, to_json(study)); !done) return done;
  const auto drawn = plot("precision_charts.py", {json, "--out", folder});
  if (!drawn)
    print_message(fmt::format("weft: {}; the data is in {}\n", drawn.error(), folder.c_str()));
  return {};
}

int run_precision(const PrecisionOptions& options) {
  const auto tasks = tasks_of(options);
  if (!tasks) return refuse(tasks.error());
  auto outputs = StudyOutputs::open(options);
  if (!outputs) return refuse(outputs.error());
  const auto study = carry_out(tasks.value(), options);
  if (!study) return refuse(study.error());
  const auto done = outputs.value().write(
      to_text(study.value()), to_json(study.value()),
      [&](const std::filesystem::path& folder) { return write_folder(folder, study.value()); });
  return done ? kDone : refuse(done.error());
}

}  // namespace

void add_precision_command(CommandLine& line) {
  const auto options = std::make_shared<PrecisionOptions>();
  Verb verb = line.add_verb("precision",
                            "Measure error against time per frame: every solver, scheme and knob",
                            [options] { return run_precision(*options); });
  verb.option("--scene", options->scene,
              "only this built-in scene, without cost against size (default: hang, corners, a "
              "cape of ropes, four_pins, and cost against size). Not one with spheres, which the "
              "reference solution has not");
  verb.option("--size", options->size,
              "N of the scene (default 40, corners and four_pins 41; quick 20, 21)");
  verb.option("--material", options->material,
              "of a cape (default) or a flag: a name or a .json file, as of weft run; its true "
              "motion is that of very many small steps");
  add_study_options(verb, *options, "write CSV, JSON, tables and the charts into a folder",
                    "few settings on small scenes: about a minute");
  verb.within(1, kMaxThreads, "--threads", options->threads,
              "threads of every run (default 1; cost against size: all)");
}

}  // namespace weft::tools
