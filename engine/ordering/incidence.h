/// The links that meet at each particle.
#pragma once

#include <cstdint>
#include <span>

#include "engine/lists.h"
#include "engine/ordering/ordering.h"

namespace weft {

/// The links at each particle, ascending.
inline Lists links_at(std::size_t particles, std::span<const Link> links) {
  return make_lists(particles, [&](auto&& add) {
    for (std::uint32_t i = 0; i < links.size(); ++i) {
      add(links[i].a, i);
      add(links[i].b, i);
    }
  });
}

inline std::uint32_t other_end(const Link& link, std::uint32_t particle) {
  return link.a == particle ? link.b : link.a;
}

}  // namespace weft
