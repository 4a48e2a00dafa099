/// relax_runs: all runs of a batch in one call, as the engine's loop calls it; and the same with
/// every run flagged as satisfied, to be compared with relax_masked_satisfied_run.
#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

struct Case {
  simd::Isa isa;
  int size;
  bool skipped;
};

void pass(const simd::Table& table, const simd::BlockRelaxation& r, const Workbench& bench,
          const std::uint8_t* wanted, std::uint32_t* corrections) {
  for (const Workbench::Range& batch : bench.batches) {
    table.relax_runs(r, bench.runs.data() + batch.first, batch.singles - batch.first,
                     wanted == nullptr ? nullptr : wanted + batch.first, corrections + batch.first);
    for (std::size_t i = batch.singles; i < batch.last && wanted == nullptr; ++i) {
      corrections[i] = table.relax_singles(r, bench.pieces[i].first(), bench.pieces[i].last());
    }
  }
}

void run(benchmark::State& state, Shared& shared, const Case& c) {
  Workbench& bench = shared.workshop.get("grid", c.size, false);
  const simd::BlockRelaxation r = bench.relaxation();
  std::vector<std::uint32_t> corrections(bench.pieces.size());
  const std::vector<std::uint8_t> none(bench.pieces.size());
  for (auto _ : state) {
    pass(simd::table(c.isa), r, bench, c.skipped ? none.data() : nullptr, corrections.data());
  }
  const auto constraints = static_cast<double>(bench.constraint_slots());
  const auto slots = static_cast<double>(bench.slots());
  const auto pieces = static_cast<double>(bench.pieces.size());
  Work work{static_cast<double>(bench.constraints), 24 * constraints + 24 * slots + 20 * pieces,
            24 * constraints + 12 * slots + 20 * pieces};
  if (c.skipped) work.bytes = work.footprint = 5 * pieces;
  count(state, work, shared.bandwidth);
}

}  // namespace

void register_batch_benchmarks(Shared& shared) {
  for (const bool skipped : {false, true}) {
    for (const simd::Isa isa : supported_isas()) {
      for (const int size : kGridSizes) {
        const std::string name = (skipped ? "relax_runs_skipped/" : "relax_runs/") + name_of(isa) +
                                 '/' + std::to_string(size);
        benchmark::RegisterBenchmark(
            name.c_str(), [&shared, c = Case{isa, size, skipped}](benchmark::State& state) {
              run(state, shared, c);
            });
      }
    }
  }
}

}  // namespace weft::perf
