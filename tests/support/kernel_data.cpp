#include "tests/support/kernel_data.h"

#include <algorithm>
#include <cstring>

namespace weft::test {
namespace {

constexpr std::uint32_t kOddSlot = 5;
constexpr double kTolerance = 0.1;  // tau; about, different for each constraint

float to_float(double x) { return static_cast<float>(x); }

kernels::Vectors random_vectors(std::size_t count, double half_width, Random& random) {
  kernels::Vectors vectors(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 v = random.in_box(half_width);
    vectors.set(i, {v.x, v.y, v.z});
  }
  return vectors;
}

template <class T>
bool same_bits(const T& one, const T& other) {
  return one.size() == other.size() &&
         std::memcmp(one.data(), other.data(), one.size() * sizeof(one[0])) == 0;
}

bool same_bits(const kernels::Vectors& one, const kernels::Vectors& other) {
  return same_bits(one.x, other.x) && same_bits(one.y, other.y) && same_bits(one.z, other.z);
}

}  // namespace

KernelData::KernelData(std::uint32_t length, std::uint32_t seed)
    : first(kLanes),
      last(kLanes + length),
      run{kOddSlot, 2 * kOddSlot + length + 2, kLanes, length},
      slots((run.b + length) / kLanes * kLanes + 2 * kLanes) {
  Random random(seed);
  position = random_vectors(slots, 1, random);
  velocity = random_vectors(slots, 2, random);
  force = random_vectors(slots, 3, random);
  solved = random_vectors(slots, 1, random);
  next_velocity = kernels::Vectors(slots);
  for (std::size_t i = 0; i < slots; ++i) {
    inverse_mass.push_back(random.below(5) == 0 ? 0 : random.between(0.1, 10));
    mass.push_back(inverse_mass.back() == 0 ? 3 : 1 / inverse_mass.back());
    reach.push_back(random.between(0, 0.5));
    mask.push_back(0);
  }
  for (std::size_t i = 0; i < 3 * (slots + kLanes); ++i) {
    u.push_back(to_float(random.between(-0.1, 0.1)));
  }
  blocks.resize(last / kLanes + 1);
  for (std::uint32_t c = 0; c < blocks.size() * kLanes; ++c) {
    const double tau = random.between(0.5, 2) * kTolerance;
    simd::ConstraintBlock& block = blocks[c / kLanes];
    const std::uint32_t k = c % kLanes;
    for (float* n : {block.nx, block.ny, block.nz}) n[k] = to_float(random.between(-1, 1) / tau);
    block.e0[k] = to_float(random.between(-2, 2));
    block.gain_a[k] = to_float(-random.between(0, 1) * tau * tau);
    block.gain_b[k] = to_float(random.between(0, 1) * tau * tau);
    impulse.push_back(to_float(random.between(0, 1)));
    compliance_share.push_back(c % 3 == 0 ? 0 : to_float(0.1 * (c % 10)));
    held.push_back(to_float(0.2 * (c % 7)));
    rest_length.push_back(random.between(0.5, 2));
    inverse_square.push_back(1 / (rest_length[c] * rest_length[c]));
    scale.push_back(1 / tau);
  }
  const std::vector<std::uint32_t> order = random.permutation(slots);
  for (std::uint32_t c = 0; c < blocks.size() * kLanes; ++c) {
    const std::uint32_t k = c - std::min(c, first);
    a.push_back(order[std::min<std::size_t>(2 * k, slots - 1)]);
    b.push_back(order[std::min<std::size_t>(2 * k + 1, slots - 1)]);
  }
  for (std::uint32_t c = first; c < last; ++c) {
    if (random.below(6) == 0) make_padding(c);
  }
}

void KernelData::make_padding(std::uint32_t c) {
  simd::ConstraintBlock& block = blocks[c / kLanes];
  for (float* field : {block.nx, block.ny, block.nz, block.e0, block.gain_a, block.gain_b}) {
    field[c % kLanes] = 0;
  }
  impulse[c] = 0;
  rest_length[c] = 1;
  inverse_square[c] = 0;
  scale[c] = 0;
}

simd::BlockRelaxation KernelData::relaxation(float threshold) {
  simd::BlockRelaxation r;
  r.u = {u.data(), stride(), 1};
  r.blocks = blocks.data();
  r.impulse = impulse.data();
  r.compliance_share = compliance_share.data();
  r.held = held.data();
  r.a = a.data();
  r.b = b.data();
  r.mask = mask.data();
  r.threshold = threshold;
  return r;
}

simd::Geometry KernelData::geometry() {
  return {position.view(), rest_length.data(), inverse_square.data(),
          scale.data(),    a.data(),           b.data()};
}

simd::Motion KernelData::motion(bool forces) {
  simd::Motion m;
  m.inverse_mass = inverse_mass.data();
  m.mass = mass.data();
  m.gravity = {0.5, -10, 0.25};
  if (forces) m.force = force.view();
  m.position = position.view();
  m.velocity = velocity.view();
  m.solved = solved.view();
  m.next_velocity = next_velocity.view();
  return m;
}

Lane KernelData::lane(std::uint32_t c) const {
  const simd::ConstraintBlock& block = blocks[c / kLanes];
  const std::uint32_t k = c % kLanes;
  return {block.nx[k], block.ny[k], block.nz[k], block.e0[k], block.gain_a[k], block.gain_b[k]};
}

float KernelData::error(const Rounding& rounding, std::uint32_t c, std::uint32_t at_a,
                        std::uint32_t at_b) const {
  const Lane l = lane(c);
  const std::size_t y = stride(), z = 2 * stride();
  return rounding.fused(l.nx, u[at_a] - u[at_b],
                        rounding.fused(l.ny, u[y + at_a] - u[y + at_b],
                                       rounding.fused(l.nz, u[z + at_a] - u[z + at_b], l.e0)));
}

void KernelData::move(const Rounding& rounding, std::uint32_t slot, float factor,
                      const Lane& lane) {
  u[slot] = rounding.fused(factor, lane.nx, u[slot]);
  u[stride() + slot] = rounding.fused(factor, lane.ny, u[stride() + slot]);
  u[2 * stride() + slot] = rounding.fused(factor, lane.nz, u[2 * stride() + slot]);
}

bool same(const KernelData& one, const KernelData& other) {
  return same_bits(one.position, other.position) && same_bits(one.velocity, other.velocity) &&
         same_bits(one.solved, other.solved) && same_bits(one.next_velocity, other.next_velocity) &&
         same_bits(one.u, other.u) && same_bits(one.impulse, other.impulse) &&
         same_bits(one.blocks, other.blocks) && same_bits(one.mask, other.mask);
}

}  // namespace weft::test
