#include "engine/bodies/thin_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "engine/bodies/convex_hull.h"

namespace weft {
namespace {

using kernels::Vector;

MeshShape with_tree(MeshShape mesh) {
  mesh.tree = tree_of(mesh);
  return mesh;
}

std::vector<std::array<double, 3>> places_of(std::span<const Vector> points) {
  std::vector<std::array<double, 3>> places;
  for (const Vector p : points) places.push_back({p.x, p.y, p.z});
  return places;
}

}  // namespace

BoxTree tree_of(const MeshShape& mesh) {
  BoxTree tree(mesh.surface.in_order);
  tree.refit([&](std::uint32_t triangle) {
    Box box = Box::none();
    for (const std::uint32_t corner : mesh.surface.triangles[triangle])
      box.add(Box::at(mesh.vertices[corner]));
    return box;
  });
  return tree;
}

MeshShape thin_thread(std::span<const Vector> places, std::vector<double> radii,
                      std::span<const std::array<std::uint32_t, 2>> links) {
  MeshShape mesh{.vertices{places.begin(), places.end()}, .two_sided = true, .is_open = true};
  mesh.radii = std::move(radii);
  mesh.radius = std::ranges::max(mesh.radii);
  mesh.surface = links.empty() ? make_triangle_surface({}, places_of(places), std::array{0u})
                               : make_triangle_surface({}, places_of(places), {}, links);
  return with_tree(std::move(mesh));
}

MeshShape thin_capsule(const reference::Round& capsule) {
  if (!(capsule.length > 0)) return thin_thread(std::array{capsule.a}, {capsule.radius}, {});
  const Vector b = capsule.a + capsule.length * capsule.axis;
  // The cone around its balls is so much wider than they are.
  const double wide = 1 / std::sqrt(1 - capsule.taper * capsule.taper);
  return thin_thread(std::array{capsule.a, b},
                     {wide * capsule.radius, wide * capsule.radius_at_end()},
                     std::array<std::array<std::uint32_t, 2>, 1>{{{0, 1}}});
}

MeshShape thin_hull(std::span<const Vector> points) {
  MeshShape mesh{.vertices{points.begin(), points.end()}};
  mesh.surface = make_triangle_surface(convex_hull(points), places_of(points), {});
  return with_tree(std::move(mesh));
}

Widths widths_of(std::span<const reference::Face> faces, std::span<const Vector> points) {
  Widths widths{.least = std::numeric_limits<double>::infinity()};
  for (const reference::Face& face : faces) {
    double height = 0;
    for (const Vector p : points) height = std::max(height, face.offset - dot(face.normal, p));
    widths.least = std::min(widths.least, height);
    widths.most = std::max(widths.most, height);
  }
  return widths;
}

}  // namespace weft
