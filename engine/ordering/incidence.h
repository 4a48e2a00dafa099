/// Links, and those that meet at each particle.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>

#include "engine/lists.h"

namespace weft {

/// A constraint to be placed: its two particles and its kind.
struct Link {
  std::uint32_t a = 0, b = 0;
  ConstraintKind kind = ConstraintKind::distance;
};

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
