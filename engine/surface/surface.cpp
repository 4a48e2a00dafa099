#include <weft/surface.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/mesh/mesh_input.h"
#include "engine/mesh/welding.h"
#include "engine/model/model.h"
#include "engine/model/validate.h"
#include "engine/surface/closed_seams.h"
#include "engine/surface/drawn_mesh.h"
#include "engine/surface/following.h"
#include "engine/surface/normals.h"
#include "engine/surface/tears.h"
#include "engine/validation.h"

namespace weft {
namespace surface {

/// The data that clones share.
struct Shape {
  DrawnMesh drawn;            // its points are the particles, or follow them
  std::size_t particles = 0;  // of the cloth
  double scale = 1;           // of the cloth (to_quads)
  bool is_mapped = false;     // if not, what is below is empty
  PointFaces followed;        // faces between particles
  std::vector<Following> points;
  ClosedSeams seams;  // not of a mapped one

  // These are empty where the cloth may not tear.
  std::vector<Triangle> parts;            // SceneDescription::surface, in the end as torn
  std::vector<std::uint32_t> split_from;  // per vertex that tears have added
  double seam_reach = 0;                  // m, of `seams`
  DrawnMesh coarse;                       // that is followed, as described
  MappedStart start;

  std::size_t bytes() const {
    return drawn.bytes() + followed.bytes() + bytes_of(points) + seams.bytes() + bytes_of(parts) +
           bytes_of(split_from) + coarse.bytes() + start.bytes();
  }
};

}  // namespace surface

namespace {

using namespace surface;

/// Whether the cloth can be one that was made of the mesh.
Result<void> check_made(const MeshDescription& mesh, const MeshCloth& cloth) {
  if (auto r = mesh::check_input(mesh); !r) return r;
  const std::vector<std::uint32_t>& particles = cloth.particle_of_vertex;
  auto r = validate_size("particle_of_vertex", particles.size(), mesh.positions.size());
  if (!r) return r;
  const std::vector<bool> used = mesh::used_vertices(mesh);
  for (std::size_t v = 0; v < particles.size(); ++v) {
    const std::size_t count = cloth.scene.positions.size();
    if (particles[v] == kNoIndex && !used[v]) continue;
    r = validate_particle(element("particle_of_vertex", v), particles[v], count);
    if (!r) return r;
  }
  if (cloth.scene.positions.empty()) return Error{"cloth: has no particles"};
  return {};
}

/// The triangles that a tear may split; none where nothing may tear.
std::span<const Triangle> parts_of(const SceneDescription& scene) {
  const auto may_break = [](const auto& element) { return std::isfinite(element.strength); };
  const bool may_tear = std::ranges::any_of(scene.constraints, may_break) ||
                        std::ranges::any_of(scene.membrane, may_break);
  return may_tear ? std::span<const Triangle>(scene.surface) : std::span<const Triangle>();
}

std::vector<Quad> normals_of(const PointFaces& faces, std::span<const Vec3> points, double scale) {
  std::vector<Quad> quads(points.size()), normals(points.size());
  to_quads(points, scale, quads);
  find_normals(faces, quads, normals);
  return normals;
}

/// The vertex that is this point first.
std::size_t vertex_of(std::uint32_t point, const std::vector<std::uint32_t>& point_of_vertex) {
  return static_cast<std::size_t>(std::ranges::find(point_of_vertex, point) -
                                  point_of_vertex.begin());
}

Result<void> map_points(const std::vector<Vec3>& particles, const DrawnMesh& followed,
                        const mesh::Welded& other, double max_distance, Shape& shape) {
  std::vector<Triangle> triangles = point_triangles(followed);
  const NearestTriangle nearest_triangle(particles, triangles);
  if (nearest_triangle.is_empty()) return Error{"mesh: has no face with an area"};
  std::vector<Quad> normals = normals_of(followed.faces, particles, shape.scale);
  std::vector<std::uint32_t> triangle_of;
  for (std::uint32_t point = 0; point < other.positions.size(); ++point) {
    const Vec3 place = other.positions[point];
    const Nearest nearest = nearest_triangle(place);
    if (nearest.distance > max_distance) {
      return refuse(element("other.positions", vertex_of(point, other.particle_of_vertex)),
                    "is farther from the mesh than max_distance, " + number(max_distance),
                    number(nearest.distance));
    }
    triangle_of.push_back(nearest.triangle);
    shape.points.push_back(
        following(place, triangles[nearest.triangle], nearest, particles, normals));
  }
  if (!shape.parts.empty())
    shape.start = {std::move(triangles), particles, std::move(normals), other.positions,
                   std::move(triangle_of)};
  return {};
}

std::vector<Seam> seams_of(const Model& model) {
  std::vector<Seam> seams;
  for (std::size_t i = 0; i < model.seams.size(); ++i) {
    if (model.seams.is_broken(i)) continue;
    seams.push_back({.a = model.ordering.particle_at[model.seams.a[i]],
                     .b = model.ordering.particle_at[model.seams.b[i]]});
  }
  return seams;
}

/// now: the parts of the model, which has torn.
std::shared_ptr<const Shape> torn_shape(const Shape& whole, const Model& model,
                                        std::vector<Triangle> now) {
  auto shape = std::make_shared<Shape>();
  shape->particles = model.particles;
  shape->scale = whole.scale;
  shape->is_mapped = whole.is_mapped;
  const DrawnMesh& of_cloth = whole.is_mapped ? whole.coarse : whole.drawn;
  std::vector<Triangle> corners = corners_now(of_cloth, whole.parts, now);
  if (whole.is_mapped) {
    TornPoints torn = torn_points(whole.start, corners, whole.drawn, whole.points);
    shape->points = std::move(torn.points);
    shape->followed = torn_mesh(of_cloth, corners).drawn.faces;
    corners = std::move(torn.corners);
  } else {
    shape->seams = ClosedSeams(seams_of(model), model.particles, whole.seam_reach);
  }
  TornMesh torn = torn_mesh(whole.drawn, corners);
  shape->drawn = std::move(torn.drawn);
  shape->split_from = std::move(torn.split_from);
  shape->parts = std::move(now);
  return shape;
}

/// Whether the parts are `before`, torn. particles: of those before.
bool are_torn_from(std::span<const Triangle> before, std::span<const Triangle> parts,
                   std::size_t particles) {
  if (parts.size() != before.size()) return false;
  for (std::size_t t = 0; t < parts.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      if (parts[t][k] != before[t][k] && parts[t][k] < particles) return false;
  }
  return true;
}

bool has_parts(const Model& model, std::span<const Triangle> parts) {
  if (model.surface.size() != parts.size()) return false;
  for (std::size_t t = 0; t < parts.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      if (model.ordering.particle_at[model.surface[t][k]] != parts[t][k]) return false;
  }
  return true;
}

}  // namespace

struct Surface::Impl {
  std::shared_ptr<const Shape> whole, shape;  // as described, and as torn
  std::weak_ptr<const Model> model;           // that the shape is known to be of
  ClosedSeams seams;                          // those of the shape, with their workspace
  // The workspace.
  std::vector<Vec3> particles, particle_velocities;  // velocities: of copy_shape
  std::vector<Quad> particle_quads, particle_normals;
  std::vector<Vec3> points, point_velocities;
  std::vector<Quad> point_quads, point_normals;

