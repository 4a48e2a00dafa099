#include "engine/mesh/bending.h"

#include <algorithm>

#include "engine/mesh/pair_key.h"
#include "engine/mesh/stencils.h"

namespace weft::mesh {
namespace {

Point point(const Face& face, std::size_t corner) {
  return {face.particles[corner], face.places[corner]};
}

std::size_t corner_of(const Face& face, std::uint32_t particle) {
  const auto found = std::ranges::find(face.particles, particle);
  return static_cast<std::size_t>(found - face.particles.begin());
}

/// From one face of an inner edge to the other, in the places of the first. In a panel both faces
/// store what an element reads; across a seam the first alone does, and another element reads it in
/// the places of the second.
struct Across {
  const Edge& edge;
  std::array<EdgeOfFace, 2> faces;
  bool is_seam = false;
  std::span<const EdgeOfFace> storing() const { return std::span(faces).first(is_seam ? 1 : 2); }
};

/// An element of a yarn that crosses an edge at one of its ends.
struct Crossing {
  std::uint64_t ends = 0;  ///< pair_key
  Vec3 place;              ///< of that end: in each panel a yarn has an element of its own
  std::uint32_t stencil = 0;
};

class Builder {
 public:
  Builder(const std::vector<Face>& faces, const Edges& edges, double weld_distance, bool have_sides)
      : faces_(faces),
        edges_(edges),
        weld_distance_(weld_distance),
        have_sides_(have_sides),
        extent_(extent(faces)) {
    for (const Face& face : faces) areas_.push_back(area(face));
  }

