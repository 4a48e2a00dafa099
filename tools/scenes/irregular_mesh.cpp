#include "tools/scenes/irregular_mesh.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>

#include "tools/scenes/splitmix.h"

namespace weft::scenes {
namespace {

constexpr std::uint64_t kIrregularSeed = 2009;

/// From the last to the first, each with one at or before it.
template <class T>
void shuffle(std::vector<T>& items, SplitMix& random) {
  for (std::size_t i = items.size(); i-- > 1;) std::swap(items[i], items[random.below(i + 1)]);
}

std::vector<Vec3> jittered_points(std::uint32_t size, SplitMix& random) {
  const double spacing = 1.0 / (size - 1);
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i < size; ++i) {
    for (std::uint32_t j = 0; j < size; ++j) {
      const double x = random.unit(), z = random.unit();
      points.push_back({spacing * (i + 0.6 * (x - 0.5)), 0, spacing * (j + 0.6 * (z - 0.5))});
    }
  }
  return points;
}

void add_cell(std::uint32_t corner, std::uint32_t size, SplitMix& random,
              std::vector<Face>& faces) {
  const std::uint32_t a = corner, b = corner + 1, c = corner + size + 1, d = corner + size;
  const std::uint64_t chance = random.below(100), diagonal = random.below(2);
  if (chance < 2) return;
  if (chance < 12) {
    faces.push_back({a, b, c, d});
  } else if (diagonal == 0) {
    faces.push_back({a, b, c});
    faces.push_back({a, c, d});
  } else {
    faces.push_back({a, b, d});
    faces.push_back({b, c, d});
  }
}

}  // namespace

IrregularMesh irregular_mesh(int size) {
  const auto n = static_cast<std::uint32_t>(size);
  SplitMix random(kIrregularSeed);
  const std::vector<Vec3> points = jittered_points(n, random);
  IrregularMesh mesh;
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) add_cell(i * n + j, n, random, mesh.faces);
  }
  std::vector<std::uint32_t> place(points.size());
  std::iota(place.begin(), place.end(), 0u);
  shuffle(place, random);
  shuffle(mesh.faces, random);

  mesh.points.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) mesh.points[place[i]] = points[i];
  for (Face& face : mesh.faces) {
    for (std::uint32_t& corner : face) corner = place[corner];
  }
  mesh.first_row.assign(place.begin(), place.begin() + size);
  return mesh;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_of(const std::vector<Face>& faces) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Face& face : faces) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (seen.insert(std::minmax(a, b)).second) edges.emplace_back(a, b);
    }
  }
  return edges;
}

}  // namespace weft::scenes
