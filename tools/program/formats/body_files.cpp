#include "tools/program/formats/body_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/program/files/text_file.h"
#include "tools/program/formats/inside_out.h"
#include "tools/program/formats/obj_file.h"
#include "tools/scenes/mesh.h"

namespace weft::tools {
namespace {

/// Of a name with a *.
Result<std::vector<std::string>> files_like(const std::string& names) {
  const std::filesystem::path path(names);
  const std::string pattern = path.filename().string();
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos || pattern.find('*', star + 1) != std::string::npos)
    return Error{fmt::format("'{}' has more than one *, or one in the name of a folder", names)};
  const std::string before = pattern.substr(0, star), after = pattern.substr(star + 1);
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code failed;
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (name.size() + 1 < pattern.size() || !name.starts_with(before) || !name.ends_with(after))
      continue;
    found.push_back((path.parent_path() / name).string());
  }
  if (failed) return Error{fmt::format("'{}': {}", folder.string(), failed.message())};
  if (found.empty()) return Error{fmt::format("no file is named like '{}'", names)};
  std::ranges::sort(found, {}, [](const std::string& f) { return std::pair(f.size(), f); });
  return found;
}

Result<VertexMove> read_frames(const std::vector<std::string>& files, double frame, double scale,
                               TriangleMesh& first) {
  VertexMove move;
  for (std::size_t i = 0; i < files.size(); ++i) {
    auto mesh = read_body_mesh(files[i], scale);
    if (!mesh) return Error{mesh.error()};
    if (i == 0) first = mesh.value();
    if (mesh.value().vertices.size() != first.vertices.size() ||
        mesh.value().triangles != first.triangles)
      return Error{fmt::format("{}: its faces are not those of {}", files[i], files[0])};
    move.times.push_back(frame * static_cast<double>(i));
    move.vertices.push_back(std::move(mesh.value().vertices));
  }
  return move;
}

}  // namespace

Result<TriangleMesh> read_body_mesh(const std::string& path, double scale) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  auto file = parse_obj_file(text.value());
  if (!file) return Error{fmt::format("{}: {}", path, file.error())};
  TriangleMesh mesh;
  mesh.vertices = std::move(file.value().mesh.vertices);
  for (Vec3& v : mesh.vertices) v = {scale * v.x, scale * v.y, scale * v.z};
  mesh.triangles = triangles_of(file.value().mesh.faces);
  if (mesh.triangles.empty()) return Error{fmt::format("{}: no face in the file", path)};
  return mesh;
}

std::string note_of_inside_out(const std::string& name, bool is_turned) {
  return name + (is_turned ? ": its triangles faced inwards, and are turned"
                           : ": it is inside out: its triangles face inwards, so that it keeps "
                             "cloth inside; --turn-bodies turns them");
}

Result<SceneBody> body_of_files(const BodyFiles& files, std::vector<std::string>& notes) {
  SceneBody body;
  TriangleMesh mesh;
  const bool is_moving = files.is_series();
  if (is_moving && !files.frame)
    return Error{fmt::format("--body: '{}' needs --body-dt", files.names)};
  if (is_moving) {
    const auto found = files_like(files.names);
    if (!found) return Error{fmt::format("--body: {}", found.error())};
    auto move = read_frames(found.value(), *files.frame, files.scale, mesh);
    if (!move) return Error{fmt::format("--body: {}", move.error())};
    body.vertex_move = std::move(move.value());
  } else {
    auto read = read_body_mesh(files.names, files.scale);
    if (!read) return Error{fmt::format("--body: {}", read.error())};
    mesh = std::move(read.value());
  }
  mesh.two_sided = !is_oriented(mesh);
  if (mesh.two_sided) {
    notes.push_back(fmt::format(
        "{}: its triangles are not all turned the same way, so that it keeps cloth on the side "
        "where it is: turn them, and cloth that gets inside comes out",
        files.names));
  } else if (is_inside_out(mesh)) {
    notes.push_back(note_of_inside_out(files.names, files.turn));
    if (files.turn) turn(mesh);
  }
  body.shape = std::move(mesh);
  if (const auto built = build_shape(body.shape); !built)
    return Error{fmt::format("--body: {}: {}", files.names, built.error())};
  return body;
}

}  // namespace weft::tools
