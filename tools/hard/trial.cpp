#include "tools/hard/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/cpu_time.h"
#include "tools/wording.h"

namespace weft::tools::hard {
namespace {

/// Two computations of one error may round differently.
constexpr double kRounding = 1e-9;

bool tells_the_truth(const StepReport& report, const Settings& settings, double strain,
                     double rigid_strain, double penetration) {
  if (std::abs(report.max_strain - strain) > kRounding * (1 + strain)) return false;
  if (std::abs(report.max_penetration - penetration) > kRounding * (1 + penetration)) return false;
  if (report.status != Status::converged) return true;
  const double error = std::max(rigid_strain, report.max_error);  // nobody else knows of tensions
  return error <= settings.tolerance * (1 + 1e-6) + kRounding &&
         penetration <= settings.contact_tolerance * (1 + 1e-6) + kRounding;
}

void add(Observed& o, const Trial& trial, const StepReport& report) {
  const double strain = max_strain(trial.scene, o.end);
  const double penetration = max_penetration(trial.scene, o.end);
  if (report.status > o.worst) o.worst_step = o.steps;
  o.worst = std::max(o.worst, report.status);
  o.missed += report.status != Status::converged;
  o.false_claims += !tells_the_truth(report, trial.settings, strain,
                                     max_rigid_strain(trial.scene, o.end), penetration);
  o.finite = o.finite && all_finite(o.end);
  o.max_strain = std::max(o.max_strain, strain);
  o.end_strain = strain;
  o.max_penetration = std::max(o.max_penetration, penetration);
  o.energy_end = energy(trial.scene, o.end);
  const double gain = o.energy_end - o.energy_start;
  o.energy_gain = o.steps == 0 ? gain : std::max(o.energy_gain, gain);
  o.end_kinetic = kinetic_energy(trial.scene, o.end);
  o.most_kinetic = std::max(o.most_kinetic, o.end_kinetic);
  ++o.steps;
}

bool take_step(Observed& o, const Trial& trial, Cloth& cloth) {
  const double dt = trial.varying_dt ? trial.varying_dt(o.steps) : trial.dt;
  const double start = thread_cpu_seconds();  // cases step on one thread each
  const auto report = cloth.step(dt);
  const double took = thread_cpu_seconds() - start;
  if (!report) return o.refusal = report.error(), false;
  o.seconds += took;
  o.longest_seconds = std::max(o.longest_seconds, took);
  o.end = snapshot(cloth);
  add(o, trial, report.value());
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
  while (o.steps < trial.steps) {
    if (trial.before_step) trial.before_step(cloth.value(), o.steps);
    if (!take_step(o, trial, cloth.value())) return o.stopped = true, o;
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
