/// A value that is made when it is first asked for, by whichever thread asks, once.
#pragma once

#include <atomic>
#include <mutex>

namespace weft {

template <class T>
class OnDemand {
 public:
  template <class Make>
  const T& get(Make&& make) const {
    std::call_once(once_, [&] {
      value_ = make();
      made_.store(true, std::memory_order_release);
    });
    return value_;
  }
  /// Null as long as nobody has asked.
  const T* if_made() const { return made_.load(std::memory_order_acquire) ? &value_ : nullptr; }

 private:
  mutable std::once_flag once_;
  mutable std::atomic<bool> made_{false};
  mutable T value_;
};

}  // namespace weft
