#include "engine/mesh/membrane.h"

#include <algorithm>

#include "engine/mesh/families.h"
#include "engine/mesh/mesh_input.h"
#include "engine/mesh/pair_numbers.h"

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

  void add(const Face& face, std::size_t from, std::size_t to, double stiffness) {
    if (!(stiffness > 0)) return;
    const std::uint32_t a = face.particles[from], b = face.particles[to];
    const auto [number, is_new] = numbers_.add(a, b);
    if (is_new) {
      const double rest_length = length(face.places[from] - face.places[to]);
      constraints_.push_back({a, b, rest_length, kind_, 1 / stiffness});
    } else {
      double& compliance = constraints_[number].compliance;
      compliance = 1 / (1 / compliance + stiffness);
    }
  }
  void set_kind(ConstraintKind kind) { kind_ = kind; }
  std::vector<Constraint> take() { return std::move(constraints_); }

 private:
  ConstraintKind kind_;
  std::vector<Constraint> constraints_;
  PairNumbers numbers_;
};

double square(double x) { return x * x; }

double side_length(const Face& face, std::size_t side) {
  return length(face.places[face.next(side)] - face.places[side]);
}

/// Of a spring of this length that carries the stiffness k of an area: it stretches by the
/// fraction e with the energy k e^2 / 2 per area.
double spring(double k, double area, double length) { return k * area / square(length); }

/// A quad with sides a along the warp and b along the weft, of area A = a b, and what it has of
/// stiffness.
///
/// A shear by the angle g makes one diagonal of length l longer by g A / l and the other shorter:
/// two springs s store s (g A / l)^2, which is G g^2 A / 2 with s = G l^2 / (2 A). A stretch of the
/// warp by e makes both longer by e a^2 / l, which stores G (a / b)^2 e^2 A / 2: diagonals carry
/// G (a / b)^2 of the warp, and G (b / a)^2 of the weft. Sides carry the rest. In narrow quads
/// diagonals would carry more than there is: G is at most what leaves half of it to the sides.
struct Shares {
  double warp = 0, weft = 0;  ///< N/m, of the sides
  double shear = 0;           ///< N/m, of the diagonals
};
Shares shares_of(const Face& quad, std::uint32_t warp_side, const Material& material) {
  const std::size_t weft_side = 1 - warp_side;
  const double a = (side_length(quad, warp_side) + side_length(quad, warp_side + 2)) / 2;
  const double b = (side_length(quad, weft_side) + side_length(quad, weft_side + 2)) / 2;
  const double along = square(a / b), across = square(b / a);
  const double shear =
      std::min({material.shear, material.warp / (2 * along), material.weft / (2 * across)});
  return {material.warp - shear * along, material.weft - shear * across, shear};
}

void add_sides(const Face& quad, std::uint32_t warp_side, const Shares& shares, Springs& springs) {
  for (std::size_t side = 0; side < 4; ++side) {
    const double k = side % 2 == warp_side ? shares.warp : shares.weft;
    springs.add(quad, side, quad.next(side), spring(k, area(quad) / 2, side_length(quad, side)));
  }
}

void add_diagonals(const Face& quad, const Shares& shares, Springs& springs) {
  for (const std::size_t corner : {std::size_t{0}, std::size_t{1}}) {
    const double across = length(quad.places[corner + 2] - quad.places[corner]);
    springs.add(quad, corner, corner + 2, shares.shear * square(across) / (2 * area(quad)));
  }
}

void add_triangle(const Face& triangle, const Material& material, Springs& springs) {
  const double k = (material.warp + material.weft) / 2;
  for (std::size_t side = 0; side < 3; ++side) {
    const double stiffness = spring(k, area(triangle), side_length(triangle, side));
    springs.add(triangle, side, triangle.next(side), stiffness);
  }
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

std::vector<Constraint> elastic_constraints(const MeshDescription& mesh, const Welded& welded,
                                            const std::vector<Face>& faces, const Edges& edges) {
  const Material& material = *mesh.material;
  const auto warp_side = warp_sides(faces, edges);
  Springs springs(kind_of_edges(mesh.ropes));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].is_quad()) {
      add_sides(faces[f], warp_side[f], shares_of(faces[f], warp_side[f], material), springs);
    } else {
      add_triangle(faces[f], material, springs);
    }
  }
  springs.set_kind(kind_of_diagonals(mesh.ropes));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!faces[f].is_quad()) continue;
    add_diagonals(faces[f], shares_of(faces[f], warp_side[f], material), springs);
  }
  std::vector<Constraint> constraints = springs.take();
  Joiner joiner(mesh, welded);
  for (const Constraint& constraint : constraints) joiner.skip(constraint);
  join_lines(mesh, joiner);
  const auto lines = joiner.take();
  constraints.insert(constraints.end(), lines.begin(), lines.end());
  return constraints;
}

}  // namespace weft::mesh
