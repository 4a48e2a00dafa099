#include <weft/surface.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "engine/bytes_of.h"
#include "engine/mesh/mesh_input.h"
#include "engine/mesh/welding.h"
#include "engine/model/validate.h"
#include "engine/surface/closed_seams.h"
#include "engine/surface/drawn_mesh.h"
#include "engine/surface/following.h"
#include "engine/surface/normals.h"
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

  std::size_t bytes() const {
    return drawn.bytes() + followed.bytes() + bytes_of(points) + seams.bytes();
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
  const std::vector<Triangle> triangles = point_triangles(followed);
  const NearestTriangle nearest_triangle(particles, triangles);
  if (nearest_triangle.is_empty()) return Error{"mesh: has no face with an area"};
  const std::vector<Quad> normals = normals_of(followed.faces, particles, shape.scale);
  for (std::uint32_t point = 0; point < other.positions.size(); ++point) {
    const Vec3 place = other.positions[point];
    const Nearest nearest = nearest_triangle(place);
    if (nearest.distance > max_distance) {
      return refuse(element("other.positions", vertex_of(point, other.particle_of_vertex)),
                    "is farther from the mesh than max_distance, " + number(max_distance),
                    number(nearest.distance));
    }
    shape.points.push_back(
        following(place, triangles[nearest.triangle], nearest, particles, normals));
  }
  return {};
}

}  // namespace

struct Surface::Impl {
  std::shared_ptr<const Shape> shape;
  ClosedSeams seams;  // those of the shape, with their workspace
  // The workspace.
  std::vector<Vec3> particles, particle_velocities;  // velocities: of copy_shape
  std::vector<Quad> particle_quads, particle_normals;
  std::vector<Vec3> points, point_velocities;
  std::vector<Quad> point_quads, point_normals;

  explicit Impl(std::shared_ptr<const Shape> of)
      : shape(std::move(of)), seams(shape->seams), particles(shape->particles) {
    if (shape->is_mapped) {
      particle_quads.resize(shape->particles);
      particle_normals.resize(shape->particles);
      points.resize(shape->points.size());
    }
    point_quads.resize(shape->is_mapped ? points.size() : particles.size());
    point_normals.resize(point_quads.size());
  }
  /// Where the points are; each read of it begins with read().
  std::span<const Vec3> where() const { return shape->is_mapped ? points : particles; }
  Result<void> read(const Cloth& from);
  void write_positions(FloatVectors out, Vec3 origin) const;
  void find_point_normals();
  void write_normals(FloatVectors out) const;
};

Result<void> Surface::Impl::read(const Cloth& from) {
  if (auto r = validate_size("from", from.particle_count(), particles.size()); !r) return r;
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
Surface Surface::clone() const { return Surface(std::make_unique<Impl>(impl_->shape)); }

std::size_t Surface::vertex_count() const { return impl_->shape->drawn.vertices.size(); }
std::size_t Surface::particle_count() const { return impl_->shape->particles; }
std::span<const std::array<std::uint32_t, 3>> Surface::triangles() const {
  return impl_->shape->drawn.triangles;
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
  return i.shape->bytes() + i.seams.bytes() + bytes_of(i.particles) +
         bytes_of(i.particle_velocities) + bytes_of(i.particle_quads) +
         bytes_of(i.particle_normals) + bytes_of(i.points) + bytes_of(i.point_velocities) +
         bytes_of(i.point_quads) + bytes_of(i.point_normals);
}

Result<Surface> surface_of_mesh(const MeshDescription& mesh, const MeshCloth& cloth) {
  if (auto r = check_made(mesh, cloth); !r) return Error{r.error()};
  auto shape = std::make_shared<Shape>();
  shape->drawn = drawn_mesh(mesh, cloth.particle_of_vertex);
  shape->particles = cloth.scene.positions.size();
  shape->scale = scale_of(cloth.scene.positions);
  const auto& places = cloth.scene.positions;
  shape->seams = ClosedSeams(cloth.scene.seams, places.size(),
                             seam_reach(point_triangles(shape->drawn), places));
  return Surface(std::make_unique<Surface::Impl>(std::move(shape)));
}

Result<Surface> map_surface(const MeshDescription& mesh, const MeshCloth& cloth,
                            const MeshDescription& other, double max_distance) {
  if (auto r = check_made(mesh, cloth); !r) return Error{r.error()};
  if (auto r = mesh::check_input(other); !r) return Error{"other." + r.error()};
  if (!(max_distance >= 0))
    return refuse("max_distance", "must be at least 0", number(max_distance));
  const mesh::Welded welded = mesh::weld(other);
  const DrawnMesh followed = drawn_mesh(mesh, cloth.particle_of_vertex);
  auto shape = std::make_shared<Shape>();
  shape->particles = cloth.scene.positions.size();
  shape->scale = scale_of(cloth.scene.positions);
  shape->is_mapped = true;
  auto r = map_points(cloth.scene.positions, followed, welded, max_distance, *shape);
  if (!r) return Error{r.error()};
  shape->drawn = drawn_mesh(other, welded.particle_of_vertex);
  shape->followed = followed.faces;
  return Surface(std::make_unique<Surface::Impl>(std::move(shape)));
}

}  // namespace weft
