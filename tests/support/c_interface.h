/// Handles and structs of C that tests use as values.
#pragma once

#include <doctest/doctest.h>
#include <weft/surface.h>
#include <weft/weft_c.h>

#include <cstdint>
#include <vector>

#include "tests/support/c_handles.h"

namespace weft::test {

/// What `make`, which takes the place for a handle, makes.
template <class Handle, class Make>
Owned<Handle> made(const Make& make) {
  Handle* handle = nullptr;
  const weft_result result = make(&handle);
  INFO(weft_last_message());
  REQUIRE(result == WEFT_OK);
  REQUIRE(handle != nullptr);
  return Owned<Handle>(handle);
}

/// A struct of C with its defaults.
template <class Struct>
Struct initial(weft_result (*init)(Struct*, std::size_t)) {
  Struct it;
  REQUIRE(init(&it, sizeof it) == WEFT_OK);
  return it;
}

inline const double* numbers(const std::vector<Vec3>& vectors) {
  return reinterpret_cast<const double*>(vectors.data());
}

}  // namespace weft::test
