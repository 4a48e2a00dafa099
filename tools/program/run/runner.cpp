#include "tools/program/run/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "engine/model/model.h"
#include "engine/model/saved_model.h"
#include "engine/model/threads.h"
#include "tools/program/measure/cpu_time.h"
#include "tools/program/run/frame_calls.h"
#include "tools/program/run/step_total.h"
#include "tools/program/run/warm_up.h"
#include "tools/program/text/wording.h"
#include "tools/scenes/anchor_moves.h"
#include "tools/scenes/body_moves.h"
#include "tools/scenes/mesh.h"

namespace weft::tools {
namespace {

using Clock = std::chrono::steady_clock;

double lowest_of(const Cloth& cloth, double Vec3::*up) {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
    lowest = std::min(lowest, cloth.position(i).*up);
  }
  return lowest;
}

/// Also of a frame that had no tolerance, but a number of iterations to do.
bool is_reached(Status status) {
  return status == Status::converged || status == Status::fixed_iterations;
}

void look_for_miss(RunSummary& summary, const StepReport& report) {
  if (is_reached(report.status)) return;
  ++summary.missed_frames;
  if (summary.first_miss) return;
  summary.first_miss = {.frame = summary.last_frame(),
                        .status = report.status,
                        .max_error = report.max_error,
                        .max_strain = report.max_strain,
                        .max_penetration = report.max_penetration,
                        .constraint = report.worst_constraint,
                        .failed_particle = report.failed_particle,
                        .passed_particle = report.passed_particle,
                        .late_seam = report.late_seams > 0 ? report.worst_seam : kNoIndex,
                        .held = report.worst_held};
}

void add_work(RunSummary& summary, const StepReport& report) {
  add_step(summary.total, report);
  summary.asleep_frames += report.asleep ? 1 : 0;
  summary.mean_motion_error += (report.motion_error - summary.mean_motion_error) / summary.frames;
  summary.solver_seconds = 0;
  for (std::size_t stage = 0; stage < kStageCount; ++stage) {
    const bool is_report = static_cast<Stage>(stage) == Stage::report;
    if (!is_report) summary.solver_seconds += summary.total.stage_seconds[stage];
  }
}

/// What a run sums up frame by frame before it can be averaged.
struct Errors {
  double strain_sum = 0;         ///< of the frames' largest strains
  double square_strain_sum = 0;  ///< of the frames' mean squares
};

void add_errors(RunSummary& summary, Errors& errors, const Cloth& cloth, const RunPlan& plan) {
  const Strain strain = cloth.strain();
  summary.max_strain = std::max(summary.max_strain, strain.max);
  errors.strain_sum += strain.max;
  errors.square_strain_sum += strain.rms * strain.rms;
  if (!plan.fabric.is_empty())
    summary.fabric = largest(summary.fabric.value_or(FabricStrain{}), plan.fabric(cloth));
  summary.total.max_penetration = std::max(summary.total.max_penetration, cloth.max_penetration());
  summary.lowest = std::min(summary.lowest, lowest_of(cloth, plan.up));
  const double gain = cloth.energy().total() - summary.energy_start - summary.total.pin_work -
                      summary.total.body_work;
  summary.energy_gain = summary.frames == 1 ? gain : std::max(summary.energy_gain, gain);
}

Result<void> begin_recording(Cloth& cloth, const RunPlan& plan, int frames_before) {
  if (!plan.record) return {};
  const std::string note = frames_before == 0
                               ? plan.scene
                               : fmt::format("after frame {}, {}", frames_before, plan.scene);
  const auto begun = cloth.begin_recording(*plan.record, note);
  return begun ? Result<void>{} : Error{fmt::format("--record: {}", begun.error())};
}

Result<void> end_recording(Cloth& cloth, const RunPlan& plan) {
  if (!plan.record) return {};
  const auto ended = cloth.end_recording();
  return ended ? Result<void>{} : Error{fmt::format("--record: {}", ended.error())};
}

/// Threads, which an edge of a triangle is when its two others have no length.
TriangleSet with_threads(const TriangleSet& surface, const Model& model) {
  TriangleSet all = surface;
  for (const auto& [a, b] : threads_of(model)) all.triangles.push_back({a, b, b});
  return all;
}

/// The surface is that of the cloth, with its threads.
void look_for_crossings(RunSummary& summary, const Cloth& cloth, const RunPlan& plan,
                        TriangleSet& surface) {
  surface.places = particle_positions(cloth);
  const TriangleSet bodies = meshes_at(plan.bodies, summary.frames * plan.dt);
  std::size_t count = count_crossings(surface, bodies);
  if (plan.touches_itself) count += count_crossings(surface);
  summary.intersections = std::max(summary.intersections.value_or(0), count);
}

/// Of the first frame in which the report says that something crosses, and that ends so.
void name_what_crosses(RunSummary& summary, const StepReport& report, const Cloth& cloth,
                       const RunPlan& plan, TriangleSet& surface) {
  if (report.intersecting == 0 || !summary.first_miss || summary.first_miss->crossing.count > 0)
    return;
  Miss& miss = *summary.first_miss;
  surface.places = particle_positions(cloth);
  miss.crossing_frame = summary.last_frame();
  miss.crossing = name_crossing(surface, plan.bodies, miss.crossing_frame * plan.dt);
  if (miss.crossing.count == 0 && miss.inside == 0) miss.inside = report.intersecting;
}

std::vector<FreeBodyEnd> ends_of_free_bodies(const Cloth& cloth,
                                             const std::vector<SceneBody>& bodies) {
  std::vector<FreeBodyEnd> ends;
  for (std::uint32_t id = 0; id < bodies.size(); ++id) {
    if (!bodies[id].mass) continue;
    const Pose pose = cloth.body_pose(id).value();
    ends.push_back({id, pose, centre_of_mass(bodies[id], pose)});
  }
  return ends;
}

void finish(RunSummary& summary, const Errors& errors, const Cloth& cloth) {
  const double frames = std::max(summary.frames, 1);
  summary.mean_max_strain = errors.strain_sum / frames;
  summary.rms_strain = std::sqrt(errors.square_strain_sum / frames);
  summary.solver = cloth.settings().solver;
  summary.scheme = cloth.settings().scheme;
  summary.isa = cloth.settings().isa;
  summary.energy_end = cloth.energy().total();
  summary.state_hash = cloth.state_hash();
  summary.model = describe(*cloth.model());
  summary.bytes = cloth.bytes() + summary.model.bytes;
}

/// The scene begins with some events: they move no particle.
Result<void> begin_scene(const RunPlan& plan, const MovedAnchors& anchors, Events& events,
                         GrowingRest& rest, MovedPins& pins, Cloth& cloth) {
  const std::vector<Vec3> positions = particle_positions(cloth);
  if (auto grown = rest.grow(cloth, 0); !grown) return grown;
  if (auto happened = events.happen(0, cloth, pins); !happened) return happened;
  if (auto sent = anchors.send(cloth, 0); !sent) return sent;
  if (events.count() > 0 || anchors.any() || rest.has_grown()) {
    if (auto put = cloth.write_positions(positions); !put) return put;
    if (!plan.velocities.empty()) {
      if (auto thrown = cloth.write_velocities(plan.velocities); !thrown) return thrown;
    }
  }
  return pins.place(cloth);
}

/// That of the state, whose cloth has torn. model: that of the scene.
Result<Cloth> torn_cloth(const RunState& state, const Model& model, const Settings& settings) {
  if (state.scene != fingerprint(model)) return Error{"state: is of another model (torn)"};
  const auto loaded = load_model(state.torn);
  if (!loaded) return Error{loaded.error()};
  auto torn = std::make_shared<Model>(*loaded.value());
  torn->tears = state.tears;
  return Cloth::create(std::move(torn), settings);
}

/// The bodies are those that were added, where they had come to.
Result<void> go_on(const RunPlan& plan, const Model& model, const Settings& settings,
                   Events& events, GrowingRest& rest, MovedPins& pins, Cloth& cloth) {
  const RunState& state = *plan.resume;
  auto happened = events.happen((state.frame - 1) * plan.dt, cloth, pins);  // for its model
  if (!happened) return happened;
  const double time = state.frame * plan.dt;
  Result<void> loaded;
  if (state.torn.empty()) {
    if (auto grown = rest.grow(cloth, time); !grown) return grown;
    loaded = cloth.load_state(state.cloth);
  } else if (auto torn = torn_cloth(state, model, settings); !torn) {
    loaded = Error{torn.error()};
  } else if (loaded = torn.value().load_state(state.cloth); loaded) {
    cloth = std::move(torn).value();
    rest.go_on_torn(cloth, time);
  }
  if (loaded) return {};
  return Error{fmt::format(
      "--resume: {}; a run goes on with the mesh, the material and the wind that it began with",
      loaded.error())};
}

Result<RunSummary> run_once(const std::shared_ptr<const Model>& model, const Settings& settings,
                            const RunPlan& plan, const FrameCallback& on_frame) {
  auto created = Cloth::create(model, settings);
  if (!created) return Error{created.error()};
  Cloth& cloth = created.value();

  MovedPins pins(plan.moves, cloth);
  const MovedAnchors anchors(plan.moves, cloth);
  Events events(plan.events);
  GrowingRest rest(plan.rest_scale, cloth);
  if (auto begun = begin_scene(plan, anchors, events, rest, pins, cloth); !begun)
    return Error{begun.error()};
  auto bodies = MovedBodies::add(plan.bodies, cloth);
  if (!bodies) return Error{bodies.error()};
  RunSummary summary;
  Errors errors;
  if (plan.resume) {
    auto gone_on = go_on(plan, *model, settings, events, rest, pins, cloth);
    if (!gone_on) return Error{gone_on.error()};
    summary.resumed_at = plan.resume->frame;
  }
  if (auto begun = begin_recording(cloth, plan, summary.resumed_at); !begun)
    return Error{begun.error()};
  TriangleSet surface{{}, plan.surface}, touched;
  if (plan.check_intersections) touched = with_threads(surface, *model);
  summary.energy_start = cloth.energy().total();
  summary.lowest = std::numeric_limits<double>::infinity();
  while (summary.last_frame() < plan.steps && summary.cpu_seconds < plan.seconds_limit &&
         committed(summary.total.status) && !summary.stopped) {
    const double begin_of_frame = summary.last_frame() * plan.dt;
    const double end_of_frame = (summary.last_frame() + 1) * plan.dt;
    if (auto done = events.happen(begin_of_frame, cloth, pins); !done) return Error{done.error()};
    if (auto grown = rest.grow(cloth, end_of_frame); !grown) return Error{grown.error()};
    const FrameCalls calls = calls_at(pins, bodies.value(), cloth, end_of_frame);
    if (auto done = apply(calls, cloth); !done) return Error{done.error()};
    if (auto sent = anchors.send(cloth, end_of_frame); !sent) return Error{sent.error()};
    const double cpu_start = cpu_seconds();
    const auto start = Clock::now();
    const auto report = cloth.step(plan.dt);
    const std::chrono::duration<double> elapsed = Clock::now() - start;
    summary.cpu_seconds += cpu_seconds() - cpu_start;
    if (!report) return Error{report.error()};
    add_frame(summary, report.value());
    summary.step_seconds += elapsed.count();
    summary.longest_step_seconds = std::max(summary.longest_step_seconds, elapsed.count());
    add_errors(summary, errors, cloth, plan);
    name_what_crosses(summary, report.value(), cloth, plan, surface);
    if (plan.check_intersections) look_for_crossings(summary, cloth, plan, touched);
    summary.stopped = plan.stop && plan.stop();
    if (on_frame) on_frame(summary.last_frame(), cloth, report.value());
  }
  if (auto ended = end_recording(cloth, plan); !ended) return Error{ended.error()};
  summary.finished_runs = summary.stopped ? 0 : 1;
  finish(summary, errors, cloth);
  summary.free_bodies = ends_of_free_bodies(cloth, plan.bodies);
  return summary;
}

Result<RunSummary> run_repeatedly(const std::shared_ptr<const Model>& model,
                                  const Settings& settings, const RunPlan& plan,
                                  const FrameCallback& on_frame) {
  auto best = run_once(model, settings, plan, on_frame);
  if (!best || plan.repeat <= 1 || best.value().stopped) return best;
  RunPlan again = plan;
  again.record.reset();
  for (int finished = 1; finished <= plan.repeat; ++finished) {
    auto next = run_once(model, settings, again, {});
    if (!next) return next;
    if (next.value().stopped) {  // a whole run is worth more than a part of one
      best.value().stopped = true;
      break;
    }
    const bool is_first = finished == 1;  // the run before it was to warm up
    if (is_first || next.value().step_seconds < best.value().step_seconds) best = std::move(next);
    best.value().finished_runs = finished + 1;
  }
  return best;
}

}  // namespace

