#include "tools/program/measure/starts_tangled.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "tools/program/measure/crossings.h"

namespace weft::tools {
namespace {

/// Of each particle the first one of those that seams join to it.
std::vector<std::uint32_t> first_of_sewn(const SceneDescription& scene) {
  std::vector<std::uint32_t> first(scene.positions.size());
  std::iota(first.begin(), first.end(), 0u);
  const auto root_of = [&](std::uint32_t particle) {
    while (first[particle] != particle) particle = first[particle] = first[first[particle]];
    return particle;
  };
  for (const Seam& seam : scene.seams) {
    const auto [low, high] = std::minmax({root_of(seam.a), root_of(seam.b)});
    first[high] = low;
  }
  for (std::uint32_t& particle : first) particle = root_of(particle);
  return first;
}

}  // namespace

std::size_t starts_tangled(const SceneDescription& scene) {
  if (!scene.self_contact.on) return 0;
  const TriangleSet surface{scene.positions, scene.surface};
  const std::vector<std::uint32_t> first = first_of_sewn(scene);
  const auto are_joined = [&](const auto& pair) {
    return std::ranges::any_of(scene.surface[pair.first], [&](std::uint32_t corner) {
      return std::ranges::any_of(scene.surface[pair.second], [&](std::uint32_t other) {
        return first[corner] == first[other];
      });
    });
  };
  const auto is_tangled = [&](const auto& pair) {
    return pair.first < pair.second && !are_joined(pair) &&
           do_cross(surface, pair.first, pair.second);
  };
  return static_cast<std::size_t>(
      std::ranges::count_if(near_pairs(surface, surface, 0), is_tangled));
}

}  // namespace weft::tools
