/// A sorted list without repeated items.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace weft {

/// The first stays of items that lie beside each other and have the same key. (clang 14 does not
/// compile the subrange that std::ranges::unique of libstdc++ returns.)
template <class Item, class Key = std::identity>
void erase_repeated(std::vector<Item>& list, Key key = {}) {
  const auto is_same = [&](const Item& a, const Item& b) {
    return std::invoke(key, a) == std::invoke(key, b);
  };
  list.erase(std::unique(list.begin(), list.end(), is_same), list.end());
}

}  // namespace weft
