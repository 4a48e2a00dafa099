#include "engine/surface/drawn_mesh.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/geometry.h"
#include "engine/lists.h"
#include "engine/mesh/mesh_input.h"

namespace weft::surface {
namespace {

using Corners = std::span<const std::uint32_t>;

/// Numbers of the corners of the triangles that a face is cut into.
using Cuts = std::vector<std::array<std::size_t, 3>>;

void cut_quad(bool beside_first, Cuts& cuts) {
  if (beside_first)
    cuts = {{0, 1, 3}, {1, 2, 3}};
  else
    cuts = {{0, 1, 2}, {0, 2, 3}};
}
bool is_second_shorter(const MeshDescription& mesh, Corners quad) {
  using mesh::operator-;
  const auto diagonal = [&](std::size_t a, std::size_t b) {
    return mesh::length(mesh.positions[quad[b]] - mesh.positions[quad[a]]);
  };
  return diagonal(1, 3) < diagonal(0, 2);
}
Triangle corners_of(Corners face, const std::array<std::size_t, 3>& cut) {
  return {face[cut[0]], face[cut[1]], face[cut[2]]};
}

/// The triangles of a cloth by their corners, in any order.
class Parts {
 public:
  explicit Parts(std::span<const Triangle> parts) : parts_(parts), is_drawn_(parts.size()) {
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      order_.push_back({sorted(parts[i]), i});
      points_ = std::max<std::size_t>(points_, order_.back().first[2] + 1);
    }
    std::ranges::sort(order_);
  }
  bool empty() const { return parts_.empty(); }
  /// No corner has this number, or a higher one.
  std::size_t points() const { return points_; }
  std::uint32_t find(const Triangle& corners) const {
    const Triangle key = sorted(corners);
    const auto found = std::ranges::lower_bound(order_, key, {}, &Entry::first);
    return found != order_.end() && found->first == key ? found->second : kNoIndex;
  }
  /// Whether all triangles of a face are parts.
  bool have(Corners points, const Cuts& cuts) const {
    return std::ranges::all_of(
        cuts, [&](const auto& cut) { return find(corners_of(points, cut)) != kNoIndex; });
  }
  void set_drawn(std::uint32_t part) { is_drawn_[part] = true; }
  /// work(number, corners) for each part that no face has.
  template <class Work>
  void for_each_other(Work&& work) const {
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
      if (!is_drawn_[i]) work(i, parts_[i]);
  }

 private:
  using Entry = std::pair<Triangle, std::uint32_t>;
  static Triangle sorted(Triangle corners) {
    std::ranges::sort(corners);
    return corners;
  }
  std::span<const Triangle> parts_;
  std::vector<Entry> order_;
  std::size_t points_ = 0;
  std::vector<bool> is_drawn_;
};

/// Per face: the first one with the same corners, in any order; itself, where there is none before.
std::vector<std::uint32_t> first_equals(const Lists& faces) {
  Lists sorted = faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    std::sort(sorted.items.begin() + sorted.begin[f], sorted.items.begin() + sorted.begin[f + 1]);
  }
  std::vector<std::uint32_t> order(faces.size()), first(faces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::ranges::lexicographical_compare(sorted[a], sorted[b]);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && std::ranges::equal(sorted[order[i - 1]], sorted[order[i]]);
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// Whether two faces with the same corners are wound the same way.
bool are_alike(Corners a, Corners b) {
  const auto start = std::ranges::find(b, a[0]);
  const std::size_t after = static_cast<std::size_t>(start - b.begin() + 1) % b.size();
  return b[after] == a[1];
}

/// Vertices that are in `turned` alone have their normals turned around.
void turn(const std::vector<bool>& kept, const std::vector<bool>& turned,
          std::vector<DrawnVertex>& vertices) {
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (turned[v] && !kept[v]) vertices[v].side = -1;
  }
}

class Drawing {
 public:
  Drawing(const MeshDescription& mesh, const std::vector<std::uint32_t>& point_of_vertex,
          std::span<const Triangle> parts)
      : mesh_(mesh), parts_(parts) {
    for (const std::uint32_t point : point_of_vertex) drawn_.vertices.push_back({point});
  }

  DrawnMesh run() {
    mesh::for_each_face(mesh_, [&](std::size_t, Corners face) { add_face(face); });
    first_ = first_equals(by_point_);
    std::vector<bool> kept(drawn_.vertices.size()), turned(drawn_.vertices.size());
    for (std::size_t f = 0; f < first_.size(); ++f) {
      if (first_[f] == f && fits(f)) add_point_face(f);
      std::vector<bool>& seen = is_turned(f) ? turned : kept;
      for (const std::uint32_t vertex : by_vertex_[f]) seen[vertex] = true;
    }
    turn(kept, turned, drawn_.vertices);
    add_other_parts();
    return std::move(drawn_);
  }

 private:
  bool fits(std::size_t face) const { return begin_[face] != kNoIndex; }
  bool is_turned(std::size_t face) const {
    return !are_alike(by_point_[first_[face]], by_point_[face]);
  }

