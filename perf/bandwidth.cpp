#include "perf/bandwidth.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <vector>

namespace weft::perf {
namespace {

/// Of one data cache of the level, in bytes.
std::size_t size_of_cache(int level, std::size_t otherwise) {
  for (const auto& cache : benchmark::CPUInfo::Get().caches) {
    if (cache.level == level && cache.type != "Instruction" && cache.size > 0) {
      return static_cast<std::size_t>(cache.size);
    }
  }
  return otherwise;
}

/// Copies between two arrays of footprint / 2 bytes each; the best of several goes. Within pages,
/// the second begins half a page behind the first: sixteen bytes behind, a Zen 3 copies at 6 GB/s
/// what it otherwise does at 180 ("rep movsb", which memcpy may be).
double measure_copy(std::size_t footprint) {
  using Clock = std::chrono::steady_clock;
  constexpr int kGoes = 15;
  constexpr std::size_t kPage = 4096;
  const std::size_t half = footprint / 2;
  const std::size_t pages = (half + kPage - 1) / kPage;
  std::vector<char> memory((pages + 1) * kPage + half, 1);
  const char* from = memory.data();
  char* to = memory.data() + pages * kPage + kPage / 2;
  const std::size_t copies = std::max<std::size_t>(1, (32u << 20) / footprint);
  double best = 0;
  for (int go = 0; go < kGoes; ++go) {
    const auto start = Clock::now();
    for (std::size_t i = 0; i < copies; ++i) {
      std::memcpy(to, from, half);
      benchmark::DoNotOptimize(to);
      benchmark::ClobberMemory();
    }
    const std::chrono::duration<double> seconds = Clock::now() - start;
    best = std::max(best, 2.0 * static_cast<double>(half * copies) / seconds.count());
  }
  return best;
}

}  // namespace

Bandwidth::Bandwidth() {
  const std::size_t l1 = size_of_cache(1, 32u << 10);
  const std::size_t l2 = std::max(2 * l1, size_of_cache(2, 512u << 10));
  const std::size_t l3 = std::max(2 * l2, size_of_cache(3, 16u << 20));
  levels_ = {{{"L1", l1, measure_copy(l1 / 2)},
              {"L2", l2, measure_copy(l2 / 2)},
              {"L3", l3, measure_copy(std::min(l3 / 2, 4 * l2))},
              {"DRAM", std::numeric_limits<std::size_t>::max(), measure_copy(4 * l3)}}};
}

const Bandwidth::Level& Bandwidth::level(double footprint) const {
  return *std::ranges::find_if(
      levels_, [&](const Level& level) { return footprint <= static_cast<double>(level.size); });
}

}  // namespace weft::perf
