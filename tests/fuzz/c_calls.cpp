#include "tests/fuzz/c_calls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace weft::fuzz {
namespace {

void check_finite(const weft_cloth* cloth) {
  std::vector<double> numbers(3 * weft_particle_count(cloth));
  const std::size_t count = weft_particle_count(cloth);
  const auto is_finite = [](double number) { return std::isfinite(number); };
  check(weft_read_positions(cloth, count, numbers.data()) == WEFT_OK, "positions are read");
  check(std::ranges::all_of(numbers, is_finite), "positions that a step committed are finite");
  check(weft_read_velocities(cloth, count, numbers.data()) == WEFT_OK, "velocities are read");
  check(std::ranges::all_of(numbers, is_finite), "velocities that a step committed are finite");
}

}  // namespace

bool done(weft_result result) {
  if (result == WEFT_OK) return true;
  check_message(weft_last_message());
  check(result == WEFT_REFUSED, "a call that is not done was refused");
  return false;
}

std::vector<std::byte> state_of(const weft_cloth* cloth) {
  const auto saved =
      made<weft_bytes>([&](weft_bytes** out) { return weft_save_state(cloth, out); });
  const auto* first = static_cast<const std::byte*>(weft_bytes_data(saved.get()));
  return {first, first + weft_bytes_size(saved.get())};
}

void step(weft_cloth* cloth, double dt, const weft_jobs* jobs) {
  const std::uint64_t before = weft_state_hash(cloth);
  auto report = initial(weft_init_report);
  if (!changed(cloth, [&] { return weft_step(cloth, dt, jobs, &report); })) return;
  check(report.status >= WEFT_CONVERGED && report.status <= WEFT_NON_FINITE, "a status is known");
  if (weft_committed(report.status) != 0) {
    check_finite(cloth);
  } else {
    check(weft_state_hash(cloth) == before, "a step that does not commit changes nothing");
  }
}

weft_jobs serial_jobs(int threads) {
  static int offered = 1;
  offered = threads;
  auto jobs = initial(weft_init_jobs);
  jobs.host = &offered;
  jobs.threads = [](void* host) { return *static_cast<int*>(host); };
  jobs.run = [](void*, void (*job)(void*), void* context, int times) {
    for (int i = 0; i < times; ++i) job(context);
  };
  return jobs;
}

}  // namespace weft::fuzz
