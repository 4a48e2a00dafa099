/// Named fabrics: strips of them at cells of 8, 4 and 2 mm.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "tools/studies/forms/elastica.h"
#include "tools/studies/forms/form.h"
#include "tools/studies/forms/sheets.h"

namespace weft::tools::forms {
namespace {

/// A strip that is clamped level hangs down by its own weight. Air is left out.
Reading hanging(Material material, int refinement) {
  constexpr double kLength = 0.064, kWidth = 0.008;
  constexpr int kFrames = 90;
  material.drag = material.lift = 0;
  material.damping_motion = 20;
  const Strip strip = clamped_strip(Pattern::quads, material, kLength, kWidth, 8 << refinement);
  Run run(strip.scene, {.tolerance = 1e-3});
  run.steps(kFrames, kFrame);
  const double load = material.density * kGravity * std::pow(kLength, 3) / material.bending;
  return run.reading(size_of(strip.sheet), -1e3 * heavy_elastica(load).y * kLength,
                     -1e3 * run.mean_y(strip.end));
}

}  // namespace

std::vector<Form> fabric_forms() {
  std::vector<Form> forms;
  for (const NamedMaterial& named : materials()) {
    forms.push_back({fmt::format("a strip of {} hangs", named.name),
                     "k_b theta'' = - rho g (L - s) cos theta", "mm",
                     [m = named.material](int r) { return hanging(m, r); }});
  }
  return forms;
}

}  // namespace weft::tools::forms
