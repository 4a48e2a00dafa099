/// Bending elements in lanes against the formulas in double, on every instruction set.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/reference/bending.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_bending {
namespace {

using kernels::kLanes;
using kernels::Vector;

constexpr std::size_t kParticles = 4 * kLanes;

/// A block of elements over four particles each, or over three of them: mostly bent a little, one
/// that is flat. Some particles are fixed, some elements stiff.
struct Elements {
  bool four;
  kernels::AlignedVector<float> base, u, v;
  std::vector<double> w;
  std::vector<reference::BendingElement> elements;
  simd::BendingBlock block{};
  simd::EdgeSpans spans{};
  std::vector<float> stiffness;

  Elements(bool four, bool curved) : four(four) {
    for (auto* array : {&base, &u, &v}) array->resize(4 * kParticles);
    Random random(11);
    for (std::size_t i = 0; i < kParticles; ++i) {
      w.push_back(random.below(6) == 0 ? 0 : random.between(0.5, 2));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place =
            axis == 0 ? 0.01 * static_cast<double>(i) : random.between(-1e-3, 1e-3);
        base[4 * i + axis] = static_cast<float>(place);
        u[4 * i + axis] = static_cast<float>(random.between(-1e-4, 1e-4));
        v[4 * i + axis] = static_cast<float>(random.between(-1, 1));
      }
    }
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) add(lane, curved, random);
  }
  void add(std::uint32_t lane, bool curved, Random& random) {
    const std::uint32_t first = 4 * lane;
    reference::BendingElement e{{first, first + 1, first + 2, first + (four ? 3 : 2)}, {}, 0, 0};
    const auto weight = [&] {
      return static_cast<double>(static_cast<float>(random.between(-2, 2)));
    };
    e.weights = {weight(), weight(), 0, four ? weight() : 0};
    e.weights[2] = -e.weights[0] - e.weights[1] - e.weights[3];
    e.rest = curved ? random.between(0, 0.02) : 0;
    w[first + lane % 3] = 1;
    double inverse = 0;
    for (std::size_t k = 0; k < 4; ++k) inverse += w[e.slots[k]] * e.weights[k] * e.weights[k];
    e.compliance = inverse * std::exp2(random.between(-24, -10));
    for (std::size_t k = 0; k < 4; ++k) {
      block.slot[k][lane] = e.slots[k];
      block.share[k][lane] = static_cast<float>(w[e.slots[k]] * e.weights[k] / inverse);
    }
    block.weight[0][lane] = static_cast<float>(e.weights[0]);
    block.weight[1][lane] = static_cast<float>(e.weights[1]);
    block.weight[2][lane] = static_cast<float>(e.weights[3]);
    block.rest[lane] = static_cast<float>(e.rest);
    block.softness[lane] = static_cast<float>(e.compliance / inverse);
    stiffness.push_back(static_cast<float>(1 / e.compliance));
    elements.push_back(e);
  }
  /// All particles of the last element to one place: it has no direction.
  void fold() {
    for (std::size_t k = 1; k < 4; ++k) {
      for (auto* array : {&base, &u}) {
        const auto from = array->end() - 16;
        std::copy(from, from + 4, from + 4 * static_cast<std::ptrdiff_t>(k));
      }
    }
  }
  Vector particle(std::size_t i) const {
    const auto axis = [&](std::size_t k) {
      return static_cast<double>(base[4 * i + k]) + static_cast<double>(u[4 * i + k]);
    };
    return {axis(0), axis(1), axis(2)};
  }
  kernels::Vectors positions() const {
    kernels::Vectors x(kParticles);
    for (std::size_t i = 0; i < kParticles; ++i) x.set(i, particle(i));
    return x;
  }
  kernels::Vectors velocities() const {
    kernels::Vectors vectors(kParticles);
    const auto axis = [&](std::size_t k) { return static_cast<double>(v[k]); };
    for (std::size_t i = 0; i < kParticles; ++i)
      vectors.set(i, {axis(4 * i), axis(4 * i + 1), axis(4 * i + 2)});
    return vectors;
  }
  simd::Bending bending(const reference::BendingVisit& visit, bool curved) {
    return {u.data(),
            v.data(),
            &block,
            &spans,
            curved,
            static_cast<float>(visit.own),
            static_cast<float>(visit.rate),
            static_cast<float>(visit.damping),
            static_cast<float>(visit.most),
            1e12f};
  }
  void bend(const simd::Table& table, const reference::BendingVisit& visit, bool curved) {
    table.measure_bending(&block, &spans, base.data(), four, 0, 1);
    table.bend(bending(visit, curved), four, 0, 1);
  }
};

