/// Kernels of the yarn solver, each over all families: of `hang`, whose yarns are woven, and of an
/// irregular triangle mesh, whose yarns find their particles in quads.
#include "engine/model/model.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "perf/benchmarks.h"
#include "perf/meshes.h"
#include "tools/scenes/scenes.h"

namespace weft::perf {
namespace {

using kernels::kLanes;

/// The arrays of a YarnSolver, at the start of the scene.
struct Loom {
  std::shared_ptr<const Model> model;
  const YarnLayout& layout;
  kernels::Vectors x;
  kernels::AlignedVector<simd::YarnBaseSteps> base_step;
  kernels::AlignedVector<simd::YarnSystemRow> system;
  kernels::AlignedVector<simd::YarnDirections> start;
  kernels::AlignedVector<simd::YarnScratch> scratch;
  kernels::AlignedVector<float> base, u, t;

  Loom(std::shared_ptr<const Model> of, const simd::Table& table)
      : model(std::move(of)),
        layout(model->yarns()),
        x(model->initial_position),
        base_step(layout.rows()),
        system(layout.rows()),
        start(layout.rows()),
        scratch(layout.scratch_rows()),
        base(layout.places.floats),
        u(layout.places.floats),
        t(layout.places.floats) {
    split(table);
    for (const simd::YarnBlock& block : layout.blocks) {
      table.yarn_linearise(yarns_anew(), block, u.data(), scratch.data());
      table.yarn_keep_start(yarns_along_start(), block, u.data(), scratch.data());
    }
    for (const simd::YarnBlock& block : layout.blocks) table.yarn_precondition(yarns(), block, 0);
  }
  void split(const simd::Table& table) {
    layout.places.split(table, x.view(), layout.cell, 0, model->slots(), base.data(), u.data());
  }
  simd::Yarns yarns() {
    return {layout.kind.data(),
            layout.kinds.data(),
            system.data(),
            layout.slot.data(),
            layout.patches.data(),
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
  /// Scheme rattle's.
  simd::Yarns yarns_along_start() {
    simd::Yarns along = yarns();
    along.start = start.data();
    return along;
  }
  std::size_t first_end() const { return layout.family_begin[1]; }
};

std::shared_ptr<const Model> hang(int size) {
  scenes::Options options;
  options.size = size;
  return build_model(scenes::make("hang", options).value()).value();
}

struct Kernel {
  const char* name;
  double bytes;      // of a lane of a row, or of a particle: read + written
  double footprint;  // touched
  void (*pass)(const simd::Table& table, Loom& loom);
  int solves = 1;
  bool particles = false;
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
  float* t = loom.t.data();
  simd::YarnScratch* scratch = loom.scratch.data();
  for_each_block(loom, first, all, [&](const simd::YarnBlock& block) {
    table.yarn_push_first(loom.yarns(), block, 0, t, scratch);
  });
  for_each_block(loom, 0, first, [&](const simd::YarnBlock& block) {
    table.yarn_eliminate(loom.yarns(), block, t, simd::YarnElimination::changes, scratch);
  });
  for_each_block(loom, first, all, [&](const simd::YarnBlock& block) {
    benchmark::DoNotOptimize(table.yarn_pull(loom.yarns(), block, t, scratch));
  });
}

/// Nothing is enough: no block is left alone.
void watched(const simd::Table& table, Loom& loom, std::uint32_t most) {
  for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
    benchmark::DoNotOptimize(table.yarn_sweep_watched(loom.yarns(), block, loom.u.data(),
                                                      loom.scratch.data(), -1, most));
  });
}

void sweep(const simd::Table& table, Loom& loom) {
  for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
    table.yarn_sweep(loom.yarns(), block, loom.u.data(), loom.scratch.data());
  });
}

constexpr Kernel kKernels[] = {
    {"yarn_split", 48, 48, [](const auto& table, Loom& loom) { loom.split(table); }, 1, true},
    {"yarn_join", 72, 48,
     [](const simd::Table& table, Loom& loom) {
       loom.layout.places.join(table, loom.x.view(), 0, loom.model->slots(), loom.base.data(),
                               loom.u.data());
     },
     1, true},
    {"yarn_add", 36, 24,
     [](const simd::Table& table, Loom& loom) {
       table.yarn_add(loom.u.data(), loom.t.data(), 0, loom.u.size());
     },
     1, true},
    {"yarn_sweep", 28, 10, sweep},
    {"yarn_sweep_watched", 28, 10, [](const auto& table, Loom& loom) { watched(table, loom, 1); }},
    {"yarn_sweep_repeated", 800, 42,
     [](const auto& table, Loom& loom) { watched(table, loom, kRepeats); }, kRepeats},
    {"yarn_sweep_first", 40, 16,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         table.yarn_sweep(loom.yarns_anew(), block, loom.u.data(), loom.scratch.data());
       });
     }},
    {"yarn_sweep_along_start", 40, 22,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         table.yarn_sweep(loom.yarns_along_start(), block, loom.u.data(), loom.scratch.data());
       });
     }},
    {"yarn_linearise", 64, 64,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         table.yarn_linearise(loom.yarns_anew(), block, loom.u.data(), loom.scratch.data());
       });
     }},
    {"yarn_precondition", 40, 40,
     [](const simd::Table& table, Loom& loom) {
       for_each_block(loom, 0, loom.layout.blocks.size(), [&](const simd::YarnBlock& block) {
         benchmark::DoNotOptimize(table.yarn_precondition(loom.yarns(), block, 0));
       });
     }},
    {"yarn_multiply", 56, 28, multiply},
};
constexpr Kernel kInQuads{"yarn_sweep_irregular", 40, 24, sweep};

void run(benchmark::State& state, const Shared& shared, const Kernel& kernel, simd::Isa isa,
         std::shared_ptr<const Model> model) {
  const simd::Table& table = simd::table(isa);
  Loom loom(std::move(model), table);
  for (auto _ : state) kernel.pass(table, loom);
  const auto lanes = static_cast<double>(loom.layout.rows() * kLanes);
  const auto particles = static_cast<double>(loom.model->particles);
  const auto constraints = static_cast<double>(loom.model->constraints.size());
  const double pieces = kernel.particles ? particles : lanes;
  count(state,
        {kernel.particles ? particles : constraints * kernel.solves, kernel.bytes * pieces,
         kernel.footprint * pieces, kernel.particles},
        shared.bandwidth);
}

void register_irregular(Shared& shared) {
  for (const simd::Isa isa : supported_isas()) {
    for (const int size : kIrregularSizes) {
      const std::string name =
          std::string(kInQuads.name) + '/' + name_of(isa) + '/' + std::to_string(size);
      benchmark::RegisterBenchmark(name.c_str(), [=, &shared](benchmark::State& state) {
        run(state, shared, kInQuads, isa, build_model(irregular(size)).value());
      });
    }
  }
}

}  // namespace

void register_yarn_benchmarks(Shared& shared) {
  register_on_grids(kKernels, shared,
                    [](benchmark::State& state, const Shared& all, const Kernel& kernel,
                       simd::Isa isa, int size) { run(state, all, kernel, isa, hang(size)); });
  register_irregular(shared);
}

}  // namespace weft::perf
