/// Decomposes the links into yarns: chains that run nearly straight through their particles, as the
/// yarns of a woven cloth do. On a grid they are its rows and its columns.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>
#include <vector>

#include "engine/ordering/incidence.h"

namespace weft {

/// Link k of a yarn joins its particles k and k + 1; the last link of a closed yarn joins its last
/// particle to its first. No particle occurs twice on a yarn.
struct Yarn {
  std::uint32_t first_particle = 0, last_particle = 0;  // in WovenYarns::particles
  std::uint32_t first_link = 0, last_link = 0;          // in WovenYarns::links
  std::uint32_t family = 0;
  bool closed = false;
};

struct WovenYarns {
  std::vector<Yarn> yarns;  // each link is in exactly one
  std::vector<std::uint32_t> particles, links;
  std::uint32_t families = 0;  // the yarns of a family share no particle

  std::span<const std::uint32_t> particles_of(const Yarn& yarn) const {
    return {particles.data() + yarn.first_particle, particles.data() + yarn.last_particle};
  }
  std::span<const std::uint32_t> links_of(const Yarn& yarn) const {
    return {links.data() + yarn.first_link, links.data() + yarn.last_link};
  }
};

/// The result depends on the arguments only. Links must be valid and without duplicates. Family 0
/// has the longest yarns; among equally long yarns, those with the shorter links.
WovenYarns find_yarns(std::span<const Vec3> positions, std::span<const Link> links);

}  // namespace weft
