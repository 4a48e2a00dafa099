#include "tools/obj_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <sstream>

#include "tools/parse.h"
#include "tools/pin_rule.h"
#include "tools/text_file.h"

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

namespace weft::tools {
namespace {

// --------------------------------------------------------------------------------------- reading

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

bool is_vertex(std::span<const std::string_view> words) {
  return words.size() >= 4 && parse_number(words[1]) && parse_number(words[2]) &&
         parse_number(words[3]);
}

/// Takes the first line off the text. A line ends as the loader has it: with \n, \r\n or \r.
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  text.remove_prefix(line.size());
  text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, text.size()));
  return line;
}

/// Comments of these lines are cut off, since the loader takes them for vertices of a face.
std::string_view without_comment(std::string_view line) {
  const auto words = words_of(line);
  const bool is_element = !words.empty() && words[0].size() == 1;  // v, f, l, p
  return is_element ? line.substr(0, line.find('#')) : line;
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

/// Reads along with the loader, for what that would accept in silence: it reads a broken number as
/// 0, 3.5 as 3 and 4294967299 as 3 too, drops faces of two corners, and counts corners in a byte.
class LineCheck {
 public:
  Result<void> add(std::string_view line) {
    ++line_;
    const auto words = words_of(line);
    if (words.empty()) return {};
    if (words[0] == "v") {
      ++vertices_;
      return is_vertex(words) ? Result<void>{}
                              : refused(line, "a vertex needs three finite numbers");
    }
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
    if (largest_ <= vertices_) return {};
    return Error{fmt::format("line {}: there is no vertex {}, the last one is {}", largest_line_,
                             largest_, vertices_)};
  }

 private:
  static constexpr std::size_t kMostCorners = 255;

  Result<void> refused(std::string_view text, std::string_view why) const {
    return Error{fmt::format("line {}: '{}': {}", line_, text, why)};
  }

  Result<void> add_corners(std::span<const std::string_view> words) {
    for (const std::string_view word : words) {
      const long long number = vertex_number(word, vertices_);
      if (number == 0) return refused(word, "not the number of a vertex");
      if (number <= largest_) continue;
      largest_ = number;
      largest_line_ = line_;
    }
    return {};
  }

  int line_ = 0;
  long long vertices_ = 0;
  long long largest_ = 0;  ///< number of a vertex
  int largest_line_ = 0;
};

/// The text as the loader is to have it.
Result<std::string> checked_text(std::string_view text) {
  std::string checked;
  checked.reserve(text.size() + 1);
  LineCheck check;
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  while (!text.empty()) {
    const std::string_view line = without_comment(take_line(text));
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

Result<Mesh> load_mesh(const std::string& text) {
  const auto checked = checked_text(text);
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
  Mesh mesh;
  for (std::size_t i = 0; i + 2 < attributes.vertices.size(); i += 3) {
    const double* v = &attributes.vertices[i];
    mesh.vertices.push_back({v[0], v[1], v[2]});
  }
  for (const tinyobj::shape_t& shape : shapes) {
    const std::size_t count = mesh.vertices.size();
    auto added = add_parts(shape.mesh.indices, shape.mesh.num_face_vertices, count, mesh.faces);
    if (!added) return Error{added.error()};
    added = add_parts(shape.lines.indices, shape.lines.num_line_vertices, count, mesh.lines);
    if (!added) return Error{added.error()};
  }
  if (mesh.faces.empty() && mesh.lines.empty()) return Error{"no face and no line in the file"};
  return mesh;
}

// --------------------------------------------------------------------------------------- joining

constexpr double kGravity = 10;  // m/s^2, as SceneDescription has it

void scale_all(std::vector<Vec3>& points, double scale) {
  for (Vec3& point : points) point = {point.x * scale, point.y * scale, point.z * scale};
}

std::vector<std::uint32_t> expanded(const std::vector<NumberRange>& ranges) {
  std::vector<std::uint32_t> numbers;
  for (const NumberRange& range : ranges) {
    for (long long i = 0; i < range.count(); ++i)
      numbers.push_back(static_cast<std::uint32_t>(range.at(i)));
  }
  return numbers;
}

/// The vertices on one side of a seam.
Result<std::vector<std::uint32_t>> side_of(std::string_view seam, std::string_view side,
                                           std::size_t vertices) {
  const auto ranges = parse_ranges(side);
  if (!ranges) {
    return Error{fmt::format("--seam: '{}' is not two lists of vertices, like 0-9:29-20", seam)};
  }
  for (const NumberRange& range : *ranges) {
    const long long largest = std::max(range.first, range.last);
    if (static_cast<std::size_t>(largest) < vertices) continue;
    return Error{fmt::format("--seam: '{}': there is no vertex {}, the last one is {}", seam,
                             largest, vertices - 1)};
  }
  return expanded(*ranges);
}

Result<void> sew(std::string_view seam, MeshDescription& description) {
  const std::size_t colon = std::min(seam.find(':'), seam.size());
  const std::size_t vertices = description.positions.size();
  const auto one = side_of(seam, seam.substr(0, colon), vertices);
  if (!one) return Error{one.error()};
  const auto other = side_of(seam, seam.substr(std::min(colon + 1, seam.size())), vertices);
  if (!other) return Error{other.error()};
  if (one.value().size() != other.value().size()) {
    return Error{fmt::format("--seam: '{}' sews {} vertices to {}", seam, one.value().size(),
                             other.value().size())};
  }
  for (std::size_t i = 0; i < one.value().size(); ++i)
    description.seams.push_back({one.value()[i], other.value()[i]});
  return {};
}

/// Pins are left out: their rules are in the file's coordinates.
Result<MeshDescription> description_of(const Mesh& mesh, const ObjOptions& options) {
  MeshDescription description = describe_mesh(mesh.vertices, mesh.faces);
  scale_all(description.positions, options.scale);
  for (const auto& line : mesh.lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      description.lines.push_back({line[i], line[i + 1]});
    }
  }
  description.material = options.material;
  description.mass = options.mass;
  description.ropes = options.ropes;
  description.weld_distance = options.weld_distance;
  for (const std::string& seam : options.seams) {
    if (auto sewn = sew(seam, description); !sewn) return Error{sewn.error()};
  }
  return description;
}

Result<void> check_positive(std::string_view option, double value) {
  if (std::isfinite(value) && value > 0) return {};
  return Error{fmt::format("{}: {} is not a number above 0", option, value)};
}

// --------------------------------------------------------------------------------------- writing

constexpr int kSphereRings = 12;
constexpr int kSphereSegments = 24;

/// Rows of segments from pole to pole; every ring between has kSphereSegments vertices, and the
/// poles have as many at one place, so that all faces are numbered alike.
void add_sphere_text(std::string& text, std::uint32_t particle, Vec3 centre, double radius,
                     std::size_t first_vertex) {
  text += fmt::format("o sphere_{}\n", particle);
  for (int ring = 0; ring <= kSphereRings; ++ring) {
    const double polar = std::numbers::pi * ring / kSphereRings;
    for (int segment = 0; segment < kSphereSegments; ++segment) {
      const double around = 2 * std::numbers::pi * segment / kSphereSegments;
      text += fmt::format("v {} {} {}\n", centre.x + radius * std::sin(polar) * std::cos(around),
                          centre.y + radius * std::cos(polar),
                          centre.z + radius * std::sin(polar) * std::sin(around));
    }
  }
  const auto vertex = [&](int ring, int segment) {
    const int offset = ring * kSphereSegments + segment % kSphereSegments;
    return first_vertex + static_cast<std::size_t>(offset);
  };
  for (int ring = 0; ring < kSphereRings; ++ring) {
    for (int segment = 0; segment < kSphereSegments; ++segment) {
      text += fmt::format("f {} {} {} {}\n", vertex(ring, segment), vertex(ring, segment + 1),
                          vertex(ring + 1, segment + 1), vertex(ring + 1, segment));
    }
  }
}

void add_part_text(std::string& text, char kind, const std::vector<std::uint32_t>& part) {
  text += kind;
  for (const std::uint32_t vertex : part) text += fmt::format(" {}", vertex + 1);
  text += '\n';
}

}  // namespace

Result<ObjScene> parse_obj(const std::string& text, const ObjOptions& options) {
  if (auto mass = check_positive("--mass", options.mass); !mass) return Error{mass.error()};
  if (auto scale = check_positive("--scale", options.scale); !scale) return Error{scale.error()};
  auto loaded = load_mesh(text);
  if (!loaded) return Error{loaded.error()};

  ObjScene scene;
  scene.mesh = std::move(loaded.value());
  const auto description = description_of(scene.mesh, options);
  if (!description) return Error{description.error()};
  auto cloth = cloth_from_mesh(description.value());
  if (!cloth) return Error{cloth.error()};
  scene.mesh.particle_of_vertex = std::move(cloth.value().particle_of_vertex);
  auto fixed = pinned_particles(options.pin, scene.mesh, options.up);
  if (!fixed) return Error{fixed.error()};
  scene.description = std::move(cloth.value().scene);
  scene.description.fixed = std::move(fixed.value());
  scene.description.gravity = {};
  scene.description.gravity.*options.up = -kGravity;
  scene.counts = cloth.value().counts;
  scale_all(scene.mesh.vertices, options.scale);
  return scene;
}

Result<ObjScene> read_obj_file(const std::string& path, const ObjOptions& options) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  auto scene = parse_obj(text.value(), options);
  if (!scene) return Error{fmt::format("{}: {}", path, scene.error())};
  return scene;
}

std::string obj_text(const Mesh& mesh, const SceneDescription& scene,
                     const std::vector<Vec3>& particles) {
  std::string text = "o cloth\n";
  for (const Vec3& v : vertex_positions(mesh, particles)) {
    text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  }
  for (const auto& face : mesh.faces) add_part_text(text, 'f', face);
  for (const auto& line : mesh.lines) add_part_text(text, 'l', line);
  std::size_t next_vertex = mesh.vertices.size() + 1;
  for (const std::uint32_t sphere : scene.spheres) {
    add_sphere_text(text, sphere, particles[sphere], scene.radii[sphere], next_vertex);
    next_vertex += (kSphereRings + 1) * kSphereSegments;
  }
  return text;
}

}  // namespace weft::tools
