#include "engine/mesh/weave.h"

#include <cmath>

#include "engine/mesh/families.h"
#include "engine/mesh/warp.h"
#include "engine/partition.h"

namespace weft::mesh {
namespace {

constexpr Vec3 kAxes[] = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};

/// A part is level if less than this share of y lies in its faces; a face is across an axis if less
/// than that of the axis lies in it.
constexpr double kInPlane = 1e-3;

Vec3 normal_of(const Face& face) { return unit(area_vector(face)); }
Vec3 in_plane(Vec3 axis, Vec3 normal) { return axis - dot(axis, normal) * normal; }

/// Along the first of the axes that the face is not across, beginning with `first`.
Vec3 along_axis(const Face& face, std::size_t first) {
  const Vec3 normal = normal_of(face);
  for (std::size_t i = first; i < std::size(kAxes); ++i) {
    const Vec3 along = in_plane(kAxes[i], normal);
    if (length(along) > kInPlane) return unit(along);
  }
  return unit(in_plane(kAxes[0], normal));
}

/// The mean of its two sides of the warp.
Vec3 along_sides(const Face& quad, std::uint32_t warp_side) {
  const auto vector = [&](std::size_t side) {
    return unit(quad.places[quad.next(side)] - quad.places[side]);
  };
  const Vec3 both = vector(warp_side) - vector(warp_side + 2);
  return unit(in_plane(both, normal_of(quad)));
}

/// A side of a face, and the direction in its plane from the side into the face.
struct SideFrame {
  Vec3 along, inward;
};

SideFrame frame_at(const Face& face, std::size_t side) {
  const Vec3 along = unit(face.places[face.next(side)] - face.places[side]);
  return {along, cross(normal_of(face), along)};
}

/// The direction v of a face in the plane of another one beside it, as if both were unfolded. If
/// both are oriented alike, their common side runs to opposite ends in them.
Vec3 carried_over(Vec3 v, const SideFrame& from, const SideFrame& to, bool alike) {
  const double along = dot(v, from.along), inward = dot(v, from.inward);
  return unit((alike ? -along : along) * to.along - inward * to.inward);
}

struct Parts {
  Partition of_faces;
  std::vector<double> area, woven, along_y;  ///< m^2, of the first face of each
  std::vector<bool> is_given;                ///< the mesh gives a warp to a face of it, likewise
};

Parts find_parts(const std::vector<Face>& faces, const Edges& edges, const Weave& weave,
                 double weld_distance) {
  Parts parts{Partition(faces.size()), {}, {}, {}, std::vector<bool>(faces.size(), false)};
  for (auto* sums : {&parts.area, &parts.woven, &parts.along_y}) sums->resize(faces.size());
  for (const Edge& edge : edges.all()) {
    if (is_seam(edge, faces, weld_distance)) continue;
    for (const EdgeOfFace& of : edge.faces) parts.of_faces.join(edge.faces[0].face, of.face);
  }
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const std::uint32_t part = parts.of_faces.first(f);
    const double size = area(faces[f]);
    if (is_given(faces[f].warp)) parts.is_given[part] = true;
    parts.area[part] += size;
    if (weave.cells[f]) parts.woven[part] += size;
    parts.along_y[part] += size * length(in_plane(kAxes[0], normal_of(faces[f])));
  }
  return parts;
}

/// From the faces whose warp is known to those beside them in their part, and on from there.
void continue_from(std::vector<std::uint32_t> known, const std::vector<Face>& faces,
                   const Edges& edges, double weld_distance, std::vector<Vec3>& warp) {
  std::vector<bool> is_known(faces.size(), false);
  for (const std::uint32_t f : known) is_known[f] = true;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::uint32_t from = known[i];
    for (std::size_t side = 0; side < faces[from].size; ++side) {
      const Edge& edge = edges.at(from, side);
      if (is_seam(edge, faces, weld_distance)) continue;
      for (const auto& [to, to_side] : edge.faces) {
        if (is_known[to]) continue;
        const bool alike = faces[to].particles[to_side] != faces[from].particles[side];
        warp[to] = carried_over(warp[from], frame_at(faces[from], side),
                                frame_at(faces[to], to_side), alike);
        is_known[to] = true;
        known.push_back(to);
      }
    }
  }
}

}  // namespace

Weave weave_of(const MeshDescription& mesh, const std::vector<Face>& faces, const Edges& edges) {
  const Material& material = *mesh.material;
  const std::vector<std::uint32_t> warp_side = warp_sides(faces, edges, mesh.weld_distance);
  Weave weave{std::vector<Vec3>(faces.size()), std::vector<std::optional<WovenCell>>(faces.size())};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    weave.warp[f] = faces[f].warp;
    if (!faces[f].is_quad()) continue;
    if (!is_given(faces[f].warp)) weave.warp[f] = along_sides(faces[f], warp_side[f]);
    weave.cells[f] = woven_cell(faces[f], weave.warp[f], material);
  }
  Parts parts = find_parts(faces, edges, weave, mesh.weld_distance);
  std::vector<std::uint32_t> known;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    const std::uint32_t part = parts.of_faces.first(f);
    if (parts.is_given[part]) {
      if (is_given(faces[f].warp)) known.push_back(f);
      continue;
    }
    if (2 * parts.woven[part] > parts.area[part]) {
      if (weave.cells[f]) known.push_back(f);
      continue;
    }
    const bool is_level = parts.along_y[part] < kInPlane * parts.area[part];
    weave.warp[f] = along_axis(faces[f], is_level ? 1 : 0);
    if (faces[f].is_quad()) weave.cells[f] = woven_cell(faces[f], weave.warp[f], material);
  }
  continue_from(std::move(known), faces, edges, mesh.weld_distance, weave.warp);
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (!faces[f].is_quad() || is_given(faces[f].warp)) continue;
    if (parts.is_given[parts.of_faces.first(f)])
      weave.cells[f] = woven_cell(faces[f], weave.warp[f], material);
  }
  return weave;
}

}  // namespace weft::mesh