  Stencils build() {
    for (const Edge& edge : edges_.all()) {
      if (edge.is_inner() && edge.faces[0].face != edge.faces[1].face) add_edge(edge);
    }
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].is_quad()) add_twist(f);
    }
    return std::move(built_);
  }

 private:
  const Face& face(const EdgeOfFace& of) const { return faces_[of.face]; }

  /// The part of a face's area that is stored across this side of it.
  double area_across(const EdgeOfFace& of) const {
    const Face& f = face(of);
    if (f.is_quad()) {
      const bool has_opposite = edges_.at(of.face, (of.side + 2) % 4).is_inner();
      return areas_[of.face] / (has_opposite ? 2 : 1);
    }
    int inner = 0;
    for (std::size_t side = 0; side < 3; ++side) inner += edges_.at(of.face, side).is_inner();
    return areas_[of.face] / inner;
  }

  void add_edge(const Edge& edge) {
    const EdgeOfFace &one = edge.faces[0], &two = edge.faces[1];
    const bool seam = is_seam(edge, faces_, weld_distance_);
    add(Across{edge, {one, two}, seam});
    if (seam) add(Across{edge, {two, one}, seam});
  }

  void add(const Across& across) {
    if (face(across.faces[0]).is_quad() && face(across.faces[1]).is_quad()) {
      add_crossing(across, across.edge.a);
      add_crossing(across, across.edge.b);
    } else {
      add_hinges(across);
    }
  }

  /// The corner of a quad beside this one that is not on the edge.
  static std::size_t beside(const Face& quad, std::size_t corner, std::size_t side) {
    return corner == side ? quad.previous(corner) : quad.next(corner);
  }

  /// Half of what the edge stores, along the yarn that crosses it at one end. The same yarn crosses
  /// the next edge at that end: both share an element.
  void add_crossing(const Across& across, std::uint32_t end) {
    const auto& [one, two] = across.faces;
    const std::size_t corner = corner_of(face(one), end);
    const std::size_t i = beside(face(one), corner, one.side);
    const std::size_t j = beside(face(two), corner_of(face(two), end), two.side);
    const std::uint32_t from = face(one).particles[i], to = face(two).particles[j];
    if (from == to) return;
    const std::uint32_t number = crossing_at(point(face(one), corner), pair_key(from, to));
    if (number == built_.stencils.size()) {
      const Stencil hinge = bend(across, i, j);
      const bool is_hinge = have_sides_ || hinge.fold != 0;
      built_.stencils.push_back(is_hinge ? hinge : without_end(hinge, end));
    }
    const Stencil& stencil = built_.stencils[number];
    for (const EdgeOfFace& of : across.storing()) {
      const double half = area_across(of) / 2;
      built_.contributions.push_back({number, of.face, weight_in_grid(stencil, half), half});
    }
  }

  /// The number of the crossing at a point between these ends; the next one if it is new.
  std::uint32_t crossing_at(const Point& at, std::uint64_t ends) {
    if (crossings_.size() <= at.particle) crossings_.resize(at.particle + 1);
    for (const Crossing& crossing : crossings_[at.particle]) {
      if (crossing.ends == ends && length(crossing.place - at.place) <= weld_distance_)
        return crossing.stencil;
    }
    const auto next = static_cast<std::uint32_t>(built_.stencils.size());
    crossings_[at.particle].push_back({ends, at.place, next});
    return next;
  }

  /// Corners of a face that are not on the side: one of a triangle, two of a quad.
  static std::vector<std::size_t> far_corners(const Face& face, std::size_t side) {
    if (!face.is_quad()) return {face.previous(side)};
    return {(side + 2) % 4, (side + 3) % 4};
  }

  /// From each far corner of one face to each of the other, in equal parts.
  void add_hinges(const Across& across) {
    const auto& [one, two] = across.faces;
    const auto far_one = far_corners(face(one), one.side);
    const auto far_two = far_corners(face(two), two.side);
    const double part = 1.0 / static_cast<double>(far_one.size() * far_two.size());
    for (const std::size_t i : far_one) {
      for (const std::size_t j : far_two) add_hinge(across, i, j, part);
    }
  }

  void add_hinge(const Across& across, std::size_t i, std::size_t j, double part) {
    const auto& [one, two] = across.faces;
    if (face(one).particles[i] == face(two).particles[j]) return;
    const Stencil stencil = bend(across, i, j);
    const auto number = static_cast<std::uint32_t>(built_.stencils.size());
    built_.stencils.push_back(stencil);
    for (const EdgeOfFace& of : across.storing()) {
      const double share = part * area_across(of);
      const double weight =
          face(of).is_quad() ? weight_in_grid(stencil, share) : weight_among_others(stencil, share);
      built_.contributions.push_back({number, of.face, weight, share});
    }
  }

  /// From one corner of the first face to one of the second.
  Stencil bend(const Across& across, std::size_t i, std::size_t j) const {
    const Edge& edge = across.edge;
    const Face& one = face(across.faces[0]);
    const Face& two = face(across.faces[1]);
    const Point a = point(one, corner_of(one, edge.a)), b = point(one, corner_of(one, edge.b));
    const Vec3 a_of_two = two.places[corner_of(two, edge.a)];
    const Vec3 b_of_two = two.places[corner_of(two, edge.b)];
    Stencil stencil = hinge(a, b, point(one, i), point(two, j), a_of_two, b_of_two, across.is_seam);
    if (!across.is_seam)
      stencil.fold = fold_of(stencil, {a.place, b.place, one.places[i], two.places[j]}, extent_);
    return stencil;
  }

  void add_twist(std::uint32_t number) {
    const Face& quad = faces_[number];
    const auto [one, two] = cut(quad);
    const Point a = point(quad, one[0]), b = point(quad, one[2]);
    const Point far_one = point(quad, one[1]), far_two = point(quad, two[1]);
    Stencil stencil = hinge(a, b, far_one, far_two, a.place, b.place, false);
    stencil.fold = fold_of(stencil, {a.place, b.place, far_one.place, far_two.place}, extent_);
    built_.contributions.push_back({static_cast<std::uint32_t>(built_.stencils.size()), number,
                                    weight_in_grid(stencil, areas_[number]), areas_[number]});
    built_.stencils.push_back(stencil);
  }

  const std::vector<Face>& faces_;
  const Edges& edges_;
  const double weld_distance_;
  const bool have_sides_;
  const double extent_;        ///< m, of the mesh
  std::vector<double> areas_;  ///< m^2, of faces
  Stencils built_;
  std::vector<std::vector<Crossing>> crossings_;  ///< at particles
};

}  // namespace

Stencils bending_stencils(const std::vector<Face>& faces, const Edges& edges, double weld_distance,
                          bool have_sides) {
  return Builder(faces, edges, weld_distance, have_sides).build();
}

std::vector<double> areas_of(const Stencils& stencils, const std::vector<Face>& faces) {
  std::vector<double> stored(faces.size()), areas(stencils.stencils.size());
  for (const Contribution& c : stencils.contributions) stored[c.face] += c.area;
  for (const Contribution& c : stencils.contributions)
    areas[c.stencil] += c.area * area(faces[c.face]) / stored[c.face];
  return areas;
}

}  // namespace weft::mesh
