#include "engine/mesh/calibration.h"

#include <algorithm>
#include <cmath>

#include "engine/hypotenuse.h"
#include "engine/mesh/corners.h"
#include "engine/mesh/moments.h"
#include "engine/tuning.h"

namespace weft::mesh {
namespace {

/// Axes of the plane in which a particle's faces lie in the mean.
struct Axes {
  Vec3 x, y;
};

/// Whichever way round the faces are given.
Axes axes_of(const std::vector<Face>& faces, std::span<const CornerOfFace> around) {
  const Face& first = faces[around[0].face];
  Vec3 normal;
  for (const auto& [f, corner] : around) {
    const Vec3 own = area_vector(faces[f]);
    normal = dot(own, area_vector(first)) < 0 ? normal - own : normal + own;
  }
  normal = unit(normal);
  const Vec3 side = first.places[1] - first.places[0];
  const Vec3 x = unit(side - dot(side, normal) * normal);
  return {x, cross(normal, x)};
}

struct Neighbour {
  std::uint32_t particle = 0;
  Turn turn;  ///< from its axes
};

Turn turn_between(const Axes& from, const Axes& to) {
  const double c = dot(to.x, from.x), s = dot(to.y, from.x), size = c * c + s * s;
  const bool mirrored = dot(cross(from.x, from.y), cross(to.x, to.y)) < 0;
  if (!(size > 0)) return {1, 0, mirrored};
  return {(c * c - s * s) / size, 2 * s * c / size, mirrored};
}

/// Half of the trace of a symmetric matrix in the axes of a particle, half of the difference on its
/// diagonal, and its element beside that: each as the weights of a sum over six numbers.
struct Readings {
  Tensor mean, difference, beside;
};

Readings readings_in(const Axes& axes) {
  const Tensor x = weights_of_form(axes.x, axes.x), y = weights_of_form(axes.y, axes.y);
  return {plus(plus({}, 0.5, x), 0.5, y), plus(plus({}, 0.5, x), -0.5, y),
          weights_of_form(axes.x, axes.y)};
}

/// A part of the area around a particle, of which an element stores the energy.
struct Part {
  std::uint32_t stencil = 0, particle = 0;
  double weight = 0;
};

/// Stencil by stencil.
std::vector<Part> parts_of(const Stencils& stencils, const std::vector<Face>& faces) {
  const auto& contributions = stencils.contributions;
  std::vector<std::uint32_t> first(stencils.stencils.size() + 1, 0), order(contributions.size());
  for (const Contribution& one : contributions) ++first[one.stencil + 1];
  for (std::size_t s = 0; s + 1 < first.size(); ++s) first[s + 1] += first[s];
  for (std::uint32_t i = 0; i < contributions.size(); ++i)
    order[first[contributions[i].stencil]++] = i;
  std::vector<Part> parts;
  std::size_t begin = 0;  // of the present stencil
  for (const std::uint32_t i : order) {
    const auto& [stencil, number, weight, its_area] = contributions[i];
    if (begin < parts.size() && parts[begin].stencil != stencil) begin = parts.size();
    const Face& face = faces[number];
    for (std::size_t corner = 0; corner < face.size; ++corner) {
      const std::uint32_t particle = face.particles[corner];
      const auto found =
          std::find_if(parts.begin() + static_cast<std::ptrdiff_t>(begin), parts.end(),
                       [&](const Part& p) { return p.particle == particle; });
      if (found != parts.end())
        found->weight += weight;
      else
        parts.push_back({stencil, particle, weight});
    }
  }
  return parts;
}

/// The energies stored around a particle, in its axes.
struct Patch {
  MomentMatrix stored{};  ///< row: moments of energy; column: as much of each coefficient
  double area = 0;

