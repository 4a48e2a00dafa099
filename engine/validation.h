/// The messages of every check of input: one line that names the field, the index and the value of
/// the input that was refused.
#pragma once

#include <weft/weft.h>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace weft {

/// Numbers between these have squares, and inverses with squares, of all digits, with a margin.
inline constexpr double kLeastSquared = 1e-150, kMostSquared = 1e150;
inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

inline std::string element(std::string_view field, std::size_t index) {
  return std::string(field) + "[" + std::to_string(index) + "]";
}

/// The name of a field, of one of its elements or of one of its members, for a message. Its text is
/// put together where there is one: a scene has a hundred fields a particle, and nearly all are
/// fine. It points to the names that it is made of.
class FieldName {
 public:
  template <std::convertible_to<std::string_view> Text>
  FieldName(const Text& name) : name_(name) {}

  FieldName at(std::size_t index) const& { return {this, {}, index}; }
  FieldName member(std::string_view name) const& { return {this, name, 0}; }
  FieldName at(std::size_t index) const&& = delete;
  FieldName member(std::string_view name) const&& = delete;

  std::string text() const {
    if (of_ == nullptr) return std::string(name_);
    return name_.empty() ? element(of_->text(), index_) : of_->text() + "." + std::string(name_);
  }

 private:
  FieldName(const FieldName* of, std::string_view name, std::size_t index)
      : of_(of), name_(name), index_(index) {}

  const FieldName* of_ = nullptr;
  std::string_view name_;
  std::size_t index_ = 0;
};

/// In one line, whatever a text from outside in it holds.
inline std::string in_one_line(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);  // char has a sign on some processors
    if (byte < ' ' || byte == 0x7f) c = '?';
  }
  return text;
}

inline Error refuse(const FieldName& what, std::string_view reason, const std::string& value) {
  return Error{what.text() + ": " + std::string(reason) + " (" + value + ")"};
}

inline bool finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline std::string text(Vec3 v) { return number(v.x) + ", " + number(v.y) + ", " + number(v.z); }

inline Result<void> validate_positive(const FieldName& field, double value) {
  if (!std::isfinite(value) || value <= 0) {
    return refuse(field, "must be finite and greater than 0", number(value));
  }
  return {};
}

inline Result<void> validate_not_negative(const FieldName& field, double value) {
  if (value >= 0 && value <= kMostSquared) return {};
  return refuse(field, "must be finite and at least 0", number(value));
}

/// Checks a length or a mass: its squares, and their inverses, must be numbers with all digits, and
/// sums of inverses numbers.
inline Result<void> validate_square(const FieldName& field, double value) {
  if (value >= kLeastSquared && value <= kMostSquared) return {};
  return refuse(field, "must be from 1e-150 to 1e150, to be squared", number(value));
}

/// The same of floats, with a margin: the simd backend measures errors in tolerances.
inline bool fits_float(double value) { return value >= 1e-18 && value <= 1e18; }

inline Result<void> validate_float(const FieldName& field, double value) {
  if (fits_float(value)) return {};
  return refuse(field, "must be from 1e-18 to 1e18 on the simd backend", number(value));
}

inline Result<void> validate_kind(const FieldName& field, ConstraintKind kind) {
  if (kind == ConstraintKind::distance || kind == ConstraintKind::rope) return {};
  return refuse(field, "unknown", std::to_string(static_cast<int>(kind)));
}

inline Result<void> validate_particle(const FieldName& field, std::uint32_t particle,
                                      std::size_t particles) {
  if (particle < particles) return {};
  return refuse(field, "no such particle, the scene has " + std::to_string(particles),
                std::to_string(particle));
}

}  // namespace weft
