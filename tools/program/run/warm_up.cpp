#include "tools/program/run/warm_up.h"

#include <sched.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "engine/erase_repeated.h"

namespace weft::tools {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

/// Processors that took part in a loop long enough for all to come.
std::size_t processors_at_work(std::size_t threads) {
  std::vector<int> processor(8 * threads);
  tbb::parallel_for(std::size_t{0}, processor.size(), [&](std::size_t i) {
    const auto start = Clock::now();
    while (Clock::now() - start < microseconds(100)) {
    }
    processor[i] = sched_getcpu();
  });
  std::ranges::sort(processor);
  erase_repeated(processor);
  return processor.size();
}

}  // namespace

void warm_up(int threads) {
  const auto wanted = static_cast<std::size_t>(std::max(threads, 1));
  const auto start = Clock::now();
  while (processors_at_work(wanted) < wanted && Clock::now() - start < microseconds(50'000)) {
  }
}

}  // namespace weft::tools
