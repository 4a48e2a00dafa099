/// The stages of a small step against the formulas in double, on every instruction set.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/solvers/yarn/yarn_layout.h"
#include "kernels/reference/small_steps.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"
#include "tests/support/yarn_block.h"

namespace weft::test::kernels_simd_small_steps {
namespace {

using kernels::Vector;

constexpr std::size_t kParticles = 32, kCount = 4 * kParticles;  // quads
constexpr double kH = 0.001;

/// Particles in quads that fly at random.
struct Flying {
  kernels::AlignedVector<float> u, before, predicted, v, v_before, a;
  kernels::AlignedVector<float> past_v, past_v_before, moved;

  Flying() {
    Random random(5);
    for (auto* array :
         {&u, &before, &predicted, &v, &v_before, &a, &past_v, &past_v_before, &moved}) {
      array->resize(kCount);
      for (float& f : *array) f = static_cast<float>(random.between(-1, 1));
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      u[i] *= 0.01f;
      before[i] = u[i] - static_cast<float>(kH) * v_before[i];
      predicted[i] = u[i] + 1e-5f * predicted[i];
    }
  }
  simd::Flight flight() {
    return {u.data(), before.data(), predicted.data(), v.data(), v_before.data(), a.data()};
  }
  simd::Past past() { return {past_v.data(), past_v_before.data(), moved.data()}; }
};

double at(const kernels::AlignedVector<float>& array, std::size_t i) {
  return static_cast<double>(array[i]);
}

/// One component in double.
struct ReferenceFlight {
  kernels::Vectors vectors[5];
  reference::Flight flight;

  ReferenceFlight(const Flying& f, std::size_t i) {
    for (kernels::Vectors& v : vectors) v.resize(1);
    const kernels::AlignedVector<float>* from[] = {&f.u, &f.before, &f.predicted, &f.v,
                                                   &f.v_before};
    for (std::size_t k = 0; k < 5; ++k) vectors[k].x[0] = at(*from[k], i);
    flight = {vectors[0].view(), vectors[1].view(), vectors[2].view(), vectors[3].view(),
              vectors[4].view()};
  }
};

TEST_CASE("advance and settle are the formulas in double, rounded") {
  const double ratio = 1.3, c = ratio * ratio / (1 + 2 * ratio);
  const double bh = (1 + ratio) / (1 + 2 * ratio) * kH, push = 0.9 * bh, last = 0.8 * kH;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    const Flying start;
    Flying f, settled;
    const simd::LastSubstep substep{static_cast<float>(last), static_cast<float>(1 / last), 2.5f};
    const simd::SubstepWeights weights{static_cast<float>(c), static_cast<float>(bh),
                                       static_cast<float>(push), substep};
    table.advance(f.flight(), weights, 0, kCount);
    const float of_settle = table.settle(settled.flight(), substep, 0, kCount);
    Flying measured;
    const float of_advance = table.advance_measured(measured.flight(), weights, 0, kCount);
    CHECK(measured.u == f.u);
    CHECK(measured.v == f.v);
    CHECK(of_advance == of_settle);
    double departure = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      ReferenceFlight expected(start, i), still(start, i);
      const Vector by = reference::departure(still.flight, 0, {at(start.a, i), 0, 0}, 2.5, last);
      departure = std::max(departure, std::abs(by.x));
      reference::advance(expected.flight, 0, {at(start.a, i), 0, 0}, c, bh, push, last);
      reference::settle(still.flight, 0, last);
      CHECK(std::abs(at(f.u, i) - expected.flight.x.x[0]) < 3e-9);
      CHECK(f.predicted[i] == f.u[i]);
      CHECK(f.before[i] == start.u[i]);
      CHECK(std::abs(at(f.v, i) - expected.flight.v.x[0]) < 1e-6);
      CHECK(std::abs(at(f.v_before, i) - expected.flight.v_before.x[0]) < 1e-6);
      CHECK(std::abs(at(settled.v, i) - still.flight.v.x[0]) < 1e-6);
      CHECK(settled.predicted[i] == start.u[i]);
    }
    CHECK(departure > 1);
    CHECK(static_cast<double>(of_settle) == doctest::Approx(departure).epsilon(1e-6));
  }
}

