/// Bending elements in lanes against the formulas in double, on every instruction set.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
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
const std::vector<double> kOne(kParticles, 1);  // 1/kg
constexpr double kSoft = 1e30;                  // all of a fold is resolved

/// A block of elements over four particles each, or over three of them: mostly bent a little, one
/// that is flat. Some are stiff.
struct Elements {
  bool four;
  kernels::AlignedVector<float> base, u, before;
  std::vector<reference::BendingElement> elements;
  simd::BendingBlock block{};
  simd::BendingFolds folds{};
  bool folded = false;
  simd::EdgeSpans spans[4] = {};  // d, the arms, and the sides of folded hinges

  Elements(bool four, bool curved, bool folded = false) : four(four), folded(folded) {
    for (auto* array : {&base, &u, &before}) array->resize(4 * kParticles);
    Random random(11);
    for (std::size_t i = 0; i < kParticles; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place =
            axis == 0 ? 0.01 * static_cast<double>(i) : random.between(-1e-3, 1e-3);
        base[4 * i + axis] = static_cast<float>(place);
        u[4 * i + axis] = static_cast<float>(random.between(-1e-4, 1e-4));
        const double way = std::exp2(random.between(-20, -4));  // m: a little, and right over
        before[4 * i + axis] = u[4 * i + axis] + static_cast<float>(random.between(-way, way));
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
    e.compliance = std::exp2(random.between(-10, 4));
    if (folded && lane % 4 != 0) {
      e.rest = 0;
      e.fold = random.between(-0.02, 0.02);
    }
    folds.fold[lane] = static_cast<float>(e.fold);
    const auto order = reference::order_of_arms(e);
    for (std::size_t k = 0; k < 4; ++k) block.slot[k][lane] = e.slots[order[k]];
    block.weight[0][lane] = static_cast<float>(e.weights[order[0]]);
    block.weight[1][lane] = static_cast<float>(e.weights[order[1]]);
    block.weight[2][lane] = four ? static_cast<float>(e.weights[order[3]]) : 0;
    if (!four) {
      if (lane % 2 == 0) e.beside = first + 3;
      block.slot[3][lane] = e.beside.value_or(block.slot[1][lane]);
      block.weight[2][lane] = e.beside ? 0 : 1;
    }
    block.rest[lane] = static_cast<float>(e.rest);
    block.stiffness[lane] = static_cast<float>(1 / e.compliance);
    block.softness[lane] =
        static_cast<float>(e.compliance / reference::inverse_mass_of(e, kOne.data()));
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
  kernels::Vectors starts() const {
    Elements e = *this;
    e.u = before;
    return e.positions();
  }
  simd::Bending bending(const simd::Table& table, bool curved, double damping) {
    const simd::BendingSpans all{&spans[0], &spans[1], &spans[2], folded ? &spans[3] : nullptr};
    table.measure_bending(&block, all, base.data(), four, 0, 1);
    return {.u = u.data(),
            .start = before.data(),
            .blocks = &block,
            .spans = all,
            .folds = folded ? &folds : nullptr,
            .curved = curved,
            .damping = static_cast<float>(damping),
            .resolved = 1e12f};
  }
  /// What the elements add to 1, in quads.
  kernels::AlignedVector<float> pulled(const simd::Table& table, bool curved, double damping) {
    kernels::AlignedVector<float> to(4 * kParticles, 1.f);
    table.pull_bending(bending(table, curved, damping), to.data(), four, 0, 1);
    return to;
  }
};

template <class Work>
void for_all_kinds(Work&& work) {
  for (const bool curved : {false, true}) {
    for (const double damping : {0., 20.}) {
      for (const bool four : {false, true}) work(Elements(four, curved), curved, damping);
      work(Elements(true, curved, true), curved, damping);
    }
  }
}

TEST_CASE("an element pulls its particles as in double, and in sum not at all") {
  for_all_kinds([](Elements start, bool curved, double damping) {
    const bool four = start.four;
    CAPTURE(four);
    CAPTURE(start.folded);
    CAPTURE(curved);
    CAPTURE(damping);
    start.fold();
    kernels::Vectors x = start.positions(), before = start.starts();
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(text(isa));
      Elements e = start;
      const kernels::AlignedVector<float> to = e.pulled(simd::table(isa), curved, damping);
      for (const reference::BendingElement& element : start.elements) {
        const reference::Pulls f =
            reference::pulls(element, damping, kSoft, x.view(), before.view());
        double scale = 1;
        for (const Vector& pull : f) scale += 2 * length(pull);
        Vector sum{0, 0, 0};
        for (std::size_t k = 0; k < (four ? 4u : 3u); ++k) {
          const std::size_t at = 4 * std::size_t{element.slots[k]};
          const Vector by{double{to[at]} - 1, double{to[at + 1]} - 1, double{to[at + 2]} - 1};
          CHECK(length(by - f[k]) < 1e-4 * scale);
          sum = sum + by;
        }
        CHECK(length(sum) < 1e-6 * scale);
      }
    }
  });
}

/// x, turned about the origin by the angle, and moved.
kernels::Vectors turned(kernels::VectorsView x, Vector axis, double angle) {
  const Vector n = (1 / length(axis)) * axis;
  kernels::Vectors to(kParticles);
  for (std::size_t i = 0; i < kParticles; ++i) {
    const Vector along = dot(n, x[i]) * n, across = x[i] - along;
    to.set(i, Vector{0.1, -0.2, 0.3} + along + std::cos(angle) * across +
                  std::sin(angle) * cross(n, across));
  }
  return to;
}

TEST_CASE("nothing is damped of what turns as a whole, in whatever order its particles are") {
  const double damping = 20;
  for (const bool four : {false, true}) {
    for (const double angle : {1e-3, 0.1, 1.}) {
      Elements start(four, true);
      kernels::Vectors x = start.positions();
      Random random(5);
      const Vector axis{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      kernels::Vectors before = turned(x.view(), axis, angle);
      for (reference::BendingElement e : start.elements) {
        std::array<std::size_t, 4> order{0, 1, 2, 3};
        do {
          if (!four && order[3] != 3) continue;
          reference::BendingElement other = e;
          for (std::size_t k = 0; k < 4; ++k) {
            other.slots[k] = e.slots[order[k]];
            other.weights[k] = e.weights[order[k]];
          }
          if (!four) other.slots[3] = other.slots[2];
          const reference::Pulls free = reference::pulls(other, 0, kSoft, x.view(), before.view());
          const reference::Pulls damped =
              reference::pulls(other, damping, kSoft, x.view(), before.view());
          const double scale =
              damping * length(reference::weighted_sum(e, x.view())) / e.compliance;
          for (std::size_t k = 0; k < 4; ++k)
            CHECK(length(damped[k] - free[k]) < 1e-9 * scale * reference::reach_of(e));
        } while (std::next_permutation(order.begin(), order.end()));
      }
    }
  }
}

TEST_CASE("lanes damp nothing of what turns as a whole") {
  for (const bool four : {false, true}) {
    for (const simd::Isa isa : supported_isas()) {
      Elements e(four, false);
      kernels::Vectors x = e.positions();
      kernels::Vectors before = turned(x.view(), {1, -2, 0.5}, 1e-2);
      for (std::size_t i = 0; i < kParticles; ++i) {
        const double at[] = {before[i].x, before[i].y, before[i].z};
        for (std::size_t k = 0; k < 3; ++k)
          e.before[4 * i + k] = static_cast<float>(at[k] - static_cast<double>(e.base[4 * i + k]));
      }
      const auto free = e.pulled(simd::table(isa), false, 0);
      const auto damped = e.pulled(simd::table(isa), false, 1);
      for (std::size_t i = 0; i < free.size(); ++i)
        CHECK(std::abs(damped[i] - free[i]) < 1e-3f * (1 + std::abs(free[i])));
    }
  }
}

TEST_CASE("AVX2 and AVX-512 pull by the same bits, and tell the same energy") {
  if (!simd::supported(simd::Isa::avx512)) {
    MESSAGE("this machine lacks avx512: not tested");
    return;
  }
  for_all_kinds([](Elements e, bool curved, double damping) {
    const bool four = e.four;
    const simd::Table &narrow = simd::table(simd::Isa::avx2),
                      &wide = simd::table(simd::Isa::avx512);
    CHECK(e.pulled(narrow, curved, damping) == e.pulled(wide, curved, damping));
    double energy[2];
    narrow.bending_energy(e.bending(narrow, curved, damping), &energy[0], four, 0, 1);
    wide.bending_energy(e.bending(wide, curved, damping), &energy[1], four, 0, 1);
    CHECK(energy[0] == energy[1]);
  });
}

TEST_CASE("the energy of a block is that of its elements") {
  for_all_kinds([](Elements e, bool curved, double) {
    const bool four = e.four;
    for (const simd::Isa isa : supported_isas()) {
      for (const double resolved : {1e12, 1.}) {  // 1/s^2, of all elements, and of some of them
        const simd::Table& table = simd::table(isa);
        simd::Bending bending = e.bending(table, curved, 0);
        bending.resolved = static_cast<float>(resolved);
        double energy = 0, expected = 0;
        table.bending_energy(bending, &energy, four, 0, 1);
        kernels::Vectors x = e.positions();
        for (const reference::BendingElement& element : e.elements)
          expected += reference::energy(element, resolved, kOne.data(), x.view());
        CHECK(energy == doctest::Approx(expected).epsilon(1e-5));
      }
    }
  });
}

TEST_CASE("a pull is what the energy falls by, and turns nothing") {
  for (const bool curved : {false, true}) {
    for (const bool folded : {false, true}) {
      Elements e(true, curved, folded);
      kernels::Vectors x = e.positions(), before = e.starts();
      for (const reference::BendingElement& element : e.elements) {
        const reference::Pulls f = reference::pulls(element, 0, kSoft, x.view(), before.view());
        Vector torque{0, 0, 0};
        double size = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          const std::uint32_t slot = element.slots[k];
          const Vector at = x[slot], step{1e-7, -2e-7, 5e-8};
          x.set(slot, at + step);
          const double more = reference::energy(element, 1e12, kOne.data(), x.view());
          x.set(slot, at - step);
          const double less = reference::energy(element, 1e12, kOne.data(), x.view());
          x.set(slot, at);
          const double fall = dot(f[k], 2. * step);
          CHECK(less - more == doctest::Approx(fall).epsilon(1e-3).scale(1e-9));
          torque = torque + cross(at, f[k]);
          size += length(at) * length(f[k]);
        }
        CHECK(length(torque) < 1e-9 * size);
      }
    }
  }
}

/// Two square faces of the side `side` with an edge along x, at the angle.
reference::BendingElement hinge_at(double angle, double fold, double side, kernels::Vectors& x) {
  const double half = angle / 2;
  x.set(0, {0, 0, 0});
  x.set(1, {side, 0, 0});
  x.set(2, {side, -side * std::cos(half), side * std::sin(half)});
  x.set(3, {0, side * std::cos(half), side * std::sin(half)});
  reference::BendingElement e{{0, 1, 2, 3}, {-1, -1, 1, 1}, 0, 2};
  e.fold = fold;
  return e;
}

TEST_CASE("a hinge has a side: it stores by how far it is from its fold") {
  const double side = 0.01;
  for (const double angle_at_rest : {0.5, 1., 2., -0.5, -2.}) {
    const double fold = 2 * side * std::sin(angle_at_rest / 2);
    kernels::Vectors x(4);
    double last = 0;
    for (double angle = -3.1; angle < 3.1; angle += 0.01) {
      const reference::BendingElement e = hinge_at(angle, fold, side, x);
      const double energy = reference::energy(e, 1e12, kOne.data(), x.view());
      const double bend = 2 * side * std::sin(angle / 2) - fold;
      if (std::abs(angle) < 2.5) CHECK(energy == doctest::Approx(bend * bend / (2 * e.compliance)));
      // Without a jump, over the angle where both faces lie on each other, too.
      if (angle > -3.1) CHECK(std::abs(energy - last) < 0.1 * side * side);
      last = energy;
    }
    const double over =
        reference::energy(hinge_at(-3.1, fold, side, x), 1e12, kOne.data(), x.view());
    CHECK(std::abs(last - over) < 2 * side * side);
    const reference::BendingElement at_rest = hinge_at(angle_at_rest, fold, side, x);
    for (const Vector& f : reference::pulls(at_rest, 0, kSoft, x.view(), x.view()))
      CHECK(length(f) < 1e-15);
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_bending
