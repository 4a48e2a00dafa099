#include "tests/support/meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace weft::test {
namespace {

/// Links every (row, column) to (row + down, column + right) where both exist.
void add_step(Mesh& mesh, std::uint32_t rows, std::uint32_t columns, std::uint32_t down, int right,
              ConstraintKind kind) {
  for (std::uint32_t r = 0; r + down < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      const int to = static_cast<int>(c) + right;
      if (to < 0 || to >= static_cast<int>(columns)) continue;
      const std::uint32_t other = (r + down) * columns + static_cast<std::uint32_t>(to);
      mesh.links.push_back({r * columns + c, other, kind});
    }
  }
}

}  // namespace

Mesh grid(std::uint32_t rows, std::uint32_t columns) {
  Mesh mesh;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      mesh.positions.push_back({static_cast<double>(r), 0, static_cast<double>(c)});
    }
  }
  add_step(mesh, rows, columns, 1, 0, ConstraintKind::distance);
  add_step(mesh, rows, columns, 0, 1, ConstraintKind::distance);
  return mesh;
}

void add_diagonals(Mesh& mesh, std::uint32_t rows, std::uint32_t columns, ConstraintKind kind) {
  add_step(mesh, rows, columns, 1, 1, kind);
  add_step(mesh, rows, columns, 1, -1, kind);
}

void add_bending(Mesh& mesh, std::uint32_t rows, std::uint32_t columns, ConstraintKind kind) {
  add_step(mesh, rows, columns, 2, 0, kind);
  add_step(mesh, rows, columns, 0, 2, kind);
}

Mesh triangles(std::uint32_t rows, std::uint32_t columns, double jitter, double removed,
               Random& random) {
  Mesh mesh = grid(rows, columns);
  for (std::uint32_t r = 0; r + 1 < rows; ++r) {
    for (std::uint32_t c = 0; c + 1 < columns; ++c) {
      const std::uint32_t corner = r * columns + c;
      if (random.below(2) == 0) {
        mesh.links.push_back({corner, corner + columns + 1, ConstraintKind::distance});
      } else {
        mesh.links.push_back({corner + 1, corner + columns, ConstraintKind::distance});
      }
    }
  }
  for (Vec3& p : mesh.positions) {
    const Vec3 d = random.in_box(jitter);
    p = {p.x + d.x, p.y + d.y, p.z + d.z};
  }
  std::erase_if(mesh.links, [&](const Link&) { return random.between(0, 1) < removed; });
  return mesh;
}

Mesh random_graph(std::uint32_t particles, std::size_t links, std::uint32_t most_at_one,
                  Random& random) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < particles; ++i) mesh.positions.push_back(random.in_box(1));
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  std::vector<std::uint32_t> degree(particles);
  for (std::size_t tries = 0; tries < 4 * links && mesh.links.size() < links; ++tries) {
    const std::uint32_t a = random.below(particles), b = random.below(particles);
    if (a == b || degree[a] == most_at_one || degree[b] == most_at_one) continue;
    if (!seen.insert(std::minmax(a, b)).second) continue;
    const bool is_rope = random.below(4) == 0;
    mesh.links.push_back({a, b, is_rope ? ConstraintKind::rope : ConstraintKind::distance});
    ++degree[a];
    ++degree[b];
  }
  return mesh;
}

Mesh chain(std::uint32_t particles) { return grid(1, particles); }

Mesh ring(std::uint32_t particles) { return tube(1, particles); }

Mesh tube(std::uint32_t rows, std::uint32_t around) {
  Mesh mesh = grid(rows, around);
  const double radius = around / (2 * std::numbers::pi);
  for (Vec3& p : mesh.positions) {
    const double angle = p.z / radius;
    p = {p.x, radius * std::sin(angle), radius * std::cos(angle)};
  }
  for (std::uint32_t r = 0; r < rows; ++r) {
    mesh.links.push_back({r * around + around - 1, r * around, ConstraintKind::distance});
  }
  return mesh;
}

Mesh shuffled(const Mesh& mesh, Random& random) {
  Mesh result;
  const std::vector<std::uint32_t> particle = random.permutation(mesh.positions.size());
  result.positions.resize(mesh.positions.size());
  for (std::size_t i = 0; i < particle.size(); ++i) {
    result.positions[particle[i]] = mesh.positions[i];
  }
  for (const std::uint32_t i : random.permutation(mesh.links.size())) {
    Link link = mesh.links[i];
    link.a = particle[link.a];
    link.b = particle[link.b];
    if (random.below(2) == 0) std::swap(link.a, link.b);
    result.links.push_back(link);
  }
  return result;
}

Mesh both(const Mesh& one, const Mesh& two) {
  Mesh mesh = one;
  double right = 0;
  for (const Vec3& p : one.positions) right = std::max(right, p.z);
  const auto first = static_cast<std::uint32_t>(one.positions.size());
  for (const Vec3& p : two.positions) mesh.positions.push_back({p.x, p.y, p.z + right + 2});
  for (const Link& link : two.links) {
    mesh.links.push_back({first + link.a, first + link.b, link.kind});
  }
  return mesh;
}

Mesh mesh_of(const SceneDescription& scene) {
  Mesh mesh;
  mesh.positions = scene.positions;
  for (const Constraint& c : scene.constraints) mesh.links.push_back({c.a, c.b, c.kind});
  std::vector<bool> fixed(scene.positions.size());
  for (const std::uint32_t i : scene.fixed) fixed[i] = true;
  pin(mesh, [&](std::uint32_t i) { return fixed[i]; });
  return mesh;
}

}  // namespace weft::test
