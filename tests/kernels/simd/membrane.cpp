/// Triangles of fabric in lanes against the formulas in double, on every instruction set, and these
/// against differences.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/reference/membrane.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_membrane {
namespace {

using kernels::kLanes;
using kernels::Vector;
using reference::Deformation;

constexpr std::size_t kParticles = 3 * kLanes;

Vector vector(Vec3 v) { return {v.x, v.y, v.z}; }

/// A triangle of about 0.1 m with stiffness over four decades, or none; some corners are fixed.
struct Triangle {
  std::array<std::array<double, 2>, 3> rest;
  std::array<double, 3> w;
  reference::MembraneElement element;

  Triangle(Random& random, bool is_rope) {
    const auto place = [&] { return random.between(-0.02, 0.02); };
    rest = {{{place(), place()}, {0.1 + place(), place()}, {0.04 + place(), 0.08 + place()}}};
    const double angle = random.between(0, 6);
    for (auto& [u, v] : rest) {
      const double x = u, y = v;
      u = std::cos(angle) * x + std::sin(angle) * y;
      v = std::cos(angle) * y - std::sin(angle) * x;
    }
    for (double& inverse : w) inverse = random.below(5) == 0 ? 0 : random.between(200, 2000);
    w[random.below(3)] = 1000;
    element.shape = reference::shape_of(rest);
    element.mobility = reference::mobility(element.shape, w);
    for (double& k : element.stiffness)
      k = random.below(6) == 0 ? 0 : 100 * std::exp2(random.between(-6, 6));
    element.is_rope = is_rope;
  }
  /// Where the fabric lies flat, turned and deformed by up to `strain`.
  std::array<Vector, 3> corners(double strain, Random& random) const {
    const auto axis = [&](Vec3 along) { return vector(along) + strain * vector(random.in_box(1)); };
    const Vector u = axis({0.6, 0.8, 0}), v = axis({0, 0, 1});
    std::array<Vector, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = rest[k][0] * u + rest[k][1] * v;
    return x;
  }
};

/// A block of triangles: mostly a little out of shape, one far out, one that has fallen to a point
/// and one to a line.
struct Block {
  std::vector<Triangle> triangles;
  kernels::AlignedVector<float> base, u, start;
  simd::MembraneBlock block{};
  simd::MembraneSpans spans{};
  std::vector<float> multiplier;
  std::uint16_t out = 0;

  explicit Block(bool is_rope, std::uint32_t seed = 7) : multiplier(3 * kLanes) {
    for (auto* array : {&base, &u, &start}) array->resize(4 * kParticles);
    Random random(seed);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      triangles.emplace_back(random, is_rope);
      fill(lane);
      place(lane, random);
    }
  }
  void fill(std::uint32_t lane) {
    const auto& [shape, mobility, stiffness, is_rope] = triangles[lane].element;
    const double most = mobility.most();
    for (std::uint32_t k = 0; k < 3; ++k) {
      block.place[k][lane] = 4 * (3 * lane + k);
      block.share_u[k][lane] = static_cast<float>(triangles[lane].w[k] * shape.u[k] / most);
      block.share_v[k][lane] = static_cast<float>(triangles[lane].w[k] * shape.v[k] / most);
      block.stiffness[k][lane] = static_cast<float>(stiffness[k] * shape.area * most);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      block.u[k][lane] = static_cast<float>(shape.u[k + 1]);
      block.v[k][lane] = static_cast<float>(shape.v[k + 1]);
    }
    block.mobility[0][lane] = static_cast<float>(mobility.uu / most);
    block.mobility[1][lane] = static_cast<float>(mobility.uv / most);
    block.mobility[2][lane] = static_cast<float>(mobility.vv / most);
  }
  void place(std::uint32_t lane, Random& random) {
    std::array<Vector, 3> x = triangles[lane].corners(lane == 3 ? 3 : 0.02, random);
    if (lane == 5) x[1] = x[2] = x[0];
    if (lane == 6) x[2] = 0.3 * x[0] + 0.7 * x[1];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = 4 * (3 * lane + k);
      const double components[] = {x[k].x, x[k].y, x[k].z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        base[at + axis] = static_cast<float>(components[axis]);
        const bool moves = lane != 5 && lane != 6;
        u[at + axis] = moves ? static_cast<float>(random.between(-1e-4, 1e-4)) : 0;
        start[at + axis] = moves ? static_cast<float>(random.between(-1e-4, 1e-4)) : 0;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double force = random.between(0, 0.01) * static_cast<double>(block.stiffness[k][lane]);
      multiplier[k * kLanes + lane] = static_cast<float>(1e-6 * force);
    }
  }
  Vector particle(const kernels::AlignedVector<float>& by, std::size_t i) const {
    const auto axis = [&](std::size_t k) {
      return static_cast<double>(base[4 * i + k]) + static_cast<double>(by[4 * i + k]);
    };
    return {axis(0), axis(1), axis(2)};
  }
  Deformation deformation(const kernels::AlignedVector<float>& by, std::uint32_t lane) const {
    const Vector x0 = particle(by, 3 * lane);
    return reference::deformation(triangles[lane].element.shape, particle(by, 3 * lane + 1) - x0,
                                  particle(by, 3 * lane + 2) - x0);
  }
  void relax(const simd::Table& table, const reference::MembraneStep& step, bool continues,
             bool is_rope) {
    table.measure_membrane(&block, &spans, base.data(), 0, 1);
    const simd::Membrane membrane{u.data(),
                                  start.data(),
                                  &block,
                                  &spans,
                                  multiplier.data(),
                                  static_cast<float>(step.give),
                                  static_cast<float>(step.damping)};
    table.judge_membrane(membrane, 0.01f, &out, is_rope, 0, 1);
    table.relax_membrane(membrane, 0.8f, continues, is_rope, 0, 1);
  }
};

