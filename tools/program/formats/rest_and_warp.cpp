#include "tools/program/formats/rest_and_warp.h"

#include <fmt/format.h>

#include "tools/program/files/text_file.h"
#include "tools/program/text/file_ending.h"
#include "tools/program/text/parse.h"
#include "tools/program/text/wording.h"

namespace weft::tools {
namespace {

constexpr std::string_view kTexture = "uv";

/// "uv" or "uv:SCALE"; nothing if it is neither.
std::optional<double> texture_scale(std::string_view given) {
  if (!given.starts_with(kTexture)) return std::nullopt;
  given.remove_prefix(kTexture.size());
  if (given.empty()) return 1;
  const auto scale = given.starts_with(':') ? parse_number(given.substr(1)) : std::nullopt;
  return scale && *scale > 0 ? scale : std::nullopt;
}

Result<void> rest_from_texture(const ObjFile& file, double scale, MeshDescription& description) {
  auto texture = whole_texture(file);
  if (!texture) return Error{"--rest: " + texture.error()};
  for (auto& [u, v] : texture.value()) u *= scale, v *= scale;
  description.rest_corners = std::move(texture.value());
  return {};
}

/// Whether another file has the same vertices and faces.
Result<void> check_same(const Mesh& mesh, const Mesh& rest) {
  if (rest.vertices.size() != mesh.vertices.size()) {
    return Error{fmt::format("{} vertices, where the mesh has {}", rest.vertices.size(),
                             mesh.vertices.size())};
  }
  if (rest.faces.size() != mesh.faces.size()) {
    return Error{fmt::format("{}, where the mesh has {}", counted(rest.faces.size(), "face"),
                             mesh.faces.size())};
  }
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (rest.faces[face] == mesh.faces[face]) continue;
    return Error{fmt::format("face {}, counted from 0, has other vertices than in the mesh", face)};
  }
  return {};
}

Result<void> rest_from_file(const std::string& path, const Mesh& mesh, double scale,
                            MeshDescription& description) {
  const auto text = read_text_file(path);
  if (!text) return Error{"--rest: " + text.error()};
  const auto rest = parse_obj_file(text.value());
  if (!rest) return Error{fmt::format("--rest: {}: {}", path, rest.error())};
  if (auto same = check_same(mesh, rest.value().mesh); !same) {
    return Error{fmt::format("--rest: {}: {}", path, same.error())};
  }
  for (const Vec3& v : rest.value().mesh.vertices)
    description.rest_positions.push_back({scale * v.x, scale * v.y, scale * v.z});
  return {};
}

}  // namespace

Result<void> give_rest(std::string_view given, const ObjFile& file, double scale,
                       MeshDescription& description) {
  if (const auto texture = texture_scale(given))
    return rest_from_texture(file, *texture, description);
  const std::string path(given);
  if (file_ending(path) == ".obj") return rest_from_file(path, file.mesh, scale, description);
  return Error{fmt::format("--rest: '{}' is not an .obj file, uv, or uv:SCALE", given)};
}

Result<void> give_warp(std::string_view given, const ObjFile& file, MeshDescription& description) {
  if (given != kTexture) {
    const auto direction = parse_vector("--warp", given);
    if (!direction) return Error{fmt::format("--warp: '{}' is not x,y,z, or uv", given)};
    description.warp = {direction.value()};
    return {};
  }
  const auto texture = whole_texture(file);
  if (!texture) return Error{"--warp: " + texture.error()};
  auto warp = warp_from_texture(description, texture.value());
  if (!warp) return Error{"--warp: " + warp.error()};
  description.warp = std::move(warp.value());
  return {};
}

}  // namespace weft::tools
