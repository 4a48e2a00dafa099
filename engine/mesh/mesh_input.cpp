#include "engine/mesh/mesh_input.h"

#include "engine/model/validation.h"

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
  if (auto r = check_pairs("lines", mesh.lines, mesh); !r) return r;
  if (mesh.corners.empty() && mesh.lines.empty()) {
    return Error{"corners: the mesh has no face and no line"};
  }
  if (auto r = check_pins(mesh); !r) return r;
  if (auto r = check_pairs("seams", mesh.seams, mesh); !r) return r;
  if (auto r = validate_not_negative("weld_distance", mesh.weld_distance); !r) return r;
  return mesh.material ? check_material(*mesh.material) : validate_positive("mass", mesh.mass);
}

std::size_t face_count(const MeshDescription& mesh) {
  return mesh.face_sizes.empty() ? mesh.corners.size() / 3 : mesh.face_sizes.size();
}

void for_each_face(const MeshDescription& mesh,
                   const std::function<void(std::span<const std::uint32_t>)>& call) {
  std::span<const std::uint32_t> rest = mesh.corners;
  for (std::size_t i = 0; i < face_count(mesh); ++i) {
    const std::size_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[i];
    call(rest.first(size));
    rest = rest.subspan(size);
  }
}

std::vector<bool> used_vertices(const MeshDescription& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const std::uint32_t vertex : mesh.corners) used[vertex] = true;
  for (const auto& line : mesh.lines) used[line[0]] = used[line[1]] = true;
  return used;
}

}  // namespace weft::mesh
