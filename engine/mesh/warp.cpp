#include "engine/mesh/warp.h"

#include <algorithm>
#include <cmath>

#include "engine/mesh/mesh_input.h"
#include "engine/validation.h"

namespace weft {
namespace mesh {
namespace {

/// A direction is across a plane if less than this share of it lies in the plane.
constexpr double kLeastInPlane = 1e-3;

Vec3 direction_of(const MeshDescription& mesh, std::size_t face) {
  if (mesh.warp.empty()) return {0, 1, 0};  // of flat places
  return mesh.warp[mesh.warp.size() == 1 ? 0 : face];
}

}  // namespace

Vec3 given_warp(const MeshDescription& mesh, std::size_t face, Vec3 normal) {
  if (mesh.warp.empty() && mesh.rest_corners.empty()) return {};
  const Vec3 direction = unit(direction_of(mesh, face));
  const Vec3 in_plane = direction - dot(direction, normal) * normal;
  return length(in_plane) > kLeastInPlane ? unit(in_plane) : Vec3{};
}

namespace {

/// The direction in which v grows and u stays, where the places of a face are as linear in u and v
/// as they can be; 0 where the texture has no area.
Vec3 along_v(std::span<const Vec3> places, std::span<const std::array<double, 2>> texture) {
  const double share = 1 / static_cast<double>(places.size());
  Vec3 middle;
  double middle_u = 0, middle_v = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    middle = middle + share * places[i];
    middle_u += share * texture[i][0];
    middle_v += share * texture[i][1];
  }
  double uu = 0, uv = 0, vv = 0;
  Vec3 pu, pv;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double u = texture[i][0] - middle_u, v = texture[i][1] - middle_v;
    const Vec3 place = places[i] - middle;
    uu += u * u, uv += u * v, vv += v * v;
    pu = pu + u * place;
    pv = pv + v * place;
  }
  const double determinant = uu * vv - uv * uv;
  const double least = kFlattest * (uu + vv);
  return determinant > least * least ? unit(uu * pv - uv * pu) : Vec3{};
}

/// The error names the first face that has an area, but none in the texture.
Result<std::vector<Vec3>> directions(const MeshDescription& mesh,
                                     std::span<const std::array<double, 2>> texture) {
  std::vector<Vec3> warp, places;
  std::size_t refused = face_count(mesh);
  for_each_face(mesh, [&](std::size_t first, std::span<const std::uint32_t> vertices) {
    places.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i)
      places.push_back(rest_of_corner(mesh, first + i));
    const Vec3 direction = along_v(places, texture.subspan(first, vertices.size()));
    if (!is_given(direction) && has_area(places)) refused = std::min(refused, warp.size());
    warp.push_back(direction);
  });
  if (refused == face_count(mesh)) return warp;
  return Error{"texture: face " + std::to_string(refused) + " has no area"};
}

}  // namespace
}  // namespace mesh

Result<std::vector<Vec3>> warp_from_texture(const MeshDescription& mesh,
                                            std::span<const std::array<double, 2>> texture) {
  if (auto r = mesh::check_input(mesh); !r) return Error{r.error()};
  if (texture.size() != mesh.corners.size()) {
    return refuse("texture", "needs as many as corners, " + std::to_string(mesh.corners.size()),
                  std::to_string(texture.size()));
  }
  return mesh::directions(mesh, texture);
}

}  // namespace weft