  void add(double factor, const Moments& energy, const Moments& own) {
    for (std::size_t i = 0; i < kMoments; ++i) {
      const double row = factor * energy[i];
      for (std::size_t j = 0; j < kMoments; ++j) stored[i][j] += row * own[j];
    }
  }
  void add(double factor, const MomentMatrix& matrix, double size) {
    for (std::size_t i = 0; i < kMoments; ++i) {
      for (std::size_t j = 0; j < kMoments; ++j) stored[i][j] += factor * matrix[i][j];
    }
    area += factor * size;
  }
  /// The first coefficient is that of the first moment, which is 1 of itself. So its column is what
  /// is stored where all factors are 1.
  double unevenness() const {
    if (!(area > 0)) return 0;
    return (std::abs(stored[0][0] - area) + hypotenuse(stored[1][0], stored[2][0]) +
            hypotenuse(stored[3][0], stored[4][0])) /
           area;
  }
};

/// Marks the particles of all faces that have a marked one.
void widen(const std::vector<Face>& faces, std::vector<bool>& marked) {
  const std::vector<bool> before = marked;
  for (const Face& face : faces) {
    bool any = false;
    for (std::size_t i = 0; i < face.size; ++i) any |= before[face.particles[i]];
    for (std::size_t i = 0; any && i < face.size; ++i) marked[face.particles[i]] = true;
  }
}

std::vector<bool> particles_of_seams(const std::vector<Face>& faces, const Edges& edges,
                                     double weld_distance, std::size_t particles) {
  std::vector<bool> is_sewn(particles, false);
  for (const Edge& edge : edges.all()) {
    if (is_seam(edge, faces, weld_distance)) is_sewn[edge.a] = is_sewn[edge.b] = true;
  }
  return is_sewn;
}

/// Those that are neither at the border of a panel nor beside a particle that is. There elements do
/// not balance each other on a cylinder, since the panel ends.
std::vector<bool> free_particles(const std::vector<Face>& faces, const Edges& edges,
                                 const std::vector<bool>& is_sewn) {
  std::vector<bool> near_border = is_sewn;
  for (const Edge& edge : edges.all()) {
    if (!edge.is_inner()) near_border[edge.a] = near_border[edge.b] = true;
  }
  widen(faces, near_border);
  near_border.flip();
  return near_border;
}

class Calibrator {
 public:
  Calibrator(const std::vector<Face>& faces, const Edges& edges, const Stencils& stencils,
             double weld_distance, std::size_t particles)
      : faces_(faces),
        stencils_(stencils),
        corners_(faces, particles),
        parts_(parts_of(stencils, faces)),
        axes_(particles),
        forms_(particles),
        is_sewn_(particles_of_seams(faces, edges, weld_distance, particles)),
        is_free_(free_particles(faces, edges, is_sewn_)),
        areas_(particles, 0),
        factors_(stencils.stencils.size(), 1),
        patches_(particles) {
    for (const Stencil& stencil : stencils.stencils) readings_.push_back(stencil.reading);
    for (std::uint32_t p = 0; p < particles; ++p) {
      if (corners_.at(p).empty()) continue;
      axes_[p] = axes_of(faces, corners_.at(p));
      forms_[p] = readings_in(axes_[p]);
    }
    for (const Face& face : faces) {
      const double size = area(face);
      for (std::size_t i = 0; i < face.size; ++i) areas_[face.particles[i]] += size;
    }
    find_neighbours(edges);
  }

  Calibrated calibrate() {
    fill_patches();
    is_active_ = uneven_patches(tuning::kBendingEven);
    const bool is_even = std::ranges::none_of(is_active_, [](bool active) { return active; });
    if (!is_even) {
      for (int ring = 0; ring < tuning::kBendingRings; ++ring) widen(faces_, is_active_);
      for (std::size_t p = 0; p < is_active_.size(); ++p) {
        if (is_sewn_[p]) is_active_[p] = false;
      }
      for (int i = 0; i < tuning::kBendingSteps; ++i) improve();
      settle();
      fill_patches();
      smooth();
    }
    Calibrated result;
    result.weights.assign(factors_.size(), 0);
    for (const Contribution& part : stencils_.contributions) {
      result.weights[part.stencil] += factors_[part.stencil] * part.weight;
    }
    const auto uneven = uneven_patches(tuning::kBendingUneven);
    for (std::uint32_t p = 0; p < uneven.size(); ++p) {
      if (!is_even && uneven[p]) result.uneven.push_back(p);
    }
    return result;
  }

