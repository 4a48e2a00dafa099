/// Counts every allocation of the process through the global operator new, and can let one fail.
#pragma once

#include <cstddef>

namespace weft::test {

std::size_t allocations();

/// While it lives, the allocation after `granted` more of this thread throws std::bad_alloc, and so
/// does every further one.
class FailingAllocations {
 public:
  explicit FailingAllocations(std::size_t granted);
  ~FailingAllocations();
  FailingAllocations(const FailingAllocations&) = delete;
  FailingAllocations& operator=(const FailingAllocations&) = delete;
};

}  // namespace weft::test
