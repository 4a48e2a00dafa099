/// Which links meet at which particle, as one compressed list.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/ordering.h"

namespace weft {

class Incidence {
 public:
  Incidence(std::size_t particles, std::span<const Link> links)
      : begin_(particles + 1), links_(2 * links.size()) {
    for (const Link& link : links) {
      ++begin_[link.a];
      ++begin_[link.b];
    }
    std::uint32_t end = 0;
    for (std::uint32_t& begin : begin_) begin = end += begin;
    for (std::size_t i = links.size(); i-- > 0;) {  // backwards: begin_ ends as the first of each
      links_[--begin_[links[i].a]] = static_cast<std::uint32_t>(i);
      links_[--begin_[links[i].b]] = static_cast<std::uint32_t>(i);
    }
  }
  /// Ascending.
  std::span<const std::uint32_t> operator[](std::size_t particle) const {
    return {links_.data() + begin_[particle], links_.data() + begin_[particle + 1]};
  }
  std::size_t particles() const { return begin_.size() - 1; }

 private:
  std::vector<std::uint32_t> begin_, links_;
};

inline std::uint32_t other_end(const Link& link, std::uint32_t particle) {
  return link.a == particle ? link.b : link.a;
}

}  // namespace weft
