#include "engine/mesh/welding.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "engine/geometry.h"
#include "engine/mesh/mesh_input.h"
#include "engine/partition.h"

namespace weft::mesh {
namespace {

bool equal(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// Equal zeros of either sign are equal here. Vertices are sorted by their places, and by their
/// numbers within one place.
void join_equal(const MeshDescription& mesh, const std::vector<bool>& used, Partition& parts) {
  struct Place {
    Vec3 at;
    std::uint32_t vertex;
  };
  std::vector<Place> places;
  for (std::uint32_t vertex = 0; vertex < used.size(); ++vertex) {
    if (used[vertex]) places.push_back({mesh.positions[vertex], vertex});
  }
  std::ranges::sort(places, [](const Place& a, const Place& b) {
    return std::tie(a.at.x, a.at.y, a.at.z, a.vertex) < std::tie(b.at.x, b.at.y, b.at.z, b.vertex);
  });
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (equal(places[i - 1].at, places[i].at)) parts.join(places[i - 1].vertex, places[i].vertex);
  }
}

/// A cube of the side weld_distance: what is as near as that lies in it or in a neighbour.
using GridCell = std::array<double, 3>;

GridCell cell_of(Vec3 v, double side) {
  return {std::floor(v.x / side), std::floor(v.y / side), std::floor(v.z / side)};
}

void join_near(const MeshDescription& mesh, const std::vector<bool>& used, Partition& parts) {
  const double side = mesh.weld_distance;
  std::map<GridCell, std::vector<std::uint32_t>> cells;
  for (std::uint32_t vertex = 0; vertex < used.size(); ++vertex) {
    if (!used[vertex]) continue;
    const Vec3 v = mesh.positions[vertex];
    const GridCell cell = cell_of(v, side);
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const auto found = cells.find({cell[0] + neighbour % 3 - 1, cell[1] + neighbour / 3 % 3 - 1,
                                     cell[2] + neighbour / 9 - 1});
      if (found == cells.end()) continue;
      for (const std::uint32_t other : found->second) {
        if (length(mesh.positions[other] - v) <= side) parts.join(other, vertex);
      }
    }
    cells[cell].push_back(vertex);
  }
}

/// A vertex that is sewn but in no face counts for nothing.
void join_sewn(const MeshDescription& mesh, const std::vector<bool>& used, Partition& parts) {
  for (const auto& [a, b] : mesh.seams) {
    if (used[a] && used[b]) parts.join(a, b);
  }
}

/// The mean of different places; of equal ones the place itself, to the last bit.
void place_particles(const MeshDescription& mesh, Welded& welded) {
  std::vector<Vec3> sums(welded.positions.size());
  std::vector<double> counts(welded.positions.size(), 0);
  std::vector<bool> differ(welded.positions.size(), false);
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    const std::uint32_t particle = welded.particle_of_vertex[vertex];
    if (particle == kNoIndex) continue;
    sums[particle] = sums[particle] + mesh.positions[vertex];
    counts[particle] += 1;
    if (!equal(mesh.positions[vertex], welded.positions[particle])) differ[particle] = true;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (differ[i]) welded.positions[i] = (1 / counts[i]) * sums[i];
  }
}

}  // namespace

Welded weld(const MeshDescription& mesh) {
  const std::vector<bool> used = used_vertices(mesh);
  Partition parts(used.size());
  if (mesh.weld_distance > 0) {
    join_near(mesh, used, parts);
  } else {
    join_equal(mesh, used, parts);
  }
  if (mesh.seam_time == 0) join_sewn(mesh, used, parts);

  Welded welded;
  welded.particle_of_vertex.assign(used.size(), kNoIndex);
  for (std::uint32_t vertex = 0; vertex < used.size(); ++vertex) {
    if (!used[vertex]) continue;
    const std::uint32_t first = parts.first(vertex);
    if (first == vertex) {
      welded.particle_of_vertex[vertex] = static_cast<std::uint32_t>(welded.positions.size());
      welded.positions.push_back(mesh.positions[vertex]);
    } else {
      welded.particle_of_vertex[vertex] = welded.particle_of_vertex[first];
    }
  }
  place_particles(mesh, welded);
  return welded;
}

}  // namespace weft::mesh
