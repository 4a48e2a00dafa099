#include "engine/contact/swept_points.h"

#include "engine/bytes_of.h"

namespace weft {

using kernels::Vector;

namespace {

void set_quad(kernels::AlignedVector<float>& quads, std::uint32_t point, Vector v) {
  float* to = quads.data() + 4 * std::size_t{point};
  to[0] = static_cast<float>(v.x);
  to[1] = static_cast<float>(v.y);
  to[2] = static_cast<float>(v.z);
}
Vector vector_of(const kernels::AlignedVector<float>& quads, std::uint32_t point) {
  const float* from = quads.data() + 4 * std::size_t{point};
  return {static_cast<double>(from[0]), static_cast<double>(from[1]), static_cast<double>(from[2])};
}

}  // namespace

void SweptPoints::begin(const ContactPoints& points) {
  const std::size_t count = points.unmoved_point() + std::size_t{1};
  for (auto* quads : {&moves_, &speeds_, &came_out_}) quads->resize(4 * count, 0);
  states_.resize(count, State::unknown);
}

void SweptPoints::read_now(const ContactScene& scene, std::uint32_t point) {
  const ContactParticle particle = scene.read(point);
  set_quad(moves_, point, particle.x - particle.start);
  set_quad(speeds_, point, particle.v);
  set_quad(came_out_, point, {});
  states_[point] = State::read;
  read_.push_back(point);
}

void SweptPoints::write(const ContactScene& scene, std::uint32_t point) {
  if (states_[point] != State::pushed) return;
  ContactParticle particle = scene.particles.read(point);
  particle.start = particle.start + vector_of(came_out_, point);
  particle.x = particle.start + vector_of(moves_, point);
  particle.v = vector_of(speeds_, point);
  scene.particles.write(point, particle);
  states_[point] = State::unknown;
}

void SweptPoints::end(const ContactScene& scene) {
  for (const std::uint32_t point : read_) {
    write(scene, point);
    states_[point] = State::unknown;
  }
  read_.clear();
}

std::size_t SweptPoints::bytes() const {
  return bytes_of(moves_) + bytes_of(speeds_) + bytes_of(came_out_) + bytes_of(states_) +
         bytes_of(read_);
}

}  // namespace weft
