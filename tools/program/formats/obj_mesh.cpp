#include "tools/program/formats/obj_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/program/files/text_file.h"
#include "tools/program/formats/obj_file.h"
#include "tools/program/formats/pin_rule.h"
#include "tools/program/formats/rest_and_warp.h"
#include "tools/program/text/parse.h"

namespace weft::tools {
namespace {

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

Result<MeshDescription> description_of(const ObjFile& file, const ObjOptions& options) {
  const Mesh& mesh = file.mesh;
  MeshDescription description = describe_mesh(mesh.vertices, mesh.faces);
  if (options.rest) {
    if (auto given = give_rest(*options.rest, file, options.scale, description); !given)
      return Error{given.error()};
  }
  scale_all(description.positions, options.scale);
  if (options.warp) {
    auto given = give_warp(*options.warp, file, description);
    if (!given) return Error{given.error()};
  }
  for (const auto& line : mesh.lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      description.lines.push_back({line[i], line[i + 1]});
    }
  }
  description.material = options.material;
  description.mass = options.mass;
  description.thread_density = options.thread_density;
  description.ropes = options.ropes;
  description.weld_distance = options.weld_distance;
  auto pins = pinned_vertices(options.pin, mesh, options.up);
  if (!pins) return Error{pins.error()};
  description.pins = std::move(pins.value());
  for (const std::string& seam : options.seams) {
    if (auto sewn = sew(seam, description); !sewn) return Error{sewn.error()};
  }
  description.seam_time = options.seam_time;
  description.seam_force = options.seam_force.value_or(description.seam_force);
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
  auto file = parse_obj_file(text);
  if (!file) return Error{file.error()};
  const auto description = description_of(file.value(), options);
  if (!description) return Error{description.error()};
  ObjScene scene;
  scene.mesh = std::move(file.value().mesh);
  auto cloth = cloth_from_mesh(description.value());
  if (!cloth) return Error{cloth.error()};
  scene.mesh.particle_of_vertex = std::move(cloth.value().particle_of_vertex);
  scene.mesh.cells = std::move(cloth.value().cells);
  scene.description = std::move(cloth.value().scene);
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
