/// weft_perf: microbenchmarks. See perf/README.md.
#include <cstdio>

#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

std::string in_gigabytes(double bytes_per_second) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB/s", bytes_per_second / 1e9);
  return text;
}

}  // namespace

void count(benchmark::State& state, const Work& work, const Bandwidth& bandwidth) {
  using benchmark::Counter;
  constexpr auto kRate = Counter::kIsIterationInvariantRate;
  const Bandwidth::Level& level = bandwidth.level(work.footprint);
  const char* each = work.particles ? "ns_per_particle" : "ns_per_constraint";
  state.counters[each] = Counter(work.items * 1e-9, kRate | Counter::kInvert);
  state.counters["items_per_second"] = Counter(work.items, kRate);
  state.counters["bytes_per_second"] = Counter(work.bytes, kRate, Counter::kIs1024);
  state.counters["copy_share"] = Counter(work.bytes / level.bytes_per_second, kRate);
  state.SetLabel(std::string(level.name));
}

std::vector<simd::Isa> supported_isas() {
  std::vector<simd::Isa> isas;
  for (const auto isa : {simd::Isa::sse2, simd::Isa::avx2, simd::Isa::avx512, simd::Isa::neon}) {
    if (simd::supported(isa)) isas.push_back(isa);
  }
  return isas;
}

std::string name_of(simd::Isa isa) {
  constexpr const char* kNames[] = {"sse2", "avx2", "avx512", "neon"};
  return kNames[static_cast<std::size_t>(isa)];
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  Shared shared;
  for (const Bandwidth::Level& level : shared.bandwidth.levels()) {
    benchmark::AddCustomContext("copy_" + std::string(level.name),
                                in_gigabytes(level.bytes_per_second));
  }
  register_particle_benchmarks(shared);
  register_constraint_benchmarks(shared);
  register_batch_benchmarks(shared);
  register_contact_benchmarks(shared);
  register_layer_benchmarks(shared);
  register_yarn_benchmarks(shared);
  register_small_step_benchmarks(shared);
  register_direct_benchmarks();
  register_team_benchmarks();
  register_step_benchmarks();
  register_cloth_benchmarks();
  register_rest_benchmarks();
  // A filter that matches nothing would pass unseen.
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}

}  // namespace weft::perf

int main(int argc, char** argv) { return weft::perf::run(argc, argv); }
