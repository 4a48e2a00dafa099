/// The direct solver's linear algebra: factors and substitutions of `hang`.
#include <algorithm>

#include "engine/model/model.h"
#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_layout.h"
#include "perf/benchmarks.h"
#include "tools/scenes/scenes.h"

namespace weft::perf {
namespace {

constexpr int kSizes[] = {20, 40, 80, 160};

struct Problem {
  std::shared_ptr<const Model> model;
  const DirectLayout& layout;
  std::vector<kernels::Vector> n;

  explicit Problem(int size) : model(model_of(size)), layout(model->direct()) {
    Random random(1);
    for (std::size_t k = 0; k < layout.rows(); ++k) {
      const kernels::Vector d{1 + random.unit(), random.unit(), random.unit()};
      n.push_back((1 / length(d)) * d);
    }
  }
  static std::shared_ptr<const Model> model_of(int size) {
    scenes::Options options;
    options.size = size;
    return build_model(scenes::make("hang", options).value()).value();
  }
  void factorise(DirectFactor& factor) const {
    factor.factorise(
        [&](std::size_t e) {
          return layout.entry_weight[e] * dot(n[layout.entry_row[e]], n[layout.entry_with[e]]);
        },
        [&](std::size_t k) { return layout.diagonal[k]; });
  }
};

void report(benchmark::State& state, const Problem& problem) {
  using benchmark::Counter;
  constexpr auto kRate = Counter::kIsIterationInvariantRate;
  const auto rows = static_cast<double>(problem.layout.rows());
  state.counters["ns_per_constraint"] = Counter(rows * 1e-9, kRate | Counter::kInvert);
  state.counters["values_per_constraint"] =
      static_cast<double>(problem.layout.fronts.values) / rows;
}

void factor(benchmark::State& state, simd::Isa isa, int size) {
  const Problem problem(size);
  DirectFactor factor(problem.layout, simd::table(isa));
  for (auto _ : state) problem.factorise(factor);
  report(state, problem);
}

void solve(benchmark::State& state, simd::Isa isa, int size) {
  const Problem problem(size);
  DirectFactor factor(problem.layout, simd::table(isa));
  problem.factorise(factor);
  std::vector<double> b(problem.layout.rows());
  for (auto _ : state) {
    std::ranges::fill(b, 1.0);
    factor.solve(b.data());
    benchmark::DoNotOptimize(b.data());
  }
  report(state, problem);
}

}  // namespace

void register_direct_benchmarks() {
  for (const simd::Isa isa : supported_isas()) {
    for (const int size : kSizes) {
      const std::string end = '/' + name_of(isa) + '/' + std::to_string(size);
      benchmark::RegisterBenchmark(("direct_factor" + end).c_str(),
                                   [=](benchmark::State& state) { factor(state, isa, size); });
      benchmark::RegisterBenchmark(("direct_solve" + end).c_str(),
                                   [=](benchmark::State& state) { solve(state, isa, size); });
    }
  }
}

}  // namespace weft::perf
