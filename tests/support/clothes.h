/// Scenes, cloths and settings, with a failed test instead of an error to handle.
#pragma once

#include <weft/weft.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scenes/scenes.h"

namespace weft::test {

SceneDescription scene_of(std::string_view name, int size);
std::shared_ptr<const Model> model_of(const SceneDescription& scene);
Cloth cloth_of(const SceneDescription& scene, const Settings& settings);
/// The description that is changed so.
SceneDescription with(SceneDescription scene, const Changes& changes);
StepReport step(Cloth& cloth, double dt);
void run(Cloth& cloth, double dt, int steps);

std::vector<Vec3> positions(const Cloth& cloth);
std::vector<Vec3> velocities(const Cloth& cloth);
double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

/// Two free particles a bar of length 1 apart along x, without gravity.
SceneDescription free_bar(double mass_a, double mass_b);
/// The same of 1 kg each, joined by a rope of length 1.
SceneDescription free_rope(double start_distance);
/// On one line: A fixed at 0, then M at 0.3 and Q at 0.6, joined by bars, and P at 1.5 and R at
/// -0.35 on ropes of 1 to Q. M, Q and P fly to +x by 0.25 a step. In truth the bars hold M and Q,
/// and Q's rope holds P at 1.6; R's rope stays slack. But until the bars have settled Q is beyond
/// 0.65, whatever the order of visits: R's rope looks overstretched and pulls, all of which must be
/// taken back.
SceneDescription early_pull();

inline constexpr std::array kBackends{Backend::reference, Backend::simd};
Settings on(Backend backend, Settings settings = paper_settings());
/// What stands after it in a test case runs twice: once for each backend.
Backend each_backend();

/// One of the paper's ways to compute a step, and on what.
struct Method {
  Directions directions;
  bool anticipate;
  bool skip;
  Backend backend = Backend::reference;
};
/// All eight, on the reference; a method's neighbour at index ^ 1 differs in skip alone, at index ^
/// 2 in anticipate.
inline constexpr std::array<Method, 8> kMethods{{
    {Directions::each, false, false},
    {Directions::each, false, true},
    {Directions::each, true, false},
    {Directions::each, true, true},
    {Directions::frozen, false, false},
    {Directions::frozen, false, true},
    {Directions::frozen, true, false},
    {Directions::frozen, true, true},
}};
consteval std::array<Method, 16> on_both_backends() {
  std::array<Method, 16> all{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = kMethods[i % 8];
    if (i >= 8) all[i].backend = Backend::simd;
  }
  return all;
}
/// The eight on the reference, then the eight on the simd backend.
inline constexpr std::array<Method, 16> kAllMethods = on_both_backends();
std::string text(const Method& method);
Settings with(Settings settings, const Method& method);
/// Every constraint, contact and velocity to the same small error.
Settings tight(double tolerance);

/// How exactly an outcome is known beside its tolerance. The reference rounds in double: `exact`.
/// The simd backend shares what it takes from a constraint, `corrected` in all, out between the two
/// ends by factors and along directions rounded to float, a few roundings of 2^-24 each.
double exactness(Backend backend, double exact, double corrected);

}  // namespace weft::test
