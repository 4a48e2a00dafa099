#include "engine/bodies/build_shape.h"

#include <weft/shape_fields.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "engine/bodies/convex_hull.h"
#include "engine/bodies/thin_shape.h"
#include "engine/public_vectors.h"
#include "engine/validation.h"

namespace weft {
namespace {

using kernels::Vector;

// The fields of a shape, each with its legal values.

Result<void> check(const FieldName& field, Vec3 v, Values) {
  if (finite(v)) return {};
  return refuse(field, "must be finite", text(v));
}
Result<void> check(const FieldName& field, double v, Values values) {
  if (values == Values::positive) return validate_positive(field, v);
  if (std::isfinite(v)) return {};
  return refuse(field, "must be finite", number(v));
}
template <class Each>
requires requires(Each each) { check(FieldName(""), each, Values::finite); }
Result<void> check(const FieldName& field, const std::vector<Each>& list, Values values) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (auto r = check(field.at(i), list[i], values); !r) return r;
  }
  return {};
}

template <class Shape>
Result<void> check_fields(const Shape& shape) {
  Result<void> all;
  for_each_part_field<Shape>([&](const auto& field) {
    if constexpr (requires { check(FieldName(""), shape.*field.member, field.values); }) {
      if (all && field.values != Values::ruled)
        all = check(FieldName(field.name), shape.*field.member, field.values);
    }
  });
  return all;
}

BuiltShape build(const Plane& plane) {
  const Vector normal = to_internal(plane.normal);
  const double l = length(normal);
  if (!(l > 0) || !std::isfinite(l))
    return refuse("normal", "has no direction", text(plane.normal));
  ShapeParts parts;
  parts.form = std::make_unique<reference::FacedForm>(
      std::vector{reference::Face{(1 / l) * normal, plane.offset / l}});
  parts.bounds.has_end = false;
  return std::make_shared<BodyShape>(std::move(parts));
}

BuiltShape round_shape(const reference::Round& round) {
  const double width = 2 * round.most_radius();
  ShapeParts parts;
  parts.form = std::make_unique<reference::RoundForm>(round);
  parts.bounds.corners = {round.a, round.a + round.length * round.axis};
  parts.bounds.radius = round.most_radius();
  parts.moments = moments_of_round(round);
  parts.thin = std::make_unique<MeshShape>(thin_capsule(round));
  parts.widths = {.least = width, .most = width + round.length};
  return std::make_shared<BodyShape>(std::move(parts));
}

BuiltShape build(const Capsule& capsule) {
  reference::Round round{.a = to_internal(capsule.a), .radius = capsule.radius_a};
  const Vector along = to_internal(capsule.b) - round.a;
  const double l = length(along), fall = capsule.radius_a - capsule.radius_b;
  if (l > std::abs(fall)) {
    round.axis = (1 / l) * along;
    round.length = l;
    round.taper = fall / l;
  } else if (fall < 0) {  // the ball at b holds that at a
    round.a = to_internal(capsule.b);
    round.radius = capsule.radius_b;
  }
  return round_shape(round);
}

BuiltShape build(const Ball& ball) {
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

double spread_of(const std::vector<reference::Face>& faces, const std::vector<Vector>& corners) {
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

BuiltShape build(const Hull& hull) {
  std::vector<Vector> points;
  for (const Vec3 point : hull.points) points.push_back(to_internal(point));
  std::vector<reference::Face> faces = faces_of(points);
  if (faces.empty()) {
    return refuse("points", "must be four or more that are not in a plane",
                  std::to_string(points.size()));
  }
  ShapeParts parts;
  parts.bounds.corners = points;
  parts.bounds.spread = spread_of(faces, points);
  parts.moments = moments_of_hull(points);
  parts.thin = std::make_unique<MeshShape>(thin_hull(points));
  parts.widths = widths_of(faces, points);
  parts.form = std::make_unique<reference::FacedForm>(std::move(faces));
  return std::make_shared<BodyShape>(std::move(parts));
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

BuiltShape build(const TriangleMesh& mesh) {
  MeshShape shape{.two_sided = mesh.two_sided};
  std::vector<std::array<double, 3>> places;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3 v = mesh.vertices[i];
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

Result<std::shared_ptr<const BodyShape>> build_shape(const ShapeDescription& shape) {
  auto built = std::visit(
      [](const auto& one) -> BuiltShape {
        if (auto r = check_fields(one); !r) return Error{r.error()};
        return build(one);
      },
      shape);
  if (!built) return Error{built.error()};
  built.value()->describe(shape);
  return std::shared_ptr<const BodyShape>(std::move(built).value());
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
