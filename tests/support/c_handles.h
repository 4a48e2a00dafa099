/// Handles of the C interface that free what they hold.
#pragma once

#include <weft/weft_c.h>

#include <memory>

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

}  // namespace weft::test
