/// relax_contacts: a sphere of 0.2 m around the middle of a grid of 1 m touches every particle
/// inside it.
#include <algorithm>

#include "perf/benchmarks.h"

namespace weft::perf {
namespace {

/// Gains are 0, so that nothing moves and every pass pushes every contact as the first did.
class Contacts {
 public:
  Contacts(Workbench& bench, const simd::Table& table) : r_(bench.relaxation()) {
    const kernels::Vector centre{0.5, 0, 0.5};
    slots_.resize(bench.slots());
    const std::size_t found = table.find_near(bench.position.view(), bench.reach.data(), centre,
                                              0.2, 0, bench.slots(), slots_.data());
    slots_.resize(found / kLanes * kLanes);
    sphere_.assign(slots_.size(), bench.ordering.slot_of[0]);
    blocks_.resize(slots_.size() / kLanes);
    for (simd::ConstraintBlock& block : blocks_) {
      std::ranges::fill(block.nx, 1.f);
      std::ranges::fill(block.e0, -0.5f);
    }
    impulse_.resize(slots_.size());
    r_.blocks = blocks_.data();
    r_.impulse = impulse_.data();
    r_.a = sphere_.data();
    r_.b = slots_.data();
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(slots_.size()); }
  std::uint32_t relax(const simd::Table& table) const {
    return table.relax_contacts(r_, 0, size());
  }

 private:
  simd::BlockRelaxation r_;
  std::vector<std::uint32_t> slots_, sphere_;
  kernels::AlignedVector<simd::ConstraintBlock> blocks_;
  kernels::AlignedVector<float> impulse_;
};

void run(benchmark::State& state, Shared& shared, simd::Isa isa, int size) {
  const simd::Table& table = simd::table(isa);
  const Contacts contacts(shared.workshop.get("grid", size, false), table);
  for (auto _ : state) benchmark::DoNotOptimize(contacts.relax(table));
  const double n = contacts.size();
  count(state, {n, 60 * n, 44 * n, false}, shared.bandwidth);
}

}  // namespace

void register_contact_benchmarks(Shared& shared) {
  for (const simd::Isa isa : supported_isas()) {
    for (const int size : kGridSizes) {
      const std::string name = "relax_contacts/" + name_of(isa) + '/' + std::to_string(size);
      benchmark::RegisterBenchmark(name.c_str(), [&shared, isa, size](benchmark::State& state) {
        run(state, shared, isa, size);
      });
    }
  }
}

}  // namespace weft::perf
