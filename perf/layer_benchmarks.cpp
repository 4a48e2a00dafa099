/// Kernels of contact, on layers that lie on each other:
///
///   contact_freeze_layers, contact_find_active_layers   each near pair, once
///   contact_visit_layers                                each pair that touches, in the rounds of a
///                                                       substep, from a fall
///   measure_pairs_layers                                each candidate, once
#include <map>
#include <string>

#include "engine/tuning.h"
#include "perf/benchmarks.h"
#include "perf/layer_contacts.h"
#include "perf/layers.h"

namespace weft::perf {
namespace {

constexpr int kSizes[] = {12, 40, 120};

/// They are made once: to find pairs takes seconds.
const Layers& layers_of(int size) {
  static std::map<int, Layers> made;
  const auto found = made.find(size);
  return found != made.end() ? found->second : made.emplace(size, make_layers(size)).first->second;
}

void run_freeze(benchmark::State& state, const Shared& shared, simd::Isa isa, int size) {
  const simd::Table& table = simd::table(isa);
  LayerContacts contacts(layers_of(size));
  contacts.fall(table);
  contacts.visit(table);  // multipliers to begin with
  for (auto _ : state) contacts.freeze(table);
  count(state,
        {.items = contacts.near(),
         .bytes = 2 * contacts.bytes(),
         .footprint = contacts.bytes() + contacts.move_bytes()},
        shared.bandwidth);
}

void run_find_active(benchmark::State& state, const Shared& shared, simd::Isa isa, int size) {
  const simd::Table& table = simd::table(isa);
  LayerContacts contacts(layers_of(size));
  contacts.fall(table);
  for (auto _ : state) contacts.find_active(table);
  const double bytes = contacts.bytes() + contacts.move_bytes();
  count(state, {.items = contacts.near(), .bytes = bytes, .footprint = bytes}, shared.bandwidth);
}

void run_visit(benchmark::State& state, const Shared& shared, simd::Isa isa, int size) {
  const simd::Table& table = simd::table(isa);
  LayerContacts contacts(layers_of(size));
  for (auto _ : state) {
    state.PauseTiming();
    contacts.fall(table);
    state.ResumeTiming();
    for (int round = 0; round < tuning::kContactRounds; ++round) contacts.visit(table);
  }
  const double bytes = contacts.active_bytes() + contacts.move_bytes();
  count(state,
        {.items = tuning::kContactRounds * contacts.touching(),
         .bytes = tuning::kContactRounds * bytes,
         .footprint = bytes},
        shared.bandwidth);
  state.counters["touching_share"] = contacts.touching() / contacts.near();
}

void run_measure_pairs(benchmark::State& state, const Shared& shared, simd::Isa isa, int size) {
  const simd::Table& table = simd::table(isa);
  LayerCandidates candidates(layers_of(size));
  for (auto _ : state) candidates.measure(table);
  const double bytes = candidates.bytes();
  count(state, {.items = candidates.count(), .bytes = bytes, .footprint = bytes}, shared.bandwidth);
  state.counters["near_share"] = candidates.near() / candidates.count();
}

}  // namespace

void register_layer_benchmarks(Shared& shared) {
  constexpr struct {
    const char* name;
    void (*run)(benchmark::State&, const Shared&, simd::Isa, int);
  } kKernels[] = {{"contact_freeze_layers", run_freeze},
                  {"contact_find_active_layers", run_find_active},
                  {"contact_visit_layers", run_visit},
                  {"measure_pairs_layers", run_measure_pairs}};
  for (const auto& kernel : kKernels) {
    for (const simd::Isa isa : supported_isas()) {
      for (const int size : kSizes) {
        const std::string name =
            std::string(kernel.name) + '/' + name_of(isa) + '/' + std::to_string(size);
        benchmark::RegisterBenchmark(
            name.c_str(), [run = kernel.run, isa, size, &shared](benchmark::State& state) {
              run(state, shared, isa, size);
            });
      }
    }
  }
}

}  // namespace weft::perf
