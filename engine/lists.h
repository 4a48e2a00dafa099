/// A compressed list of lists.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace weft {

/// List i is items[begin[i]] ... items[begin[i + 1] - 1].
struct Lists {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> items;

  std::size_t size() const { return begin.empty() ? 0 : begin.size() - 1; }
  std::span<const std::uint32_t> operator[](std::size_t i) const {
    return {items.data() + begin[i], items.data() + begin[i + 1]};
  }
  std::size_t bytes() const {
    return (begin.capacity() + items.capacity()) * sizeof(std::uint32_t);
  }
  /// Appends a list.
  void push_back(std::span<const std::uint32_t> list) {
    if (begin.empty()) begin.push_back(0);
    items.insert(items.end(), list.begin(), list.end());
    begin.push_back(static_cast<std::uint32_t>(items.size()));
  }
};

/// `count` lists of what visit_all(add) calls add(list, item) with, in that order; it is asked
/// twice.
template <class VisitAll>
Lists make_lists(std::size_t count, VisitAll&& visit_all) {
  Lists lists;
  lists.begin.assign(count + 1, 0);
  visit_all([&](std::uint32_t list, std::uint32_t) { ++lists.begin[list + 1]; });
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.items.resize(lists.begin.back());
  std::vector<std::uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  visit_all([&](std::uint32_t list, std::uint32_t item) { lists.items[next[list]++] = item; });
  return lists;
}

}  // namespace weft
