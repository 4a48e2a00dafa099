#include "engine/mesh/pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/geometry.h"
#include "engine/hypotenuse.h"
#include "engine/partition.h"

namespace weft::mesh {
namespace {

constexpr std::uint32_t kNoPiece = kNoIndex;

/// Calls join(a, b) for whatever keeps two particles together.
template <class Join>
void for_each_joint(const SceneDescription& scene, Join join) {
  for (const Constraint& constraint : scene.constraints) join(constraint.a, constraint.b);
  for (const MembraneElement& element : scene.membrane) {
    join(element.particles[0], element.particles[1]);
    join(element.particles[0], element.particles[2]);
  }
  for (const Seam& seam : scene.seams) join(seam.a, seam.b);
  for (const Tether& tether : scene.tethers) join(tether.particle, tether.pin);
  for (const Slider& slider : scene.sliders) {
    for (std::uint32_t i = slider.first; i <= slider.last; ++i)
      join(slider.particle, scene.rail_particles[i]);
  }
}

/// Spheres that are joined to nothing.
std::vector<bool> lone_spheres(const SceneDescription& scene) {
  std::vector<bool> lone(scene.positions.size());
  for (const std::uint32_t sphere : scene.spheres) lone[sphere] = true;
  for_each_joint(scene, [&](std::uint32_t a, std::uint32_t b) { lone[a] = lone[b] = false; });
  return lone;
}

double mean_edge(const SceneDescription& scene) {
  double sum = 0;
  for (const Constraint& c : scene.constraints) sum += c.rest_length;
  for (const MembraneElement& element : scene.membrane) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [u, v] = element.rest[i];
      const auto [next_u, next_v] = element.rest[(i + 1) % 3];
      sum += hypotenuse(next_u - u, next_v - v);
    }
  }
  const std::size_t edges = scene.constraints.size() + 3 * scene.membrane.size();
  return sum / static_cast<double>(std::max<std::size_t>(1, edges));
}

double extent(const SceneDescription& scene, double Vec3::*axis) {
  const auto [least, most] = std::ranges::minmax(scene.positions, {}, axis);
  return most.*axis - least.*axis;
}

double Vec3::*longest_axis(const SceneDescription& scene) {
  double Vec3::*longest = &Vec3::x;
  for (const auto axis : {&Vec3::y, &Vec3::z}) {
    if (extent(scene, axis) > extent(scene, longest)) longest = axis;
  }
  return longest;
}

/// Particles along the longest side of the scene: neighbours are in a short stretch of them.
class InOrder {
 public:
  explicit InOrder(const SceneDescription& scene)
      : scene_(scene), axis_(longest_axis(scene)), order_(scene.positions.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::ranges::sort(order_, {}, [&](std::uint32_t i) { return scene.positions[i].*axis_; });
  }
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// m, from the particle at this place in the order to the nearest one of another piece;
  /// infinite if there is none within the reach.
  double gap(std::size_t place, const Pieces& pieces, double reach) const {
    return std::min(gap(place, 1, pieces, reach), gap(place, -1, pieces, reach));
  }

 private:
  double gap(std::size_t place, int way, const Pieces& pieces, double reach) const {
    const std::uint32_t own = order_[place];
    const Vec3 here = scene_.positions[own];
    double least = std::numeric_limits<double>::infinity();
    for (auto k = static_cast<std::ptrdiff_t>(place) + way; k >= 0 && k < std::ssize(order_);
         k += way) {
      const std::uint32_t other = order_[static_cast<std::size_t>(k)];
      const Vec3 there = scene_.positions[other];
      if (std::abs(there.*axis_ - here.*axis_) > reach) break;
      const std::uint32_t piece = pieces.of_particle[other];
      if (piece == kNoPiece || piece == pieces.of_particle[own]) continue;
      if (const double d = length(here - there); d <= reach) least = std::min(least, d);
    }
    return least;
  }

  const SceneDescription& scene_;
  double Vec3::*axis_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

std::size_t Pieces::loose() const {
  return static_cast<std::size_t>(std::ranges::count(held, false));
}

Pieces pieces_of(const SceneDescription& scene) {
  Partition parts(scene.positions.size());
  for_each_joint(scene, [&](std::uint32_t a, std::uint32_t b) { parts.join(a, b); });
  const std::vector<bool> lone = lone_spheres(scene);
  Pieces pieces;
  pieces.of_particle.assign(scene.positions.size(), kNoPiece);
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    if (lone[i]) continue;
    const std::uint32_t first = parts.first(i);
    pieces.of_particle[i] =
        first == i ? static_cast<std::uint32_t>(pieces.count++) : pieces.of_particle[first];
  }
  pieces.held.assign(pieces.count, false);
  const auto hold = [&](std::uint32_t particle) {
    const std::uint32_t piece = pieces.of_particle[particle];
    if (piece != kNoPiece) pieces.held[piece] = true;
  };
  for (const std::uint32_t particle : scene.fixed) hold(particle);
  for (const Anchor& anchor : scene.anchors) hold(anchor.particle);
  return pieces;
}

double joining_distance(const SceneDescription& scene, const Pieces& pieces) {
  if (pieces.loose() == 0 || pieces.count < 2) return 0;
  constexpr double kShareOfEdge = 0.05;
  const double reach = kShareOfEdge * mean_edge(scene);
  const InOrder in_order(scene);
  double largest = 0;
  for (std::size_t place = 0; place < in_order.order().size(); ++place) {
    const std::uint32_t piece = pieces.of_particle[in_order.order()[place]];
    if (piece == kNoPiece || pieces.held[piece]) continue;
    const double gap = in_order.gap(place, pieces, reach);
    if (std::isfinite(gap)) largest = std::max(largest, gap);
  }
  return largest > 0 ? std::pow(10, std::ceil(std::log10(largest))) : 0;
}

}  // namespace weft::mesh