TEST_CASE("the largest move is that of a substep, along one axis") {
  Flying f;
  for (const std::size_t mover : {std::size_t{0}, kCount / 2 + 3, kCount - 1}) {
    f.before = f.u;
    f.before[mover] -= 0.25f;
    f.before[7] += 0.125f;
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(text(isa));
      CHECK(simd::table(isa).largest_move(f.flight(), 0, kCount) == f.u[mover] - f.before[mover]);
    }
  }
}

TEST_CASE("what is not moved stays to the last bit: the spare float of a quad, and what is fixed") {
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    Flying f;
    for (auto* array : {&f.v, &f.v_before, &f.a}) std::ranges::fill(*array, 0.f);
    f.before = f.predicted = f.u;
    const auto u = f.u;
    for (int k = 0; k < 100; ++k)
      table.advance(f.flight(), {1.f / 3, 7e-4f, 7e-4f, {7e-4f, 1500, 3}}, 0, kCount);
    CHECK(f.u == u);
  }
}

TEST_CASE("a frame goes on where the last one ended; a change of velocity is one of the past too") {
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    Flying f;
    table.keep_past(f.flight(), f.past(), 0, kCount);
    Flying next = f;
    std::ranges::fill(next.before, 0.f);
    std::ranges::fill(next.v_before, 0.f);
    table.resume(next.flight(), next.past(), static_cast<float>(kH), 0, kCount);
    Flying pushed = f;
    for (float& v : pushed.v) v += 2;
    table.resume(pushed.flight(), pushed.past(), static_cast<float>(kH), 0, kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
      CHECK(next.v_before[i] == f.v_before[i]);
      CHECK(std::abs(at(next.before, i) - at(f.before, i)) < 2e-9);
      CHECK(std::abs(at(pushed.v_before, i) - at(f.v_before, i) - 2) < 1e-6);
      CHECK(std::abs(at(pushed.before, i) - at(f.before, i) + 2 * kH) < 1e-8);
    }
  }
}

TEST_CASE("renewing the base moves nothing, and leaves less than a cell") {
  const float cell = 0x1p-10f;
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    Flying f;
    kernels::AlignedVector<float> base(kCount);
    for (std::size_t i = 0; i < kCount; ++i) base[i] = cell * static_cast<float>(i);
    const auto old_base = base, u = f.u, before = f.before;
    table.renew_base(f.flight(), base.data(), cell, 0, kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
      CHECK(at(base, i) + at(f.u, i) == at(old_base, i) + at(u, i));
      CHECK(std::abs(at(f.u, i)) <= 0.5 * static_cast<double>(cell));
      CHECK(std::fmod(at(base, i), static_cast<double>(cell)) == 0);
      CHECK(std::abs(at(f.before, i) - at(f.u, i) - (at(before, i) - at(u, i))) < 1e-9);
    }
  }
}

/// A block of edges between particles 2 k and 2 k + 1.
struct Edges {
  kernels::AlignedVector<float> base, u;
  std::vector<double> w;
  simd::EdgeBlock block{};
  simd::EdgeSpans spans{};
  std::uint16_t out = 0;

  Edges() : base(kCount), u(kCount) {
    Random random(9);
    for (std::size_t i = 0; i < kParticles; ++i) w.push_back(random.between(0.1, 1));
    w[3] = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      if (i % 4 == 3) continue;
      base[i] = static_cast<float>(random.between(-1, 1));
      u[i] = static_cast<float>(random.between(-0.01, 0.01));
    }
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      const std::uint32_t a = 2 * k, b = 2 * k + 1;
      block.a[k] = a;
      block.b[k] = b;
      block.share_a[k] = static_cast<float>(w[a] / (w[a] + w[b]));
      block.share_b[k] = static_cast<float>(w[b] / (w[a] + w[b]));
      const double rest = length(k) * (1 + 0.002 * (static_cast<double>(k) - 8));
      block.square[k] = static_cast<float>(rest * rest);
    }
  }
  Vector particle(std::size_t i) const {
    const auto axis = [&](std::size_t k) { return at(base, 4 * i + k) + at(u, 4 * i + k); };
    return {axis(0), axis(1), axis(2)};
  }
  double length(std::uint32_t k) const {
    return kernels::length(particle(2 * k) - particle(2 * k + 1));
  }
  simd::EdgeRelaxation relaxation(double strain, double left) {
    return {u.data(),
            &block,
            &spans,
            &out,
            0.8f,
            static_cast<float>(2 * strain + strain * strain),
            static_cast<float>(left)};
  }
};