 private:
  void find_neighbours(const Edges& edges) {
    first_neighbour_.assign(axes_.size() + 1, 0);
    for (const Edge& edge : edges.all()) {
      ++first_neighbour_[edge.a + 1];
      ++first_neighbour_[edge.b + 1];
    }
    for (std::size_t p = 0; p < axes_.size(); ++p) first_neighbour_[p + 1] += first_neighbour_[p];
    neighbours_.resize(first_neighbour_.back());
    auto next = first_neighbour_;
    for (const Edge& edge : edges.all()) {
      neighbours_[next[edge.a]++] = {edge.b, turn_between(axes_[edge.b], axes_[edge.a])};
      neighbours_[next[edge.b]++] = {edge.a, turn_between(axes_[edge.a], axes_[edge.b])};
    }
  }

  std::span<const Neighbour> neighbours(std::size_t particle) const {
    return std::span(neighbours_)
        .subspan(first_neighbour_[particle],
                 first_neighbour_[particle + 1] - first_neighbour_[particle]);
  }

  Moments moments(const Tensor& reading, std::uint32_t particle) const {
    const Readings& of = forms_[particle];
    return moments_of_square(contract(of.mean, reading), contract(of.difference, reading),
                             contract(of.beside, reading));
  }

  bool is_active(std::uint32_t particle) const {
    return is_active_.empty() || is_active_[particle];
  }

  void fill_patches() {
    for (std::size_t p = 0; p < patches_.size(); ++p) patches_[p] = {.area = areas_[p]};
    for (const auto& [stencil, particle, weight] : parts_) {
      if (!is_active(particle)) continue;
      const Moments energy = moments(readings_[stencil], particle);
      const Moments own = moments(stencils_.stencils[stencil].reading, particle);
      if (own[0] > 0) patches_[particle].add(factors_[stencil] * weight / own[0], energy, own);
    }
  }

  std::vector<bool> uneven_patches(double most) const {
    std::vector<bool> uneven(patches_.size());
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      if (is_sewn_[p] || corners_.at(static_cast<std::uint32_t>(p)).empty()) continue;
      uneven[p] = patches_[p].unevenness() > most;
    }
    return uneven;
  }

  /// Patches become means of themselves and their neighbours, several times.
  void smooth() {
    for (int ring = 0; ring < tuning::kBendingRings; ++ring) {
      const std::vector<Patch> before = patches_;
      for (std::size_t p = 0; p < before.size(); ++p) {
        if (!is_active_[p]) continue;
        const double share = 1.0 / (1 + static_cast<double>(neighbours(p).size()));
        patches_[p] = {};
        patches_[p].add(share, before[p].stored, before[p].area);
        for (const auto& [other, turn] : neighbours(p)) {
          if (is_active_[other])
            patches_[p].add(share, turn(before[other].stored), before[other].area);
        }
      }
    }
  }

  Moments coefficients(const Patch& patch) const {
    const double size = patch.stored[0][0];
    if (!(size > 0)) return {1, 0, 0, 0, 0};
    MomentMatrix stored = patch.stored;
    for (Moments& row : stored) {
      for (double& value : row) value /= size;
    }
    const Moments target{patch.area / size, 0, 0, 0, 0};
    return least_squares(stored, target, target, tuning::kBendingRestraint);
  }

  void improve() {
    settle();
    fill_patches();
    smooth();
    std::vector<Moments> at(patches_.size(), {1, 0, 0, 0, 0});
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      if (is_active_[p]) at[p] = coefficients(patches_[p]);
    }
    std::vector<double> sums(factors_.size(), 0), counts(factors_.size(), 0);
    for (const auto& [stencil, particle, weight] : parts_) {
      counts[stencil] += weight;
      sums[stencil] += weight * factor_by(at[particle], stencil, particle);
    }
    for (std::size_t s = 0; s < factors_.size(); ++s) {
      if (counts[s] > 0) factors_[s] *= sums[s] / counts[s];
    }
  }

