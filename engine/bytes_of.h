/// Memory held by a vector.
#pragma once

#include <cstddef>

namespace weft {

template <class T>
std::size_t bytes_of(const T& vector) {
  return vector.capacity() * sizeof(vector[0]);
}

}  // namespace weft
