#include "tools/studies/forms/form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "tools/program/measure/cpu_time.h"

namespace weft::tools::forms {
namespace {

template <class T>
T demanded(Result<T> result) {
  if (!result) throw std::runtime_error(result.error());
  return std::move(result).value();
}

Settings by_one_thread(Settings settings) {
  settings.threads = 1;
  return settings;
}

}  // namespace

bool FormResult::holds() const {
  const auto converged = [](const Reading& r) { return r.missed == 0; };
  if (readings.empty() || !std::ranges::all_of(readings, converged)) return false;
  if (std::ssize(readings) < kRefinements) return true;
  const auto is_within = [&](const Reading& r) { return std::abs(r.error()) <= bound; };
  const double finest = std::abs(readings.back().error());
  const double coarsest = std::abs(readings.front().error());
  if (!converges) return std::ranges::all_of(readings, is_within);
  return is_within(readings.back()) && (finest <= kSmall || finest < coarsest);
}

FormResult measure(const Form& form, int refinements) {
  FormResult result{form.name, form.formula, form.unit, form.bound, form.converges, {}};
  for (int i = 0; i < refinements; ++i) result.readings.push_back(form.measure(i));
  return result;
}

std::vector<Form> all_forms() {
  std::vector<Form> all;
  for (std::vector<Form>& forms :
       std::array{membrane_forms(), film_forms(), bending_forms(), fold_forms(), crease_forms(),
                  end_forms(), annulus_forms(), fabric_forms(), motion_forms(), body_forms(),
                  layer_forms(), pressure_forms()})
    std::ranges::move(forms, std::back_inserter(all));
  return all;
}

Run::Run(const SceneDescription& scene, Settings settings)
    : cloth_(demanded(Cloth::create(demanded(build_model(scene)), by_one_thread(settings)))) {}

void Run::step(double dt) {
  const double start = thread_cpu_seconds();
  const StepReport report = demanded(cloth_.step(dt));
  seconds_ += thread_cpu_seconds() - start;
  ++frames_;
  missed_ += report.status != Status::converged;
  substeps_ += report.substeps;
}

double Run::mean_y(std::span<const std::uint32_t> particles) const {
  double sum = 0;
  for (const std::uint32_t i : particles) sum += at(i).y;
  return sum / static_cast<double>(particles.size());
}

void Run::pull(std::span<const Vec3> forces) {
  if (const auto written = cloth_.write_forces(forces); !written)
    throw std::runtime_error(written.error());
}

void Run::move_pins(const SceneDescription& scene, const std::function<Vec3(Vec3)>& to) {
  for (const std::uint32_t pin : scene.fixed) {
    if (const auto moved = cloth_.move_fixed(pin, to(scene.positions[pin])); !moved)
      throw std::runtime_error(moved.error());
  }
}

Reading Run::reading(std::string size, double expected, double measured) const {
  return {.size = std::move(size),
          .expected = expected,
          .measured = measured,
          .ms_per_frame = 1e3 * seconds_ / std::max(1, frames_),
          .substeps = static_cast<double>(substeps_) / std::max(1, frames_),
          .missed = missed_};
}

}  // namespace weft::tools::forms