/// Of l^2 / L^2 - 1, that a visit leaves: a sweep nothing, mending some.
constexpr double kLeft[] = {0, 0.01};

TEST_CASE("edges are relaxed as in double, ropes only where they are too long") {
  const Edges start;
  for (const simd::Isa isa : supported_isas()) {
    for (const auto& [rope, left] :
         {std::pair{false, kLeft[0]}, {true, kLeft[0]}, {false, kLeft[1]}, {true, kLeft[1]}}) {
      CAPTURE(text(isa));
      CAPTURE(rope);
      CAPTURE(left);
      const simd::Table& table = simd::table(isa);
      Edges e;
      table.measure_edges(&e.block, &e.spans, e.base.data(), 0, 1);
      (rope ? table.relax_ropes : table.relax_distances)(e.relaxation(0.005, left), 0, 1);
      for (std::uint32_t k = 0; k < kLanes; ++k) {
        const std::uint32_t a = 2 * k, b = a + 1;
        const Vector d = start.particle(a) - start.particle(b);
        const double rest = std::sqrt(static_cast<double>(e.block.square[k]));
        const double strain = kernels::length(d) / rest - 1;
        const bool slack = rope && strain <= 0;
        const double q =
            slack ? 0 : reference::relaxed_impulse(d, rest, start.w[a] + start.w[b], 0.8, left);
        const Vector expected_a = start.particle(a) - (start.w[a] * q) * d;
        const Vector expected_b = start.particle(b) + (start.w[b] * q) * d;
        CHECK(kernels::length(e.particle(a) - expected_a) < 1e-7 * rest);
        CHECK(kernels::length(e.particle(b) - expected_b) < 1e-7 * rest);
        const bool is_out = (e.out >> k & 1) != 0;
        CHECK(is_out == (!slack && std::abs(strain) > 0.005));
      }
    }
  }
}

TEST_CASE("a relaxed sweep solves each yarn as a chain in double, wherever its particles stand") {
  for (const simd::Isa isa : supported_isas()) {
    for (const Stand stand : kStands) {
      for (const double left : kLeft) {
        CAPTURE(text(isa));
        CAPTURE(static_cast<int>(stand));
        CAPTURE(left);
        const simd::Table& table = simd::table(isa);
        BlockOfYarns b(stand);
        b.start(table);
        std::vector<std::uint32_t> out(BlockOfYarns::kRows);
        const simd::YarnRelaxation relaxation{0.8f, 0.01f, out.data(), static_cast<float>(left)};
        table.relax_yarns(b.yarns(), b.block(), b.u.data(), b.scratch.data(), relaxation);
        const kernels::Vectors moved = b.end(table);
        for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
          const std::uint32_t n = BlockOfYarns::length(lane);
          reference::ChainSystem chain;
          for (std::uint32_t k = 0; k < n; ++k) {
            chain.w.push_back(static_cast<double>(b.rows[k].inverse_mass[lane]));
            if (k + 1 == n) break;
            const Vector d = b.x[b.slot_of(k, lane)] - b.x[b.slot_of(k + 1, lane)];
            const double rest = static_cast<double>(b.rows[k].rest[lane]);
            chain.d.push_back(d);
            chain.error.push_back(0.5 *
                                  reference::beyond(dot(d, d) - rest * rest, left * rest * rest));
            const bool is_out = (out[k] >> lane & 1) != 0;
            CHECK(is_out == (std::abs(dot(d, d) / (rest * rest) - 1) > 0.01));
          }
          chain.solve(0.8, BlockOfYarns::compliance(lane));
          for (std::uint32_t k = 0; k < n; ++k) {
            Vector expected = b.x[b.slot_of(k, lane)];
            if (k > 0) expected = expected + (chain.w[k] * chain.error[k - 1]) * chain.d[k - 1];
            if (k + 1 < n) expected = expected - (chain.w[k] * chain.error[k]) * chain.d[k];
            CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected) < 3e-8);
          }
        }
      }
    }
  }
}

