#include "tools/studies/hard/scenes.h"

#include <algorithm>
#include <random>
#include <set>
#include <utility>

#include "tools/studies/hard/oracle.h"

namespace weft::tools::hard {

SceneDescription built_in(std::string_view name, const scenes::Options& options) {
  return scenes::make(name, options).value();
}

SceneDescription sheet(std::string_view name, int size) {
  scenes::Options options;
  options.size = size;
  return built_in(name, options);
}

SceneDescription pulled_chain(double stretch) {
  SceneDescription scene = built_in("chain", {});
  for (Vec3& position : scene.positions) position = stretch * position;
  scene.fixed.push_back(static_cast<std::uint32_t>(scene.positions.size() - 1));
  return scene;
}

void add_diagonals(SceneDescription& scene, int size) {
  const auto join = [&](int a, int b) {
    const auto first = static_cast<std::uint32_t>(a), second = static_cast<std::uint32_t>(b);
    scene.constraints.push_back(
        {first, second, length(scene.positions[first] - scene.positions[second])});
  };
  for (int i = 0; i + 1 < size; ++i) {
    for (int j = 0; j + 1 < size; ++j) {
      join(i * size + j, (i + 1) * size + j + 1);
      join(i * size + j + 1, (i + 1) * size + j);
    }
  }
}

namespace {

/// Joined to its neighbours in both directions, except where both are fixed.
void join_grid(SceneDescription& scene, int rows, int columns, double cell) {
  std::vector<bool> fixed(scene.positions.size());
  for (const std::uint32_t particle : scene.fixed) fixed[particle] = true;
  const auto join = [&](int a, int b) {
    const auto first = static_cast<std::uint32_t>(a), second = static_cast<std::uint32_t>(b);
    if (!fixed[first] || !fixed[second]) scene.constraints.push_back({first, second, cell});
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i + 1 < rows) join(i * columns + j, (i + 1) * columns + j);
      if (j + 1 < columns) join(i * columns + j, i * columns + j + 1);
    }
  }
}

SceneDescription level_grid(int rows, int columns, double cell) {
  SceneDescription scene;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) scene.positions.push_back({cell * i, 0, cell * j});
  }
  scene.masses.assign(scene.positions.size(), 1.0 / (rows * columns));
  return scene;
}

/// The same on every machine: the standard's distributions are not.
class Chance {
 public:
  explicit Chance(std::uint32_t seed) : bits_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_()) / 4294967296.0;
  }
  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(bits_() % bound); }

 private:
  std::mt19937 bits_;
};

}  // namespace

SceneDescription ribbon(int along, int across, double cell) {
  SceneDescription scene = level_grid(along, across, cell);
  for (int j = 0; j < across; ++j) {
    scene.fixed.push_back(static_cast<std::uint32_t>(j));
    scene.fixed.push_back(static_cast<std::uint32_t>((along - 1) * across + j));
  }
  join_grid(scene, along, across, cell);
  return scene;
}

SceneDescription held_sheet_under_sphere(double speed) {
  constexpr int kSize = 15;
  constexpr double kCell = 0.05, kRadius = 0.15;
  SceneDescription scene = level_grid(kSize, kSize, kCell);
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j) {
      const bool border = i == 0 || j == 0 || i == kSize - 1 || j == kSize - 1;
      if (border) scene.fixed.push_back(static_cast<std::uint32_t>(i * kSize + j));
    }
  }
  join_grid(scene, kSize, kSize, kCell);
  const double middle = kCell * (kSize - 1) / 2;
  scene.spheres = {static_cast<std::uint32_t>(scene.positions.size())};
  scene.radii.assign(scene.positions.size(), 0);
  scene.velocities.assign(scene.positions.size(), {});
  scene.positions.push_back({middle, 0.4, middle});
  scene.masses.push_back(1);
  scene.radii.push_back(kRadius);
  scene.velocities.push_back({0, -speed, 0});
  return scene;
}

SceneDescription spinning_sheet(int size) {
  SceneDescription scene = level_grid(size, size, 1.0 / (size - 1));
  join_grid(scene, size, size, 1.0 / (size - 1));
  scene.gravity = {0, 0, 0};
  const Vec3 turning{0.5, 2, -0.3}, flying{3, 1, -2};
  for (const Vec3 at : scene.positions) {
    scene.velocities.push_back(flying + cross(turning, at - Vec3{0.5, 0, 0.5}));
  }
  return scene;
}

SceneDescription hub(int spokes) {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}};
  scene.masses = {1};
  scene.fixed = {0};
  Chance chance(1);
  for (int k = 1; k <= spokes; ++k) {
    Vec3 at;
    while (length(at) < 0.1) {
      const double x = chance.between(-1, 1), y = chance.between(-1, 1);
      at = {x, y, chance.between(-1, 1)};
    }
    scene.positions.push_back(at);
    scene.masses.push_back(chance.between(0.5, 2));
    scene.constraints.push_back({0, static_cast<std::uint32_t>(k), length(at)});
  }
  return scene;
}

SceneDescription pieces(int count) {
  SceneDescription scene;
  for (int k = 0; k < count; ++k) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const Vec3 corner{0.3 * k, 0, 0};
    for (const Vec3 at : {Vec3{0, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0.1}, {0, 0, 0.1}}) {
      scene.positions.push_back(corner + at);
      scene.masses.push_back(1);
    }
    for (std::uint32_t side = 0; side < 4; ++side) {
      scene.constraints.push_back({first + side, first + (side + 1) % 4, 0.1});
    }
    scene.fixed.push_back(first);
  }
  return scene;
}

SceneDescription random_graph(std::uint32_t seed) {
  Chance chance(seed);
  SceneDescription scene;
  const std::uint32_t particles = 2 + chance.below(60);
  for (std::uint32_t i = 0; i < particles; ++i) {
    const double x = chance.between(0, 1), y = chance.between(0, 1), z = chance.between(0, 1);
    scene.positions.push_back({x, y, z});
    scene.masses.push_back(chance.between(0.1, 10));
    if (chance.below(8) == 0) scene.fixed.push_back(i);
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> joined;
  for (std::uint32_t k = 0; k < 2 * particles; ++k) {
    const std::uint32_t a = chance.below(particles), b = chance.below(particles);
    if (a == b || !joined.insert(std::minmax(a, b)).second) continue;
    const double apart = length(scene.positions[a] - scene.positions[b]);
    const auto kind = chance.below(4) == 0 ? ConstraintKind::rope : ConstraintKind::distance;
    scene.constraints.push_back({a, b, chance.between(0.7, 1.3) * apart, kind});
  }
  return scene;
}

}  // namespace weft::tools::hard
