/// Kernels of the yarn solver, each over all families of `hang`.
#include "engine/model.h"
#include "engine/scenes.h"
#include "engine/solvers/yarn_layout.h"
#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

using kernels::kLanes;

/// The arrays of a YarnSolver, at the start of the scene.
struct Loom {
  std::shared_ptr<const Model> model;
  const YarnLayout& layout;
  kernels::Vectors x;
  kernels::AlignedVector<std::int32_t> base_step;
  kernels::AlignedVector<simd::YarnSystemRow> system;
  kernels::AlignedVector<simd::YarnScratch> scratch;
  kernels::AlignedVector<float> base, u, t;

  Loom(int size, const simd::Table& table)
      : model(model_of(size)),
        layout(model->yarns()),
        x(model->initial_position),
        base_step(layout.rows() * kLanes),
        system(layout.rows()),
        scratch(layout.longest),
        base(4 * layout.slots),
        u(4 * layout.slots),
        t(4 * layout.slots) {
    table.split_positions(x.view(), quads(base), quads(u), layout.cell, 0, model->slots());
    for (const simd::YarnBlock& block : layout.blocks)
      table.yarn_linearise(yarns_anew(), block, quads(u));
    for (const simd::YarnBlock& block : layout.blocks) table.yarn_precondition(yarns(), block, 0);
  }
  static std::shared_ptr<const Model> model_of(int size) {
    scenes::Options options;
    options.size = size;
    return build_model(scenes::make("hang", options).value()).value();
  }
  simd::Yarns yarns() {
    return {layout.kind.data(),
            layout.kinds.data(),
            system.data(),
            layout.slot.data(),
            nullptr,
            false,
            base.data(),
            base_step.data(),
            static_cast<float>(layout.cell),
            false,
            layout.from_memory()};
  }
  /// Where positions have changed.
  simd::Yarns yarns_anew() {
    simd::Yarns changed = yarns();
    changed.moved = true;
    return changed;
  }
  static simd::Displacements quads(kernels::AlignedVector<float>& v) { return {v.data(), 1, 4}; }
  std::size_t first_end() const { return layout.family_begin[1]; }
};

struct Kernel {
  const char* name;
  double bytes_per_lane;      // of a row: read + written
  double footprint_per_lane;  // touched
  void (*pass)(const simd::Table& table, Loom& loom);
  int solves = 1;
};
constexpr int kRepeats = 12;

/// work(block) for all blocks.
template <class Work>
void for_each_block(Loom& loom, std::size_t first, std::size_t last, Work&& work) {
  for (std::size_t i = first; i < last; ++i) work(loom.layout.blocks[i]);
}

/// An iteration of conjugate gradients without its preconditioner.
void multiply(const simd::Table& table, Loom& loom) {
  const std::size_t first = loom.first_end(), all = loom.layout.blocks.size();
  const simd::Displacements t = Loom::quads(loom.t);
  for_each_block(loom, first, all, [&](const simd::YarnBlock& block) {
    table.yarn_push_first(loom.yarns(), block, 0, t);
  });
  for_each_block(loom, 0, first, [&](const simd::YarnBlock& block) {
    table.yarn_eliminate(loom.yarns(), block, t, false, loom.scratch.data());
  });
  for_each_block(loom, first, all, [&](const simd::YarnBlock& block) {
    benchmark::DoNotOptimize(table.yarn_pull(loom.yarns(), block, t));
  });
}

/// Nothing is enough: no block is left alone.
void watched(const simd::Table& table, Loom& loom, std::uint32_t most) {
  for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
    benchmark::DoNotOptimize(table.yarn_sweep_watched(loom.yarns(), block, Loom::quads(loom.u),
                                                      loom.scratch.data(), -1, most));
  });
}

constexpr Kernel kKernels[] = {
    {"yarn_sweep", 40, 24,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         table.yarn_sweep(loom.yarns(), block, Loom::quads(loom.u), loom.scratch.data());
       });
     }},
    {"yarn_sweep_watched", 40, 24, [](const auto& table, Loom& loom) { watched(table, loom, 1); }},
    {"yarn_sweep_repeated", 828, 56,
     [](const auto& table, Loom& loom) { watched(table, loom, kRepeats); }, kRepeats},
    {"yarn_sweep_first", 56, 40,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         table.yarn_sweep(loom.yarns_anew(), block, Loom::quads(loom.u), loom.scratch.data());
       });
     }},
    {"yarn_linearise", 60, 64,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         table.yarn_linearise(loom.yarns(), block, Loom::quads(loom.u));
       });
     }},
    {"yarn_precondition", 40, 40,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         benchmark::DoNotOptimize(table.yarn_precondition(loom.yarns(), block, 0));
       });
     }},
    {"yarn_multiply", 70, 38, multiply},
};

void run(benchmark::State& state, Shared& shared, const Kernel& kernel, simd::Isa isa, int size) {
  const simd::Table& table = simd::table(isa);
  Loom loom(size, table);
  for (auto _ : state) kernel.pass(table, loom);
  const auto lanes = static_cast<double>(loom.layout.rows() * kLanes);
  count(state,
        {static_cast<double>(loom.model->constraints.size()) * kernel.solves,
         kernel.bytes_per_lane * lanes, kernel.footprint_per_lane * lanes, false},
        shared.bandwidth);
}

}  // namespace

void register_yarn_benchmarks(Shared& shared) { register_on_grids(kKernels, shared, run); }

}  // namespace weft::perf