template <class Work>
void for_all_kinds(Work&& work) {
  for (const bool is_rope : {false, true}) {
    for (const bool continues : {false, true}) {
      for (const double damping : {0., 3.}) work(is_rope, continues, damping);
    }
  }
}

constexpr double kGive = 1e-6;  // s^2

TEST_CASE("a triangle of fabric moves its corners as in double") {
  for_all_kinds([](bool is_rope, bool continues, double damping) {
    CAPTURE(is_rope);
    CAPTURE(continues);
    CAPTURE(damping);
    const reference::MembraneStep step{kGive, damping};
    const Block start(is_rope);
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(text(isa));
      Block block = start;
      block.relax(simd::table(isa), step, continues, is_rope);
      double moved = 0;
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        CAPTURE(lane);
        const Triangle& t = start.triangles[lane];
        const double most = t.element.mobility.most();
        reference::MembraneMultipliers multipliers;
        for (std::size_t k = 0; k < 3; ++k)
          multipliers[k] = static_cast<double>(start.multiplier[k * kLanes + lane]) / most;
        const Deformation now = start.deformation(start.u, lane);
        const Deformation before = start.deformation(start.start, lane);
        const double left = violation(t.element, step, now, before, multipliers);
        if (!continues) multipliers = {};
        const Deformation push = relax(t.element, step, 0.8, now, before, multipliers);
        for (std::size_t k = 0; k < 3; ++k) {
          const Vector by =
              -t.w[k] * (t.element.shape.u[k] * push.u + t.element.shape.v[k] * push.v);
          const Vector is =
              block.particle(block.u, 3 * lane + k) - start.particle(start.u, 3 * lane + k);
          CHECK(length(is - by) < 1e-7 + 1e-5 * length(by));
          moved = std::max(moved, length(is));
          if (t.w[k] == 0) CHECK(length(is) == 0);
          const double expected = most * multipliers[k];
          CHECK(std::abs(static_cast<double>(block.multiplier[k * kLanes + lane]) - expected) <
                1e-6 + 1e-4 * std::abs(expected));
        }
        const bool is_out = (block.out >> lane & 1) != 0;
        if (std::abs(left - 0.01) > 1e-6) CHECK(is_out == (left > 0.01));
      }
      CHECK(moved > 1e-3);
    }
  });
}

TEST_CASE("AVX2 and AVX-512 move corners to the same bits") {
  if (!simd::supported(simd::Isa::avx512)) {
    MESSAGE("this machine lacks avx512: not tested");
    return;
  }
  for_all_kinds([](bool is_rope, bool continues, double damping) {
    Block narrow(is_rope), wide(is_rope);
    narrow.relax(simd::table(simd::Isa::avx2), {kGive, damping}, continues, is_rope);
    wide.relax(simd::table(simd::Isa::avx512), {kGive, damping}, continues, is_rope);
    CHECK(narrow.u == wide.u);
    CHECK(narrow.multiplier == wide.multiplier);
    CHECK(narrow.out == wide.out);
  });
}

/// Blocks that share no particle, in the arrays of a cloth.
struct Blocks {
  std::vector<simd::MembraneBlock> blocks;
  std::vector<simd::MembraneSpans> spans;
  kernels::AlignedVector<float> u, start;
  std::vector<float> multiplier;

