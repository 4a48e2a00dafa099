#include "engine/mesh/membrane.h"

#include <algorithm>
#include <limits>

#include "engine/mesh/delaunay.h"
#include "engine/mesh/mesh_input.h"
#include "engine/mesh/pair_numbers.h"
#include "engine/mesh/weave.h"
#include "engine/tuning.h"

namespace weft::mesh {
namespace {

// ----------------------------------------------------------------------------------------- rigid

/// Adds constraints at their lengths at rest, the first of any two particles only.
class Joiner {
 public:
  Joiner(const MeshDescription& mesh, const Welded& welded) : mesh_(mesh), welded_(welded) {}

  void join_vertices(std::uint32_t first, std::uint32_t second, ConstraintKind kind) {
    const Vec3 across = rest_of_vertex(mesh_, first) - rest_of_vertex(mesh_, second);
    join(first, second, length(across), kind);
  }
  /// Corners of one face, by their numbers in the mesh.
  void join_corners(std::size_t first, std::size_t second, ConstraintKind kind) {
    const Vec3 across = rest_of_corner(mesh_, first) - rest_of_corner(mesh_, second);
    join(mesh_.corners[first], mesh_.corners[second], length(across), kind);
  }
  void skip(const Constraint& joined) { joined_.add(joined.a, joined.b); }
  std::vector<Constraint> take() { return std::move(constraints_); }

 private:
  void join(std::uint32_t first_vertex, std::uint32_t second_vertex, double length,
            ConstraintKind kind) {
    const std::uint32_t a = welded_.particle_of_vertex[first_vertex];
    const std::uint32_t b = welded_.particle_of_vertex[second_vertex];
    if (a == b || !joined_.add(a, b).second) return;
    constraints_.push_back({a, b, length, kind});
  }

  const MeshDescription& mesh_;
  const Welded& welded_;
  PairNumbers joined_;
  std::vector<Constraint> constraints_;
};

ConstraintKind kind_of_edges(Ropes ropes) {
  return ropes == Ropes::all ? ConstraintKind::rope : ConstraintKind::distance;
}

ConstraintKind kind_of_diagonals(Ropes ropes) {
  return ropes == Ropes::none ? ConstraintKind::distance : ConstraintKind::rope;
}

void join_lines(const MeshDescription& mesh, Joiner& joiner) {
  for (const auto& [a, b] : mesh.lines) joiner.join_vertices(a, b, kind_of_edges(mesh.ropes));
}

// --------------------------------------------------------------------------------------- elastic

/// Adds up what faces ask of the same pair of particles. Its length is that in the first of them.
class Springs {
 public:
  Springs(ConstraintKind kind) : kind_(kind) {}

  /// strength: N
  void add(const Face& face, std::size_t from, std::size_t to, double stiffness,
           double strength = std::numeric_limits<double>::infinity()) {
    if (!(stiffness > 0)) return;
    const std::uint32_t a = face.particles[from], b = face.particles[to];
    const auto [number, is_new] = numbers_.add(a, b);
    if (is_new) {
      const double rest_length = length(face.places[from] - face.places[to]);
      constraints_.push_back({a, b, rest_length, kind_, 1 / stiffness, strength});
    } else {
      Constraint& spring = constraints_[number];
      spring.compliance = 1 / (1 / spring.compliance + stiffness);
      spring.strength += strength;
    }
  }
  void set_kind(ConstraintKind kind) { kind_ = kind; }
  std::vector<Constraint> take() { return std::move(constraints_); }

