/// An array of which little is written: the system gives it pages of zeros when they are first
/// touched, so the rest costs neither time nor memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace weft {

template <class T>
class SparseArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  /// Where it has less room than that, all values are zero then; else those stay that were there.
  void make_room(std::size_t count) {
    if (count <= capacity_) return;
    void* const memory = std::calloc(count * sizeof(T) + kAlignment, 1);
    if (memory == nullptr) throw std::bad_alloc();
    memory_.reset(memory);
    const std::size_t beyond = reinterpret_cast<std::uintptr_t>(memory) % kAlignment;
    values_ = reinterpret_cast<T*>(static_cast<std::byte*>(memory) + (kAlignment - beyond));
    capacity_ = count;
  }
  std::size_t capacity() const { return capacity_; }
  T* data() { return values_; }
  const T* data() const { return values_; }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  static constexpr std::size_t kAlignment = 64;  // of lanes

  std::unique_ptr<void, Free> memory_;
  T* values_ = nullptr;
  std::size_t capacity_ = 0;
};

}  // namespace weft