/// Links of all stiffness in the lanes of a block, some of them rigid, with what they had when the
/// substep began and multipliers of a sweep before.
struct SpringYarns {
  static constexpr double kOmega = 0.8, kScale = 1e6, kUnitMass = 0.5;
  static constexpr double kStrain = 0.02;
  BlockOfYarns b;
  kernels::AlignedVector<float> start, multiplier;
  std::vector<std::uint32_t> out;

  explicit SpringYarns(const simd::Table& table)
      : multiplier(BlockOfYarns::kRows * kLanes), out(BlockOfYarns::kRows) {
    for (std::uint32_t k = 0; k < BlockOfYarns::kRows; ++k) {
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const bool is_link = k + 1 < BlockOfYarns::length(lane);
        const bool is_rigid = (k + lane) % 4 == 0;
        const double compliance = std::pow(10., -8. + (k + 2 * lane) % 12 / 2.);
        if (is_link && !is_rigid) b.rows[k].compliance[lane] = static_cast<float>(compliance);
        if (is_link) multiplier[k * kLanes + lane] = 1e-3f * static_cast<float>((k + lane) % 3);
      }
    }
    b.start(table);
    start = b.u;
    Random random(5);
    for (float& u : start) u += static_cast<float>(random.between(-1e-3, 1e-3));
  }
  simd::YarnSpringRelaxation relaxation(double damping, bool continues) {
    return {.yarns = {static_cast<float>(kOmega), 0, out.data()},
            .multiplier = multiplier.data(),
            .unit_mass = static_cast<float>(kUnitMass),
            .laws = {.u_start = start.data(),
                     .scale = static_cast<float>(kScale),
                     .damping = static_cast<float>(damping),
                     .most_compliance = std::numeric_limits<float>::max(),
                     .strain = static_cast<float>(kStrain),
                     .continues = continues}};
  }
  Vector start_of(std::uint32_t k, std::uint32_t lane) const {
    const std::size_t at = b.place_of(k, lane);
    const auto axis = [&](std::size_t i) {
      return static_cast<double>(b.base[at + i]) + static_cast<double>(start[at + i]);
    };
    return {axis(0), axis(1), axis(2)};
  }
  double multiplier_of(std::uint32_t k, std::uint32_t lane) const {
    return static_cast<double>(multiplier[k * kLanes + lane]);
  }
};

/// A sweep over a lane in double; the multipliers that it adds.
struct SpringLane {
  reference::ChainSystem chain;
  std::vector<double> from;       // multipliers before
  std::vector<double> violation;  // m, then, with the multipliers before

  SpringLane(const SpringYarns& s, std::uint32_t lane, double damping, bool continues) {
    const BlockOfYarns& b = s.b;
    for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
      chain.w.push_back(static_cast<double>(b.rows[k].inverse_mass[lane]) / SpringYarns::kUnitMass);
      if (k + 1 == BlockOfYarns::length(lane)) break;
      const auto law = reference::SpringStep{SpringYarns::kScale, damping}.law(
          static_cast<double>(b.rows[k].compliance[lane]), false);
      const Vector d = b.x[b.slot_of(k, lane)] - b.x[b.slot_of(k + 1, lane)];
      const double l = length(d), rest = static_cast<double>(b.rows[k].rest[lane]);
      const double change = l - length(s.start_of(k, lane) - s.start_of(k + 1, lane));
      const double share = 1 / (1 + law.damping);
      from.push_back(continues ? s.multiplier_of(k, lane) : 0);
      violation.push_back(law.residual(l - rest, change, s.multiplier_of(k, lane)));
      chain.d.push_back(d);
      chain.error.push_back(share * l * law.residual(l - rest, change, from.back()));
      chain.softness.push_back(share * law.softness);
    }
    chain.solve(SpringYarns::kOmega, BlockOfYarns::compliance(lane));
  }
  Vector moved(std::uint32_t k) const {
    Vector by{0, 0, 0};
    if (k > 0) by = by + (chain.w[k] * chain.error[k - 1]) * chain.d[k - 1];
    if (k < chain.d.size()) by = by - (chain.w[k] * chain.error[k]) * chain.d[k];
    return by;
  }
};

