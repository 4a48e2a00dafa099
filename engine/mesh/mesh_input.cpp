#include "engine/mesh/mesh_input.h"

#include <cmath>

#include "engine/geometry.h"
#include "engine/validation.h"

namespace weft::mesh {
namespace {

constexpr std::size_t kMostVertices = kNoIndex;

Result<void> check_vertex(const std::string& field, std::uint32_t vertex,
                          const MeshDescription& mesh) {
  if (vertex < mesh.positions.size()) return {};
  return refuse(field, "no such vertex, the mesh has " + std::to_string(mesh.positions.size()),
                std::to_string(vertex));
}

Result<void> check_pairs(std::string_view field,
                         const std::vector<std::array<std::uint32_t, 2>>& pairs,
                         const MeshDescription& mesh) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t end = 0; end < 2; ++end) {
      auto r = check_vertex(element(element(field, i), end), pairs[i][end], mesh);
      if (!r) return r;
    }
  }
  return {};
}

Result<void> check_positions(const MeshDescription& mesh) {
  if (mesh.positions.size() >= kMostVertices) {
    return refuse("positions", "too many", std::to_string(mesh.positions.size()));
  }
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (finite(mesh.positions[i])) continue;
    return refuse(element("positions", i), "must be finite", text(mesh.positions[i]));
  }
  return {};
}

Result<void> check_count(std::string_view field, std::size_t count, std::string_view of,
                         std::size_t needed) {
  if (count == 0 || count == needed) return {};
  return refuse(field, "needs as many as " + std::string(of) + ", " + std::to_string(needed),
                std::to_string(count));
}

Result<void> check_rest(const MeshDescription& mesh) {
  const auto& in_space = mesh.rest_positions;
  const auto& flat = mesh.rest_corners;
  if (!in_space.empty() && !flat.empty()) {
    return Error{"rest_corners: there are rest_positions already"};
  }
  auto r = check_count("rest_positions", in_space.size(), "positions", mesh.positions.size());
  if (!r) return r;
  r = check_count("rest_corners", flat.size(), "corners", mesh.corners.size());
  if (!r) return r;
  for (std::size_t i = 0; i < in_space.size(); ++i) {
    if (finite(in_space[i])) continue;
    return refuse(element("rest_positions", i), "must be finite", text(in_space[i]));
  }
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const auto [u, v] = flat[i];
    if (std::isfinite(u) && std::isfinite(v)) continue;
    return refuse(element("rest_corners", i), "must be finite", number(u) + ", " + number(v));
  }
  return {};
}

Result<void> check_faces(const MeshDescription& mesh) {
  const std::size_t corners = mesh.corners.size();
  if (mesh.face_sizes.empty() && corners % 3 != 0) {
    return refuse("corners", "triangles need a multiple of 3", std::to_string(corners));
  }
  std::size_t sum = mesh.face_sizes.empty() ? corners : 0;
  for (std::size_t i = 0; i < mesh.face_sizes.size(); ++i) {
    if (mesh.face_sizes[i] < 3) {
      return refuse(element("face_sizes", i), "a face has three corners at least",
                    std::to_string(mesh.face_sizes[i]));
    }
    sum += mesh.face_sizes[i];
  }
  if (sum != corners) {
    return refuse("face_sizes", "must sum to the number of corners, " + std::to_string(corners),
                  std::to_string(sum));
  }
  for (std::size_t i = 0; i < corners; ++i) {
    if (auto r = check_vertex(element("corners", i), mesh.corners[i], mesh); !r) return r;
  }
  return {};
}

Result<void> check_warp(const MeshDescription& mesh) {
  const std::size_t faces = face_count(mesh);
  if (mesh.warp.size() > 1 && mesh.warp.size() != faces) {
    return refuse("warp", "needs one for all, or as many as faces, " + std::to_string(faces),
                  std::to_string(mesh.warp.size()));
  }
  for (std::size_t i = 0; i < mesh.warp.size(); ++i) {
    if (finite(mesh.warp[i])) continue;
    return refuse(element("warp", i), "must be finite", text(mesh.warp[i]));
  }
  return {};
}

