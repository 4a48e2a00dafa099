#include "tools/studies/precision/meter.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "tools/studies/precision/reference_solution.h"

namespace weft::tools::precision {

Meter::Meter(const Task& task)
    : task_(&task),
      cloth_(std::move(Cloth::create(task.model, {}).value())),  // taken by make_task()
      energy_start_(cloth_.energy().total()) {
  sums_.energy_gain = -std::numeric_limits<double>::infinity();
}

bool Meter::add_frame(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                      double seconds) {
  seconds_ += seconds;
  ++sums_.frames;
  if (!cloth_.write_positions(positions) || !cloth_.write_velocities(velocities)) return false;
  const double strain = cloth_.strain().max;
  strain_sum_ += strain;
  sums_.max_strain = std::max(sums_.max_strain, strain);
  sums_.energy_gain = std::max(sums_.energy_gain, cloth_.energy().total() - energy_start_);
  if (sums_.frames == kReferenceFrame && !task_->reference.empty()) {
    sums_.trajectory_error =
        trajectory_error({positions.begin(), positions.end()}, task_->reference);
  }
  return true;
}

Outcome Meter::outcome() const {
  Outcome outcome = sums_;
  outcome.ms_per_frame = 1000 * seconds_ / std::max(sums_.frames, 1);
  outcome.mean_max_strain = strain_sum_ / std::max(sums_.frames, 1);
  return outcome;
}

}  // namespace weft::tools::precision
