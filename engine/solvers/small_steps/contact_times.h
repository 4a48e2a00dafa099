/// The time of contacts with bodies, by the clock of the calling thread.
#pragma once

#include <weft/cloth.h>

#include <chrono>
#include <utility>

namespace weft {

class ContactTimes {
 public:
  /// Does the work, whose time counts for this part, but for what counts for others within.
  template <class Work>
  decltype(auto) timed(double ContactMs::*part, Work&& work) {
    const Span span(ms_, part);
    return std::forward<Work>(work)();
  }
  /// Since they were last taken.
  ContactMs take() { return std::exchange(ms_, {}); }

 private:
  class Span {
   public:
    Span(ContactMs& ms, double ContactMs::*part) : ms_(ms), part_(part), counted_(sum(ms)) {}
    ~Span() {
      const std::chrono::duration<double, std::milli> spent = Clock::now() - start_;
      ms_.*part_ += spent.count() - (sum(ms_) - counted_);
    }
    Span(const Span&) = delete;
    Span& operator=(const Span&) = delete;

   private:
    using Clock = std::chrono::steady_clock;
    static double sum(const ContactMs& ms) { return ms.find + ms.sweep + ms.verify; }

    ContactMs& ms_;
    double ContactMs::*part_;
    const double counted_;  // when it began
    const Clock::time_point start_ = Clock::now();
  };

  ContactMs ms_;
};

}  // namespace weft
