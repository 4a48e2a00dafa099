#include "engine/surface/closed_seams.h"

#include <algorithm>
#include <numeric>

#include "engine/bytes_of.h"
#include "engine/erase_repeated.h"
#include "engine/geometry.h"
#include "engine/tuning.h"

namespace weft::surface {

ClosedSeams::ClosedSeams(std::span<const Seam> seams, std::size_t particles, double reach)
    : seams_(seams.begin(), seams.end()), square_(reach * reach) {
  if (seams_.empty()) return;
  for (const Seam& seam : seams_) particles_.insert(particles_.end(), {seam.a, seam.b});
  std::ranges::sort(particles_);
  erase_repeated(particles_);
  first_.resize(particles);
  count_.resize(particles);
}

std::uint32_t ClosedSeams::root(std::uint32_t particle) const {
  while (first_[particle] != particle) particle = first_[particle];
  return particle;
}

template <class Work>
void ClosedSeams::for_joined(Work&& work) const {
  for (const std::uint32_t particle : particles_) {
    if (first_[particle] != particle) work(particle, first_[particle]);
  }
}

void ClosedSeams::join(std::span<Vec3> particles) {
  using mesh::operator+;
  using mesh::operator-;
  using mesh::operator*;
  for (const std::uint32_t particle : particles_) {
    first_[particle] = particle;
    count_[particle] = 1;
  }
  for (const Seam& seam : seams_) {
    const Vec3 way = particles[seam.b] - particles[seam.a];
    if (mesh::dot(way, way) > square_) continue;
    const auto [low, high] = std::minmax({root(seam.a), root(seam.b)});
    first_[high] = low;
  }
  for (const std::uint32_t particle : particles_) first_[particle] = root(particle);
  for_joined([&](std::uint32_t particle, std::uint32_t group) {
    const double share = 1.0 / ++count_[group];
    particles[group] = particles[group] + share * (particles[particle] - particles[group]);
  });
  for_joined(
      [&](std::uint32_t particle, std::uint32_t group) { particles[particle] = particles[group]; });
}

void ClosedSeams::add_up(std::span<Quad> normals) const {
  for_joined([&](std::uint32_t particle, std::uint32_t group) {
    normals[group] = normals[group] + normals[particle];
  });
  for_joined(
      [&](std::uint32_t particle, std::uint32_t group) { normals[particle] = normals[group]; });
}

std::size_t ClosedSeams::bytes() const {
  return bytes_of(seams_) + bytes_of(particles_) + bytes_of(first_) + bytes_of(count_);
}

double seam_reach(std::span<const Triangle> triangles, std::span<const Vec3> points) {
  double sum = 0;
  using mesh::operator-;
  for (const auto& [a, b, c] : triangles) sum += mesh::length(points[b] - points[a]);
  return triangles.empty() ? 0 : tuning::kClosedSeam * sum / static_cast<double>(triangles.size());
}

}  // namespace weft::surface
