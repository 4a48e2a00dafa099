/// Structs of C that say their own size: those of other versions are shorter or longer.
#pragma once

#include <weft/result.h>
#include <weft/weft_c.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "engine/c_interface/calls.h"

namespace weft::c_interface {

/// A size above that of any struct of ours was never set.
inline constexpr std::size_t kMostBytes = 4096;

inline Result<void> check_size(std::string_view name, std::size_t size) {
  if (size >= sizeof(std::size_t) && size <= kMostBytes && size % alignof(std::size_t) == 0) {
    return {};
  }
  return Error{std::string(name) +
               ".size: must be that of the struct, which its init function sets (" +
               std::to_string(size) + ")"};
}

/// All that is filled in must be there and have a size.
template <class Struct>
Result<void> check_struct(std::string_view name, const Struct* it) {
  if (auto r = given({{name, it}}); !r) return r;
  return check_size(name, it->size);
}

/// The part of `value` that the caller's struct has; what it has beyond becomes 0.
template <class Struct>
void write_struct(const Struct& value, Struct* out) {
  static_assert(std::is_trivially_copyable_v<Struct> && alignof(Struct) >= alignof(std::size_t));
  const std::size_t size = out->size, known = std::min(size, sizeof(Struct));
  std::memcpy(static_cast<void*>(out), &value, known);
  std::memset(reinterpret_cast<std::byte*>(out) + known, 0, size - known);
  out->size = size;
}

template <class Struct>
weft_result init_struct(std::string_view name, const Struct& defaults, Struct* out,
                        std::size_t size) noexcept {
  return call([&]() -> Result<void> {
    if (auto r = given({{name, out}}); !r) return r;
    if (auto r = check_size(name, size); !r) return r;
    out->size = size;
    write_struct(defaults, out);
    return {};
  });
}

/// The values of the caller's struct; fields that it lacks are as in `defaults`.
template <class Struct>
Result<Struct> read_struct(std::string_view name, const Struct* in, const Struct& defaults) {
  if (auto r = check_struct(name, in); !r) return Error{r.error()};
  const std::size_t known = std::min(in->size, sizeof(Struct));
  const auto* bytes = reinterpret_cast<const std::byte*>(in);
  const auto is_zero = [](std::byte byte) { return byte == std::byte{}; };
  if (!std::all_of(bytes + known, bytes + in->size, is_zero)) {
    return Error{std::string(name) + ".size: a field that this version does not know is set (" +
                 std::to_string(in->size) + ")"};
  }
  Struct value = defaults;
  std::memcpy(static_cast<void*>(&value), in, known);
  return value;
}

}  // namespace weft::c_interface