Result<void> check_rest_areas(const MeshDescription& mesh) {
  if (mesh.rest_positions.empty() && mesh.rest_corners.empty()) return {};
  std::size_t face = 0, refused = face_count(mesh);
  std::vector<Vec3> start, rest;
  for_each_face(mesh, [&](std::size_t first, std::span<const std::uint32_t> vertices) {
    start.clear();
    rest.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      start.push_back(mesh.positions[vertices[i]]);
      rest.push_back(rest_of_corner(mesh, first + i));
    }
    if (has_area(start) && !has_area(rest)) refused = std::min(refused, face);
    ++face;
  });
  if (refused == face_count(mesh)) return {};
  return Error{std::string(mesh.rest_corners.empty() ? "rest_positions" : "rest_corners") +
               ": face " + std::to_string(refused) + " has no area at rest"};
}

Result<void> check_pins(const MeshDescription& mesh) {
  const std::vector<bool> used = used_vertices(mesh);
  for (std::size_t i = 0; i < mesh.pins.size(); ++i) {
    const std::string field = element("pins", i);
    if (auto r = check_vertex(field, mesh.pins[i], mesh); !r) return r;
    if (used[mesh.pins[i]]) continue;
    return refuse(field, "this vertex is in no face and no line", std::to_string(mesh.pins[i]));
  }
  return {};
}

}  // namespace

Result<void> check_input(const MeshDescription& mesh) {
  if (auto r = check_positions(mesh); !r) return r;
  if (auto r = check_faces(mesh); !r) return r;
  if (auto r = check_rest(mesh); !r) return r;
  if (auto r = check_rest_areas(mesh); !r) return r;
  if (auto r = check_warp(mesh); !r) return r;
  if (auto r = check_pairs("lines", mesh.lines, mesh); !r) return r;
  if (mesh.corners.empty() && mesh.lines.empty()) {
    return Error{"corners: the mesh has no face and no line"};
  }
  if (auto r = check_pins(mesh); !r) return r;
  if (auto r = check_pairs("seams", mesh.seams, mesh); !r) return r;
  if (auto r = validate_not_negative("seam_time", mesh.seam_time); !r) return r;
  if (!(mesh.seam_force > 0))
    return refuse("seam_force", "must be greater than 0, or infinite", number(mesh.seam_force));
  if (auto r = validate_not_negative("weld_distance", mesh.weld_distance); !r) return r;
  if (auto r = validate_positive("thread_density", mesh.thread_density); !r) return r;
  return mesh.material ? check_material(*mesh.material) : validate_positive("mass", mesh.mass);
}

std::size_t face_count(const MeshDescription& mesh) {
  return mesh.face_sizes.empty() ? mesh.corners.size() / 3 : mesh.face_sizes.size();
}

void for_each_face(
    const MeshDescription& mesh,
    const std::function<void(std::size_t first, std::span<const std::uint32_t> vertices)>& call) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < face_count(mesh); ++i) {
    const std::size_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[i];
    call(first, std::span(mesh.corners).subspan(first, size));
    first += size;
  }
}

bool has_area(std::span<const Vec3> face) {
  for (std::size_t i = 2; i < face.size(); ++i) {
    if (has_area(face[0], face[i - 1], face[i])) return true;
  }
  return false;
}

Vec3 rest_of_corner(const MeshDescription& mesh, std::size_t corner) {
  if (mesh.rest_corners.empty()) return rest_of_vertex(mesh, mesh.corners[corner]);
  const auto [along_weft, along_warp] = mesh.rest_corners[corner];
  return {along_weft, along_warp, 0};
}

Vec3 rest_of_vertex(const MeshDescription& mesh, std::uint32_t vertex) {
  return mesh.rest_positions.empty() ? mesh.positions[vertex] : mesh.rest_positions[vertex];
}

std::vector<bool> used_vertices(const MeshDescription& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const std::uint32_t vertex : mesh.corners) used[vertex] = true;
  for (const auto& line : mesh.lines) used[line[0]] = used[line[1]] = true;
  return used;
}

}  // namespace weft::mesh
