#include "tools/program/commands/run_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>

#include "tools/program/commands/run_progress.h"
#include "tools/program/files/json_output.h"
#include "tools/program/files/text_file.h"
#include "tools/program/measure/starts_inside.h"
#include "tools/program/measure/starts_tangled.h"
#include "tools/program/options/scene_source.h"
#include "tools/program/options/solver_options.h"
#include "tools/program/run/outputs.h"
#include "tools/program/run/run_report.h"
#include "tools/program/run/runner.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/terminal/interrupt.h"
#include "tools/program/text/file_ending.h"
#include "tools/program/text/parse.h"
#include "tools/program/text/wording.h"

namespace weft::tools {
namespace {

struct RunOptions {
  SceneOptions scene;
  SolverOptions solver;
  RunPlan plan;
  std::optional<std::string> dt;
  std::vector<std::string> out;
  std::optional<std::string> json;
  std::optional<std::string> save, resume, record;
};

Result<RunState> state_of(const RunOptions& options, const RunPlan& plan) {
  auto state = read_run_state(*options.resume);
  if (!state) return Error{fmt::format("--resume: {}", state.error())};
  const auto refused = [&](const std::string& why) {
    return Error{fmt::format("--resume: '{}' {}", *options.resume, why)};
  };
  const int frame = state.value().frame;
  const double dt = state.value().dt;
  if (dt != plan.dt)
    return refused(fmt::format("is of frames of {} s, and --dt is {}", dt, plan.dt));
  if (frame >= plan.steps)
    return refused(
        fmt::format("is of frame {}, and --steps {} asks for none after it", frame, plan.steps));
  for (const std::string& name : options.out) {
    if (const auto ending = file_ending(name); ending == ".pc2" || ending == ".glb" ||
                                               ending == ".pvd" || ending == ".html" ||
                                               ending == ".motion")
      return Error{fmt::format("--out: '{}' needs all frames, and --resume leaves out the first {}",
                               name, frame)};
  }
  return state;
}

Result<RunPlan> plan_of(const RunOptions& options) {
  RunPlan plan = options.plan;
  if (options.dt) {
    const auto seconds = parse_seconds("--dt", *options.dt);
    if (!seconds) return Error{seconds.error()};
    plan.dt = seconds.value();
  }
  if (plan.steps < 1) return Error{fmt::format("--steps: {} is below 1", plan.steps)};
  if (plan.repeat < 1) return Error{fmt::format("--repeat: {} is below 1", plan.repeat)};
  if (options.resume) {
    auto state = state_of(options, plan);
    if (!state) return Error{state.error()};
    plan.resume = std::move(state).value();
  }
  return plan;
}

/// Two outputs of one name, however it is spelt, would overwrite each other.
Result<void> check_destinations(const RunOptions& options) {
  struct Destination {
    std::filesystem::path place;
    std::string name;
  };
  std::vector<Destination> all;
  const auto add = [&all](const std::string& name) {
    std::error_code unknown;  // then it is told when the file is opened
    all.push_back({weakly_canonical(std::filesystem::absolute(name, unknown), unknown), name});
  };
  std::ranges::for_each(options.out, add);
  if (options.json && *options.json != "-") add(*options.json);
  if (options.save) add(*options.save);
  if (options.record) add(*options.record);
  std::ranges::stable_sort(all, {}, &Destination::place);
  const auto twice = std::ranges::adjacent_find(all, {}, &Destination::place);
  if (twice == all.end() || twice->place.empty()) return {};
  return Error{fmt::format("--out, --json, --save, --record: '{}' is named twice", twice->name)};
}

/// What is known to be possible before anything runs.
struct Prepared {
  SceneSource source;
  std::shared_ptr<const Model> model;
  Settings settings;
  RunPlan plan;
  std::optional<JsonOutput> json;
  std::optional<StateFile> state;
  std::size_t tangled = 0;  ///< pairs of triangles, in the scene
};

Result<Prepared> prepare(const RunOptions& options) {
  auto plan = plan_of(options);
  if (!plan) return Error{plan.error()};
  if (auto names = check_destinations(options); !names) return Error{names.error()};
  const auto settings = settings_of(options.solver);
  if (!settings) return Error{settings.error()};
  auto source = load_scene(options.scene);
  if (!source) return Error{source.error()};
  auto model = model_of(source.value());
  if (!model) return Error{model.error()};
  const std::size_t tangled = starts_tangled(source.value().description);
  if (tangled > 0) {
    source.value().description.self_contact.untangle = true;
    model = build_model(source.value().description);
  }
  plan.value().moves = source.value().moves;
  plan.value().bodies = source.value().bodies;
  plan.value().events = source.value().events;
  plan.value().rest_scale = source.value().rest_scale;
  plan.value().velocities = source.value().description.velocities;
  plan.value().surface = source.value().description.surface;
  plan.value().touches_itself = source.value().description.self_contact.on;
  plan.value().scene = source.value().title();
  plan.value().record = options.record;
  plan.value().up = source.value().up;
  plan.value().fabric = FabricMeasure(source.value().description, source.value().mesh.cells);
  Prepared prepared{std::move(source.value()),
                    model.value(),
                    settings.value(),
                    std::move(plan.value()),
                    std::nullopt,
                    std::nullopt,
                    tangled};
  if (options.json) {
    auto json = JsonOutput::open(*options.json);
    if (!json) return Error{fmt::format("--json: {}", json.error())};
    prepared.json = std::move(json.value());
  }
  if (options.save) {
    auto state = StateFile::open(*options.save, prepared.plan.dt, *prepared.model);
    if (!state) return Error{fmt::format("--save: {}", state.error())};
    prepared.state = std::move(state.value());
  }
  return prepared;
}

Result<RunSummary> run_and_record(Prepared& prepared, Outputs& outputs) {
  RunPlan plan = prepared.plan;
  RunProgress progress(plan);
  bool stopped = false;
  plan.stop = [&] {
    progress.add_frame();
    return stopped = OrderlyInterrupt::signal() != 0;
  };
  const auto on_frame = [&](int frame, const Cloth& cloth, const StepReport& report) {
    const bool is_done = committed(report.status);
    const int done = is_done ? frame : frame - 1;
    if (is_done) outputs.add_frame(cloth, report, frame, plan.dt * frame);
    if (is_done && prepared.state) prepared.state->add_frame(cloth, frame);
    if (frame == plan.steps || !is_done || stopped) {
      outputs.add_last(cloth, plan.dt * done);
      if (prepared.state) prepared.state->add_last(cloth, done);
    }
    progress.show(report.max_strain);
  };
  return run(prepared.model, prepared.settings, plan, on_frame);
}

/// What begins inside a body, a line for each body. What goes on began elsewhere.
void tell_what_begins_inside(const SceneSource& source, const Prepared& prepared) {
  if (prepared.plan.resume) return;
  for (const auto& [body, particles] :
       starts_inside(source.description, source.bodies, prepared.settings.contact_tolerance)) {
    print_message(fmt::format("weft: {} of the cloth {} inside body {}, and {} pushed out\n",
                              counted(particles, "particle"), particles == 1 ? "begins" : "begin",
                              body, particles == 1 ? "is" : "are"));
  }
}

/// Where the cloth crosses itself. What goes on began elsewhere.
void tell_what_begins_tangled(const Prepared& prepared) {
  if (prepared.plan.resume || prepared.tangled == 0) return;
  print_message(fmt::format("weft: {} of triangles of the cloth {} tangled, and {} drawn apart\n",
                            counted(prepared.tangled, "pair"),
                            prepared.tangled == 1 ? "begins" : "begin",
                            prepared.tangled == 1 ? "is" : "are"));
}
/// When the run is over.
void tell_what_is_tangled(const Prepared& prepared, const RunSummary& summary) {
  if (prepared.plan.resume || prepared.tangled == 0) return;
  const int left = summary.total.tangled;
  print_message(left == 0 ? std::string("weft: what began tangled has come out\n")
                          : fmt::format("weft: {} of triangles {} tangled in the end\n",
                                        counted(left, "pair"), left == 1 ? "is" : "are"));
}

/// Files are those of the first run, the report is that of the fastest.
std::string interruption(const RunSummary& summary, const RunPlan& plan) {
  if (summary.finished_runs == 0) {
    return fmt::format("in frame {} of {}, the last one in all that was written",
                       summary.last_frame(), plan.steps);
  }
  const int finished_repeats = summary.finished_runs - 1;
  return fmt::format("in repeat {} of {}; the report is that of {}", summary.finished_runs,
                     plan.repeat,
                     finished_repeats == 0 ? "the run to warm up" : "the fastest before it");
}

int interrupted(const RunSummary& summary, const RunPlan& plan) {
  print_message(fmt::format("weft: interrupted {}\n", interruption(summary, plan)));
  return interrupted_by(OrderlyInterrupt::signal());
}

Result<int> run_verb(const RunOptions& options) {
  auto prepared = prepare(options);
  if (!prepared) return Error{prepared.error()};
  auto& [source, model, settings, plan, json, state, tangled] = prepared.value();
  for (const std::string& note : source.notes) print_message(fmt::format("weft: {}\n", note));
  tell_what_begins_inside(source, prepared.value());
  tell_what_begins_tangled(prepared.value());
  const OrderlyInterrupt interrupt;
  auto outputs = Outputs::open(options.out, source, model, settings, plan.dt);
  if (!outputs) return Error{outputs.error()};
  auto summary = run_and_record(prepared.value(), outputs.value());
  if (!summary) return Error{summary.error()};
  tell_what_is_tangled(prepared.value(), summary.value());

  const RunReport report{source.title(), settings, plan, summary.value(), source.counts};
  if (auto finished = outputs.value().finish(); !finished) {
    return Error{fmt::format("--out: {}", finished.error())};
  }
  if (state) {
    if (auto saved = state->finish(); !saved)
      return Error{fmt::format("--save: {}", saved.error())};
  }
  if (json) {
    auto written = json->write(to_json(report));
    if (!written) return Error{fmt::format("--json: {}", written.error())};
  }
  if (!json || !json->is_stdout()) {
    const auto printed = print_text(to_table(report));
    const bool hung_up = OrderlyInterrupt::signal() == SIGHUP;  // and nobody reads any more
    if (!printed && !hung_up) return Error{printed.error()};
  }
  if (summary.value().stopped) return interrupted(summary.value(), plan);
  if (summary.value().reached_tolerance()) return kDone;
  return missed_tolerance(text(*summary.value().first_miss));
}

}  // namespace

void add_run_command(CommandLine& line) {
  auto options = std::make_shared<RunOptions>();
  Verb verb = line.add_verb("run", "Run a scene; report time beside error", [options] {
    const auto result = run_verb(*options);
    return result ? result.value() : refuse(result.error());
  });
  add_scene_options(verb, options->scene);
  verb.group("The run");
  verb.option("--dt", options->dt, "s, one frame: 0.01 (default), or as 1/60");
  verb.option("--steps", options->plan.steps, "frames to run (default 200)");
  verb.option("--repeat", options->plan.repeat,
              "report the fastest of this many runs, after one to warm up (default 1: a "
              "single run)");
  verb.flag(
      "--check-intersections", options->plan.check_intersections,
      "count after every frame how many triangles of the cloth cross triangles of bodies, and "
      "with --self-contact of the cloth");
  verb.group("How it is solved");
  add_solver_options(verb, options->solver);
  verb.group("Files");
  verb.repeated("--out", options->out,
                "file to write, may be repeated: .obj the last frame, .pc2 the motion of all "
                "frames, .glb the same as glTF, .pvd the same for ParaView, .html a page that "
                "shows the run in a browser, .motion what such a page "
                "shows, for `weft view`, .json the last state as a scene; frame_%04d.obj or .json "
                "a file for the "
                "start and each frame");
  verb.option("--save", options->save,
              "file that has the state of the run, to go on from: written anew about once a second "
              "and in the end, so that one is there whenever the run is killed");
  verb.option("--resume", options->resume,
              "file of --save to go on from, to the same bits if all other options are as they "
              "were; --steps counts its frames too");
  verb.option("--record", options->record,
              "file that has all that the run did, for a report of a bug: `weft replay FILE` runs "
              "it again, and names the first frame that comes to other bits");
  verb.option("--json", options->json, "write the report to a file, or - for stdout");
}

}  // namespace weft::tools
