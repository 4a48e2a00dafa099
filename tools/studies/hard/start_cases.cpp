/// Starts that no constraint likes: the sheet must find back to its tolerance.
#include <algorithm>
#include <random>

#include "tools/studies/hard/scenes.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {
namespace {

constexpr int kSize = 10;

/// The figure is the strain in the end; on the way, reports must be true.
Outcome run_start(const Setup& setup, const SceneDescription& start) {
  Trial trial{start, setup.settings(kStrain)};
  trial.steps = setup.steps(300, 100);
  const Observed o = observe(trial);
  return outcome(o.end_strain, o, kAnyEnergy);
}

SceneDescription scaled(double factor) {
  SceneDescription scene = sheet("hang", kSize);
  const Vec3 middle{0, 0, 0.5};
  replace_free(scene, [&](std::uint32_t, Vec3 at) { return middle + factor * (at - middle); });
  return scene;
}

SceneDescription scrambled() {
  SceneDescription scene = sheet("hang", kSize);
  std::mt19937 bits(1);
  const auto any = [&] { return static_cast<double>(bits()) / 4294967296.0; };
  replace_free(scene, [&](std::uint32_t, Vec3) {
    const double x = any(), y = any() - 0.5, z = any();
    return Vec3{x, y, z};
  });
  return scene;
}

SceneDescription placed(Vec3 (*place)(Vec3)) {
  SceneDescription scene = sheet("hang", kSize);
  replace_free(scene, [&](std::uint32_t, Vec3 at) { return place(at); });
  return scene;
}

SceneDescription with_zero_edge() {
  SceneDescription scene = sheet("hang", kSize);
  scene.positions[kSize * 5 + 5] = scene.positions[kSize * 5 + 4];
  return scene;
}

}  // namespace

std::vector<Case> start_cases() {
  const std::pair<const char*, SceneDescription> starts[] = {
      {"start_scaled_0.5", scaled(0.5)},
      {"start_scaled_2", scaled(2)},
      {"start_scrambled", scrambled()},
      {"start_on_a_line", placed([](Vec3 at) {
         return Vec3{at.x, 0, 0.5};
       })},
      {"start_in_a_point", placed([](Vec3) {
         return Vec3{0.5, 0, 0.5};
       })},
      {"start_edge_of_no_length", with_zero_edge()},
      {"start_folded", placed([](Vec3 at) {
         return Vec3{std::min(at.x, 1 - at.x), 0, at.z};
       })},
  };
  std::vector<Case> cases;
  for (const auto& [name, start] : starts) {
    cases.push_back({name, "strain in the end", kStrain,
                     [start = start](const Setup& setup) { return run_start(setup, start); }});
  }
  return cases;
}

}  // namespace weft::tools::hard
