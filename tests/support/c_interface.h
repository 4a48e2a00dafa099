/// Handles and structs of C that tests use as values.
#pragma once

#include <doctest/doctest.h>
#include <weft/surface.h>
#include <weft/weft_c.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace weft::test {

struct Freed {
  void operator()(weft_model* model) const { weft_free_model(model); }
  void operator()(weft_cloth* cloth) const { weft_free_cloth(cloth); }
  void operator()(weft_shape* shape) const { weft_free_shape(shape); }
  void operator()(weft_mesh_cloth* cloth) const { weft_free_mesh_cloth(cloth); }
  void operator()(weft_surface* surface) const { weft_free_surface(surface); }
  void operator()(weft_bytes* bytes) const { weft_free_bytes(bytes); }
};
template <class Handle>
using Owned = std::unique_ptr<Handle, Freed>;

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
