/// Errors of weft, which are values, as exceptions.
#pragma once

#include <weft/result.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace weft::python {

/// weft.Error.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[noreturn]] inline void refuse(const std::string& line) { throw Refusal(line); }

template <class T>
T value_of(Result<T> result) {
  if (!result) refuse(result.error());
  return std::move(result).value();
}
inline void check(const Result<void>& result) {
  if (!result) refuse(result.error());
}

}  // namespace weft::python
