#include "tools/program/run/run_report.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <weft/report_fields.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "tools/program/text/wording.h"
#include "tools/program/text/wrapping.h"
#include "tools/scenes/body_moves.h"

namespace weft::tools {
namespace {

double mean(std::int64_t total, int frames) {
  return frames > 0 ? static_cast<double>(total) / frames : 0;
}

double milliseconds_per_frame(const RunSummary& summary, double seconds) {
  return summary.frames > 0 ? 1e3 * seconds / summary.frames : 0;
}

double real_time_factor(const RunReport& report) {
  const double seconds = report.summary.seconds_per_frame();
  return seconds > 0 ? report.plan.dt / seconds : 0;
}

double nanoseconds_per_constraint_iteration(const RunSummary& summary) {
  const double visits = static_cast<double>(summary.model.constraints) *
                        static_cast<double>(summary.total.iterations);
  const auto stage = static_cast<std::size_t>(Stage::solve_positions);
  return visits > 0 ? 1e9 * summary.total.stage_seconds[stage] / visits : 0;
}

double bytes_per_particle(const RunSummary& summary) {
  return static_cast<double>(summary.bytes) / static_cast<double>(summary.model.particles);
}

char axis(const RunPlan& plan) { return plan.up == &Vec3::z ? 'z' : 'y'; }
/// "lowest_y"
std::string lowest_name(const RunPlan& plan) { return fmt::format("lowest_{}", axis(plan)); }

std::string_view isa(const RunReport& report) {
  return report.settings.backend == Backend::reference ? "scalar" : name(report.summary.isa);
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

Json stages_json(const RunSummary& summary) {
  Json stages = Json::object();
  for (std::size_t i = 0; i < kStageCount; ++i) {
    stages[std::string(name(static_cast<Stage>(i)))] =
        milliseconds_per_frame(summary, summary.total.stage_seconds[i]);
  }
  return stages;
}

std::string stages_text(const RunSummary& summary) {
  std::string text;
  for (std::size_t i = 0; i < kStageCount; ++i) {
    text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", name(static_cast<Stage>(i)),
                        milliseconds_per_frame(summary, summary.total.stage_seconds[i]));
  }
  return text;
}

/// "direct", "auto (yarn)".
std::string solver_text(const RunReport& report) {
  const std::string asked(name(report.settings.solver));
  if (report.settings.solver != Solver::automatic) return asked;
  return fmt::format("{} ({})", asked, name(report.summary.solver));
}

std::string goal_text(const Settings& settings) {
  if (settings.iterations > 0)
    return fmt::format("{} per substep", counted(settings.iterations, "iteration"));
  const std::string strain = fmt::format("tolerance {}", percent(settings.tolerance));
  if (settings.motion_tolerance == 0) return strain;
  return fmt::format("{} and {:g} m/s", strain, settings.motion_tolerance);
}

/// Of a frame: as asked for, or the mean of those chosen.
Json substeps(const RunReport& report) {
  if (report.settings.substeps != kAutomaticSubsteps) return report.settings.substeps;
  return mean(report.summary.total.substeps, report.summary.frames);
}

/// Of rigid constraints the error is their strain.
std::string_view error_name(const RunSummary& summary) {
  return summary.model.compliant > 0 || summary.model.membrane_elements > 0 ? "error of the law"
                                                                            : "strain";
}

std::string material_text(const ModelInfo& model) {
  std::string text;
  const auto add = [&](std::size_t count, std::string_view what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, what);
  };
  add(model.compliant, "spring");
  add(model.membrane_elements, "triangle");
  add(model.bending_elements, "bending element");
  add(model.air_triangles, "air triangle");
  return text;
}

std::string_view verb_of(std::int64_t count) { return count == 1 ? "was" : "were"; }

/// Of the cloth with itself and with bodies that are meshes; empty where there is nothing to say.
std::string crossings_text(const RunSummary& summary) {
  const StepReport& total = summary.total;
  std::string text;
  if (total.contact_failures > 0) {
    text = fmt::format("{} {} stopped", counted(total.contact_failures, "crossing"),
                       verb_of(total.contact_failures));
  }
  if (total.zones > 0) {
    text += fmt::format("{}{} moved as if glued", text.empty() ? "" : ", ", total.zones);
  }
  if (total.intersecting > 0) {
    text += fmt::format("{}at most {} could not be stopped in a frame", text.empty() ? "" : ", ",
                        total.intersecting);
  }
  if (summary.intersections) {
    text += fmt::format("{}{} of triangles at most in a frame", text.empty() ? "" : "; ",
                        counted(*summary.intersections, "crossing"));
  }
  return text;
}

struct MeshCount {
  std::string_view key;
  std::string_view noun;  ///< of one
  std::string_view rest;  ///< after the noun
  std::size_t MeshCounts::*value;
};
constexpr MeshCount kMeshCounts[] = {
    {"welded_vertices", "vertex", " welded", &MeshCounts::welded_vertices},
    {"unused_vertices", "vertex", " in no face and no line", &MeshCounts::unused_vertices},
    {"degenerate_faces", "face", " without area", &MeshCounts::degenerate_faces},
    {"double_faces", "face", " twice, used once", &MeshCounts::double_faces},
    {"thread_lines", "line", " that are threads", &MeshCounts::thread_lines},
    {"non_manifold_edges", "edge", " of more than two faces", &MeshCounts::non_manifold_edges},
};

void add_mesh(const MeshCounts& mesh, Json& json) {
  json["pieces"] = mesh.pieces;
  json["loose_pieces"] = mesh.loose_pieces;
  for (const MeshCount& count : kMeshCounts) json[std::string(count.key)] = mesh.*count.value;
}

/// Of what is seldom, only what there is.
std::string mesh_text(const MeshCounts& mesh) {
  std::string text = counted(mesh.pieces, "piece");
  if (mesh.loose_pieces > 0) text += fmt::format(", {} on no pin", mesh.loose_pieces);
  for (const MeshCount& count : kMeshCounts) {
    const std::size_t number = mesh.*count.value;
    if (number == 0) continue;
    const bool is_vertex = count.noun == "vertex";
    text += ", " + (is_vertex && number != 1 ? fmt::format("{} vertices", number)
                                             : counted(number, count.noun));
    text += count.rest;
  }
  return text;
}

/// Numbers of StepReport that the JSON has in a form of its own: per frame, under the name of a
/// setting, or as the program measures them.
constexpr std::string_view kInOwnForm[] = {
    "asleep",     "substeps",   "iterations", "velocity_iterations", "direction_updates",
    "contacts",   "max_strain", "rms_strain", "max_shear",           "motion_error",
    "worst_seam", "worst_held"};

/// All other numbers of the total, by their names.
void add_total(const StepReport& total, Json& json) {
  for_each_report_field([&]<class T>(const ReportField<T>& field) {
    if constexpr (std::is_arithmetic_v<T>) {
      if (field.over_steps == OverSteps::none) return;
      if (std::ranges::find(kInOwnForm, field.name) != std::end(kInOwnForm)) return;
      json[field.name] = total.*field.member;
    }
  });
}

/// Of a frame, the mean.
ContactMs contact_ms(const RunSummary& summary) {
  const ContactMs& ms = summary.total.contact_ms;
  const double frames = std::max(summary.frames, 1);
  return {ms.find / frames, ms.sweep / frames, ms.verify / frames};
}

Json contact_ms_json(const RunSummary& summary) {
  const ContactMs ms = contact_ms(summary);
  return {{"find", ms.find}, {"sweep", ms.sweep}, {"verify", ms.verify}};
}

std::string times_text(const RunSummary& summary) {
  const ContactMs ms = contact_ms(summary);
  return fmt::format("{:.3g} ms per frame to find contacts, {:.3g} in sweeps, {:.3g} to verify",
                     ms.find, ms.sweep, ms.verify);
}

/// When the run ends.
std::string open_seams_text(const StepReport& total) {
  std::string text = fmt::format("{} open in the end", total.open_seams);
  if (total.late_seams > 0) {
    text += fmt::format(" and {} of them late, the widest is seam {}", total.late_seams,
                        total.worst_seam);
  }
  return text;
}

/// When the run ends: what pins or anchors exclude.
std::string held_text(const StepReport& total) {
  std::string text = fmt::format("{} between held particles cannot be met where these are",
                                 counted(total.held_apart, "demand"));
  if (total.worst_held != kNoIndex) text += fmt::format(", as constraint {}", total.worst_held);
  if (total.worst_seam != kNoIndex) text += fmt::format(", as seam {}", total.worst_seam);
  return text;
}

Json free_body_json(const FreeBodyEnd& end) {
  const auto& [p, r] = end.pose;
  return {{"body", end.body},
          {"position", {p.x, p.y, p.z}},
          {"rotation", {r.x, r.y, r.z, r.w}},
          {"centre", {end.centre.x, end.centre.y, end.centre.z}}};
}

/// When the run ends.
std::string free_bodies_text(const RunReport& report) {
  const auto height = [&](const FreeBodyEnd& end) { return end.centre.*report.plan.up; };
  const auto& ends = report.summary.free_bodies;
  const auto [least, most] = std::ranges::minmax(ends, {}, height);
  if (ends.size() == 1)
    return fmt::format("1 with a mass, its centre at {} {:.4g} m in the end", axis(report.plan),
                       height(least));
  return fmt::format("{} with a mass, their centres at {} {:.4g} m to {:.4g} m in the end",
                     ends.size(), axis(report.plan), height(least), height(most));
}

/// Of the cloth with itself.
std::string layers_text(const StepReport& total) {
  return fmt::format("{} at most, {} tangled in the last frame",
                     counted(total.self_contacts, "contact"), counted(total.tangled, "pair"));
}

}  // namespace

