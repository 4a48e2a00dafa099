#include "engine/mesh/faces.h"

#include <algorithm>
#include <compare>

#include "engine/mesh/mesh_input.h"
#include "engine/mesh/warp.h"

namespace weft::mesh {
namespace {

double longest_side(const Face& face) {
  double longest = 0;
  for (std::size_t i = 0; i < face.size; ++i) {
    longest = std::max(longest, length(face.places[face.next(i)] - face.places[i]));
  }
  return longest;
}

bool triangle_has_area(const Face& triangle) {
  const auto& p = triangle.places;
  return has_area(p[0], p[1], p[2]);
}

bool has_repeated_particle(const Face& face) {
  for (std::size_t i = 0; i < face.size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (face.particles[i] == face.particles[j]) return true;
    }
  }
  return false;
}

/// Per corner: twice the area of the triangle at it, negative where the quad is concave.
std::array<double, 4> turns(const Face& quad) {
  const Vec3 normal = unit(area_vector(quad));
  std::array<double, 4> turns{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 at_corner =
        area_vector(quad.places[quad.previous(i)], quad.places[i], quad.places[quad.next(i)]);
    turns[i] = dot(normal, at_corner);
  }
  return turns;
}

class Collector {
 public:
  explicit Collector(const MeshDescription& mesh) : mesh_(mesh) {}
  /// number: of the face in the mesh that this is all or a part of.
  void add(const Face& face, std::size_t number) {
    number_ = number;
    if (face.is_quad()) {
      add_quad(face);
    } else {
      add_triangle(face);
    }
  }
  void add_degenerate() { ++found_.degenerate; }
  Faces take() { return std::move(found_); }

 private:
  void add_triangle(const Face& face) {
    if (has_repeated_particle(face) || !triangle_has_area(face)) return add_degenerate();
    found_.faces.push_back(with_warp(face));
  }

  Face with_warp(Face face) const {
    face.warp = given_warp(mesh_, number_, unit(area_vector(face)));
    return face;
  }

  /// A quad that is not convex is cut at its innermost corner.
  void add_quad(const Face& quad) {
    const auto at_corner = turns(quad);
    const auto least = std::ranges::min_element(at_corner);
    const double longest = longest_side(quad);
    if (!has_repeated_particle(quad) && *least > kFlattest * longest * longest) {
      found_.faces.push_back(with_warp(quad));
      return;
    }
    const auto i = static_cast<std::size_t>(least - at_corner.begin());
    add_triangle(triangle_of(quad, {i, (i + 1) % 4, (i + 2) % 4}));
    add_triangle(triangle_of(quad, {i, (i + 2) % 4, (i + 3) % 4}));
  }

  const MeshDescription& mesh_;
  std::size_t number_ = 0;
  Faces found_;
};

/// A face by its particles, whatever their order.
struct Key {
  std::array<std::uint32_t, 4> particles{};  ///< ascending; kNoIndex after those of a triangle
  std::uint32_t face = 0;
  std::strong_ordering operator<=>(const Key&) const = default;
};

std::vector<Key> sorted_keys(const std::vector<Face>& faces) {
  std::vector<Key> keys;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    Key key{faces[f].particles, f};
    if (!faces[f].is_quad()) key.particles[3] = kNoIndex;
    std::ranges::sort(key.particles);
    keys.push_back(key);
  }
  std::ranges::sort(keys);
  return keys;
}

/// Whether two faces with the same particles have these at the same places.
bool at_same_places(const Face& one, const Face& two, double weld_distance) {
  for (std::size_t i = 0; i < one.size; ++i) {
    const auto found = std::ranges::find(two.particles, one.particles[i]);
    const Vec3 place = two.places[static_cast<std::size_t>(found - two.particles.begin())];
    if (length(one.places[i] - place) > weld_distance) return false;
  }
  return true;
}

