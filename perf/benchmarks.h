/// What every file of benchmarks registers, and what they share.
#pragma once

#include <benchmark/benchmark.h>
#include <weft/result.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "kernels/simd/isa.h"
#include "perf/bandwidth.h"
#include "perf/workbench.h"

namespace weft::perf {

struct Shared {
  Bandwidth bandwidth;
  Workshop workshop;
};

/// What one benchmark iteration goes through.
struct Work {
  double items = 0;      // constraints or particles
  double bytes = 0;      // that must move: each array element once per read and once per write
  double footprint = 0;  // bytes touched
  bool particles = false;
};
void count(benchmark::State& state, const Work& work, const Bandwidth& bandwidth);

/// A failure here is a mistake in the benchmark.
template <class T>
T& checked(Result<T>& result) {
  if (!result) std::fprintf(stderr, "%s\n", result.error().c_str()), std::exit(1);
  return result.value();
}

std::vector<simd::Isa> supported_isas();
std::string name_of(simd::Isa isa);
inline constexpr int kGridSizes[] = {20, 40, 100, 300, 1000};
inline constexpr int kIrregularSizes[] = {40, 120, 300};  // 14,400 particles: 120

/// kernel/ISA/size for each kernel, on grids: run(state, shared, kernel, isa, size).
template <class Kernels, class Run>
void register_on_grids(const Kernels& kernels, Shared& shared, Run&& run) {
  for (const auto& kernel : kernels) {
    for (const simd::Isa isa : supported_isas()) {
      for (const int size : kGridSizes) {
        const std::string name =
            std::string(kernel.name) + '/' + name_of(isa) + '/' + std::to_string(size);
        benchmark::RegisterBenchmark(name.c_str(), [=, &kernel, &shared](benchmark::State& state) {
          run(state, shared, kernel, isa, size);
        });
      }
    }
  }
}

void register_particle_benchmarks(Shared& shared);
void register_constraint_benchmarks(Shared& shared);
void register_batch_benchmarks(Shared& shared);
void register_contact_benchmarks(Shared& shared);
void register_layer_benchmarks(Shared& shared);
void register_yarn_benchmarks(Shared& shared);
void register_small_step_benchmarks(Shared& shared);
void register_direct_benchmarks();
void register_team_benchmarks();
void register_step_benchmarks();
void register_cloth_benchmarks();
void register_rest_benchmarks();

}  // namespace weft::perf