  /// Particles leave a cylinder until no element pulls at them, and elements read what is left.
  void settle() {
    std::vector<double> weights(factors_.size(), 0), stiffness(patches_.size(), 0);
    for (const Contribution& part : stencils_.contributions) {
      weights[part.stencil] += factors_[part.stencil] * part.weight;
    }
    for (std::uint32_t s = 0; s < weights.size(); ++s) {
      for_each_end(
          s, [&](std::uint32_t particle, double w) { stiffness[particle] += weights[s] * w * w; });
    }
    std::vector<Tensor> moved(patches_.size()), pulls;
    for (int i = 0; i < tuning::kSettlings; ++i) {
      pulls.assign(patches_.size(), {});
      for (std::uint32_t s = 0; s < readings_.size(); ++s) {
        const Tensor reading = read(s, moved);
        for_each_end(s, [&](std::uint32_t particle, double w) {
          pulls[particle] = plus(pulls[particle], weights[s] * w, reading);
        });
      }
      for (std::size_t p = 0; p < moved.size(); ++p) {
        if (!is_free_[p] || !is_active_[p] || !(stiffness[p] > 0)) continue;
        moved[p] = plus(moved[p], -tuning::kSettlingShare / stiffness[p], pulls[p]);
      }
    }
    for (std::uint32_t s = 0; s < readings_.size(); ++s) readings_[s] = read(s, moved);
  }

  template <class Call>
  void for_each_end(std::uint32_t s, const Call& call) const {
    const Stencil& stencil = stencils_.stencils[s];
    for (std::size_t i = 0; i < stencil.particles.size(); ++i) {
      if (stencil.particles[i] != kNoIndex) call(stencil.particles[i], stencil.weights[i]);
    }
  }

  /// moved: by how much particles have left a surface of curvature K: the product with K.
  Tensor read(std::uint32_t s, const std::vector<Tensor>& moved) const {
    Tensor reading = stencils_.stencils[s].reading;
    for_each_end(
        s, [&](std::uint32_t particle, double w) { reading = plus(reading, w, moved[particle]); });
    return reading;
  }

  double factor_by(const Moments& coefficients, std::uint32_t stencil,
                   std::uint32_t particle) const {
    if (!is_active_[particle]) return 1;
    const Moments m = moments(stencils_.stencils[stencil].reading, particle);
    if (!(m[0] > 0)) return 1;
    return std::clamp(dot(coefficients, m) / m[0], 1 / tuning::kMostBendingFactor,
                      tuning::kMostBendingFactor);
  }

  const std::vector<Face>& faces_;
  const Stencils& stencils_;
  const Corners corners_;
  const std::vector<Part> parts_;
  std::vector<Axes> axes_;
  std::vector<Readings> forms_;  ///< in the axes
  std::vector<std::size_t> first_neighbour_;
  std::vector<Neighbour> neighbours_;  ///< of one particle after the other
  const std::vector<bool> is_sewn_;    ///< particles on a seam
  const std::vector<bool> is_free_;    ///< particles that leave a cylinder by themselves
  std::vector<double> areas_;          ///< m^2, of all faces at a particle
  std::vector<double> factors_;        ///< of elements
  std::vector<Tensor> readings_;       ///< of elements, when the particles have settled
  std::vector<Patch> patches_;         ///< around particles
  std::vector<bool> is_active_;        ///< empty: all are
};

}  // namespace

Calibrated calibrate(const std::vector<Face>& faces, const Edges& edges, const Stencils& stencils,
                     double weld_distance, std::size_t particles) {
  return Calibrator(faces, edges, stencils, weld_distance, particles).calibrate();
}

}  // namespace weft::mesh