/// Leaves out faces that an earlier one has all corners of.
void remove_doubles(double weld_distance, Faces& found) {
  const std::vector<Key> keys = sorted_keys(found.faces);
  std::vector<bool> is_double(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Face& face = found.faces[keys[i].face];
    for (std::size_t k = i; k-- > 0 && keys[k].particles == keys[i].particles;) {
      if (at_same_places(face, found.faces[keys[k].face], weld_distance))
        is_double[keys[i].face] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < keys.size(); ++f) {
    if (!is_double[f]) found.faces[kept++] = found.faces[f];
  }
  found.doubles = found.faces.size() - kept;
  found.faces.resize(kept);
}

/// Without corners that are the same particle as the one before.
struct Polygon {
  std::vector<std::uint32_t> particles;
  std::vector<Vec3> places;
};

/// first: the number of the face's first corner.
Polygon polygon_of(const MeshDescription& mesh,
                   const std::vector<std::uint32_t>& particle_of_vertex, std::size_t first,
                   std::span<const std::uint32_t> vertices) {
  Polygon polygon;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t before = vertices[i > 0 ? i - 1 : vertices.size() - 1];
    const std::uint32_t particle = particle_of_vertex[vertices[i]];
    if (particle == particle_of_vertex[before]) continue;
    polygon.particles.push_back(particle);
    polygon.places.push_back(rest_of_corner(mesh, first + i));
  }
  return polygon;
}

Face face_of(const Polygon& polygon, std::span<const std::size_t> corners) {
  Face face;
  face.size = corners.size();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    face.particles[i] = polygon.particles[corners[i]];
    face.places[i] = polygon.places[corners[i]];
  }
  return face;
}

}  // namespace

Vec3 area_vector(const Face& face) {
  const auto& p = face.places;
  return face.is_quad() ? cross(p[2] - p[0], p[3] - p[1]) : area_vector(p[0], p[1], p[2]);
}

std::array<double, 4> corner_areas(const Face& face) {
  std::array<double, 4> shares{};
  if (!face.is_quad()) {
    shares.fill(area(face) / 3);
    shares[3] = 0;
    return shares;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t corners[] = {face.previous(i), i, face.next(i)};
    const double size =
        triangle_area(face.places[corners[0]], face.places[corners[1]], face.places[corners[2]]);
    for (const std::size_t corner : corners) shares[corner] += size / 6;
  }
  return shares;
}

double area(const Face& face) {
  if (!face.is_quad()) return length(area_vector(face)) / 2;
  const auto shares = corner_areas(face);
  return shares[0] + shares[1] + shares[2] + shares[3];
}

Face triangle_of(const Face& face, std::array<std::size_t, 3> corners) {
  Face triangle;
  triangle.size = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    triangle.particles[i] = face.particles[corners[i]];
    triangle.places[i] = face.places[corners[i]];
  }
  return triangle;
}

std::array<std::array<std::size_t, 3>, 2> cut(const Face& quad) {
  const double first = length(quad.places[2] - quad.places[0]);
  const double second = length(quad.places[3] - quad.places[1]);
  if (first <= second) return {{{0, 1, 2}, {2, 3, 0}}};
  return {{{1, 2, 3}, {3, 0, 1}}};
}

double extent(const std::vector<Face>& faces) {
  double largest = 0;
  for (const Face& face : faces) {
    for (std::size_t i = 0; i < face.size; ++i) {
      largest = std::max(largest, length(face.places[i] - faces[0].places[0]));
    }
  }
  return largest;
}

Faces faces_of(const MeshDescription& mesh, const std::vector<std::uint32_t>& particle_of_vertex) {
  Collector collector(mesh);
  std::size_t number = 0;
  const auto add = [&](const Polygon& polygon) {
    const std::size_t size = polygon.particles.size();
    if (size < 3) return collector.add_degenerate();
    if (size == 4)
      return collector.add(face_of(polygon, std::array<std::size_t, 4>{0, 1, 2, 3}), number);
    for (std::size_t i = 1; i + 1 < size; ++i) {
      collector.add(face_of(polygon, std::array<std::size_t, 3>{0, i, i + 1}), number);
    }
  };
  for_each_face(mesh, [&](std::size_t first, std::span<const std::uint32_t> vertices) {
    add(polygon_of(mesh, particle_of_vertex, first, vertices));
    ++number;
  });
  Faces found = collector.take();
  remove_doubles(mesh.weld_distance, found);
  return found;
}

}  // namespace weft::mesh
