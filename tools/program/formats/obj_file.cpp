#include "tools/program/formats/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <sstream>
#include <utility>

#include "tools/program/text/parse.h"
#include "tools/program/text/wording.h"

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

namespace weft::tools {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::optional<Vec3> vertex_place(std::span<const std::string_view> words) {
  if (words.size() < 4) return std::nullopt;
  const auto x = parse_number(words[1]), y = parse_number(words[2]), z = parse_number(words[3]);
  if (!x || !y || !z) return std::nullopt;
  return Vec3{*x, *y, *z};
}

/// Takes the first line off the text. A line ends as the loader has it: with \n, \r\n or \r.
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  text.remove_prefix(line.size());
  text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, text.size()));
  return line;
}

/// What a mesh is made of, without comments, which the loader takes for vertices of a face. The
/// loader sees nothing else: it converts numbers of lines that nobody needs without looking at
/// their range.
std::string_view needed_part(std::string_view line) {
  constexpr std::array<std::string_view, 5> kNeeded{"v", "vt", "vn", "f", "l"};
  const auto words = words_of(line);
  if (words.empty() || std::ranges::find(kNeeded, words[0]) == kNeeded.end()) return {};
  return line.substr(0, line.find('#'));
}

/// From 1 up, or below 0 and counted back from the last vertex; 0: it is no number of a vertex.
/// Textures and normals after it are left to the loader.
long long vertex_number(std::string_view word, long long vertices_before) {
  const std::string_view digits = word.substr(0, word.find('/'));
  const bool counts_back = digits.starts_with('-');
  const long long number = parse_count(digits.substr(counts_back ? 1 : 0)).value_or(0);
  if (!counts_back) return number;
  return number <= vertices_before ? -number : 0;
}

/// Nothing if it is no pair of numbers. Files may have such lines as long as nobody needs them.
std::optional<FlatPlace> texture_place(std::span<const std::string_view> words) {
  const auto u = words.size() > 1 ? parse_number(words[1]) : std::nullopt;
  const auto v = words.size() > 2 ? parse_number(words[2]) : std::nullopt;
  if (!u || !v) return std::nullopt;
  return FlatPlace{*u, *v};
}

/// Reads along with the loader, for what that would accept in silence: it reads a broken number as
/// 0, 3.5 as 3 and 4294967299 as 3 too, drops faces of two corners, and counts corners in a byte.
/// Numbers with a point it reads with errors of rounding.
class LineCheck {
 public:
  Result<void> add(std::string_view line) {
    ++line_;
    const auto words = words_of(line);
    if (words.empty()) return {};
    if (words[0] == "v") {
      const auto place = vertex_place(words);
      if (!place) return refused(line, "a vertex needs three finite numbers");
      vertices_.push_back(*place);
      return {};
    }
    if (words[0] == "vt") texture_.push_back(texture_place(words));
    if (words[0] != "f" && words[0] != "l") return {};
    const auto corners = std::span(words).subspan(1);
    if (words[0] == "l" && corners.size() < 2) return refused(line, "a line has two ends at least");
    if (words[0] == "f" && corners.size() < 3) {
      return refused(line, "a face has three corners at least");
    }
    if (words[0] == "f" && corners.size() > kMostCorners) {
      return Error{fmt::format("line {}: a face of {} vertices; at most {} can be read", line_,
                               corners.size(), kMostCorners)};
    }
    return add_corners(corners);
  }

  /// Vertices may follow the faces that use them: only now is known how many there are.
  Result<void> finish() const {
    if (largest_ <= count()) return {};
    return Error{fmt::format("line {}: there is no vertex {}, the last one is {}", largest_line_,
                             largest_, count())};
  }
  /// Of each v of the file, to the last bit, which the loader's own numbers are not.
  std::vector<Vec3>& vertices() { return vertices_; }
  /// Of each vt of the file.
  const std::vector<std::optional<FlatPlace>>& texture() const { return texture_; }

 private:
  static constexpr std::size_t kMostCorners = 255;

  Result<void> refused(std::string_view text, std::string_view why) const {
    return Error{fmt::format("line {}: '{}': {}", line_, shown(text), why)};
  }

