/// Counts every allocation of the process through the global operator new.
#pragma once

#include <cstddef>

namespace weft::test {

std::size_t allocations();

}  // namespace weft::test
