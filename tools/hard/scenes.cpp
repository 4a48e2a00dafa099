#include "tools/hard/scenes.h"

#include "tools/hard/oracle.h"

namespace weft::tools::hard {

SceneDescription built_in(std::string_view name, const scenes::Options& options) {
  return scenes::make(name, options).value();
}

SceneDescription sheet(std::string_view name, int size) {
  scenes::Options options;
  options.size = size;
  return built_in(name, options);
}

SceneDescription pulled_chain(double stretch) {
  SceneDescription scene = built_in("chain", {});
  for (Vec3& position : scene.positions) position = stretch * position;
  scene.fixed.push_back(static_cast<std::uint32_t>(scene.positions.size() - 1));
  return scene;
}

void add_diagonals(SceneDescription& scene, int size) {
  const auto join = [&](int a, int b) {
    const auto first = static_cast<std::uint32_t>(a), second = static_cast<std::uint32_t>(b);
    scene.constraints.push_back(
        {first, second, length(scene.positions[first] - scene.positions[second])});
  };
  for (int i = 0; i + 1 < size; ++i) {
    for (int j = 0; j + 1 < size; ++j) {
      join(i * size + j, (i + 1) * size + j + 1);
      join(i * size + j + 1, (i + 1) * size + j);
    }
  }
}

}  // namespace weft::tools::hard