  void add_face(Corners face) {
    points_.clear();
    for (const std::uint32_t vertex : face) points_.push_back(drawn_.vertices[vertex].point);
    by_vertex_.push_back(face);
    by_point_.push_back(points_);
    if (!cut(face)) {
      begin_.push_back(kNoIndex);
      return;
    }
    begin_.push_back(static_cast<std::uint32_t>(drawn_.triangles.size()));
    for (const auto& corners : cuts_) {
      drawn_.triangles.push_back(corners_of(face, corners));
      if (parts_.empty()) continue;
      drawn_.part.push_back(parts_.find(corners_of(points_, corners)));
      parts_.set_drawn(drawn_.part.back());
    }
  }
  /// Returns whether the parts allow it.
  bool cut(Corners face) {
    const auto fits = [&] { return parts_.empty() || parts_.have(points_, cuts_); };
    if (face.size() == 4) {
      const bool beside_first = is_second_shorter(mesh_, face);
      cut_quad(beside_first, cuts_);
      if (fits()) return true;
      cut_quad(!beside_first, cuts_);
      return fits();
    }
    cuts_.clear();
    for (std::size_t i = 2; i < face.size(); ++i) cuts_.push_back({0, i - 1, i});
    return fits();
  }

  void add_point_face(std::size_t face) {
    const Corners points = by_point_[face];
    if (points.size() == 4) {
      drawn_.faces.quads.push_back({points[0], points[1], points[2], points[3]});
      drawn_.of_quads.push_back(begin_[face]);
      return;
    }
    for (std::uint32_t i = 2; i < points.size(); ++i) {
      drawn_.faces.triangles.push_back({points[0], points[i - 1], points[i]});
      drawn_.of_triangles.push_back(begin_[face] + i - 2);
    }
  }

  /// Both sides of them where the mesh has both.
  void add_other_parts() {
    for (const bool are_turned : {false, true}) {
      const Lists faces_at = make_lists(parts_.points(), [&](auto&& add) {
        for (std::uint32_t f = 0; f < first_.size(); ++f) {
          if (fits(f) || is_turned(f) != are_turned) continue;
          for (const std::uint32_t point : by_point_[f])
            if (point < parts_.points()) add(point, f);
        }
      });
      parts_.for_each_other([&](std::uint32_t number, const Triangle& part) {
        add_part(number, part, are_turned, faces_at);
      });
    }
  }
  void add_part(std::uint32_t number, const Triangle& part, bool is_turned, const Lists& faces_at) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = vertex_at(part[k], part, faces_at);
      if (corners[k] == kNoIndex) return;
    }
    if (is_turned) std::swap(corners[1], corners[2]);
    if (!is_turned) {
      drawn_.faces.triangles.push_back(part);
      drawn_.of_triangles.push_back(static_cast<std::uint32_t>(drawn_.triangles.size()));
    }
    drawn_.triangles.push_back(corners);
    drawn_.part.push_back(number);
  }
  /// The corner of the face that has most corners of the part.
  std::uint32_t vertex_at(std::uint32_t point, const Triangle& part, const Lists& faces_at) const {
    std::uint32_t vertex = kNoIndex;
    std::ptrdiff_t most = 0;
    for (const std::uint32_t face : faces_at[point]) {
      const Corners points = by_point_[face];
      const auto common = std::ranges::count_if(
          part, [&](std::uint32_t corner) { return std::ranges::count(points, corner) > 0; });
      if (common <= most) continue;
      most = common;
      vertex =
          by_vertex_[face]
                    [static_cast<std::size_t>(std::ranges::find(points, point) - points.begin())];
    }
    return vertex;
  }

  const MeshDescription& mesh_;
  Parts parts_;
  DrawnMesh drawn_;
  Lists by_vertex_, by_point_;
  std::vector<std::uint32_t> first_;   // per face, as first_equals
  std::vector<std::uint32_t> begin_;   // per face: its first triangle; kNoIndex: it fits no parts
  std::vector<std::uint32_t> points_;  // of a face
  Cuts cuts_;
};

}  // namespace

DrawnMesh drawn_mesh(const MeshDescription& mesh, const std::vector<std::uint32_t>& point_of_vertex,
                     std::span<const Triangle> parts) {
  return Drawing(mesh, point_of_vertex, parts).run();
}

std::vector<Triangle> point_triangles(const DrawnMesh& drawn) {
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : drawn.triangles) {
    triangles.push_back(
        {drawn.vertices[a].point, drawn.vertices[b].point, drawn.vertices[c].point});
  }
  return triangles;
}

std::size_t PointFaces::bytes() const { return bytes_of(triangles) + bytes_of(quads); }

std::size_t DrawnMesh::bytes() const {
  return bytes_of(vertices) + bytes_of(triangles) + faces.bytes() + bytes_of(of_triangles) +
         bytes_of(of_quads) + bytes_of(part);
}

}  // namespace weft::surface
