#include "tests/support/counting_new.h"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace weft::test {
namespace {

std::atomic<std::size_t> count{0};
constexpr std::size_t kEndless = std::numeric_limits<std::size_t>::max();
thread_local std::size_t granted_here = kEndless;

void* counted(std::size_t bytes, std::size_t alignment) {
  ++count;
  if (granted_here == 0) throw std::bad_alloc();
  if (granted_here != kEndless) --granted_here;
  const std::size_t rounded = (bytes + alignment) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded)) return memory;
  throw std::bad_alloc();
}

}  // namespace

std::size_t allocations() { return count; }

FailingAllocations::FailingAllocations(std::size_t granted) { granted_here = granted; }
FailingAllocations::~FailingAllocations() { granted_here = kEndless; }

}  // namespace weft::test

void* operator new(std::size_t bytes) {
  return weft::test::counted(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return weft::test::counted(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept try {
  return operator new(bytes);
} catch (const std::bad_alloc&) {
  return nullptr;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
