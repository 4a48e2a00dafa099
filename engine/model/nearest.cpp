#include "engine/model/nearest.h"

#include <functional>
#include <queue>
#include <utility>

#include "engine/hypotenuse.h"

namespace weft {
namespace {

std::vector<Join> joins_of(const SceneDescription& d) {
  std::vector<Join> joins;
  for (const Constraint& c : d.constraints) {
    if (c.strength > 0) joins.push_back({c.a, c.b, c.rest_length});
  }
  for (const MembraneElement& e : d.membrane) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &from = e.rest[k], &to = e.rest[(k + 1) % 3];
      joins.push_back(
          {e.particles[k], e.particles[(k + 1) % 3], hypotenuse(to[0] - from[0], to[1] - from[1])});
    }
  }
  return joins;
}

}  // namespace

Lists joins_at(std::size_t particles, std::span<const Join> joins) {
  return make_lists(particles, [&](auto&& add) {
    for (std::uint32_t i = 0; i < joins.size(); ++i) {
      add(joins[i].a, i);
      add(joins[i].b, i);
    }
  });
}

std::vector<Nearest> find_nearest(std::size_t particles, std::span<const std::uint32_t> ends,
                                  std::span<const Join> joins) {
  const Lists at = joins_at(particles, joins);
  std::vector<Nearest> nearest(particles);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const std::uint32_t end : ends) {
    nearest[end] = {0, end};
    queue.push({0, end});
  }
  while (!queue.empty()) {
    const auto [length, here] = queue.top();
    queue.pop();
    if (length > nearest[here].length) continue;
    for (const std::uint32_t i : at[here]) {
      const std::uint32_t to = joins[i].a == here ? joins[i].b : joins[i].a;
      const double there = length + joins[i].length;
      if (there >= nearest[to].length) continue;
      nearest[to] = {there, nearest[here].end};
      queue.push({there, to});
    }
  }
  return nearest;
}

std::vector<Nearest> find_nearest_pins(const SceneDescription& scene) {
  return find_nearest(scene.positions.size(), scene.fixed, joins_of(scene));
}

}  // namespace weft
