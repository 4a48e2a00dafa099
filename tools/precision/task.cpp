#include "tools/precision/task.h"

#include <utility>

#include "engine/scenes.h"
#include "tools/precision/reference_solution.h"

namespace weft::tools::precision {

Result<Task> make_task(const std::string& scene, int size) {
  scenes::Options options;
  options.size = size;
  auto description = scenes::make(scene, options);
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

Result<void> add_reference(Task& task, int parts) {
  const auto at = [&](int n) {
    return reference_solution(task.description, kFrame / n, kReferenceFrame * n);
  };
  const auto coarse = at(parts);
  if (!coarse) return Error{coarse.error()};
  auto fine = at(2 * parts);
  if (!fine) return Error{fine.error()};
  task.reference = std::move(fine.value().positions);
  task.reference_error = trajectory_error(coarse.value().positions, task.reference) / 3;
  return {};
}

}  // namespace weft::tools::precision
