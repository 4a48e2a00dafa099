#include "tools/studies/precision/task.h"

#include <fmt/format.h>

#include <utility>

#include "tools/program/options/scene_source.h"
#include "tools/scenes/scenes.h"
#include "tools/studies/precision/reference_solution.h"

namespace weft::tools::precision {

namespace {

Result<SceneDescription> describe_scene(const std::string& scene, int size,
                                        const std::string& material) {
  if (!material.empty()) {
    SceneOptions options;
    options.scene = scene;
    options.size = size;
    options.material.material = material;
    auto source = load_scene(options);
    if (!source) return Error{source.error()};
    return std::move(source.value().description);
  }
  scenes::Options options;
  options.size = size;
  options.ropes = scene == "cape";
  return scenes::make(scene, options);
}

}  // namespace

bool Task::has_material() const {
  const ModelInfo info = describe(*model);
  return info.compliant + info.membrane_elements > 0;
}

Result<Task> make_task(const std::string& scene, int size, const std::string& material) {
  auto description = describe_scene(scene, size, material);
  if (!description) return Error{description.error()};
  auto model = build_model(description.value());
  if (!model) return Error{model.error()};
  if (const auto plain = Cloth::create(model.value(), {}); !plain) return Error{plain.error()};
  Task task;
  task.scene = scene;
  task.size = size;
  task.description = std::move(description.value());
  task.model = std::move(model.value());
  return task;
}

namespace {

/// So many substeps that local passes have next to nothing to do.
Result<std::vector<Vec3>> by_small_steps(const Task& task, int substeps) {
  Settings settings;
  settings.solver = Solver::small_steps;
  settings.substeps = substeps;
  settings.threads = task.threads;
  auto cloth = Cloth::create(task.model, settings);
  if (!cloth) return Error{cloth.error()};
  for (int frame = 0; frame < kReferenceFrame; ++frame) {
    const auto report = cloth.value().step(kFrame);
    if (!report) return Error{report.error()};
    if (report.value().status == Status::converged) continue;
    return Error{"small steps found no motion to compare with"};
  }
  std::vector<Vec3> positions(cloth.value().particle_count());
  static_cast<void>(cloth.value().read_positions(positions));  // fails for a wrong size alone
  return positions;
}

Result<void> add_reference_by_small_steps(Task& task, int substeps) {
  const auto coarse = by_small_steps(task, substeps);
  if (!coarse) return Error{coarse.error()};
  auto fine = by_small_steps(task, 2 * substeps);
  if (!fine) return Error{fine.error()};
  task.reference = std::move(fine.value());
  task.reference_by = fmt::format("small_steps, {} substeps", 2 * substeps);
  task.reference_error = trajectory_error(coarse.value(), task.reference);
  return {};
}

}  // namespace

Result<void> add_reference(Task& task, int parts) {
  const auto at = [&](int n) {
    return reference_solution(task.description, kFrame / n, kReferenceFrame * n);
  };
  const auto coarse = at(parts);
  if (!coarse) return add_reference_by_small_steps(task, 32 * parts);
  auto fine = at(2 * parts);
  if (!fine) return add_reference_by_small_steps(task, 32 * parts);
  task.reference = std::move(fine.value().positions);
  task.reference_by = "rattle in double precision, sparse factors";
  task.reference_error = trajectory_error(coarse.value().positions, task.reference) / 3;
  return {};
}

}  // namespace weft::tools::precision
