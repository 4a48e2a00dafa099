#include <weft/weft.h>

#include <algorithm>
#include <cstdio>
#include <string>

int fail(const std::string& message) { return std::puts(message.c_str()), 1; }

int main() {
  weft::SceneDescription scene;  // ten particles in a level line, 1 cm apart
  for (unsigned i = 0; i < 10; ++i) {
    scene.positions.push_back({0.01 * i, 0, 0});
    scene.masses.push_back(0.005);
    if (i > 0) scene.constraints.push_back({i - 1, i, 0.01});
  }
  scene.fixed = {0};
  const auto model = weft::build_model(scene);
  if (!model) return fail(model.error());
  auto cloth = weft::Cloth::create(model.value(), {.tolerance = 0.001});  // 0.1 %
  if (!cloth) return fail(cloth.error());

  double max_strain = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const auto report = cloth.value().step(0.01);
    if (!report) return fail(report.error());
    if (report.value().status != weft::Status::converged) return fail("tolerance missed");
    max_strain = std::max(max_strain, report.value().max_strain);
  }
  std::printf("after 1 s the end is at y = %g m; largest strain on the way: %g\n",
              cloth.value().position(9).y, max_strain);
}
