#include "engine/mesh/calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/tuning.h"

namespace weft::mesh {
namespace {

constexpr std::size_t kDirections = 8;
using PerDirection = std::array<double, kDirections>;

/// Cosines and sines of half a turn's directions.
struct Directions {
  PerDirection cc{}, ss{}, sc2{};  ///< cos^2, sin^2, 2 sin cos
  Directions() {
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double angle = std::numbers::pi * static_cast<double>(i) / kDirections;
      cc[i] = std::cos(angle) * std::cos(angle);
      ss[i] = 1 - cc[i];
      sc2[i] = 2 * std::sin(angle) * std::cos(angle);
    }
  }
};

/// An element in the patch around a particle: what it reads of curvatures along the two axes of the
/// patch's plane and of its twist, and its weight there.
struct Entry {
  std::uint32_t stencil = 0;
  double xx = 0, yy = 0, xy = 0;
  double weight = 0;

  /// At the curvature 1, by direction.
  PerDirection energies(const Directions& of) const {
    PerDirection values;
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double d = of.cc[i] * xx + of.ss[i] * yy + of.sc2[i] * xy;
      values[i] = weight * d * d;
    }
    return values;
  }
};

struct Patch {
  std::uint32_t particle = 0;
  std::size_t first = 0, last = 0;  ///< entries
  double area = 0;
};

struct System {
  std::vector<Entry> entries;
  std::vector<Patch> patches;
};

template <class Value>
using Lists = std::vector<std::vector<Value>>;

Lists<std::uint32_t> faces_at_particles(const std::vector<Face>& faces, std::size_t particles) {
  Lists<std::uint32_t> at(particles);
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (std::size_t i = 0; i < faces[f].size; ++i) at[faces[f].particles[i]].push_back(f);
  }
  return at;
}

struct Axes {
  Vec3 x, y;
};

/// Of the plane that the faces have in the mean, whichever way round they are given.
Axes axes_of(const std::vector<Face>& faces, const std::vector<std::uint32_t>& around) {
  const Face& first = faces[around[0]];
  Vec3 normal;
  for (const std::uint32_t f : around) {
    const Vec3 own = area_vector(faces[f]);
    normal = dot(own, area_vector(first)) < 0 ? normal - own : normal + own;
  }
  normal = unit(normal);
  const Vec3 side = first.places[1] - first.places[0];
  const Vec3 x = unit(side - dot(side, normal) * normal);
  return {x, cross(normal, x)};
}

Entry entry_of(const Contribution& part, const Stencils& stencils, const Axes& axes) {
  const Tensor& reading = stencils.stencils[part.stencil].reading;
  return {part.stencil, form(reading, axes.x, axes.x), form(reading, axes.y, axes.y),
          form(reading, axes.x, axes.y), part.weight};
}

/// Entries of one element become one.
void merge(std::vector<Entry>& entries, std::size_t first) {
  const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(first);
  std::stable_sort(begin, entries.end(),
                   [](const Entry& a, const Entry& b) { return a.stencil < b.stencil; });
  auto kept = begin;
  for (auto entry = begin; entry != entries.end(); ++entry) {
    if (kept != begin && (kept - 1)->stencil == entry->stencil) {
      (kept - 1)->weight += entry->weight;
    } else {
      *kept++ = *entry;
    }
  }
  entries.erase(kept, entries.end());
}

System system_of(const std::vector<Face>& faces, const Stencils& stencils, std::size_t particles) {
  Lists<Contribution> of_face(faces.size());
  for (const Contribution& part : stencils.contributions) of_face[part.face].push_back(part);
  System system;
  const auto at_particles = faces_at_particles(faces, particles);
  for (std::uint32_t particle = 0; particle < particles; ++particle) {
    const auto& around = at_particles[particle];
    if (around.empty()) continue;
    const Axes axes = axes_of(faces, around);
    Patch patch{particle, system.entries.size(), 0, 0};
    for (const std::uint32_t f : around) {
      patch.area += area(faces[f]);
      for (const Contribution& part : of_face[f]) {
        system.entries.push_back(entry_of(part, stencils, axes));
      }
    }
    merge(system.entries, patch.first);
    patch.last = system.entries.size();
    if (patch.last > patch.first) system.patches.push_back(patch);
  }
  return system;
}

PerDirection stored_in(const System& system, const Patch& patch, const Directions& directions,
                       const std::vector<double>& factors) {
  PerDirection sums{};
  for (std::size_t e = patch.first; e < patch.last; ++e) {
    const Entry& entry = system.entries[e];
    const PerDirection energies = entry.energies(directions);
    const double factor = factors[entry.stencil];
    for (std::size_t i = 0; i < kDirections; ++i) sums[i] += factor * energies[i];
  }
  return sums;
}

/// One step of the iteration. stored: the sum of each element's energies over all patches.
void improve(const System& system, const Directions& directions, const std::vector<double>& stored,
             std::vector<double>& factors) {
  std::vector<double> wanted(factors.size(), 0);
  for (const Patch& patch : system.patches) {
    PerDirection ratios = stored_in(system, patch, directions, factors);
    for (double& ratio : ratios) ratio = ratio > 0 ? patch.area / ratio : 0;
    for (std::size_t e = patch.first; e < patch.last; ++e) {
      const PerDirection energies = system.entries[e].energies(directions);
      double sum = 0;
      for (std::size_t i = 0; i < kDirections; ++i) sum += energies[i] * ratios[i];
      wanted[system.entries[e].stencil] += sum;
    }
  }
  for (std::size_t s = 0; s < factors.size(); ++s) {
    if (stored[s] > 0) factors[s] *= wanted[s] / stored[s];
  }
}

std::vector<double> sums_of_energies(const System& system, const Directions& directions,
                                     std::size_t stencils) {
  std::vector<double> sums(stencils, 0);
  for (const Entry& entry : system.entries) {
    for (const double energy : entry.energies(directions)) sums[entry.stencil] += energy;
  }
  return sums;
}

bool is_uneven(const PerDirection& sums, double area) {
  return std::ranges::any_of(
      sums, [area](double sum) { return std::abs(sum - area) > tuning::kBendingUneven * area; });
}

}  // namespace

Calibrated calibrate(const std::vector<Face>& faces, const Stencils& stencils,
                     std::size_t particles) {
  const System system = system_of(faces, stencils, particles);
  const Directions directions;
  std::vector<double> factors(stencils.stencils.size(), 1);
  const auto stored = sums_of_energies(system, directions, factors.size());
  for (int i = 0; i < tuning::kBendingSteps; ++i) improve(system, directions, stored, factors);

  Calibrated result;
  result.weights.assign(factors.size(), 0);
  for (const Contribution& part : stencils.contributions) {
    result.weights[part.stencil] += factors[part.stencil] * part.weight;
  }
  for (const Patch& patch : system.patches) {
    const PerDirection sums = stored_in(system, patch, directions, factors);
    if (is_uneven(sums, patch.area)) result.uneven.push_back(patch.particle);
  }
  return result;
}

}  // namespace weft::mesh
