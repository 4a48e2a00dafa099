#include "engine/mesh/delaunay.h"

#include <algorithm>

#include "engine/mesh/edges.h"
#include "engine/mesh/pair_numbers.h"

namespace weft::mesh {
namespace {

/// So many edges are flipped at most, per face. In a plane far fewer are. Edges of faces that are
/// curved at rest could be flipped back and forth.
constexpr std::size_t kMostFlips = 16;
/// So that rounding flips nothing: four corners of a rectangle have a sum of 0.
constexpr double kLeastCotangent = 1e-6;

double cotangent_against(const Face& triangle, std::size_t side) {
  const Vec3 far = triangle.places[triangle.previous(side)];
  const Vec3 u = triangle.places[side] - far, v = triangle.places[triangle.next(side)] - far;
  return dot(u, v) / length(cross(u, v));
}

/// The mean of two warps, 0 for faces without one. Warps are lines: opposite ones are alike.
Vec3 mean_warp(const Face& one, const Face& two) {
  const double sign = dot(one.warp, two.warp) < 0 ? -1 : 1;
  return unit(area(one) * one.warp + sign * area(two) * two.warp);
}

/// A corner of a face.
struct At {
  const Face& face;
  std::size_t corner;
};

Face triangle(At a, At b, At c) {
  Face made;
  made.size = 3;
  std::size_t i = 0;
  for (const At& at : {a, b, c}) {
    made.particles[i] = at.face.particles[at.corner];
    made.places[i++] = at.face.places[at.corner];
  }
  return made;
}

/// Flips edges, and then the edges around those that were flipped, until nothing is left to flip.
class Flipper {
 public:
  Flipper(std::vector<Face>& faces, double weld_distance, double most_change)
      : faces_(faces),
        weld_distance_(weld_distance),
        most_change_(most_change),
        across_(faces.size()) {
    const Edges edges(faces);
    for (const Edge& edge : edges.all()) {
      joined_.add(edge.a, edge.b);
      if (!edge.is_inner() || edge.faces[0].face == edge.faces[1].face) continue;
      join(edge.faces[0], edge.faces[1]);
      waiting_.push_back(edge.faces[0]);
    }
  }

  void run() {
    std::size_t left = kMostFlips * faces_.size();
    while (!waiting_.empty() && left > 0) {
      const EdgeOfFace edge = waiting_.back();
      waiting_.pop_back();
      left -= flip(edge);
    }
  }

 private:
  bool has_other(const EdgeOfFace& edge) const {
    return across_[edge.face][edge.side].face != kNoIndex;
  }
  void join(const EdgeOfFace& one, const EdgeOfFace& two) {
    across_[one.face][one.side] = two;
    across_[two.face][two.side] = one;
  }

  bool flip(const EdgeOfFace& edge) {
    if (!has_other(edge)) return false;
    const EdgeOfFace across = across_[edge.face][edge.side];
    const Face one = faces_[edge.face], two = faces_[across.face];
    if (one.is_quad() || two.is_quad()) return false;
    if (cotangent_against(one, edge.side) + cotangent_against(two, across.side) >
        -kLeastCotangent) {
      return false;
    }
    const std::size_t from = edge.side, to = one.next(from), far = one.previous(from);
    const std::size_t far_two = two.previous(across.side);
    if (one.particles[far] == two.particles[far_two] || !is_one_place(one, from, two) ||
        !is_one_place(one, to, two) || changes_much(one, from, two, far_two) ||
        !joined_.add(one.particles[far], two.particles[far_two]).second) {
      return false;
    }
    replace(edge, across, one, two);
    return true;
  }

  /// The sum of both areas as vectors is that of the four-sided outline, whichever diagonal cuts
  /// it: a fold adds the rest of the areas. Seen in its own plane a thin triangle may have any
  /// warp.
  bool changes_much(const Face& one, std::size_t from, const Face& two, std::size_t far_two) const {
    const Vec3 a = one.places[from], b = one.places[one.next(from)];
    const Vec3 c = one.places[one.previous(from)], d = two.places[far_two];
    const double outline = length(cross(b - a, d - c)) / 2;
    const double area_one = area(one), area_two = area(two), both = area_one + area_two;
    const double flipped = triangle_area(a, c, d) + triangle_area(b, c, d);
    const double turn = length(cross(one.warp, two.warp));
    return std::max(both, flipped) - outline > most_change_ * both ||
           std::min(area_one, area_two) * turn * turn > most_change_ * both;
  }

  /// Puts the triangles on both sides of the other diagonal in the place of both.
  void replace(const EdgeOfFace& edge, const EdgeOfFace& across, const Face& one, const Face& two) {
    const std::size_t from = edge.side, to = one.next(from), far = one.previous(from);
    const std::size_t far_two = two.previous(across.side);
    // The other triangle may have its corners in the same order or in the opposite one.
    const bool starts_at_to = two.particles[across.side] == one.particles[to];
    const std::size_t after = two.next(across.side);
    const EdgeOfFace at_far_to = across_[edge.face][to];
    const EdgeOfFace at_far_from = across_[edge.face][far];
    const EdgeOfFace after_side = across_[across.face][after];
    const EdgeOfFace before_side = across_[across.face][far_two];
    const EdgeOfFace two_from = starts_at_to ? after_side : before_side;
    const EdgeOfFace two_to = starts_at_to ? before_side : after_side;
    faces_[edge.face] = triangle({one, far}, {one, from}, {two, far_two});
    faces_[across.face] = triangle({two, far_two}, {one, to}, {one, far});
    faces_[edge.face].warp = faces_[across.face].warp = mean_warp(one, two);
    const std::uint32_t f = edge.face, g = across.face;
    put({f, 0}, at_far_from);
    put({f, 1}, two_from);
    put({g, 0}, two_to);
    put({g, 1}, at_far_to);
    join({f, 2}, {g, 2});
  }

  /// Joins the side to what was across it before, and looks at it again.
  void put(const EdgeOfFace& side, const EdgeOfFace& other) {
    across_[side.face][side.side] = {kNoIndex, 0};
    if (other.face == kNoIndex) return;
    join(side, other);
    waiting_.push_back(side);
  }

  bool is_one_place(const Face& one, std::size_t corner, const Face& two) const {
    for (std::size_t i = 0; i < two.size; ++i) {
      if (two.particles[i] == one.particles[corner]) {
        return length(two.places[i] - one.places[corner]) <= weld_distance_;
      }
    }
    return false;
  }

  struct Across : std::array<EdgeOfFace, 4> {
    Across() { fill({kNoIndex, 0}); }
  };

  std::vector<Face>& faces_;
  const double weld_distance_;
  const double most_change_;
  std::vector<Across> across_;       ///< by side: the same edge in the other face; kNoIndex: none
  std::vector<EdgeOfFace> waiting_;  ///< edges to look at
  PairNumbers joined_;               ///< particles
};

}  // namespace

std::vector<Face> well_shaped(std::vector<Face> faces, double weld_distance, double most_change) {
  Flipper(faces, weld_distance, most_change).run();
  return faces;
}

}  // namespace weft::mesh