Json to_json(const RunReport& report) {
  const RunSummary& summary = report.summary;
  const StepReport& total = summary.total;
  const Settings& settings = report.settings;
  Json json{
      {"scene", report.scene},
      {"particles", summary.model.particles},
      {"constraints", summary.model.constraints},
      {"springs", summary.model.compliant},
      {"membrane_elements", summary.model.membrane_elements},
      {"bending_elements", summary.model.bending_elements},
      {"anchors", summary.model.anchors},
      {"seams", summary.model.seams},
      {"tethers", summary.model.tethers},
      {"air_triangles", summary.model.air_triangles},
      {"spheres", summary.model.spheres},
      {"solver", name(settings.solver)},
      {"solver_used", name(summary.solver)},
      {"scheme", name(summary.scheme)},
      {"backend", name(settings.backend)},
      {"anticipate_products", settings.measuring.anticipate_products},
      {"isa", isa(report)},
      {"threads", settings.backend == Backend::reference ? 1 : summary.threads},
      {"dt", report.plan.dt},
      {"steps", summary.frames},
      {"frames", summary.frames},
      {"asleep_frames", summary.asleep_frames},
      {"substeps", substeps(report)},
      {"tolerance", settings.tolerance},
      {"iterations", settings.iterations},
      {"status", name(total.status)},
      {"missed_frames", summary.missed_frames},
      {"ms_per_frame", 1e3 * summary.seconds_per_frame()},
      {"max_ms_per_frame", 1e3 * summary.longest_step_seconds},
      {"real_time_factor", real_time_factor(report)},
      {"rejected", total.halvings + total.scheme_fallbacks},
      {"max_strain", summary.max_strain},
      {"mean_max_strain", summary.mean_max_strain},
      {"rms_strain", summary.rms_strain},
      {"max_contacts", total.contacts},
      {"bodies", report.plan.bodies.size()},
      {"body_triangles", count_triangles(report.plan.bodies)},
      {"iterations_per_step", summary.iterations_per_step()},
      {"velocity_iterations_per_step", mean(total.velocity_iterations, summary.frames)},
      {"direction_updates_per_step", mean(total.direction_updates, summary.frames)},
      {"ns_per_constraint_iteration", nanoseconds_per_constraint_iteration(summary)},
      {"energy_start", summary.energy_start},
      {"energy_end", summary.energy_end},
      {"energy_gain", summary.energy_gain},
      {"motion_tolerance", settings.motion_tolerance},
      {"motion_error", summary.mean_motion_error},
      {"max_motion_error", total.motion_error},
      {lowest_name(report.plan), summary.lowest},
      {"state_hash", fmt::format("{:016x}", summary.state_hash)},
      {"bytes_per_particle", bytes_per_particle(summary)},
      {"stages", stages_json(summary)},
      {"contact_ms", contact_ms_json(summary)},
      {"peak_rss_mb", peak_rss_mb()},
  };
  add_total(total, json);
  if (total.worst_seam != kNoIndex) json["worst_seam"] = total.worst_seam;
  if (total.worst_held != kNoIndex) json["worst_held"] = total.worst_held;
  if (summary.intersections) json["intersections"] = *summary.intersections;
  if (summary.fabric) {
    json["max_warp"] = summary.fabric->warp;
    json["max_weft"] = summary.fabric->weft;
    json["max_shear"] = summary.fabric->shear;
  }
  for (const FreeBodyEnd& end : summary.free_bodies)
    json["free_bodies"].push_back(free_body_json(end));
  if (report.mesh) add_mesh(*report.mesh, json);
  return json;
}

