#include "tools/studies/hard/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tools/program/measure/cpu_time.h"
#include "tools/program/text/wording.h"
#include "tools/studies/hard/mesh_oracle.h"

namespace weft::tools::hard {
namespace {

/// Two computations of one error may round differently.
constexpr double kRounding = 1e-9;
/// m: those of bodies are computed in floats.
constexpr double kRoundingOfBodies = 5e-6;
/// Of a body's thickness: what goes deeper than that below its own surface was on the way through.
constexpr double kDeep = 2;

bool tells_the_truth(const StepReport& report, const Settings& settings, double strain,
                     double rigid_strain, double penetration, bool bodies) {
  if (std::abs(report.max_strain - strain) > kRounding * (1 + strain)) return false;
  const double rounded = bodies ? kRoundingOfBodies : kRounding * (1 + penetration);
  if (std::abs(report.max_penetration - penetration) > rounded) return false;
  if (report.status != Status::converged) return true;
  const double error = std::max(rigid_strain, report.max_error);  // nobody else knows of tensions
  return error <= settings.tolerance * (1 + 1e-6) + kRounding &&
         penetration <= settings.contact_tolerance * (1 + 1e-6) + kRounding;
}

/// Where the bodies of a trial are, and their ids.
struct Moved {
  std::vector<std::uint32_t> ids = {};  // kNoIndex: not yet there
  std::vector<Pose> from = {}, to = {};
  double time = 0;  // s, of `to`
};

/// Returns what weft said where it refuses one.
std::string move_bodies(const Trial& trial, Cloth& cloth, int step, double from, double to,
                        Moved& moved) {
  moved.ids.resize(trial.bodies.size(), kNoIndex);
  moved.from.resize(trial.bodies.size());
  moved.to.resize(trial.bodies.size());
  moved.time = to;
  for (std::size_t i = 0; i < trial.bodies.size(); ++i) {
    const TrialBody& body = trial.bodies[i];
    if (step < body.appears) continue;
    moved.from[i] = body.pose(from);
    moved.to[i] = body.pose(to);
    if (moved.ids[i] == kNoIndex) {
      const auto id = cloth.add_body({.shape = body.shape,
                                      .pose = moved.from[i],
                                      .thickness = body.thickness,
                                      .friction = body.friction});
      if (!id) return id.error();
      moved.ids[i] = id.value();
    }
    if (const auto is = cloth.move_body(moved.ids[i], moved.to[i]); !is) return is.error();
    if (!body.vertices) continue;
    if (const auto is = cloth.move_body_vertices(moved.ids[i], body.vertices(to)); !is)
      return is.error();
  }
  return {};
}

/// m, into those that are there. Notes what went through one, or crosses it, or itself.
double look_at_bodies(Observed& o, const Trial& trial, const Snapshot& before, const Moved& moved) {
  double deepest = 0;
  o.end_crossings = 0;
  if (trial.scene.self_contact.on)
    o.end_crossings += count_crossings({o.end.positions, trial.scene.surface});
  for (std::size_t i = 0; i < moved.ids.size(); ++i) {
    if (moved.ids[i] == kNoIndex) continue;
    const TrialBody& body = trial.bodies[i];
    if (body.mesh) {
      const TriangleSet cloth{o.end.positions, trial.scene.surface};
      const TriangleSet mesh = mesh_at(body, moved.to[i], moved.time);
      o.end_crossings += count_crossings(cloth, mesh);
      deepest = std::max(deepest, body.thickness - distance(cloth, mesh, body.thickness));
      continue;
    }
    deepest = std::max(deepest, max_penetration(trial.scene, o.end, body, moved.to[i]));
    o.went_through = o.went_through || went_through(before, o.end, body, moved.from[i], moved.to[i],
                                                    kDeep * body.thickness);
  }
  return deepest;
}

void add(Observed& o, const Trial& trial, const StepReport& report, double in_bodies) {
  const double strain = max_strain(trial.scene, o.end);
  const double penetration = std::max(in_bodies, max_penetration(trial.scene, o.end));
  if (report.status > o.worst) o.worst_step = o.steps;
  o.worst = std::max(o.worst, report.status);
  o.missed += report.status != Status::converged;
  o.crossings = std::max(o.crossings, o.end_crossings);
  o.intersecting = std::max(o.intersecting, report.intersecting + report.tangled);
  o.contact_failures += report.contact_failures;
  o.zones += report.zones;
  // Nobody measures how deep what crosses is.
  const double told = o.end_crossings > 0 ? report.max_penetration : penetration;
  o.false_claims +=
      !tells_the_truth(report, trial.settings, strain, max_rigid_strain(trial.scene, o.end), told,
                       !trial.bodies.empty()) ||
      (o.end_crossings > 0 && report.status == Status::converged);
  o.finite = o.finite && all_finite(o.end);
  o.max_strain = std::max(o.max_strain, strain);
  o.end_strain = strain;
  o.max_penetration = std::max(o.max_penetration, penetration);
  o.end_penetration = penetration;
  o.body_work += report.body_work;
  o.energy_end = energy(trial.scene, o.end);
  const double gain = o.energy_end - o.energy_start - o.body_work;
  o.energy_gain = o.steps == 0 ? gain : std::max(o.energy_gain, gain);
  o.end_kinetic = kinetic_energy(trial.scene, o.end);
  o.most_kinetic = std::max(o.most_kinetic, o.end_kinetic);
  ++o.steps;
}

bool take_step(Observed& o, const Trial& trial, Cloth& cloth, Moved& moved) {
  const double dt = trial.varying_dt ? trial.varying_dt(o.steps) : trial.dt;
  const double time = o.steps * trial.dt;
  o.refusal = move_bodies(trial, cloth, o.steps, time, time + trial.dt, moved);
  if (!o.refusal.empty()) return false;
  const double start = thread_cpu_seconds();  // cases step on one thread each
  const auto report = cloth.step(dt);
  const double took = thread_cpu_seconds() - start;
  if (!report) return o.refusal = report.error(), false;
  o.seconds += took;
  o.longest_seconds = std::max(o.longest_seconds, took);
  const Snapshot before = std::exchange(o.end, snapshot(cloth));
  add(o, trial, report.value(), look_at_bodies(o, trial, before, moved));
  return committed(report.value().status);
}

}  // namespace

Observed observe(const Trial& trial) {
  Observed o;
  const auto model = build_model(trial.scene);
  if (!model) return o.refusal = model.error(), o;
  auto cloth = Cloth::create(model.value(), trial.settings);
  if (!cloth) return o.refusal = cloth.error(), o;
  o.end = snapshot(cloth.value());
  o.energy_start = energy(trial.scene, o.end);
  Moved moved;
  while (o.steps < trial.steps) {
    if (trial.before_step) trial.before_step(cloth.value(), o.steps);
    if (!take_step(o, trial, cloth.value(), moved)) return o.stopped = true, o;
    if (trial.after_step) trial.after_step(cloth.value(), o.steps - 1);
  }
  return o;
}

std::string text(const Observed& o) {
  if (!o.refusal.empty()) return "refused: " + o.refusal;
  std::string text = fmt::format("{} of {:.3g} ms, max strain {}", counted(o.steps, "step"),
                                 o.ms_per_step(), measured_percent(o.max_strain));
  if (o.max_penetration > 0) text += fmt::format(", {:.2g} m deep", o.max_penetration);
  text += fmt::format(", energy gain {:.2g} J", o.energy_gain);
  if (o.contact_failures > 0)
    text += fmt::format(", {} failures with {} zones", o.contact_failures, o.zones);
  if (o.crossings > 0 || o.intersecting > 0) {
    text += fmt::format(", {} at most ({} reported, {} in the end)",
                        counted(o.crossings, "crossing"), o.intersecting, o.end_crossings);
  }
  if (o.missed > 0) {
    text += fmt::format(", {} not converged ({} in step {})", counted(o.missed, "step"),
                        name(o.worst), o.worst_step);
  }
  if (o.false_claims > 0) text += fmt::format(", {}", counted(o.false_claims, "false claim"));
  if (!o.finite) text += ", not finite";
  if (o.stopped) text += ", stopped";
  return text;
}

}  // namespace weft::tools::hard
