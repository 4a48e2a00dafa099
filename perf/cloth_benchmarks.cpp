/// Many cloths: sheets of cotton of 20 x 20 particles that swing from one edge.
///
///   step_all/CLOTHS/THREADS     as one batch, on so many threads
///   one_by_one/CLOTHS/THREADS   one cloth after the other, each on so many threads
///
/// One benchmark iteration is a frame of 0.01 s of all cloths, by the clock.
#include <tbb/task_arena.h>
#include <weft/batch.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "perf/benchmarks.h"
#include "tools/scenes/scenes.h"

namespace weft::perf {
namespace {

constexpr double kFrame = 0.01;  // s
constexpr int kFrames = 40;      // all do the same ones
constexpr int kSize = 20;

std::vector<Cloth> cloths_of_cotton(std::int64_t number) {
  auto scene = scenes::make("hang", {.size = kSize, .material = find_material("cotton").value()});
  auto model = build_model(checked(scene));
  std::vector<Cloth> cloths;
  for (std::int64_t i = 0; i < number; ++i) {
    auto cloth = Cloth::create(checked(model), {});
    cloths.push_back(std::move(checked(cloth)));
  }
  return cloths;
}

class Frames {
 public:
  explicit Frames(std::int64_t number) : cloths_(cloths_of_cotton(number)) {
    for (Cloth& cloth : cloths_) steps_.push_back({.cloth = &cloth, .dt = kFrame});
  }

  void step_as_one_batch() {
    step_all(steps_);
    for (ClothStep& step : steps_) note(step.result);
  }

  void step_one_by_one() {
    for (Cloth& cloth : cloths_) {
      auto result = cloth.step(kFrame);
      note(result);
    }
  }

  double max_strain() const { return max_strain_; }

 private:
  void note(Result<StepReport>& result) {
    max_strain_ = std::max(max_strain_, checked(result).max_strain);
  }

  std::vector<Cloth> cloths_;
  std::vector<ClothStep> steps_;
  double max_strain_ = 0;
};

void run(benchmark::State& state, void (Frames::*step)()) {
  Frames frames(state.range(0));
  tbb::task_arena arena(static_cast<int>(state.range(1)));
  arena.execute([&] { (frames.*step)(); });  // memory of the first step
  for (auto _ : state) arena.execute([&] { (frames.*step)(); });
  state.counters["max_strain"] = frames.max_strain();
}

}  // namespace

void register_cloth_benchmarks() {
  const auto add = [](const char* name, void (Frames::*step)()) {
    auto* made =
        benchmark::RegisterBenchmark(name, [step](benchmark::State& state) { run(state, step); });
    made->ArgsProduct({{8, 1000}, {1, 2}})
        ->Iterations(kFrames)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("step_all", &Frames::step_as_one_batch);
  add("one_by_one", &Frames::step_one_by_one);
}

}  // namespace weft::perf
