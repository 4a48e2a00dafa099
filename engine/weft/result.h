/// Errors are values: a Result holds an Error or the value that was asked for. Part of weft.h.
///
///   auto model = weft::build_model(scene);
///   if (!model) return std::puts(model.error().c_str());  // one line
///   auto cloth = weft::Cloth::create(model.value(), {});
#pragma once

#include <weft/api.h>

#include <optional>
#include <string>
#include <utility>

namespace weft {

/// One line that names the field, the index and the value that were refused.
struct Error {
  std::string message;
};

/// A value or an Error. Test it before use: value() of a failed result is undefined, and so is
/// error() of a successful one.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}
  explicit operator bool() const { return value_.has_value(); }
  T& value() & { return *value_; }
  const T& value() const& { return *value_; }
  T&& value() && { return *std::move(value_); }
  const std::string& error() const { return error_.message; }

 private:
  std::optional<T> value_;
  Error error_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}
  explicit operator bool() const { return !error_.has_value(); }
  const std::string& error() const { return error_->message; }

 private:
  std::optional<Error> error_;
};

}  // namespace weft
