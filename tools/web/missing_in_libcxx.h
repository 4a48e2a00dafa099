/// Algorithms of ranges, and atomic_ref, which the C++ library of Debian's Emscripten (LLVM 13)
/// lacks: the forms that weft uses. Included ahead of every source.
#pragma once

#if defined(__cplusplus)
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 15000
// clang-format off
namespace std::ranges {

struct identity {
  template <class T> constexpr T&& operator()(T&& t) const noexcept { return static_cast<T&&>(t); }
};
struct anything_less {
  template <class A, class B> constexpr bool operator()(const A& a, const B& b) const { return a < b; }
};
struct anything_equal {
  template <class A, class B> constexpr bool operator()(const A& a, const B& b) const { return a == b; }
};

template <class T> concept has_range = requires(T& t) { std::begin(t); std::end(t); };
template <class I> concept is_iterator = !has_range<I> && requires(I i) { *i; ++i; };

template <class Compare, class Projection>
constexpr auto projected_by(Compare& compare, Projection& projection) {
  return [&](const auto& a, const auto& b) -> bool {
    return std::invoke(compare, std::invoke(projection, a), std::invoke(projection, b));
  };
}
template <class Test, class Projection>
constexpr auto tested_by(Test& test, Projection& projection) {
  return [&](const auto& a) -> bool { return std::invoke(test, std::invoke(projection, a)); };
}

#define WEFT_OF_TEST(name)                                                                  \
  template <has_range R, class Test, class P = identity>                                    \
  constexpr auto name(R&& r, Test test, P p = {}) {                                         \
    return std::name(std::begin(r), std::end(r), tested_by(test, p));                       \
  }
WEFT_OF_TEST(all_of) WEFT_OF_TEST(any_of) WEFT_OF_TEST(none_of) WEFT_OF_TEST(count_if)
WEFT_OF_TEST(find_if)
#undef WEFT_OF_TEST

#define WEFT_OF_ORDER(name)                                                                 \
  template <has_range R, class C = anything_less, class P = identity>                       \
  constexpr auto name(R&& r, C c = {}, P p = {}) {                                          \
    return std::name(std::begin(r), std::end(r), projected_by(c, p));                       \
  }                                                                                         \
  template <is_iterator I, class C = anything_less, class P = identity>                     \
  constexpr auto name(I first, I last, C c = {}, P p = {}) {                                \
    return std::name(first, last, projected_by(c, p));                                      \
  }
WEFT_OF_ORDER(sort) WEFT_OF_ORDER(stable_sort) WEFT_OF_ORDER(is_sorted)
WEFT_OF_ORDER(min_element) WEFT_OF_ORDER(max_element)
WEFT_OF_ORDER(push_heap) WEFT_OF_ORDER(pop_heap)
#undef WEFT_OF_ORDER

template <class I, class C = anything_less, class P = identity>
constexpr void nth_element(I first, I nth, I last, C c = {}, P p = {}) {
  std::nth_element(first, nth, last, projected_by(c, p));
}
template <has_range R, class C = anything_equal, class P = identity>
constexpr auto adjacent_find(R&& r, C c = {}, P p = {}) {
  return std::adjacent_find(std::begin(r), std::end(r), projected_by(c, p));
}

template <class I> struct rest_of {
  I from, to;
  constexpr I begin() const { return from; }
  constexpr I end() const { return to; }
  constexpr std::size_t size() const { return static_cast<std::size_t>(to - from); }
};
template <has_range R, class Test> constexpr auto stable_partition(R&& r, Test test) {
  const auto at = std::stable_partition(std::begin(r), std::end(r), test);
  return rest_of<decltype(std::begin(r))>{at, std::end(r)};
}
template <has_range R, class C = anything_equal, class P = identity>
constexpr auto unique(R&& r, C c = {}, P p = {}) {
  const auto at = std::unique(std::begin(r), std::end(r), projected_by(c, p));
  return rest_of<decltype(std::begin(r))>{at, std::end(r)};
}

template <is_iterator I, class T, class C = anything_less, class P = identity>
constexpr I lower_bound(I first, I last, const T& value, C c = {}, P p = {}) {
  return std::lower_bound(first, last, value, [&](const auto& item, const T& v) -> bool {
    return std::invoke(c, std::invoke(p, item), v);
  });
}
template <is_iterator I, class T, class C = anything_less, class P = identity>
constexpr I upper_bound(I first, I last, const T& value, C c = {}, P p = {}) {
  return std::upper_bound(first, last, value, [&](const T& v, const auto& item) -> bool {
    return std::invoke(c, v, std::invoke(p, item));
  });
}
template <has_range R, class T, class C = anything_less, class P = identity>
constexpr auto lower_bound(R&& r, const T& value, C c = {}, P p = {}) {
  return ranges::lower_bound(std::begin(r), std::end(r), value, c, p);
}
template <has_range R, class T, class C = anything_less, class P = identity>
constexpr auto upper_bound(R&& r, const T& value, C c = {}, P p = {}) {
  return ranges::upper_bound(std::begin(r), std::end(r), value, c, p);
}
template <has_range R, class T, class C = anything_less, class P = identity>
constexpr bool binary_search(R&& r, const T& value, C c = {}, P p = {}) {
  const auto at = ranges::lower_bound(r, value, c, p);
  return at != std::end(r) && !std::invoke(c, value, std::invoke(p, *at));
}

template <has_range R, class C = anything_less, class P = identity>
  requires(!std::is_arithmetic_v<std::remove_cvref_t<R>>)
constexpr auto min(R&& r, C c = {}, P p = {}) { return *ranges::min_element(r, c, p); }
template <has_range R, class C = anything_less, class P = identity>
  requires(!std::is_arithmetic_v<std::remove_cvref_t<R>>)
constexpr auto max(R&& r, C c = {}, P p = {}) { return *ranges::max_element(r, c, p); }
template <class T> struct least_and_most { T min, max; };
template <has_range R, class C = anything_less, class P = identity>
constexpr auto minmax(R&& r, C c = {}, P p = {}) {
  const auto [least, most] = std::minmax_element(std::begin(r), std::end(r), projected_by(c, p));
  return least_and_most<std::remove_cvref_t<decltype(*least)>>{*least, *most};
}

template <has_range R, class T, class P = identity>
constexpr auto find(R&& r, const T& value, P p = {}) {
  return std::find_if(std::begin(r), std::end(r),
                      [&](const auto& item) -> bool { return std::invoke(p, item) == value; });
}
template <has_range R, class T>
constexpr auto count(R&& r, const T& value) { return std::count(std::begin(r), std::end(r), value); }
template <has_range R, class T>
constexpr void fill(R&& r, const T& value) { std::fill(std::begin(r), std::end(r), value); }
template <has_range R, class F> constexpr void for_each(R&& r, F f) { for (auto&& item : r) f(item); }
template <has_range R> constexpr void reverse(R&& r) { std::reverse(std::begin(r), std::end(r)); }
template <has_range R, class I>
constexpr void rotate(R&& r, I middle) { std::rotate(std::begin(r), middle, std::end(r)); }

template <class O> struct end_of_output { O out; };
template <has_range R, class O>
constexpr end_of_output<O> copy(R&& r, O o) { return {std::copy(std::begin(r), std::end(r), o)}; }
template <has_range R, class O>
constexpr end_of_output<O> move(R&& r, O o) { return {std::move(std::begin(r), std::end(r), o)}; }
template <has_range R, class O, class F>
constexpr end_of_output<O> copy_if(R&& r, O o, F f) { return {std::copy_if(std::begin(r), std::end(r), o, f)}; }
template <has_range R, class O, class F>
constexpr end_of_output<O> transform(R&& r, O o, F f) { return {std::transform(std::begin(r), std::end(r), o, f)}; }

template <has_range A, has_range B, class C = anything_equal, class P = identity, class Q = identity>
constexpr bool equal(A&& a, B&& b, C c = {}, P p = {}, Q q = {}) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b),
                    [&](const auto& x, const auto& y) -> bool {
                      return std::invoke(c, std::invoke(p, x), std::invoke(q, y));
                    });
}
template <has_range A, has_range B> constexpr auto mismatch(A&& a, B&& b) {
  return std::mismatch(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
template <has_range A, has_range B> constexpr bool lexicographical_compare(A&& a, B&& b) {
  return std::lexicographical_compare(std::begin(a), std::end(a), std::begin(b), std::end(b));
}

}  // namespace std::ranges

namespace std {

template <class T> class atomic_ref {
 public:
  explicit atomic_ref(T& value) : value_(&value) {}
  void store(T to, memory_order) { __atomic_store_n(value_, to, __ATOMIC_SEQ_CST); }

 private:
  T* value_;
};

#if !defined(__cpp_lib_bit_cast)
template <class To, class From> constexpr To bit_cast(const From& from) { return __builtin_bit_cast(To, from); }
#endif

}  // namespace std
// clang-format on
#endif
#endif
