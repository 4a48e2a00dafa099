#include "engine/solvers/yarn/yarn_spans.h"

#include <algorithm>

#include "engine/model/model.h"
#include "engine/ordering/incidence.h"

namespace weft {

void Braces::enter(std::span<const std::uint32_t> slots) {
  if (inside_.empty()) {
    links_ = links_of(model_.constraints, model_.constraints.size());
    incidence_ = links_at(model_.slots(), links_);
    met_.resize(model_.slots());
    inside_.resize(model_.slots());
  }
  entered_ = ++time_;
  for (const std::uint32_t slot : slots) inside_[slot] = entered_;
}

std::uint32_t Braces::other(std::uint32_t link, std::uint32_t slot) const {
  return other_end(links_[link], slot);
}

/// A link is the side of a triangle if a particle outside the span is a neighbour of both of its
/// ends.
bool Braces::is_braced(std::span<const std::uint32_t> slots) {
  enter(slots);
  std::size_t triangles = 0;
  for (std::size_t k = 0; k + 1 < slots.size(); ++k) {
    const std::uint32_t now = ++time_;
    for (const std::uint32_t link : incidence_[slots[k]]) met_[other(link, slots[k])] = now;
    const auto joins = [&](std::uint32_t link) {
      const std::uint32_t slot = other(link, slots[k + 1]);
      return met_[slot] == now && !is_inside(slot);
    };
    if (std::ranges::any_of(incidence_[slots[k + 1]], joins)) ++triangles;
  }
  return 2 * triangles > slots.size() - 1;
}

bool Braces::has_chords(std::span<const std::uint32_t> slots) {
  enter(slots);
  std::size_t ends = 0;
  for (const std::uint32_t slot : slots) {
    const auto inside = [&](std::uint32_t link) { return is_inside(other(link, slot)); };
    ends += static_cast<std::size_t>(std::ranges::count_if(incidence_[slot], inside));
  }
  return ends > 2 * (slots.size() - 1);
}

}  // namespace weft
