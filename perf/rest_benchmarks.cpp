/// Whole frames of scenes whose layers rest on each other, by the clock:
///
///   rest_on_layers/SCENE/SIZE
#include <weft/weft.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "perf/benchmarks.h"
#include "tools/scenes/body_moves.h"
#include "tools/scenes/scenes.h"

namespace weft::perf {
namespace {

constexpr double kFrame = 1.0 / 60;
constexpr int kFrames = 20, kFramesBefore = 60;

struct Rest {
  const char* scene;
  int size;
};

/// At rest, or nearly; each benchmark goes on from there.
const Cloth& rested(const Rest& rest) {
  static std::map<const Rest*, std::unique_ptr<Cloth>> made;
  auto& cloth = made[&rest];
  if (cloth) return *cloth;
  auto scene = scenes::make_scene(rest.scene, {.size = rest.size});
  auto model = build_model(checked(scene).description);
  auto created = Cloth::create(checked(model), {.threads = 1});
  cloth = std::make_unique<Cloth>(std::move(checked(created)));
  auto added = tools::MovedBodies::add(scene.value().bodies, *cloth);
  checked(added);
  for (int frame = 0; frame < kFramesBefore; ++frame) {
    auto report = cloth->step(kFrame);
    checked(report);
  }
  return *cloth;
}

void run_rest(benchmark::State& state, const Rest& rest) {
  Cloth cloth = rested(rest).clone();
  ContactMs ms{};
  double pairs = 0, frames = 0, max_strain = 0;
  for (auto _ : state) {
    auto result = cloth.step(kFrame);
    const StepReport& report = checked(result);
    ms.find += report.contact_ms.find;
    ms.sweep += report.contact_ms.sweep;
    ms.verify += report.contact_ms.verify;
    pairs += static_cast<double>(report.substeps) * report.self_contacts;
    max_strain = std::max(max_strain, report.max_strain);
    ++frames;
  }
  state.counters["max_strain"] = max_strain;
  state.counters["touching"] = pairs / frames;  // times substeps
  state.counters["find_ms"] = ms.find / frames;
  state.counters["sweep_ms"] = ms.sweep / frames;
  state.counters["verify_ms"] = ms.verify / frames;
  state.counters["ns_per_touch"] = 1e6 * (ms.find + ms.sweep + ms.verify) / pairs;
}

}  // namespace

void register_rest_benchmarks() {
  static constexpr Rest kRests[] = {{"stack", 20}, {"fold", 20}};
  for (const Rest& rest : kRests) {
    const std::string name =
        std::string("rest_on_layers/") + rest.scene + '/' + std::to_string(rest.size);
    benchmark::RegisterBenchmark(name.c_str(),
                                 [&rest](benchmark::State& state) { run_rest(state, rest); })
        ->Iterations(kFrames)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace weft::perf
