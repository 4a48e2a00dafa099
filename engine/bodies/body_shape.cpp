#include "engine/bodies/body_shape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "engine/bodies/convex_hull.h"
#include "engine/bodies/thin_shape.h"
#include "engine/public_vectors.h"
#include "engine/saving/fields.h"
#include "engine/validation.h"

namespace weft {
namespace {

using kernels::Vector;
using Shared = Result<std::shared_ptr<BodyShape>>;

Result<void> validate_finite(std::string_view field, Vec3 v) {
  if (finite(v)) return {};
  return refuse(field, "must be finite", text(v));
}

Shared build(const Plane& plane) {
  if (auto r = validate_finite("normal", plane.normal); !r) return Error{r.error()};
  const Vector normal = to_internal(plane.normal);
  const double l = length(normal);
  if (!(l > 0) || !std::isfinite(l))
    return refuse("normal", "has no direction", text(plane.normal));
  if (!std::isfinite(plane.offset)) return refuse("offset", "must be finite", number(plane.offset));
  return std::make_shared<BodyShape>(
      std::vector{reference::Face{(1 / l) * normal, plane.offset / l}}, std::vector<Vector>{});
}

Shared round_shape(const reference::Solid& solid) {
  auto shape = std::make_shared<BodyShape>(solid);
  const double width = 2 * std::max(solid.radius, solid.radius - solid.taper * solid.length);
  shape->set_thin(thin_capsule(solid), {.least = width, .most = width + solid.length});
  return shape;
}

Shared build(const Capsule& capsule) {
  for (const auto& [field, at] : {std::pair{"a", capsule.a}, std::pair{"b", capsule.b}}) {
    if (auto r = validate_finite(field, at); !r) return Error{r.error()};
  }
  for (const auto& [field, radius] :
       {std::pair{"radius_a", capsule.radius_a}, std::pair{"radius_b", capsule.radius_b}}) {
    if (auto r = validate_positive(field, radius); !r) return Error{r.error()};
  }
  reference::Solid solid{.a = to_internal(capsule.a), .radius = capsule.radius_a};
  const Vector along = to_internal(capsule.b) - solid.a;
  const double l = length(along), fall = capsule.radius_a - capsule.radius_b;
  if (l > std::abs(fall)) {
    solid.axis = (1 / l) * along;
    solid.length = l;
    solid.taper = fall / l;
  } else if (fall < 0) {  // the ball at b holds that at a
    solid.a = to_internal(capsule.b);
    solid.radius = capsule.radius_b;
  }
  return round_shape(solid);
}

Shared build(const Ball& ball) {
  if (auto r = validate_finite("centre", ball.centre); !r) return Error{r.error()};
  if (auto r = validate_positive("radius", ball.radius); !r) return Error{r.error()};
  return round_shape({.a = to_internal(ball.centre), .radius = ball.radius});
}

/// Triangles in one plane have one face.
std::vector<reference::Face> faces_of(const std::vector<Vector>& points) {
  constexpr double kSame = 1e-9;  // of normals, as unit vectors
  std::vector<reference::Face> faces;
  for (const auto& [a, b, c] : convex_hull(points)) {
    const Vector across = cross(points[b] - points[a], points[c] - points[a]);
    const Vector normal = kernels::direction(across, length(across));
    const auto is_same = [&](const reference::Face& face) {
      return length(face.normal - normal) < kSame;
    };
    if (std::ranges::none_of(faces, is_same)) faces.push_back({normal, dot(normal, points[a])});
  }
  return faces;
}

Shared build(const Hull& hull) {
  std::vector<Vector> points;
  for (std::size_t i = 0; i < hull.points.size(); ++i) {
    if (auto r = validate_finite(element("points", i), hull.points[i]); !r) return Error{r.error()};
    points.push_back(to_internal(hull.points[i]));
  }
  std::vector<reference::Face> faces = faces_of(points);
  if (faces.empty()) {
    return refuse("points", "must be four or more that are not in a plane",
                  std::to_string(points.size()));
  }
  MeshShape thin = thin_hull(points);
  const Widths widths = widths_of(faces, points);
  auto shape = std::make_shared<BodyShape>(std::move(faces), std::move(points));
  shape->set_thin(std::move(thin), widths);
  return shape;
}

bool has_three_corners(const TriangleSurface::Triangle& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

std::vector<TriangleSurface::Triangle> proper(const TriangleMesh& mesh) {
  std::vector<TriangleSurface::Triangle> triangles;
  std::ranges::copy_if(mesh.triangles, std::back_inserter(triangles), has_three_corners);
  return triangles;
}

/// Checks a one-sided mesh: every side is run along once in each direction.
Result<void> validate_sides(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> sides;  // from, to, triangle
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleSurface::Triangle& corners = mesh.triangles[t];
    if (!has_three_corners(corners)) continue;
    for (std::size_t k = 0; k < 3; ++k) sides.push_back({corners[k], corners[(k + 1) % 3], t});
  }
  std::ranges::sort(sides);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i][0] != sides[i - 1][0] || sides[i][1] != sides[i - 1][1]) continue;
    return refuse(element("triangles", sides[i][2]),
                  "runs along an edge in the same direction as another triangle; turn it, or set "
                  "two_sided",
                  std::to_string(sides[i - 1][2]));
  }
  return {};
}