  Result<void> add_corners(std::span<const std::string_view> words) {
    for (const std::string_view word : words) {
      const long long number = vertex_number(word, count());
      if (number == 0) return refused(word, "not the number of a vertex");
      if (number <= largest_) continue;
      largest_ = number;
      largest_line_ = line_;
    }
    return {};
  }

  long long count() const { return static_cast<long long>(vertices_.size()); }

  int line_ = 0;
  std::vector<Vec3> vertices_;
  long long largest_ = 0;  ///< number of a vertex
  int largest_line_ = 0;
  std::vector<std::optional<FlatPlace>> texture_;
};

/// The text as the loader is to have it.
Result<std::string> checked_text(std::string_view text, LineCheck& check) {
  std::string checked;
  checked.reserve(text.size() + 1);
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  while (!text.empty()) {
    const std::string_view line = needed_part(take_line(text));
    if (auto added = check.add(line); !added) return Error{added.error()};
    checked += line;
    checked += '\n';
  }
  if (auto finished = check.finish(); !finished) return Error{finished.error()};
  return checked;
}

/// Cuts a flat list of corners into its faces or lines.
template <class Count>
Result<void> add_parts(const std::vector<tinyobj::index_t>& corners,
                       const std::vector<Count>& counts, std::size_t vertex_count,
                       std::vector<std::vector<std::uint32_t>>& parts) {
  auto corner = corners.begin();
  for (const Count count : counts) {
    std::vector<std::uint32_t> part;
    for (Count i = 0; i < count; ++i, ++corner) {
      const auto vertex = static_cast<std::size_t>(corner->vertex_index);
      if (corner->vertex_index < 0 || vertex >= vertex_count) {
        return Error{fmt::format("a face or line uses vertex {} of {}", corner->vertex_index + 1,
                                 vertex_count)};
      }
      part.push_back(static_cast<std::uint32_t>(vertex));
    }
    parts.push_back(std::move(part));
  }
  return {};
}

/// One per corner of the faces.
void add_texture(const std::vector<tinyobj::index_t>& corners,
                 const std::vector<std::optional<FlatPlace>>& all,
                 std::vector<std::optional<FlatPlace>>& texture) {
  for (const tinyobj::index_t& corner : corners) {
    const auto number = static_cast<std::size_t>(corner.texcoord_index);
    const bool is_known = corner.texcoord_index >= 0 && number < all.size();
    texture.push_back(is_known ? all[number] : std::nullopt);
  }
}

}  // namespace

Result<std::vector<FlatPlace>> whole_texture(const ObjFile& file) {
  std::vector<FlatPlace> texture;
  for (std::size_t face = 0; face < file.mesh.faces.size(); ++face) {
    for (std::size_t i = 0; i < file.mesh.faces[face].size(); ++i) {
      const auto& place = file.texture[texture.size()];
      if (!place) {
        return Error{
            fmt::format("face {}, counted from 0, has a corner without texture coordinates", face)};
      }
      texture.push_back(*place);
    }
  }
  return texture;
}

Result<ObjFile> parse_obj_file(std::string_view text) {
  LineCheck check;
  const auto checked = checked_text(text, check);
  if (!checked) return Error{checked.error()};
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning;
  std::string error;
  std::istringstream stream(checked.value());
  constexpr bool kTriangulate = false;
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, nullptr,
                        kTriangulate)) {
    return Error{error.substr(0, error.find('\n'))};
  }
  ObjFile file;
  Mesh& mesh = file.mesh;
  mesh.vertices = std::move(check.vertices());
  for (const tinyobj::shape_t& shape : shapes) {
    const std::size_t count = mesh.vertices.size();
    auto added = add_parts(shape.mesh.indices, shape.mesh.num_face_vertices, count, mesh.faces);
    if (!added) return Error{added.error()};
    added = add_parts(shape.lines.indices, shape.lines.num_line_vertices, count, mesh.lines);
    if (!added) return Error{added.error()};
    add_texture(shape.mesh.indices, check.texture(), file.texture);
  }
  if (mesh.faces.empty() && mesh.lines.empty()) return Error{"no face and no line in the file"};
  return file;
}

}  // namespace weft::tools