  void add(const Block& from) {
    simd::MembraneBlock& block = blocks.emplace_back(from.block);
    for (auto& corner : block.place) {
      for (std::uint32_t& place : corner) place += static_cast<std::uint32_t>(u.size());
    }
    spans.push_back(from.spans);
    u.insert(u.end(), from.u.begin(), from.u.end());
    start.insert(start.end(), from.start.begin(), from.start.end());
    multiplier.insert(multiplier.end(), from.multiplier.begin(), from.multiplier.end());
  }
};

TEST_CASE("blocks that are visited together move as each of them alone, to the last bit") {
  for_all_kinds([](bool is_rope, bool continues, double damping) {
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(text(isa));
      const simd::Table& table = simd::table(isa);
      Blocks together, alone;
      for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        Block block(is_rope, seed);
        table.measure_membrane(&block.block, &block.spans, block.base.data(), 0, 1);
        together.add(block);
        block.relax(table, {kGive, damping}, continues, is_rope);
        alone.add(block);
      }
      const simd::Membrane membrane{together.u.data(),          together.start.data(),
                                    together.blocks.data(),     together.spans.data(),
                                    together.multiplier.data(), static_cast<float>(kGive),
                                    static_cast<float>(damping)};
      table.relax_membrane(membrane, 0.8f, continues, is_rope, 0, together.blocks.size());
      CHECK(together.u == alone.u);
      CHECK(together.multiplier == alone.multiplier);
    }
  });
}

TEST_CASE("gradients of the laws are what differences say") {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Triangle t(random, false);
    const std::array<Vector, 3> x = t.corners(0.3, random);
    const Deformation f = reference::deformation(t.element.shape, x[1] - x[0], x[2] - x[0]);
    constexpr double kStep = 1e-6;
    for (std::size_t law = 0; law < 3; ++law) {
      const reference::MembraneTerm term = reference::term(t.element, f, law);
      for (const Vector along : {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}}) {
        const auto error = [&](double u, double v) {
          return reference::term(t.element, {f.u + u * along, f.v + v * along}, law).error;
        };
        CHECK(dot(term.gradient.u, along) ==
              doctest::Approx((error(kStep, 0) - error(-kStep, 0)) / (2 * kStep)).epsilon(1e-6));
        CHECK(dot(term.gradient.v, along) ==
              doctest::Approx((error(0, kStep) - error(0, -kStep)) / (2 * kStep)).epsilon(1e-6));
      }
    }
  }
}

TEST_CASE("visit after visit, an element alone obeys its laws") {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Triangle t(random, i % 2 == 1);
    const reference::MembraneElement& e = t.element;
    const reference::MembraneStep step{kGive, 0};
    std::array<Vector, 3> x = t.corners(0.3, random);
    reference::MembraneMultipliers multipliers{};
    const auto f = [&] { return deformation(e.shape, x[1] - x[0], x[2] - x[0]); };
    for (int visit = 0; visit < 2000; ++visit) {
      const Deformation push = relax(e, step, 0.8, f(), {}, multipliers);
      for (std::size_t k = 0; k < 3; ++k)
        x[k] = x[k] - t.w[k] * (e.shape.u[k] * push.u + e.shape.v[k] * push.v);
    }
    CHECK(violation(e, step, f(), {}, multipliers) < 1e-6);
    if (e.is_rope) CHECK(std::min(multipliers[0], multipliers[1]) >= 0);
  }
}

TEST_CASE("whatever shape a triangle is in, a visit moves it by no more than it is out of shape") {
  Random random(8);
  for (int i = 0; i < 20000; ++i) {
    const Triangle t(random, false);
    const reference::MembraneElement& e = t.element;
    const double size = std::exp2(random.between(-30, 4));
    Deformation f{size * vector(random.in_box(1)), size * vector(random.in_box(1))};
    if (i % 3 == 0) f.v = random.between(-2, 2) * f.u;
    if (i % 3 == 1) f.v = random.between(-2, 2) * f.u + 1e-9 * size * vector(random.in_box(1));
    reference::MembraneMultipliers multipliers{};
    const Deformation push = relax(e, {1, 0}, 1, f, {}, multipliers);
    // In the norm of the masses: sum of |x_k|^2 / w_k, over the mobility of the nearest law.
    const reference::MembraneMobility& m = e.mobility;
    const double square =
        m.uu * dot(push.u, push.u) + 2 * m.uv * dot(push.u, push.v) + m.vv * dot(push.v, push.v);
    const double least = std::min(m.uu > 0 ? m.uu : m.vv, m.vv > 0 ? m.vv : m.uu);
    CHECK(std::isfinite(square));
    CHECK(std::sqrt(std::max(0., square) * least) < 20 * (1 + size));
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_membrane
