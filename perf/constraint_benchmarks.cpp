/// Kernels that go through all constraints, colour by colour, in pieces as the engine calls them.
///
///   NAME_run        a grid in runs
///   NAME_singles    the same grid, every constraint finding its particles through an index
///   NAME_quads      the same again, displacements in quads
///   NAME_irregular  an irregular triangle mesh as the engine has it: singles, in quads
#include <algorithm>

#include "engine/solvers/sweeps/pull_layout.h"
#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

/// The tables' arguments, made once per benchmark.
struct Arguments {
  const simd::Table& table;
  simd::BlockRelaxation r;
  simd::Geometry g;
  simd::Anticipation p;
  const PullLayout* pulls;  // anticipation only
  kernels::VectorsView v;
};

/// Bytes that must move per constraint and per slot.
struct Traffic {
  double per_constraint, per_slot;  // read + written
  double footprint_per_constraint, footprint_per_slot;
  double per_pull = 0;  // anticipation only: footprint and traffic
};

struct Kernel {
  const char* name;
  Traffic traffic;
  bool anticipates, moves;  // moves: reads and writes displacements
  float threshold;
  void (*run)(const Arguments&, const Piece&);
  void (*singles)(const Arguments&, const Piece&);  // null: as relax; only measured in runs
};

constexpr float kNothingIsCorrected = 1e30f;

/// Some blocks of a run may be scattered, too.
void relax_anticipated(const Arguments& x, const Piece& piece) {
  x.pulls->for_each_stretch(piece.first(), piece.last(),
                            [&](std::uint32_t first, std::uint32_t last, bool scattered) {
                              if (scattered) {
                                x.table.relax_anticipated_singles(x.p, first, last);
                              } else {
                                x.table.relax_anticipated_run(x.p, {0, 0, first, last - first});
                              }
                            });
}
void renew_products(const Arguments& x, const Piece& piece) {
  x.pulls->for_each_stretch(piece.first(), piece.last(),
                            [&](std::uint32_t first, std::uint32_t last, bool scattered) {
                              if (scattered) {
                                x.table.renew_products_singles(x.p, x.r, first, last);
                              } else {
                                x.table.renew_products_run(x.p, x.r, {0, 0, first, last - first});
                              }
                            });
}

constexpr Kernel kKernels[] = {
    {"renew",
     {32, 24, 32, 24},
     false,
     false,
     0,
     [](const Arguments& x, const Piece& piece) { x.table.renew_run(x.g, x.r, piece.run); },
     [](const Arguments& x, const Piece& piece) {
       x.table.renew_singles(x.g, x.r, piece.first(), piece.last());
     }},
    {"renew_velocity",
     {24, 48, 24, 48},
     false,
     false,
     0,
     [](const Arguments& x, const Piece& piece) {
       x.table.renew_velocity_run(x.g, x.v, x.r, piece.run);
     },
     [](const Arguments& x, const Piece& piece) {
       x.table.renew_velocity_singles(x.g, x.v, x.r, piece.first(), piece.last());
     }},
    {"relax",
     {24, 24, 24, 12},
     false,
     true,
     0,
     [](const Arguments& x, const Piece& piece) { x.table.relax_run(x.r, piece.run); },
     [](const Arguments& x, const Piece& piece) {
       x.table.relax_singles(x.r, piece.first(), piece.last());
     }},
    {"relax_satisfied",
     {24, 12, 24, 12},
     false,
     true,
     kNothingIsCorrected,
     [](const Arguments& x, const Piece& piece) { x.table.relax_run(x.r, piece.run); },
     [](const Arguments& x, const Piece& piece) {
       x.table.relax_singles(x.r, piece.first(), piece.last());
     }},
    {"relax_rope",
     {32, 24, 28, 12},
     false,
     true,
     0,
     [](const Arguments& x, const Piece& piece) { x.table.relax_rope_run(x.r, piece.run); },
     [](const Arguments& x, const Piece& piece) {
       x.table.relax_rope_singles(x.r, piece.first(), piece.last());
     }},
    {"relax_masked",
     {24, 40, 24, 20},
     false,
     true,
     0,
     [](const Arguments& x, const Piece& piece) {
       std::uint64_t visits = 0;
       x.table.relax_masked_run(x.r, piece.run, std::uint64_t{1} << piece.colour % 64, visits);
       benchmark::DoNotOptimize(visits);
     },
     nullptr},
    {"relax_masked_satisfied",
     {0, 8, 0, 8},
     false,
     true,
     kNothingIsCorrected,
     [](const Arguments& x, const Piece& piece) {
       std::uint64_t visits = 0;
       x.table.relax_masked_run(x.r, piece.run, std::uint64_t{1} << piece.colour % 64, visits);
       benchmark::DoNotOptimize(visits);
     },
     nullptr},
    {"relax_anticipated", {20, 0, 12, 0, 4}, true, false, 0, relax_anticipated, relax_anticipated},
    {"renew_products", {28, 0, 28, 0, 8}, true, false, 0, renew_products, renew_products},
    {"apply_sums",
     {28, 24, 24, 12},
     true,
     true,
     0,
     [](const Arguments& x, const Piece& piece) { x.table.apply_sums_run(x.p, x.r, piece.run); },
     [](const Arguments& x, const Piece& piece) {
       x.table.apply_sums_singles(x.p, x.r, piece.first(), piece.last());
     }},
    {"refresh_errors",
     {32, 12, 32, 12},
     true,
     true,
     0,
     [](const Arguments& x, const Piece& piece) {
       x.table.refresh_errors_run(x.p, x.r, piece.run);
     },
     [](const Arguments& x, const Piece& piece) {
       x.table.refresh_errors_singles(x.p, x.r, piece.first(), piece.last());
     }},
    {"strain",
     {16, 24, 16, 24},
     false,
     false,
     0,
     [](const Arguments& x, const Piece& piece) {
       benchmark::DoNotOptimize(x.table.strain_run(x.g, piece.run, false));
     },
     [](const Arguments& x, const Piece& piece) {
       benchmark::DoNotOptimize(x.table.strain_singles(x.g, piece.first(), piece.last(), false));
     }},
    {"stretch",
     {8, 24, 16, 24},
     false,
     false,
     0,
     [](const Arguments& x, const Piece& piece) {
       benchmark::DoNotOptimize(x.table.stretch_runs(x.g, &piece.run, 1, false));
     },
     [](const Arguments& x, const Piece& piece) {
       benchmark::DoNotOptimize(x.table.stretch_singles(x.g, piece.first(), piece.last(), false));
     }},
};

