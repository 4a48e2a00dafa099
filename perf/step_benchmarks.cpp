/// Whole steps, each timing beside the error that it bought.
///
///   step/SCENE/BACKEND/METHOD/SIZE     to 1 %: time per step
///   iterate/SCENE/BACKEND/METHOD/SIZE  exactly kIterations iterations per step: time per
///   constraint
///                                      and iteration, everything in the step included
///
/// Both take kSteps steps from the start. Steps are as much shorter as the mesh is finer: with a
/// fixed length a step would move a fine mesh by more than an edge.
#include <algorithm>
#include <memory>

#include "perf/benchmarks.h"
#include "tools/scenes/scenes.h"

namespace weft::perf {
namespace {

constexpr int kSteps = 100;
constexpr int kIterations = 50;

/// A method of the paper under the numbers of its sections.
struct Method {
  const char* name;
  weft::Directions directions;
  bool anticipate, skip;
};
constexpr Method kMethods[] = {
    {"original", weft::Directions::each, false, false},
    {"4.3", weft::Directions::each, false, true},
    {"4.2", weft::Directions::each, true, false},
    {"4.2+4.3", weft::Directions::each, true, true},
    {"4.4", weft::Directions::frozen, false, false},
    {"4.3+4.4", weft::Directions::frozen, false, true},
    {"4.2+4.4", weft::Directions::frozen, true, false},
    {"4.2+4.3+4.4", weft::Directions::frozen, true, true},
};

struct Case {
  std::string scene;
  int size;
  Backend backend;
  simd::Isa isa;
  Method method;
  int iterations;
};

std::string case_name(const Case& c) {
  const std::string backend = c.backend == Backend::reference ? "reference" : perf::name_of(c.isa);
  return std::string(c.iterations > 0 ? "iterate/" : "step/") + c.scene + '/' + backend + '/' +
         c.method.name + '/' + std::to_string(c.size);
}

Settings settings_of(const Case& c) {
  Settings settings = paper_settings();
  settings.backend = c.backend;
  settings.isa = static_cast<Isa>(static_cast<int>(c.isa) + 1);  // Isa::automatic comes first
  settings.threads = 1;
  settings.measuring.directions = c.method.directions;
  settings.measuring.anticipate = c.method.anticipate;
  settings.measuring.skip = c.method.skip;
  settings.iterations = c.iterations;
  return settings;
}

std::shared_ptr<const Model> model_of(const Case& c) {
  auto scene = c.scene == "irregular" ? Result<SceneDescription>(irregular(c.size))
                                      : scenes::make(c.scene, {.size = c.size});
  auto model = build_model(checked(scene));
  return checked(model);
}

/// What kSteps steps did.
struct Totals {
  double iterations = 0, visits = 0, corrections = 0, max_strain = 0;
};

void run_steps(Cloth& cloth, double dt, Totals& totals) {
  for (int i = 0; i < kSteps; ++i) {
    auto result = cloth.step(dt);
    const StepReport& report = checked(result);
    totals.iterations += static_cast<double>(report.iterations);
    totals.visits += static_cast<double>(report.visits);
    totals.corrections += static_cast<double>(report.corrections);
    totals.max_strain = std::max(totals.max_strain, report.max_strain);
  }
}

/// One benchmark iteration is kSteps steps from the start.
void run(benchmark::State& state, const Case& c) {
  using benchmark::Counter;
  const auto model = model_of(c);
  const Settings settings = settings_of(c);
  Totals totals;
  for (auto _ : state) {
    state.PauseTiming();
    auto cloth = Cloth::create(model, settings);
    totals = {};
    state.ResumeTiming();
    run_steps(checked(cloth), 0.2 / c.size, totals);
  }
  const auto time_for = Counter::kIsIterationInvariantRate | Counter::kInvert;
  const double constraints = static_cast<double>(describe(*model).constraints);
  state.counters["max_strain"] = totals.max_strain;
  state.counters["ms_per_step"] = Counter(kSteps * 1e-3, time_for);
  state.counters["ns_per_constraint_iteration"] =
      Counter(constraints * totals.iterations * 1e-9, time_for);
  state.counters["ns_per_visit"] = Counter(totals.visits * 1e-9, time_for);
  state.counters["iterations_per_step"] = totals.iterations / kSteps;
  state.counters["corrected_share"] = totals.corrections / std::max(1.0, totals.visits);
}

void add(const Case& c) {
  benchmark::RegisterBenchmark(case_name(c).c_str(), [c](benchmark::State& state) {
    run(state, c);
  })->Unit(benchmark::kMillisecond);
}

void add_methods(const std::string& scene, int size, Backend backend, simd::Isa isa) {
  for (const Method& method : kMethods) add({scene, size, backend, isa, method, 0});
  for (const Method& method : kMethods) {
    if (!method.skip) add({scene, size, backend, isa, method, kIterations});
  }
}

}  // namespace

void register_step_benchmarks() {
  for (const int size : {20, 40}) {
    add_methods("hang", size, Backend::reference, simd::best_isa());
    for (const simd::Isa isa : supported_isas()) add_methods("hang", size, Backend::simd, isa);
  }
  const Method& all = std::end(kMethods)[-1];
  const Method& frozen = kMethods[4];
  for (const simd::Isa isa : supported_isas()) {
    add({"hang", 100, Backend::simd, isa, all, 0});
    for (const int size : {100, 300}) {
      add({"hang", size, Backend::simd, isa, frozen, kIterations});
    }
    for (const int size : kIrregularSizes) {
      add({"irregular", size, Backend::simd, isa, frozen, kIterations});
    }
  }
}

}  // namespace weft::perf
