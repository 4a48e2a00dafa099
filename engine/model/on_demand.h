/// A value that is made when it is first asked for, by whichever thread asks, once. Copies share it
/// where it is made already. Only get() and put() need the type T whole.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

namespace weft {

template <class T>
class OnDemand {
 public:
  OnDemand() = default;
  OnDemand(const OnDemand& other)
      : value_(other.made()), bytes_(value_ ? other.bytes_ : 0), made_(value_ != nullptr) {}
  OnDemand& operator=(const OnDemand&) = delete;

  template <class Make>
  const T& get(Make&& make) const {
    std::call_once(once_, [&] {
      if (value_ == nullptr) {
        value_ = std::make_shared<const T>(make());
        bytes_ = value_->bytes();
      }
      made_.store(true, std::memory_order_release);
    });
    return *value_;
  }
  /// Before anybody asks: another value, or none yet.
  void put(std::shared_ptr<const T> value) {
    value_ = std::move(value);
    bytes_ = value_ == nullptr ? 0 : value_->bytes();
    made_ = value_ != nullptr;
  }
  /// Null until it is first asked for.
  const T* if_made() const {
    return made_.load(std::memory_order_acquire) ? value_.get() : nullptr;
  }
  /// Bytes of memory; 0 until it is first asked for.
  std::size_t bytes() const { return made_.load(std::memory_order_acquire) ? bytes_ : 0; }

 private:
  std::shared_ptr<const T> made() const {
    return made_.load(std::memory_order_acquire) ? value_ : nullptr;
  }

  mutable std::once_flag once_;
  mutable std::shared_ptr<const T> value_;
  mutable std::size_t bytes_ = 0;
  mutable std::atomic<bool> made_{false};
};

}  // namespace weft
