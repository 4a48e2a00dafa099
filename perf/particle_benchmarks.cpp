/// Kernels that go through all slots: predict, commit, find_near, split_quads, ...
#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

struct Kernel {
  const char* name;
  double bytes_per_slot;      // read + written
  double footprint_per_slot;  // touched
  void (*pass)(const simd::Table& table, Workbench& bench, const simd::BlockRelaxation& r);
};

constexpr double kStep = 0.01;

constexpr Kernel kKernels[] = {
    {"predict", 80, 80,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       t.predict(w.motion(), kStep, 0, w.slots());
     }},
    {"commit", 104, 104,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       t.commit(w.motion(), kStep, 0, w.slots());
     }},
    {"commit_watched", 112, 112,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       kernels::ImpulseEnergy impulses;
       t.commit_watched(w.motion(), kStep, 0, w.slots(), impulses);
       benchmark::DoNotOptimize(impulses);
     }},
    {"apply_displacements", 72, 36,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation& r) {
       t.apply_displacements(w.solved.view(), r.u, 0, w.slots());
     }},
    {"apply_displacements_quads", 80, 40,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation& r) {
       t.apply_displacements(w.solved.view(), {r.u.x, 1, 4}, 0, w.slots());
     }},
    {"bound", 32, 32,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       t.bound(w.position.view(), w.mass.data(), w.slots(), w.boxes());
     }},
    {"find_boxes", 56. / simd::kBoxed, 56. / simd::kBoxed,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       const kernels::Vector centre{0.5, 0, 0.5};
       benchmark::DoNotOptimize(t.find_boxes(w.boxes(), centre, centre, 0.1, w.near.data()));
     }},
    {"find_near", 32, 32,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       const kernels::Vector centre{0.5, 0, 0.5};
       benchmark::DoNotOptimize(t.find_near(w.position.view(), w.reach.data(), centre, 0.1, 0,
                                            w.slots(), w.near.data()));
     }},
    {"find_moved", 56, 56,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       benchmark::DoNotOptimize(t.find_moved(w.position.view(), w.solved.view(), {}, w.reach.data(),
                                             1, 1, 0, w.slots(), w.near.data()));
     }},
    {"split_quads", 56, 56,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       t.split_quads(w.position.view(), 0, w.slots(), 0, w.base.data(), w.change.data());
     }},
    {"join_quads", 80, 56,
     [](const simd::Table& t, Workbench& w, const simd::BlockRelaxation&) {
       t.join_quads(w.solved.view(), 0, w.slots(), w.base.data(), w.change.data());
     }},
};

void run_kernel(benchmark::State& state, Shared& shared, const Kernel& kernel, simd::Isa isa,
                int size) {
  Workbench& bench = shared.workshop.get("grid", size, false);
  const simd::BlockRelaxation r = bench.relaxation();
  for (auto _ : state) kernel.pass(simd::table(isa), bench, r);
  const auto slots = static_cast<double>(bench.slots());
  count(state,
        {static_cast<double>(bench.particles), kernel.bytes_per_slot * slots,
         kernel.footprint_per_slot * slots, true},
        shared.bandwidth);
}

}  // namespace

void register_particle_benchmarks(Shared& shared) {
  register_on_grids(kKernels, shared, run_kernel);
}

}  // namespace weft::perf
