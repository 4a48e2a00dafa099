/// The time of contacts with bodies, by the clock of the calling thread.
#pragma once

#include <weft/cloth.h>

#include <chrono>
#include <utility>

namespace weft {

class ContactTimes {
 public:
  /// Does the work. Its time counts for this part. Timed works do not contain each other.
  template <class Work>
  decltype(auto) timed(double ContactMs::*part, Work&& work) {
    const Span span(ms_.*part);
    return std::forward<Work>(work)();
  }
  /// Since they were last taken.
  ContactMs take() { return std::exchange(ms_, {}); }

 private:
  class Span {
   public:
    explicit Span(double& ms) : ms_(ms) {}
    ~Span() { ms_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }
    Span(const Span&) = delete;
    Span& operator=(const Span&) = delete;

   private:
    using Clock = std::chrono::steady_clock;
    double& ms_;
    const Clock::time_point start_ = Clock::now();
  };

  ContactMs ms_;
};

}  // namespace weft