void add_frame(RunSummary& summary, const StepReport& report) {
  ++summary.frames;
  look_for_miss(summary, report);
  add_work(summary, report);
}

std::string text(const Miss& miss) {
  const std::string end = fmt::format("frame {}: {}", miss.frame, name(miss.status));
  if (miss.failed_particle != kNoIndex) {
    return fmt::format("{} at particle {}", end, miss.failed_particle);
  }
  if (miss.passed_particle != kNoIndex) {
    return fmt::format("{}; particle {} went through a sphere", end, miss.passed_particle);
  }
  const std::string contacts =
      miss.max_penetration > 0
          ? fmt::format("; contacts are up to {:.3g} m deep", miss.max_penetration)
          : "";
  if (const NamedCrossing& crossing = miss.crossing; crossing.count > 0) {
    const Vec3 at = crossing.place;
    return fmt::format(
        "{}; triangle {} of the cloth crosses body {} at ({:.4g}, {:.4g}, {:.4g}) m in frame {}, "
        "one "
        "of {}{}",
        end, crossing.triangle, crossing.body, at.x, at.y, at.z, miss.crossing_frame,
        counted(crossing.count, "crossing"), contacts);
  }
  if (miss.inside > 0) {
    return fmt::format("{}; {} of the cloth {} inside a body{}", end,
                       counted(miss.inside, "particle"), miss.inside == 1 ? "is" : "are", contacts);
  }
  if (miss.held != kNoIndex) {
    return fmt::format("{}; constraint {} is between two held particles that exclude it{}", end,
                       miss.held, contacts);
  }
  if (miss.late_seam != kNoIndex)
    return fmt::format("{}; seam {} is open after its time{}", end, miss.late_seam, contacts);
  if (miss.constraint == kNoIndex) return end + contacts;
  return fmt::format("{}; constraint {} has the largest strain, {}{}", end, miss.constraint,
                     measured_percent(miss.max_strain), contacts);
}

Result<RunSummary> run(std::shared_ptr<const Model> model, const Settings& settings,
                       const RunPlan& plan, const FrameCallback& on_frame) {
  if (settings.threads < 0 || settings.threads > kMaxThreads) {
    return Error{"threads: must be from 0 to " + std::to_string(kMaxThreads) + " (" +
                 std::to_string(settings.threads) + ")"};
  }
  const int threads = settings.threads > 0
                          ? settings.threads
                          : std::min(tbb::info::default_concurrency(), kMaxThreads);
  const tbb::global_control at_most(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(std::max(threads, 2)));
  tbb::task_arena arena(threads);
  auto result = arena.execute([&] {
    if (threads > 1) warm_up(threads);
    return run_repeatedly(model, settings, plan, on_frame);
  });
  if (result) result.value().threads = threads;
  return result;
}

Result<RunSummary> run(const SceneDescription& scene, const Settings& settings, const RunPlan& plan,
                       const FrameCallback& on_frame) {
  auto model = build_model(scene);
  if (!model) return Error{model.error()};
  return run(model.value(), settings, plan, on_frame);
}

}  // namespace weft::tools