  explicit Impl(std::shared_ptr<const Shape> of) : Impl(of, of) {}
  Impl(std::shared_ptr<const Shape> described, std::shared_ptr<const Shape> torn)
      : whole(std::move(described)),
        shape(std::move(torn)),
        seams(shape->seams),
        particles(shape->particles) {
    if (shape->is_mapped) {
      particle_quads.resize(shape->particles);
      particle_normals.resize(shape->particles);
      points.resize(shape->points.size());
    }
    point_quads.resize(shape->is_mapped ? points.size() : particles.size());
    point_normals.resize(point_quads.size());
  }
  bool is_torn() const { return shape != whole; }
  bool knows(const Cloth& cloth) const {
    return !model.owner_before(cloth.model()) && !cloth.model().owner_before(model);
  }
  Result<void> check_followed(const Cloth& cloth);
  /// Where the points are; each read of it begins with read().
  std::span<const Vec3> where() const { return shape->is_mapped ? points : particles; }
  Result<void> read(const Cloth& from);
  void write_positions(FloatVectors out, Vec3 origin) const;
  void find_point_normals();
  void write_normals(FloatVectors out) const;
};

Result<void> Surface::Impl::check_followed(const Cloth& from) {
  if (knows(from)) return {};
  const std::size_t count = from.particle_count();
  const bool has_torn = !whole->parts.empty() && count > whole->particles;
  if (has_torn && (count != particles.size() || !has_parts(*from.model(), shape->parts)))
    return refuse("from", "has torn, so follow() comes first; its particles",
                  std::to_string(count));
  if (auto r = validate_size("from", count, particles.size()); !r) return r;
  model = from.model();
  return {};
}

Result<void> Surface::Impl::read(const Cloth& from) {
  if (auto r = check_followed(from); !r) return r;
  if (auto r = from.read_positions(std::span(particles)); !r) return r;
  if (!shape->is_mapped) {
    seams.join(particles);
    return {};
  }
  to_quads(particles, shape->scale, particle_quads);
  find_normals(shape->followed, particle_quads, particle_normals);
  place_points(shape->points, particles, particle_normals, points);
  return {};
}

void Surface::Impl::write_positions(FloatVectors out, Vec3 origin) const {
  const std::span<const Vec3> of_points = where();
  for (std::size_t v = 0; v < shape->drawn.vertices.size(); ++v) {
    const std::uint32_t point = shape->drawn.vertices[v].point;
    if (point == kNoIndex) continue;
    const Vec3 p = of_points[point];
    float* const to = &out.floats[v * out.stride];
    to[0] = static_cast<float>(p.x - origin.x);
    to[1] = static_cast<float>(p.y - origin.y);
    to[2] = static_cast<float>(p.z - origin.z);
  }
}

void Surface::Impl::find_point_normals() {
  to_quads(where(), shape->scale, point_quads);
  find_areas(shape->drawn.faces, point_quads, point_normals);
  seams.add_up(point_normals);
  for (Quad& normal : point_normals) normal = unit(normal);
}

void Surface::Impl::write_normals(FloatVectors out) const {
  for (std::size_t v = 0; v < shape->drawn.vertices.size(); ++v) {
    const auto [point, side] = shape->drawn.vertices[v];
    if (point == kNoIndex) continue;
    const Quad normal = point_normals[point];
    float* const to = &out.floats[v * out.stride];
    to[0] = side * normal.x;
    to[1] = side * normal.y;
    to[2] = side * normal.z;
  }
}

Surface::Surface(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;
Surface::~Surface() = default;
Surface Surface::clone() const {
  return Surface(std::make_unique<Impl>(impl_->whole, impl_->shape));
}

std::size_t Surface::vertex_count() const { return impl_->shape->drawn.vertices.size(); }
std::size_t Surface::particle_count() const { return impl_->shape->particles; }
std::span<const std::array<std::uint32_t, 3>> Surface::triangles() const {
  return impl_->shape->drawn.triangles;
}

std::span<const std::uint32_t> Surface::split_from() const { return impl_->shape->split_from; }

Result<bool> Surface::follow(const Cloth& from) {
  if (impl_->knows(from)) return false;
  const std::shared_ptr<const Shape> whole = impl_->whole;
  const std::size_t count = from.particle_count();
  std::shared_ptr<const Shape> shape = whole;
  if (count > whole->particles) {
    if (whole->parts.empty())
      return refuse("from", "has torn, and nothing had a strength when the surface was made",
                    std::to_string(count));
    std::vector<Triangle> now = from.surface();
    if (!are_torn_from(whole->parts, now, whole->particles))
      return Error{"from: is another cloth than that of the surface"};
    shape = now == impl_->shape->parts && impl_->shape->particles == count
                ? impl_->shape
                : torn_shape(*whole, *from.model(), std::move(now));
  } else if (auto r = validate_size("from", count, whole->particles); !r) {
    return Error{r.error()};
  }
  const bool changes = shape != impl_->shape;
  if (changes) impl_ = std::make_unique<Impl>(whole, shape);
  impl_->model = from.model();
  return changes;
}

Result<void> Surface::read_vertices(const Cloth& from, FloatVectors positions, FloatVectors normals,
                                    Vec3 origin) {
  if (auto r = validate_origin(origin); !r) return r;
  for (const auto& [field, out] : {std::pair{"positions", positions}, {"normals", normals}}) {
    if (out.floats.empty()) continue;
    if (auto r = validate_floats(field, out, vertex_count()); !r) return r;
  }
  if (auto r = impl_->read(from); !r) return r;
  if (!positions.floats.empty()) impl_->write_positions(positions, origin);
  if (normals.floats.empty()) return {};
  impl_->find_point_normals();
  impl_->write_normals(normals);
  return {};
}

Result<void> Surface::copy_shape(const Cloth& from, Cloth& to) {
  Impl& impl = *impl_;
  if (!impl.shape->is_mapped) return Error{"copy_shape: this surface was not made by map_surface"};
  if (impl.is_torn()) return Error{"copy_shape: the cloth that is read has torn"};
  if (auto r = validate_size("to", to.particle_count(), impl.points.size()); !r) return r;
  if (auto r = impl.read(from); !r) return r;
  impl.particle_velocities.resize(impl.particles.size());
  impl.point_velocities.resize(impl.points.size());
  if (auto r = from.read_velocities(std::span(impl.particle_velocities)); !r) return r;
  find_velocities(impl.shape->points, impl.particles, impl.particle_velocities,
                  impl.particle_normals, impl.point_velocities);
  auto r = validate_vectors("velocities", impl.point_velocities, impl.points.size());
  if (!r) return r;  // before the positions are written
  if (r = to.write_positions(impl.points); !r) return r;
  return to.write_velocities(impl.point_velocities);
}

std::size_t Surface::bytes() const {
  const Impl& i = *impl_;
  return i.whole->bytes() + (i.is_torn() ? i.shape->bytes() : 0) + i.seams.bytes() +
         bytes_of(i.particles) + bytes_of(i.particle_velocities) + bytes_of(i.particle_quads) +
         bytes_of(i.particle_normals) + bytes_of(i.points) + bytes_of(i.point_velocities) +
         bytes_of(i.point_quads) + bytes_of(i.point_normals);
}

Result<Surface> surface_of_mesh(const MeshDescription& mesh, const MeshCloth& cloth) {
  if (auto r = check_made(mesh, cloth); !r) return Error{r.error()};
  auto shape = std::make_shared<Shape>();
  const std::span<const Triangle> parts = parts_of(cloth.scene);
  shape->parts.assign(parts.begin(), parts.end());
  shape->drawn = drawn_mesh(mesh, cloth.particle_of_vertex, parts);
  shape->particles = cloth.scene.positions.size();
  shape->scale = scale_of(cloth.scene.positions);
  const auto& places = cloth.scene.positions;
  shape->seam_reach = seam_reach(point_triangles(shape->drawn), places);
  shape->seams = ClosedSeams(cloth.scene.seams, places.size(), shape->seam_reach);
  return Surface(std::make_unique<Surface::Impl>(std::move(shape)));
}

Result<Surface> map_surface(const MeshDescription& mesh, const MeshCloth& cloth,
                            const MeshDescription& other, double max_distance) {
  if (auto r = check_made(mesh, cloth); !r) return Error{r.error()};
  if (auto r = mesh::check_input(other); !r) return Error{"other." + r.error()};
  if (!(max_distance >= 0))
    return refuse("max_distance", "must be at least 0", number(max_distance));
  const mesh::Welded welded = mesh::weld(other);
  const std::span<const Triangle> parts = parts_of(cloth.scene);
  DrawnMesh followed = drawn_mesh(mesh, cloth.particle_of_vertex, parts);
  auto shape = std::make_shared<Shape>();
  shape->parts.assign(parts.begin(), parts.end());
  shape->particles = cloth.scene.positions.size();
  shape->scale = scale_of(cloth.scene.positions);
  shape->is_mapped = true;
  auto r = map_points(cloth.scene.positions, followed, welded, max_distance, *shape);
  if (!r) return Error{r.error()};
  shape->drawn = drawn_mesh(other, welded.particle_of_vertex);
  shape->followed = followed.faces;
  if (!parts.empty()) shape->coarse = std::move(followed);
  return Surface(std::make_unique<Surface::Impl>(std::move(shape)));
}

}  // namespace weft