void pass(const Kernel& kernel, const Arguments& x, const Workbench& bench) {
  for (const Piece& piece : bench.pieces) {
    if (!piece.singles) {
      kernel.run(x, piece);
    } else if (kernel.singles != nullptr) {
      kernel.singles(x, piece);
    } else {
      x.table.relax_singles(x.r, piece.first(), piece.last());
    }
  }
}

Work work_of(const Kernel& kernel, Workbench& bench) {
  const Traffic& t = kernel.traffic;
  const auto slots = static_cast<double>(bench.slots());
  const auto constraints = static_cast<double>(bench.constraint_slots());
  Work work;
  work.items = static_cast<double>(bench.constraints);
  work.bytes = t.per_constraint * constraints + t.per_slot * slots;
  work.footprint = t.footprint_per_constraint * constraints + t.footprint_per_slot * slots;
  for (const Piece& piece : bench.pieces) {
    if (piece.singles) work.bytes += 8 * piece.run.length, work.footprint += 8 * piece.run.length;
  }
  if (!kernel.anticipates) return work;
  const double pulled = static_cast<double>(bench.pulls().pulls()) * kernels::kLanes;
  work.bytes += t.per_pull * pulled;
  work.footprint += t.per_pull * pulled;
  return work;
}

Arguments arguments_of(const Kernel& kernel, bool in_quads, Workbench& bench, simd::Isa isa) {
  Arguments x{simd::table(isa), bench.relaxation(in_quads), bench.geometry(), {},
              nullptr,          bench.velocity.view()};
  x.r.threshold = kernel.threshold;
  if (kernel.anticipates) {
    x.pulls = &bench.pulls();
    x.p = bench.anticipation(kernel.threshold);
    for (const Piece& piece : bench.pieces) renew_products(x, piece);
  }
  // Ropes, and masks: as before the first pass.
  std::fill(bench.impulse.begin(), bench.impulse.end(), 0.f);
  std::fill(bench.mask.begin(), bench.mask.end(), ~std::uint64_t{0});
  return x;
}

struct Case {
  const Kernel& kernel;
  const char* mesh;
  bool singles, in_quads;
  simd::Isa isa;
  int size;
};

void run(benchmark::State& state, Shared& shared, const Case& c) {
  Workbench& bench = shared.workshop.get(c.mesh, c.size, c.singles);
  const Arguments x = arguments_of(c.kernel, c.in_quads, bench, c.isa);
  pass(c.kernel, x, bench);
  for (auto _ : state) pass(c.kernel, x, bench);
  count(state, work_of(c.kernel, bench), shared.bandwidth);
}

void add(Shared& shared, const Case& c, const char* form) {
  const std::string name =
      std::string(c.kernel.name) + form + '/' + name_of(c.isa) + '/' + std::to_string(c.size);
  benchmark::RegisterBenchmark(name.c_str(),
                               [&shared, c](benchmark::State& state) { run(state, shared, c); });
}

}  // namespace

void register_constraint_benchmarks(Shared& shared) {
  for (const Kernel& kernel : kKernels) {
    for (const simd::Isa isa : supported_isas()) {
      const bool quads = kernel.moves && !kernel.anticipates;
      for (const int n : kGridSizes) add(shared, {kernel, "grid", false, false, isa, n}, "_run");
      if (kernel.singles == nullptr) continue;
      for (const int n : kGridSizes) add(shared, {kernel, "grid", true, false, isa, n}, "_singles");
      for (const int n : kIrregularSizes) {
        add(shared, {kernel, "irregular", false, quads, isa, n}, "_irregular");
      }
      if (!quads) continue;
      for (const int n : kGridSizes) add(shared, {kernel, "grid", true, true, isa, n}, "_quads");
    }
  }
}

}  // namespace weft::perf