std::string to_table(const RunReport& report) {
  const RunSummary& summary = report.summary;
  const StepReport& total = summary.total;
  const Settings& settings = report.settings;
  std::string text;
  const auto row = [&text](std::string_view label, const std::string& value) {
    constexpr std::size_t kColumn = 10;
    text += fmt::format("{:<{}}{}\n", label, kColumn, wrapped(value, kColumn, Break::at_commas));
  };
  row("scene",
      fmt::format("{}: {}, {}, {}", report.scene, counted(summary.model.particles, "particle"),
                  counted(summary.model.constraints, "constraint"),
                  counted(summary.model.spheres, "sphere")));
  if (report.mesh) row("mesh", mesh_text(*report.mesh));
  if (const auto material = material_text(summary.model); !material.empty())
    row("material", material);
  row("solver", fmt::format("{}, scheme {}, backend {}, {}", solver_text(report),
                            name(summary.scheme), name(settings.backend), goal_text(settings)));
  if (summary.scheme == Scheme::rattle) {
    row("scheme", fmt::format("{} of {} left to scheme paper", total.scheme_fallbacks,
                              counted(total.substeps, "substep")));
  }
  const auto in_substeps =
      settings.substeps != 1
          ? fmt::format(" in {:.3g} substeps each", mean(total.substeps, summary.frames))
          : "";
  const auto asleep =
      summary.asleep_frames > 0 ? fmt::format(", {} asleep", summary.asleep_frames) : "";
  const auto missed =
      summary.missed_frames > 0 ? fmt::format(", {} out of tolerance", summary.missed_frames) : "";
  row("frames", fmt::format("{} of {:.6g} s{}{}{}, status {}", summary.frames, report.plan.dt,
                            in_substeps, asleep, missed, name(total.status)));
  row("time",
      fmt::format("{:.4g} ms per frame, {:.3g} the longest, {} times real time, at max {} {}",
                  1e3 * summary.seconds_per_frame(), 1e3 * summary.longest_step_seconds,
                  factor_text(real_time_factor(report)), error_name(summary),
                  measured_percent(total.max_error)));
  row("stages", fmt::format("{} ms at max {} {}", stages_text(summary), error_name(summary),
                            measured_percent(total.max_error)));
  row("strain",
      fmt::format("max {}, mean of the frames' max {}, rms {}",
                  measured_percent(summary.max_strain), measured_percent(summary.mean_max_strain),
                  measured_percent(summary.rms_strain)));
  if (summary.fabric) {
    row("fabric", fmt::format("warp {}, weft {}, shear {:.3g} rad at most",
                              measured_percent(summary.fabric->warp),
                              measured_percent(summary.fabric->weft), summary.fabric->shear));
  }
  if (summary.model.spheres > 0) {
    row("contacts", fmt::format("{:.3g} m deepest penetration", total.max_penetration));
  }
  if (!report.plan.bodies.empty()) {
    row("bodies", fmt::format("{}, {} at most, {:.3g} m deepest penetration, {:.3g} J by friction, "
                              "{:.3g} J by moved ones",
                              report.plan.bodies.size() == 1
                                  ? "1 body"
                                  : fmt::format("{} bodies", report.plan.bodies.size()),
                              counted(total.body_contacts, "contact"), total.max_penetration,
                              total.friction_work, total.body_work));
  }
  if (!summary.free_bodies.empty()) row("", free_bodies_text(report));
  if (report.plan.touches_itself) row("layers", layers_text(total));
  if (report.plan.touches_itself || !report.plan.bodies.empty()) row("", times_text(summary));
  if (const auto crossed = crossings_text(summary); !crossed.empty()) row("crossings", crossed);
  if (summary.model.anchors > 0) {
    row("anchors", fmt::format("{}, {:.3g} m beyond their limits at most", summary.model.anchors,
                               total.max_anchor_error));
  }
  if (summary.model.tethers > 0) {
    row("tethers", fmt::format("{}, {:.3g} m beyond their lengths at most", summary.model.tethers,
                               total.max_anchor_error));
  }
  if (summary.model.seams > 0) {
    row("seams",
        fmt::format("{}, {}, closed ones {:.3g} m apart at most, {:.3g} J", summary.model.seams,
                    open_seams_text(total), total.max_seam_gap, total.seam_work));
  }
  if (total.torn > 0) row("torn", counted(total.torn, "break"));
  if (total.held_apart > 0) row("held", held_text(total));
  row("work",
      fmt::format("{:.4g} iterations and {:.3g} direction updates per step, {}, {}",
                  summary.iterations_per_step(), mean(total.direction_updates, summary.frames),
                  counted(total.visits, "visit"), counted(total.corrections, "correction")));
  const auto by_pins =
      total.pin_work != 0 ? fmt::format(", {:.6g} J by moved pins", total.pin_work) : "";
  row("energy", fmt::format("{:.6g} J to {:.6g} J{}, largest gain {:.3g} J, {:.3g} J lost",
                            summary.energy_start, summary.energy_end, by_pins, summary.energy_gain,
                            total.energy_lost));
  if (summary.solver == Solver::small_steps) {
    row("motion", fmt::format("{:.3g} m/s away from the true one by estimate, {:.3g} at most",
                              summary.mean_motion_error, total.motion_error));
  }
  row("state", fmt::format("{:016x}, lowest {} {:.6g} m", summary.state_hash, axis(report.plan),
                           summary.lowest));
  return text;
}

}  // namespace weft::tools
