#include "engine/mesh/grid_recognition.h"

#include <algorithm>

#include "engine/mesh/edges.h"

namespace weft::mesh {
namespace {

/// The largest cosine of the angle at a corner: 78 to 102 degrees.
constexpr double kMostCosine = 0.2;

constexpr std::uint32_t kNone = kNoIndex;

bool is_longest(const Face& triangle, std::size_t side) {
  const double size = side_length(triangle, side);
  return size > side_length(triangle, triangle.next(side)) &&
         size > side_length(triangle, triangle.previous(side));
}

bool is_near_rectangle(const Face& quad) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 back = unit(quad.places[quad.previous(i)] - quad.places[i]);
    const Vec3 on = unit(quad.places[quad.next(i)] - quad.places[i]);
    if (std::abs(dot(back, on)) > kMostCosine) return false;
  }
  return true;
}

/// The first triangle with the other's far corner between the two ends of its side.
Face joined(const Face& first, std::size_t side, const Face& other, std::size_t other_side) {
  const std::size_t far = other.previous(other_side);
  const std::size_t corners[] = {side, first.next(side), first.previous(side)};
  Face quad;
  quad.size = 4;
  quad.warp = first.warp;
  quad.is_recognised = true;
  const auto put = [&](std::size_t at, const Face& face, std::size_t corner) {
    quad.particles[at] = face.particles[corner];
    quad.places[at] = face.places[corner];
  };
  put(0, first, corners[0]);
  put(1, other, far);
  put(2, first, corners[1]);
  put(3, first, corners[2]);
  return quad;
}

struct Cell {
  std::uint32_t first = 0, second = 0;  ///< triangles
  Face quad;
};

std::vector<Cell> possible_cells(const std::vector<Face>& faces, const Edges& edges,
                                 double weld_distance) {
  std::vector<Cell> cells;
  for (const Edge& edge : edges.all()) {
    if (!edge.is_inner() || is_seam(edge, faces, weld_distance)) continue;
    const auto [f, side] = edge.faces[0];
    const auto [g, other_side] = edge.faces[1];
    if (faces[f].is_quad() || faces[g].is_quad() || f == g) continue;
    if (!is_longest(faces[f], side) || !is_longest(faces[g], other_side)) continue;
    const Face quad = joined(faces[f], side, faces[g], other_side);
    if (quad.particles[1] != quad.particles[3] && is_near_rectangle(quad)) {
      cells.push_back({f, g, quad});
    }
  }
  return cells;
}

/// The neighbours of a particle.
struct Around {
  int quads = 0;      ///< cells and quads
  int triangles = 0;  ///< that are in no cell
  bool is_at_border = false;
  bool is_regular() const { return triangles == 0 && quads == (is_at_border ? 2 : 4); }
};

std::size_t particle_count(const std::vector<Face>& faces) {
  std::uint32_t last = 0;
  for (const Face& face : faces) {
    for (std::size_t i = 0; i < face.size; ++i) last = std::max(last, face.particles[i]);
  }
  return std::size_t{last} + 1;
}

std::vector<Around> look_around(const std::vector<Face>& faces, const Edges& edges,
                                const std::vector<Cell>& cells) {
  std::vector<Around> around(particle_count(faces));
  std::vector<bool> in_cell(faces.size(), false);
  for (const Cell& cell : cells) {
    in_cell[cell.first] = in_cell[cell.second] = true;
    for (const std::uint32_t particle : cell.quad.particles) ++around[particle].quads;
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (in_cell[f]) continue;
    for (std::size_t i = 0; i < faces[f].size; ++i) {
      Around& at = around[faces[f].particles[i]];
      ++(faces[f].is_quad() ? at.quads : at.triangles);
    }
  }
  for (const Edge& edge : edges.all()) {
    if (edge.is_border()) around[edge.a].is_at_border = around[edge.b].is_at_border = true;
  }
  return around;
}

}  // namespace

std::size_t recognise_grids(std::vector<Face>& faces, double weld_distance) {
  const Edges edges(faces);
  std::vector<Cell> cells = possible_cells(faces, edges, weld_distance);
  if (cells.empty()) return 0;
  const auto around = look_around(faces, edges, cells);
  std::erase_if(cells, [&](const Cell& cell) {
    return std::ranges::none_of(
        cell.quad.particles, [&](std::uint32_t particle) { return around[particle].is_regular(); });
  });
  std::vector<std::uint32_t> cell_of(faces.size(), kNone);
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    cell_of[cells[c].first] = cell_of[cells[c].second] = c;
  }
  std::vector<Face> kept;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (cell_of[f] == kNone) {
      kept.push_back(faces[f]);
    } else if (cells[cell_of[f]].first == f) {
      kept.push_back(cells[cell_of[f]].quad);
    }
  }
  faces = std::move(kept);
  return cells.size();
}

}  // namespace weft::mesh
