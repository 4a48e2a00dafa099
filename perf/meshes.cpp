#include "perf/meshes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace weft::perf {
namespace {

using Face = std::vector<std::uint32_t>;

/// From the last to the first, each with one at or before it.
template <class T>
void shuffle(std::vector<T>& items, Random& random) {
  for (std::size_t i = items.size(); i-- > 1;) std::swap(items[i], items[random.below(i + 1)]);
}

double distance(Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

void add_cell(std::uint32_t corner, std::uint32_t size, Random& random, std::vector<Face>& faces) {
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

/// The edges of the faces, in the order in which they are met.
void add_edges(const std::vector<Face>& faces, SceneDescription& scene) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (const Face& face : faces) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (!seen.insert(std::minmax(a, b)).second) continue;
      scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
    }
  }
}

}  // namespace

std::uint64_t Random::bits() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Random::unit() { return std::ldexp(static_cast<double>(bits() >> 11), -53); }

SceneDescription grid(int size) {
  const auto n = static_cast<std::uint32_t>(size);
  const double spacing = 1.0 / (n - 1);
  SceneDescription scene;
  Random random(1);
  const auto jitter = [&] { return 0.02 * spacing * (2 * random.unit() - 1); };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      scene.positions.push_back({i * spacing + jitter(), jitter(), j * spacing + jitter()});
      const std::uint32_t p = i * n + j;
      if (i + 1 < n) scene.constraints.push_back({p, p + n, spacing});
      if (j + 1 < n) scene.constraints.push_back({p, p + 1, spacing});
    }
  }
  scene.masses.assign(scene.positions.size(), 1.0 / (n * n));
  return scene;
}

SceneDescription irregular(int size) {
  const auto n = static_cast<std::uint32_t>(size);
  const double spacing = 1.0 / (n - 1);
  Random random(2009);
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double x = random.unit(), z = random.unit();
      points.push_back({spacing * (i + 0.6 * (x - 0.5)), 0, spacing * (j + 0.6 * (z - 0.5))});
    }
  }
  std::vector<Face> faces;
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) add_cell(i * n + j, n, random, faces);
  }
  std::vector<std::uint32_t> place(points.size());
  std::iota(place.begin(), place.end(), 0u);
  shuffle(place, random);
  shuffle(faces, random);

  SceneDescription scene;
  scene.positions.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) scene.positions[place[i]] = points[i];
  for (std::uint32_t i = 0; i < n; ++i) scene.fixed.push_back(place[i]);
  for (Face& face : faces) {
    for (std::uint32_t& corner : face) corner = place[corner];
  }
  add_edges(faces, scene);
  scene.masses.assign(points.size(), 1.0 / (n * n));
  return scene;
}

}  // namespace weft::perf
