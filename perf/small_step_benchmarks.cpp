/// A substep of small steps, all in, of a frame of sixteen, and its sweep alone: yarns of a woven
/// sheet, single edges of an irregular mesh, and a braced sheet, which has both.
#include <algorithm>

#include "engine/isa.h"
#include "engine/model/model.h"
#include "engine/solvers/small_steps/simd_small_steps.h"
#include "engine/tuning.h"
#include "perf/benchmarks.h"
#include "tools/scenes/scenes.h"

namespace weft::perf {
namespace {

struct Kind {
  const char* name;
  const char* scene;
  bool diagonals;
};
constexpr Kind kKinds[] = {
    {"yarns", "hang", false}, {"braced", "hang", true}, {"edges", "cape", false}};
constexpr int kSizes[] = {40, 120, 300};

Isa to_public(simd::Isa isa) {
  constexpr Isa kIsas[] = {Isa::sse2, Isa::avx2, Isa::avx512};
  return kIsas[static_cast<std::size_t>(isa)];
}

constexpr int kSubsteps = 16;

/// A cloth that is let go, in substeps as long as its load allows at 1 %.
struct Falling {
  std::shared_ptr<const Model> model;
  Team team{1};
  Settings settings;
  SmallStepsSolver solver;
  ContactStore contacts;
  kernels::Vectors x, v;

  Falling(const Kind& kind, simd::Isa isa, int size)
      : model(build_model(
                  scenes::make(kind.scene, {.size = size, .diagonals = kind.diagonals}).value())
                  .value()),
        settings(settings_on(isa)),
        solver(*model, settings, simd::table(isa)) {
    x = model->initial_position;
    v = model->initial_velocity;
    frame();
  }
  /// From its beginning, each time, to the velocities in its end.
  void frame() {
    const double h = std::min(0.005, solver.substep_length(x.view(), 10));
    solver.begin(x.view(), v.view(), model->gravity, {},
                 {.h = h, .substeps = kSubsteps, .omega = tuning::kOmega, .placed = true}, team);
    for (int k = 0; k < kSubsteps; ++k) {
      solver.advance(team);
      solver.sweep(team);
      solver.repair(contacts, static_cast<std::int64_t>(model->constraints.size()));
    }
    solver.settle(team);
  }
  static Settings settings_on(simd::Isa isa) {
    Settings settings;
    settings.solver = Solver::small_steps;
    settings.scheme = Scheme::bdf2;
    settings.isa = to_public(isa);
    settings.threads = 1;
    return settings;
  }
};

void run(benchmark::State& state, const Shared& shared, const Kind& kind, simd::Isa isa, int size,
         bool all) {
  Falling falling(kind, isa, size);
  for (auto _ : state) {
    if (all)
      falling.frame();
    else
      falling.solver.sweep(falling.team);
  }
  const auto edges = static_cast<double>(falling.model->constraints.size()) * (all ? kSubsteps : 1);
  const double footprint = static_cast<double>(falling.solver.bytes());
  const double bytes = footprint * (all ? kSubsteps : 1);  // about: each array once in a substep
  count(state, {.items = edges, .bytes = bytes, .footprint = footprint}, shared.bandwidth);
}

}  // namespace

void register_small_step_benchmarks(Shared& shared) {
  for (const bool all : {true, false}) {
    for (const Kind& kind : kKinds) {
      for (const simd::Isa isa : supported_isas()) {
        for (const int size : kSizes) {
          const std::string name = std::string(all ? "small_step/" : "small_step_sweep/") +
                                   kind.name + '/' + name_of(isa) + '/' + std::to_string(size);
          benchmark::RegisterBenchmark(name.c_str(), [=, &kind, &shared](benchmark::State& state) {
            run(state, shared, kind, isa, size, all);
          });
        }
      }
    }
  }
}

}  // namespace weft::perf
