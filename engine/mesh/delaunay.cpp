#include "engine/mesh/delaunay.h"

#include <unordered_set>

#include "engine/mesh/edges.h"
#include "engine/mesh/pair_key.h"

namespace weft::mesh {
namespace {

/// Passes end when nothing is left to flip: in a plane they do. Edges of faces that are curved at
/// rest could be flipped to and fro.
constexpr int kMostPasses = 64;
/// So that rounding flips nothing: four corners of a rectangle have a sum of 0.
constexpr double kLeastCotangent = 1e-6;

double cotangent_against(const Face& triangle, std::size_t side) {
  const Vec3 far = triangle.places[triangle.previous(side)];
  const Vec3 u = triangle.places[side] - far, v = triangle.places[triangle.next(side)] - far;
  return dot(u, v) / length(cross(u, v));
}

class Flipper {
 public:
  Flipper(std::vector<Face>& faces, double weld_distance)
      : faces_(faces), edges_(faces), weld_distance_(weld_distance), done_(faces.size(), false) {
    for (const Edge& edge : edges_.all()) joined_.insert(pair_key(edge.a, edge.b));
  }

  /// Flips what it can, each face once. Returns whether there was anything.
  bool pass() {
    bool any = false;
    for (const Edge& edge : edges_.all()) any |= edge.is_inner() && flip(edge);
    return any;
  }

 private:
  bool flip(const Edge& edge) {
    const auto [f, side] = edge.faces[0];
    const auto [g, other_side] = edge.faces[1];
    if (faces_[f].is_quad() || faces_[g].is_quad() || done_[f] || done_[g] || f == g) return false;
    const Face one = faces_[f], two = faces_[g];
    if (cotangent_against(one, side) + cotangent_against(two, other_side) > -kLeastCotangent) {
      return false;
    }
    const std::size_t from = side, to = one.next(side), far = one.previous(side);
    const std::size_t far_two = two.previous(other_side);
    const auto key = pair_key(one.particles[far], two.particles[far_two]);
    if (one.particles[far] == two.particles[far_two] || !is_one_place(one, from, two) ||
        !is_one_place(one, to, two) || !joined_.insert(key).second) {
      return false;
    }
    faces_[f] = triangle(one, far, one, from, two, far_two);
    faces_[g] = triangle(two, far_two, one, to, one, far);
    done_[f] = done_[g] = true;
    return true;
  }

  bool is_one_place(const Face& one, std::size_t corner, const Face& two) const {
    for (std::size_t i = 0; i < two.size; ++i) {
      if (two.particles[i] == one.particles[corner]) {
        return length(two.places[i] - one.places[corner]) <= weld_distance_;
      }
    }
    return false;
  }

  static Face triangle(const Face& a, std::size_t i, const Face& b, std::size_t j, const Face& c,
                       std::size_t k) {
    Face made;
    made.size = 3;
    made.particles = {a.particles[i], b.particles[j], c.particles[k]};
    made.places = {a.places[i], b.places[j], c.places[k]};
    return made;
  }

  std::vector<Face>& faces_;
  const Edges edges_;
  const double weld_distance_;
  std::vector<bool> done_;
  std::unordered_set<std::uint64_t> joined_;  ///< particles
};

}  // namespace

std::vector<Face> well_shaped(std::vector<Face> faces, double weld_distance) {
  for (int i = 0; i < kMostPasses; ++i) {
    if (!Flipper(faces, weld_distance).pass()) break;
  }
  return faces;
}

}  // namespace weft::mesh