void check_spring_yarns(const simd::Table& table, double damping, bool continues) {
  const SpringYarns before(table);
  SpringYarns s(table);
  BlockOfYarns& b = s.b;
  const simd::YarnSpringRelaxation relaxation = s.relaxation(damping, continues);
  table.judge_spring_yarns(b.yarns(), b.block(), b.u.data(), b.scratch.data(), relaxation);
  table.relax_spring_yarns(b.yarns(), b.block(), b.u.data(), b.scratch.data(), relaxation);
  const kernels::Vectors moved = b.end(table);
  for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
    CAPTURE(lane);
    const SpringLane expected(before, lane, damping, continues);
    for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
      CAPTURE(k);
      const Vector at = b.x[b.slot_of(k, lane)] + expected.moved(k);
      CHECK(length(moved[b.slot_of(k, lane)] - at) < 1e-7);
      if (k + 1 == BlockOfYarns::length(lane)) break;
      const double multiplier =
          expected.from[k] + expected.chain.error[k] * length(expected.chain.d[k]);
      CHECK(std::abs(s.multiplier_of(k, lane) - multiplier) < 3e-8 + 1e-5 * std::abs(multiplier));
      const double share = std::abs(expected.violation[k]) / 0.1 / SpringYarns::kStrain;
      if (std::abs(share - 1) > 1e-3) CHECK((s.out[k] >> lane & 1) == (share > 1 ? 1 : 0));
    }
  }
}

TEST_CASE("a yarn of springs and rigid links is solved by its laws as a chain in double") {
  for (const simd::Isa isa : supported_isas()) {
    for (const double damping : {0., 3.}) {
      for (const bool continues : {false, true}) {
        CAPTURE(text(isa));
        CAPTURE(damping);
        CAPTURE(continues);
        check_spring_yarns(simd::table(isa), damping, continues);
      }
    }
  }
}

TEST_CASE("springs of yarns that take no part are left, and are not out of tolerance") {
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    SpringYarns s(table);
    for (simd::YarnRow& row : s.b.rows) std::ranges::fill(row.compliance, 1e-4f);
    simd::YarnSpringRelaxation relaxation = s.relaxation(3, false);
    relaxation.laws.most_compliance = 0;
    const kernels::AlignedVector<float> before = s.b.u;
    table.relax_spring_yarns(s.b.yarns(), s.b.block(), s.b.u.data(), s.b.scratch.data(),
                             relaxation);
    table.judge_spring_yarns(s.b.yarns(), s.b.block(), s.b.u.data(), s.b.scratch.data(),
                             relaxation);
    CHECK(s.b.of_particles(before) == s.b.of_particles(s.b.u));
    CHECK(std::ranges::all_of(s.out, [](std::uint32_t lanes) { return lanes == 0; }));
  }
}

TEST_CASE("a yarn that is straight between two fixed ends moves finitely, and hardly to its side") {
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    BlockOfYarns b;
    const std::uint32_t lane = 10, n = BlockOfYarns::length(lane);
    for (std::uint32_t k = 0; k < n; ++k) {
      b.x.set(b.slot_of(k, lane), {0.1001 * k, 0, 0});  // a thousandth too long
      b.rows[k].inverse_mass[lane] = k == 0 || k + 1 == n ? 0.f : 1.f;
    }
    b.start(table);
    std::vector<std::uint32_t> out(BlockOfYarns::kRows);
    table.relax_yarns(b.yarns(), b.block(), b.u.data(), b.scratch.data(),
                      {0.8f, 0.01f, out.data()});
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t k = 0; k < n; ++k) {
      const Vector by = moved[b.slot_of(k, lane)] - b.x[b.slot_of(k, lane)];
      CHECK(std::abs(by.x) < 1e-3);
      CHECK(std::abs(by.y) + std::abs(by.z) < 1e-9);
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_small_steps
