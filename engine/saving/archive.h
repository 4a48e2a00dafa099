/// Values as bytes, little-endian and without gaps.
///
/// Each part that is saved has one function for both directions, which calls the archive for its
/// fields in order:
///
///     friend void visit_fields(Is<Part> auto& part, auto& archive) {
///       auto& [first, second, scratch] = part;  // all of them: a new field has to be thought of
///       archive(first, second);
///     }
///
/// A reader never reads beyond its bytes, and allocates memory only in proportion to them. Each
/// part checks the values that were read.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "kernels/vectors.h"

namespace weft {

/// For functions that are the same for a constant part, which is written.
template <class T, class U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// The unsigned integer of the same size that stands for a scalar.
template <Scalar T>
using Bits = std::conditional_t<
    sizeof(T) == 1, std::uint8_t,
    std::conditional_t<sizeof(T) == 2, std::uint16_t,
                       std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

template <Scalar T>
void store(std::byte* to, const T& value) {
  const auto bits = std::bit_cast<Bits<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) to[i] = static_cast<std::byte>(bits >> (8 * i));
}

template <Scalar T>
Bits<T> load(const std::byte* from) {
  Bits<T> bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bits = static_cast<Bits<T>>(bits | static_cast<Bits<T>>(from[i]) << (8 * i));
  return bits;
}

class ArchiveWriter {
 public:
  void operator()(const auto&... values) { (add(values), ...); }
  std::vector<std::byte> bytes() && { return std::move(bytes_); }

 private:
  template <Scalar T>
  void add(const T& value) {
    store(grow(sizeof(T)), value);
  }
  void add(kernels::Vector v) { (*this)(v.x, v.y, v.z); }
  void add(const kernels::Vectors& v) { (*this)(v.x, v.y, v.z); }
  void add(const std::vector<bool>& list) {
    add(std::uint64_t{list.size()});
    for (const bool value : list) add(value);
  }
  template <class T, class A>
  void add(const std::vector<T, A>& list) {
    add(std::uint64_t{list.size()});
    if constexpr (Scalar<T>) {
      std::byte* at = grow(sizeof(T) * list.size());
      for (const T& value : list) store(std::exchange(at, at + sizeof(T)), value);
    } else {
      for (const T& value : list) add(value);
    }
  }
  void add(const std::string& text) {
    add(std::uint64_t{text.size()});
    for (const char c : text) add(c);
  }
  template <class T, std::size_t n>
  void add(const std::array<T, n>& list) {
    for (const T& value : list) add(value);
  }
  template <class... T>
  void add(const std::variant<T...>& value) {
    add(static_cast<std::uint8_t>(value.index()));
    std::visit([this](const auto& one) { this->add(one); }, value);
  }
  template <class T>
  void add(const T& part) {
    visit_fields(part, *this);
  }
  std::byte* grow(std::size_t by) {
    bytes_.resize(bytes_.size() + by);
    return bytes_.data() + bytes_.size() - by;
  }

  std::vector<std::byte> bytes_;
};

class ArchiveReader {
 public:
  explicit ArchiveReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  void operator()(auto&... values) { (take(values), ...); }
  /// The values that were read are impossible.
  void refuse() { is_good_ = false; }
  /// Whether all that was asked for was there. Once it was not, nothing more is read.
  bool is_good() const { return is_good_; }
  /// The same, and nothing is left.
  bool is_done() const { return is_good_ && bytes_.empty(); }

 private:
  template <Scalar T>
  void take(T& value) {
    if (bytes_.size() < sizeof(T)) return refuse();
    const Bits<T> bits = load<T>(bytes_.data());
    bytes_ = bytes_.subspan(sizeof(T));
    if constexpr (std::same_as<T, bool>) {
      value = bits != 0;
      if (bits > 1) refuse();
    } else {
      value = std::bit_cast<T>(bits);
    }
  }
  void take(kernels::Vector& v) { (*this)(v.x, v.y, v.z); }
  void take(kernels::Vectors& v) {
    (*this)(v.x, v.y, v.z);
    if (v.y.size() != v.x.size() || v.z.size() != v.x.size()) refuse();
  }
  /// The count of elements that take so many bytes at least.
  std::uint64_t take_count(std::size_t bytes) {
    std::uint64_t count = 0;
    take(count);
    if (count > bytes_.size() / bytes) refuse();
    return is_good_ ? count : 0;
  }
  void take(std::vector<bool>& list) {
    list.assign(take_count(1), false);
    for (std::size_t i = 0; i < list.size() && is_good_; ++i) {
      bool value = false;
      take(value);
      list[i] = value;
    }
  }
  template <class T, class A>
  void take(std::vector<T, A>& list) {
    const std::uint64_t count = take_count(Scalar<T> ? sizeof(T) : 1);
    list.clear();
    if constexpr (Scalar<T>) list.reserve(count);
    for (std::uint64_t i = 0; i < count && is_good_; ++i) take(list.emplace_back());
  }
  void take(std::string& text) {
    text.assign(take_count(1), '\0');
    for (char& c : text) take(c);
  }
  template <class T, std::size_t n>
  void take(std::array<T, n>& list) {
    for (T& value : list) take(value);
  }
  template <class... T>
  void take(std::variant<T...>& value) {
    std::uint8_t index = 0;
    take(index);
    std::uint8_t i = 0;
    const bool is_known = ((i++ == index && (take(value.template emplace<T>()), true)) || ...);
    if (!is_known) refuse();
  }
  template <class T>
  void take(T& part) {
    visit_fields(part, *this);
  }

  std::span<const std::byte> bytes_;
  bool is_good_ = true;
};

}  // namespace weft
