/// Arrays of C: a pointer and a count, of numbers that make up items.
#pragma once

#include <weft/scene.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace weft::c_interface {

/// An Item consists of Numbers and of nothing else, so that an array of numbers is one of items.
template <class Item, class Number>
inline constexpr bool kConsistsOf =
    std::is_trivially_copyable_v<Item>&& std::is_standard_layout_v<Item> &&
    sizeof(Item) % sizeof(Number) == 0 && alignof(Item) == alignof(Number);

template <class Item, class Number>
const Item* as_items(const Number* numbers) {
  static_assert(kConsistsOf<Item, Number>);
  return reinterpret_cast<const Item*>(numbers);
}

template <class Number, class Item>
const Number* as_numbers(const std::vector<Item>& items) {
  static_assert(kConsistsOf<Item, Number>);
  return reinterpret_cast<const Number*>(items.data());
}

inline constexpr std::size_t kMostItems = 0xffffffffu;

/// Takes arrays, and remembers the first that is not there or too long.
class Arrays {
 public:
  template <class Item, class Number>
  std::span<const Item> needed(std::string_view field, const Number* numbers, std::size_t count) {
    if (count > 0 && numbers == nullptr) note(field, "must not be NULL", count);
    return taken<Item>(field, numbers, count);
  }
  /// Empty where there is none.
  template <class Item, class Number>
  std::span<const Item> optional(std::string_view field, const Number* numbers, std::size_t count) {
    return taken<Item>(field, numbers, count);
  }

  bool are_good() const { return !error_; }
  Error error() const { return *error_; }
  Result<void> result() const { return error_ ? Result<void>(*error_) : Result<void>(); }

 private:
  template <class Item, class Number>
  std::span<const Item> taken(std::string_view field, const Number* numbers, std::size_t count) {
    if (numbers == nullptr) return {};
    if (count > kMostItems) {
      note(field, "there may be 4294967295 at most", count);
      return {};
    }
    return {as_items<Item>(numbers), count};
  }
  void note(std::string_view field, std::string_view reason, std::size_t count) {
    if (error_) return;
    error_ =
        Error{std::string(field) + ": " + std::string(reason) + " (" + std::to_string(count) + ")"};
  }

  std::optional<Error> error_;
};

/// An array that may have been left out.
template <class Item>
Item item_or(std::span<const Item> items, std::size_t i, Item otherwise) {
  return items.empty() ? otherwise : items[i];
}

template <class Item>
std::vector<Item> list_of(std::span<const Item> items) {
  return {items.begin(), items.end()};
}

/// Three numbers; without them 0.
inline Vec3 vector_of(const double* numbers) {
  return numbers == nullptr ? Vec3{} : Vec3{numbers[0], numbers[1], numbers[2]};
}

inline void write_vector(Vec3 v, double* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

}  // namespace weft::c_interface