 private:
  ConstraintKind kind_;
  std::vector<Constraint> constraints_;
  PairNumbers numbers_;
};

/// Stiffness of a spring of this length that carries the stiffness k of an area: it stretches by
/// the fraction e with the energy k e^2 / 2 per area.
double spring(double k, double area, double length) { return k * area / square(length); }

/// A side carries what runs through half of the cell beside it.
void add_sides(const Face& quad, const WovenCell& cell, double strength, Springs& springs) {
  for (std::size_t side = 0; side < 4; ++side) {
    const double k = side % 2 == cell.warp_side ? cell.warp : cell.weft;
    const double half = area(quad) / 2, size = side_length(quad, side);
    springs.add(quad, side, quad.next(side), spring(k, half, size), strength * half / size);
  }
}

void add_diagonals(const Face& quad, const WovenCell& cell, Springs& springs) {
  for (const std::size_t corner : {std::size_t{0}, std::size_t{1}}) {
    const double size = length(quad.places[corner + 2] - quad.places[corner]);
    springs.add(quad, corner, corner + 2, cell.shear * square(size) / (2 * area(quad)));
  }
}

/// A triangle whose corners at rest are seen along the warp, as far as it lies in the plane, and
/// along the weft.
MembraneElement triangle_element(const Face& triangle, const Material& material,
                                 ConstraintKind kind) {
  const Vec3 normal = unit(area_vector(triangle));
  const Vec3 weft = unit(cross(normal, triangle.warp)), warp = cross(weft, normal);
  MembraneElement element;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 from_first = triangle.places[i] - triangle.places[0];
    element.particles[i] = triangle.particles[i];
    element.rest[i] = {dot(from_first, warp), dot(from_first, weft)};
  }
  element.warp = material.warp;
  element.weft = material.weft;
  element.shear = material.shear;
  element.kind = kind;
  element.strength = material.strength;
  return element;
}

/// Woven cells, and the triangles of all other faces, well shaped.
std::vector<Face> cells_and_triangles(const std::vector<Face>& faces, const Weave& weave,
                                      double weld_distance) {
  std::vector<Face> parts;
  const auto add = [&](Face part, std::size_t f) {
    part.warp = weave.warp[f];
    parts.push_back(part);
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (weave.cells[f] || !faces[f].is_quad()) {
      add(faces[f], f);
    } else {
      for (const auto& corners : cut(faces[f])) add(triangle_of(faces[f], corners), f);
    }
  }
  return well_shaped(std::move(parts), weld_distance, tuning::kMostFabricChange);
}

}  // namespace

std::vector<Constraint> rigid_constraints(const MeshDescription& mesh, const Welded& welded) {
  Joiner joiner(mesh, welded);
  for_each_face(mesh, [&](std::size_t first, std::span<const std::uint32_t> face) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      joiner.join_corners(first + i, first + (i + 1) % face.size(), kind_of_edges(mesh.ropes));
    }
  });
  join_lines(mesh, joiner);
  if (mesh.ropes == Ropes::diagonals) {
    for_each_face(mesh, [&](std::size_t first, std::span<const std::uint32_t> face) {
      if (face.size() != 4) return;
      joiner.join_corners(first, first + 2, ConstraintKind::rope);
      joiner.join_corners(first + 1, first + 3, ConstraintKind::rope);
    });
  }
  return joiner.take();
}

Fabric fabric_of(const MeshDescription& mesh, const Welded& welded, const std::vector<Face>& faces,
                 const Edges& edges) {
  const Material& material = *mesh.material;
  const Weave weave = weave_of(mesh, faces, edges);
  const ConstraintKind kind = kind_of_edges(mesh.ropes);
  Fabric fabric;
  Springs springs(kind);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!weave.cells[f]) {
      fabric.cut_again += faces[f].is_recognised;
      continue;
    }
    add_sides(faces[f], *weave.cells[f], material.strength, springs);
    fabric.cells.push_back(faces[f].particles);
    std::rotate(fabric.cells.back().begin(),
                fabric.cells.back().begin() + weave.cells[f]->warp_side, fabric.cells.back().end());
  }
  fabric.parts = cells_and_triangles(faces, weave, mesh.weld_distance);
  for (const Face& part : fabric.parts) {
    if (!part.is_quad()) fabric.membrane.push_back(triangle_element(part, material, kind));
  }
  springs.set_kind(kind_of_diagonals(mesh.ropes));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (weave.cells[f]) add_diagonals(faces[f], *weave.cells[f], springs);
  }
  fabric.springs = springs.take();
  Joiner joiner(mesh, welded);
  for (const Constraint& spring : fabric.springs) joiner.skip(spring);
  for (const Edge& edge : edges.all()) joiner.skip({edge.a, edge.b});
  join_lines(mesh, joiner);
  fabric.threads = joiner.take();
  return fabric;
}

}  // namespace weft::mesh
