/// Edges that may be springs against the law in double, on every instruction set.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/reference/small_steps.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_springs {
namespace {

using kernels::Vector;

using kernels::kLanes;

constexpr std::size_t kParticles = 2 * kLanes, kCount = 4 * kParticles;  // quads
constexpr double kOmega = 0.8, kScale = 1e6, kStrain = 0.002;

/// A block of edges between particles 2 k and 2 k + 1, from rigid to soft, some short and some
/// long, with multipliers of a substep before.
struct Springs {
  kernels::AlignedVector<float> base, u, start, multiplier;
  std::vector<double> w;
  simd::EdgeBlock block{};
  simd::EdgeSpans spans{};
  simd::SpringBlock spring{};
  std::uint16_t out = 0;

  Springs() : base(kCount), u(kCount), start(kCount), multiplier(kLanes) {
    Random random(19);
    for (std::size_t i = 0; i < kParticles; ++i) w.push_back(random.between(0.1, 1));
    w[3] = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      if (i % 4 == 3) continue;
      base[i] = static_cast<float>(random.between(-1, 1));
      u[i] = static_cast<float>(random.between(-0.01, 0.01));
      start[i] = static_cast<float>(random.between(-0.01, 0.01));
    }
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      const std::uint32_t a = 2 * k, b = a + 1;
      block.a[k] = a;
      block.b[k] = b;
      block.share_a[k] = static_cast<float>(w[a] / (w[a] + w[b]));
      block.share_b[k] = static_cast<float>(w[b] / (w[a] + w[b]));
      spring.inverse_masses[k] = static_cast<float>(w[a] + w[b]);
      spring.rest[k] = static_cast<float>(kernels::length(difference(u, k)) *
                                          (1 + 0.004 * (static_cast<double>(k) - 8)));
      block.square[k] = spring.rest[k] * spring.rest[k];
      spring.compliance[k] = k % 4 == 0 ? 0 : static_cast<float>(std::pow(10., -9. + k / 2.));
      multiplier[k] = k % 3 == 0 ? 0 : static_cast<float>(random.between(0, 0.01));
    }
  }
  Vector particle(const kernels::AlignedVector<float>& from, std::size_t i) const {
    const auto axis = [&](std::size_t k) {
      return static_cast<double>(base[4 * i + k]) + static_cast<double>(from[4 * i + k]);
    };
    return {axis(0), axis(1), axis(2)};
  }
  Vector difference(const kernels::AlignedVector<float>& from, std::uint32_t k) const {
    return particle(from, 2 * k) - particle(from, 2 * k + 1);
  }
  simd::SpringRelaxation relaxation(double damping, bool continues) {
    return {.edges = {u.data(), &block, &spans, &out, static_cast<float>(kOmega), 0},
            .springs = &spring,
            .multiplier = multiplier.data(),
            .laws = {.u_start = start.data(),
                     .scale = static_cast<float>(kScale),
                     .damping = static_cast<float>(damping),
                     .most_compliance = std::numeric_limits<float>::max(),
                     .strain = static_cast<float>(kStrain),
                     .continues = continues}};
  }
};

void check_against_reference(const simd::Table& table, bool rope, double damping, bool continues) {
  const Springs before;
  Springs s;
  table.measure_edges(&s.block, &s.spans, s.base.data(), 0, 1);
  table.judge_springs(s.relaxation(damping, continues), rope, 0, 1);
  table.relax_springs(s.relaxation(damping, continues), rope, 0, 1);
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    CAPTURE(k);
    const reference::ConstraintLaw law = reference::SpringStep{kScale, damping}.law(
        static_cast<double>(s.spring.compliance[k]), rope);
    const Vector d = before.difference(before.u, k);
    const double l = kernels::length(d), rest = static_cast<double>(s.spring.rest[k]);
    const double change = l - kernels::length(before.difference(before.start, k));
    const auto last = static_cast<double>(before.multiplier[k]);
    const double violation = law.violation(law.residual(l - rest, change, last), last);
    const double from = continues ? last : 0;
    const double w = before.w[2 * k] + before.w[2 * k + 1];
    const double impulse = law.impulse(law.residual(l - rest, change, from), from, w, kOmega);
    CHECK(std::abs(static_cast<double>(s.multiplier[k]) - from - impulse) <
          2e-7 / w + 3e-6 * std::abs(from + impulse));
    const Vector by = (impulse / l) * d;
    for (const std::uint32_t end : {0u, 1u}) {
      const double weight = (end == 0 ? -1 : 1) * before.w[2 * k + end];
      const Vector expected = before.particle(before.u, 2 * k + end) + weight * by;
      CHECK(kernels::length(s.particle(s.u, 2 * k + end) - expected) < 3e-7);
    }
    if (std::abs(std::abs(violation) / rest / kStrain - 1) > 1e-3) {
      CHECK((s.out >> k & 1) == (std::abs(violation) > kStrain * rest ? 1 : 0));
    }
  }
}

TEST_CASE("springs that take no part are left, and are not out of tolerance") {
  for (const simd::Isa isa : supported_isas()) {
    const Springs before;
    Springs s;
    const simd::Table& table = simd::table(isa);
    table.measure_edges(&s.block, &s.spans, s.base.data(), 0, 1);
    simd::SpringRelaxation rigid_alone = s.relaxation(0, false);
    rigid_alone.laws.most_compliance = 0;
    table.relax_springs(rigid_alone, false, 0, 1);
    table.judge_springs(rigid_alone, false, 0, 1);
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      if (s.spring.compliance[k] == 0) continue;
      CHECK(kernels::length(s.difference(s.u, k) - before.difference(before.u, k)) == 0);
      CHECK((s.out >> k & 1) == 0);
    }
  }
}

TEST_CASE("springs are relaxed by their law as in double, rigid edges and ropes among them") {
  for (const simd::Isa isa : supported_isas()) {
    for (const bool rope : {false, true}) {
      for (const double damping : {0., 7.}) {
        for (const bool continues : {false, true}) {
          CAPTURE(text(isa));
          CAPTURE(rope);
          CAPTURE(damping);
          CAPTURE(continues);
          check_against_reference(simd::table(isa), rope, damping, continues);
        }
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_springs
