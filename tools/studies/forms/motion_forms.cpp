/// What moves as a whole: through the air, and against the decay of motion. The readings differ in
/// the length of a step.
#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

/// Level, of cotton, held by nothing.
SceneDescription free_sheet(const Material& material) {
  return scene_of(mesh_of(sheet_of(Pattern::irregular, 0.5, 0.5, 10), material));
}

/// m/s, downwards.
double mean_fall(Run& run) {
  const auto count = static_cast<std::uint32_t>(run.cloth().particle_count());
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) sum -= run.cloth().velocity(i).y;
  return sum / count;
}

Reading at_rate(Run& run, int rate, double expected) {
  return run.reading(fmt::format("1/{} s", rate), expected, mean_fall(run));
}

int rate_of(int refinement) { return 30 << refinement; }

/// After seven of its time constants, v / g. Later the sheet, which nothing holds, begins to
/// flutter.
Reading terminal(int refinement) {
  const Material material = cotton();
  const SceneDescription scene = free_sheet(material);
  const int rate = rate_of(refinement);
  Run run(scene, {});
  run.steps(rate, 1.0 / rate);
  return at_rate(run, rate,
                 std::sqrt(2 * material.density * kGravity / (scene.air.density * material.drag)));
}

Reading decaying(bool falls, int refinement) {
  constexpr double kDecay = 2, kStart = 3;  // 1/s, m/s
  Material material = cotton();
  material.drag = material.lift = 0;
  material.damping_motion = kDecay;
  SceneDescription scene = free_sheet(material);
  if (!falls) {
    scene.gravity = {};
    scene.velocities.assign(scene.positions.size(), {0, -kStart, 0});
  }
  const int rate = rate_of(refinement);
  Run run(scene, {});
  run.steps(rate, 1.0 / rate);
  const double left = std::exp(-kDecay);
  return at_rate(run, rate, falls ? kGravity / kDecay * (1 - left) : kStart * left);
}

}  // namespace

std::vector<Form> motion_forms() {
  return {
      {"a sheet falls through air", "sqrt(2 m g / rho C_d A)", "m/s", terminal},
      {"a motion decays", "v e^(-c t)", "m/s", [](int r) { return decaying(false, r); }},
      {"a fall decays", "g (1 - e^(-c t)) / c", "m/s", [](int r) { return decaying(true, r); }}};
}

}  // namespace weft::tools::forms
