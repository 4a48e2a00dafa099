/// Positions and links alone: what an ordering is made of.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

#include "engine/ordering/ordering.h"
#include "tests/support/random.h"

namespace weft::test {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Link> links;
};

/// Rows by columns, spacing 1, in the plane; particle (row, column) is row * columns + column.
Mesh grid(std::uint32_t rows, std::uint32_t columns);
/// Both diagonals of every cell.
void add_diagonals(Mesh& mesh, std::uint32_t rows, std::uint32_t columns, ConstraintKind kind);
/// Links over every other particle.
void add_bending(Mesh& mesh, std::uint32_t rows, std::uint32_t columns, ConstraintKind kind);
/// A grid whose particles are moved by up to jitter, with one diagonal in each cell, chosen by
/// chance, and without the given share of its links.
Mesh triangles(std::uint32_t rows, std::uint32_t columns, double jitter, double removed,
               Random& random);
Mesh random_graph(std::uint32_t particles, std::size_t links, std::uint32_t most_at_one,
                  Random& random);
Mesh chain(std::uint32_t particles);
Mesh ring(std::uint32_t particles);
/// Rows around the axis, closed.
Mesh tube(std::uint32_t rows, std::uint32_t around);

/// Without the links between pinned particles; the particles stay.
template <class Pinned>
void pin(Mesh& mesh, const Pinned& pinned) {
  std::erase_if(mesh.links, [&](const Link& link) { return pinned(link.a) && pinned(link.b); });
}
/// The same mesh under other numbers, its links in another order and turned around.
Mesh shuffled(const Mesh& mesh, Random& random);
/// Beside each other, not joined.
Mesh both(const Mesh& one, const Mesh& two);
/// Positions and links of a scene, without the links between fixed particles.
Mesh mesh_of(const SceneDescription& scene);

}  // namespace weft::test
