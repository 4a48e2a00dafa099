/// Buffers of floats of C.
#pragma once

#include <weft/cloth.h>
#include <weft/weft_c.h>

#include <string>
#include <string_view>

namespace weft::c_interface {

inline Result<FloatVectors> float_vectors(std::string_view name, const weft_float_vectors& given) {
  if (given.floats == nullptr && given.count > 0) {
    return Error{std::string(name) + ": must not be NULL (" + std::to_string(given.count) + ")"};
  }
  return FloatVectors{{given.floats, given.count}, given.stride};
}

}  // namespace weft::c_interface
