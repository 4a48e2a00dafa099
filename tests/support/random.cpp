#include "tests/support/random.h"

#include <utility>

namespace weft::test {

double Random::between(double low, double high) {
  return low + (high - low) * (static_cast<double>(bits_()) / 0x1p32);
}

std::uint32_t Random::below(std::uint32_t bound) {
  return static_cast<std::uint32_t>(std::uint64_t{bits_()} * bound >> 32);
}

Vec3 Random::in_box(double half_width) {
  const double x = between(-half_width, half_width);
  const double y = between(-half_width, half_width);
  const double z = between(-half_width, half_width);
  return {x, y, z};
}

std::vector<std::uint32_t> Random::permutation(std::size_t count) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < count; ++i) order.push_back(i);
  for (std::uint32_t i = static_cast<std::uint32_t>(count); i > 1; --i) {
    std::swap(order[i - 1], order[below(i)]);
  }
  return order;
}

SceneDescription drifting_sheet(int size, std::uint32_t seed) {
  constexpr double kSpacing = 0.1;
  Random random(seed);
  SceneDescription scene;
  scene.gravity = {0, 0, 0};
  const auto number = [size](int i, int j) { return static_cast<std::uint32_t>(i * size + j); };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      scene.positions.push_back({kSpacing * i, 0, kSpacing * j});
      scene.velocities.push_back(random.in_box(1));
      scene.masses.push_back(random.between(0.5, 2));
      if (i > 0) scene.constraints.push_back({number(i - 1, j), number(i, j), kSpacing});
      if (j > 0) scene.constraints.push_back({number(i, j), number(i, j - 1), kSpacing});
    }
  }
  return scene;
}

}  // namespace weft::test