reference::BendingVisit visit_with(double damping) {
  return {.own = 1 / 0.8, .rate = 1e5, .damping = damping, .most = 30};
}

template <class Work>
void for_all_kinds(Work&& work) {
  for (const bool four : {false, true}) {
    for (const bool curved : {false, true}) {
      for (const double damping : {0., 2e-3}) work(four, curved, damping);
    }
  }
}

TEST_CASE("an element moves its particles as in double") {
  for_all_kinds([](bool four, bool curved, double damping) {
    CAPTURE(four);
    CAPTURE(curved);
    CAPTURE(damping);
    Elements start(four, curved);
    start.fold();
    const reference::BendingVisit visit = visit_with(damping);
    kernels::Vectors x = start.positions(), v = start.velocities();
    double moved = 0;
    for (const reference::BendingElement& e : start.elements)
      reference::bend(e, visit, start.w.data(), x.view(), v.view());
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(text(isa));
      Elements e = start;
      e.bend(simd::table(isa), visit, curved);
      for (std::size_t i = 0; i < kParticles; ++i) {
        CHECK(length(e.particle(i) - x[i]) < 1e-8);
        moved = std::max(moved, length(x[i] - start.particle(i)));
        if (start.w[i] == 0) CHECK(length(e.particle(i) - start.particle(i)) == 0);
      }
    }
    CHECK(moved > 1e-3);
  });
}

TEST_CASE("AVX2 and AVX-512 move particles to the same bits, and tell the same energy") {
  if (!simd::supported(simd::Isa::avx512)) {
    MESSAGE("this machine lacks avx512: not tested");
    return;
  }
  for_all_kinds([](bool four, bool curved, double damping) {
    Elements narrow(four, curved), wide(four, curved);
    double energy[2];
    const simd::Isa isas[] = {simd::Isa::avx2, simd::Isa::avx512};
    for (std::size_t k = 0; k < 2; ++k) {
      Elements& e = k == 0 ? narrow : wide;
      const simd::Table& table = simd::table(isas[k]);
      e.bend(table, visit_with(damping), curved);
      table.bending_energy(e.bending(visit_with(damping), curved), e.stiffness.data(), &energy[k],
                           four, 0, 1);
    }
    CHECK(narrow.u == wide.u);
    CHECK(energy[0] == energy[1]);
  });
}

TEST_CASE("the energy of a block is that of its elements") {
  for_all_kinds([](bool four, bool curved, double) {
    for (const simd::Isa isa : supported_isas()) {
      for (const double resolved : {1e12, 1e5}) {  // 1/s^2, of all elements, and of some of them
        Elements e(four, curved);
        const simd::Table& table = simd::table(isa);
        simd::Bending bending = e.bending({}, curved);
        bending.resolved = static_cast<float>(resolved);
        table.measure_bending(&e.block, &e.spans, e.base.data(), four, 0, 1);
        double energy = 0, expected = 0;
        table.bending_energy(bending, e.stiffness.data(), &energy, four, 0, 1);
        kernels::Vectors x = e.positions();
        for (const reference::BendingElement& element : e.elements)
          expected += reference::energy(element, resolved, e.w.data(), x.view());
        CHECK(energy == doctest::Approx(expected).epsilon(1e-5));
      }
    }
  });
}

TEST_CASE("with half of its own answer taken back, the law holds") {
  for (const bool curved : {false, true}) {
    Elements e(true, curved);
    const reference::BendingVisit visit{.own = 0, .rate = 1e5};
    kernels::Vectors x = e.positions(), v = e.velocities();
    for (const reference::BendingElement& element : e.elements) {
      const kernels::Vectors before = x;
      reference::bend(element, visit, e.w.data(), x.view(), v.view());
      kernels::Vectors start = before;
      const Vector from = reference::weighted_sum(element, start.view());
      const Vector change = reference::weighted_sum(element, x.view()) - from;
      const Vector stretch = (1 - element.rest / length(from)) * from + 0.5 * change;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t slot = element.slots[k];
        if (e.w[slot] == 0) continue;
        // The particle has moved by w c f / rate.
        const Vector moved = x[slot] - before[slot];
        const Vector force = (visit.rate / (e.w[slot] * element.weights[k])) * moved;
        CHECK(length(stretch + element.compliance * force) < 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_bending