Shared build(const TriangleMesh& mesh) {
  MeshShape shape{.two_sided = mesh.two_sided};
  std::vector<std::array<double, 3>> places;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3 v = mesh.vertices[i];
    if (auto r = validate_finite(element("vertices", i), v); !r) return Error{r.error()};
    shape.vertices.push_back(to_internal(v));
    places.push_back({v.x, v.y, v.z});
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = mesh.triangles[i][k];
      if (corner < mesh.vertices.size()) continue;
      return refuse(element(element("triangles", i), k),
                    "no such vertex, the mesh has " + std::to_string(mesh.vertices.size()),
                    std::to_string(corner));
    }
  }
  const std::vector<TriangleSurface::Triangle> triangles = proper(mesh);
  if (triangles.empty())
    return refuse("triangles", "must be one or more with three corners",
                  std::to_string(mesh.triangles.size()));
  if (!mesh.two_sided) {
    if (auto r = validate_sides(mesh); !r) return Error{r.error()};
  }
  shape.surface = make_triangle_surface(triangles, places, {});
  shape.tree = tree_of(shape);
  shape.is_open = std::ranges::any_of(shape.surface.opposite,
                                      [](const auto& third) { return third[1] == kNoIndex; });
  return std::make_shared<BodyShape>(std::move(shape));
}

}  // namespace

BodyShape::BodyShape(const reference::Solid& capsule)
    : corners_{capsule.a, capsule.a + capsule.length * capsule.axis},
      radius_(std::max(capsule.radius, capsule.radius - capsule.taper * capsule.length)),
      solid_(capsule) {}

namespace {

/// How far from a corner faces meet that were moved out by 1: at m, where n . m = 1 for three of
/// the normals n there, and at most 1 for the others.
double spread_at(const std::vector<Vector>& normals) {
  constexpr double kRounding = 1e-6;
  double most = 1;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        const Vector a = normals[i], b = normals[j], c = normals[k];
        const double volume = dot(a, cross(b, c));
        if (std::abs(volume) < kRounding) continue;
        const Vector m = (1 / volume) * (cross(b, c) + cross(c, a) + cross(a, b));
        const bool is_outmost = std::ranges::all_of(
            normals, [&](Vector n) { return dot(n, m) <= 1 + kRounding * length(m); });
        if (is_outmost) most = std::max(most, length(m));
      }
    }
  }
  return most;
}

}  // namespace

double BodyShape::spread_of(const std::vector<reference::Face>& faces,
                            const std::vector<Vector>& corners) {
  double extent = 0, most = 1;
  for (const Vector corner : corners) extent = std::max(extent, length(corner - corners.front()));
  for (const Vector corner : corners) {
    std::vector<Vector> normals;
    for (const reference::Face& face : faces) {
      if (dot(face.normal, corner) - face.offset > -1e-9 * extent) normals.push_back(face.normal);
    }
    most = std::max(most, spread_at(normals));
  }
  return most;
}

Result<std::shared_ptr<const BodyShape>> build_shape(const ShapeDescription& shape) {
  auto built = std::visit([](const auto& one) { return build(one); }, shape);
  if (!built) return Error{built.error()};
  built.value()->describe(shape);
  return std::shared_ptr<const BodyShape>(std::move(built).value());
}

void visit_fields(const std::shared_ptr<const BodyShape>& shape, ArchiveWriter& archive) {
  archive(shape != nullptr);
  if (shape != nullptr) archive(shape->description());
}

void visit_fields(std::shared_ptr<const BodyShape>& shape, ArchiveReader& archive) {
  bool is_there = false;
  archive(is_there);
  if (!is_there) return;
  ShapeDescription description;
  archive(description);
  if (!archive.is_good()) return;
  auto built = build_shape(description);
  if (!built) return archive.refuse();
  shape = std::move(built).value();
}

Hull box(Vec3 size) {
  Hull hull;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5})
        hull.points.push_back({x * size.x, y * size.y, z * size.z});
    }
  }
  return hull;
}

}  // namespace weft
