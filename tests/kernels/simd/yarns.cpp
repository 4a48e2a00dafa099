/// Yarns against dense solutions in double, on every instruction set.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <vector>

#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test {
namespace {

using kernels::kLanes;

/// A block of kLanes yarns of lanes 0 ... kLanes - 1 particles, each with slots of its own, bent at
/// random and stretched by up to a hundredth; some particles are fixed.
struct Block {
  static constexpr std::uint32_t kRows = kLanes;
  std::vector<std::uint32_t> slot;
  kernels::AlignedVector<simd::YarnRow> rows;
  kernels::AlignedVector<simd::YarnSystemRow> system;
  kernels::AlignedVector<simd::LaneVectors> base_step;
  kernels::AlignedVector<simd::YarnScratch> scratch;
  kernels::AlignedVector<simd::LaneVectors> directions;  // at the start of a rattle step
  kernels::AlignedVector<float> base, u, t;
  kernels::Vectors x;
  bool placed = false;  // the rows have the base
  bool from_memory = false;
  bool in_fours = false;

  Block() : rows(kRows), system(kRows), base_step(kRows), scratch(kRows) {
    const std::size_t slots = kRows * kLanes + kLanes;
    base.resize(4 * slots);
    u.resize(4 * slots);
    t.resize(4 * slots);
    x.resize(slots);
    Random random(7);
    for (std::uint32_t k = 0; k < kRows; ++k) {
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const bool real = k < length(lane);
        slot.push_back(real ? (k * kLanes + lane) * 77 % (kRows * kLanes) : kRows * kLanes + lane);
        rows[k].rest[lane] = k + 1 < length(lane) ? 0.1f : 0.f;
        rows[k].inverse_mass[lane] =
            real && (k > 0 || lane % 3 > 0) ? static_cast<float>(random.between(0.1, 1)) : 0.f;
      }
    }
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) place(lane, random);
  }

  static std::uint32_t length(std::uint32_t lane) { return lane; }
  std::uint32_t slot_of(std::uint32_t k, std::uint32_t lane) const {
    return slot[k * kLanes + lane];
  }

  void place(std::uint32_t lane, Random& random) {
    kernels::Vector at{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    for (std::uint32_t k = 0; k < length(lane); ++k) {
      x.set(slot_of(k, lane), at);
      kernels::Vector d{1, random.between(-1, 1), random.between(-1, 1)};
      at = at + (0.1 * random.between(0.99, 1.01) / kernels::length(d)) * d;
    }
  }
  simd::Yarns yarns() {
    simd::Yarns yarns{rows.data(), base_step.data(), system.data(), slot.data()};
    if (!directions.empty()) yarns.start = directions.data();
    if (!placed) yarns.base = base.data();
    yarns.from_memory = from_memory;
    return yarns;
  }
  simd::YarnBlock block() const { return {0, kRows, in_fours}; }
  /// Lanes k, k + 4, k + 8 and k + 12 side by side; those of k = 3 are padding.
  void stand_in_fours() {
    for (std::uint32_t i = 0; i < slot.size(); ++i) {
      const std::uint32_t lane = i % kLanes, place = 4 * (lane % 4) + lane / 4;
      slot[i] = lane % 4 == 3 ? kRows * kLanes + place : i - lane + place;
      if (lane % 4 < 3) continue;
      rows[i / kLanes].rest[lane] = rows[i / kLanes].inverse_mass[lane] = 0;
    }
    Random random(7);
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) place(lane, random);
  }
  void push(const kernels::Vectors& d) {
    for (std::size_t i = 0; i < d.size(); ++i) {
      t[4 * i] = static_cast<float>(d[i].x);
      t[4 * i + 1] = static_cast<float>(d[i].y);
      t[4 * i + 2] = static_cast<float>(d[i].z);
    }
  }
  kernels::Vector t_of(std::uint32_t k, std::uint32_t lane) const {
    const float* at = &t[4 * slot_of(k, lane)];
    return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
  }
  std::vector<float> p() const {
    std::vector<float> values;
    for (const simd::YarnSystemRow& row : system) {
      values.insert(values.end(), std::begin(row.p), std::end(row.p));
    }
    return values;
  }
  simd::Displacements quads(kernels::AlignedVector<float>& v) { return {v.data(), 1, 4}; }
  void start(const simd::Table& table) {
    table.split_positions(x.view(), quads(base), quads(u), 0, x.size());
  }
  /// Impulses act along the directions at q from now on.
  void keep_start(const simd::Table& table, const kernels::Vectors& q) {
    directions.resize(kRows);
    table.split_positions(kernels::Vectors(q).view(), quads(base), quads(u), 0, q.size());
    table.yarn_keep_start(yarns(), block(), quads(u));
  }
  kernels::Vectors end(const simd::Table& table) { return end(table, x); }
  kernels::Vectors end(const simd::Table& table, kernels::Vectors moved) {
    table.join_positions(moved.view(), quads(base), quads(u), 0, x.size());
    return moved;
  }
};

std::vector<kernels::Vector> directions(const Block& b, const kernels::Vectors& x,
                                        std::uint32_t lane) {
  std::vector<kernels::Vector> n;
  for (std::uint32_t k = 0; k + 1 < Block::length(lane); ++k) {
    const kernels::Vector d = x[b.slot_of(k, lane)] - x[b.slot_of(k + 1, lane)];
    n.push_back((1 / kernels::length(d)) * d);
  }
  return n;
}

/// What vectors at the particles of a lane become by impulses along s that bring e, errors that
/// change along n, to 0.
std::vector<kernels::Vector> solved_densely(const Block& b, std::uint32_t lane,
                                            const kernels::Vectors& at,
                                            const std::vector<kernels::Vector>& n,
                                            const std::vector<kernels::Vector>& s,
                                            const Eigen::VectorXd& e) {
  std::vector<kernels::Vector> x;
  std::vector<double> w;
  for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
    x.push_back(at[b.slot_of(k, lane)]);
    w.push_back(static_cast<double>(b.rows[k].inverse_mass[lane]));
  }
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(e.size(), e.size());
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    a(i, i) = (w[k] + w[k + 1]) * kernels::dot(n[k], s[k]);
    if (k == 0) continue;
    a(i, i - 1) = -w[k] * kernels::dot(n[k], s[k - 1]);
    a(i - 1, i) = -w[k] * kernels::dot(n[k - 1], s[k]);
  }
  const Eigen::VectorXd lambda = a.partialPivLu().solve(e);
  for (std::size_t k = 0; k < n.size(); ++k) {
    const double impulse = lambda[static_cast<Eigen::Index>(k)];
    x[k] = x[k] + (-w[k] * impulse) * s[k];
    x[k + 1] = x[k + 1] + (w[k + 1] * impulse) * s[k];
  }
  return x;
}

Eigen::VectorXd length_errors(const Block& b, std::uint32_t lane) {
  Eigen::VectorXd e(Block::length(lane) - 1);
  for (std::uint32_t k = 0; k + 1 < Block::length(lane); ++k) {
    const kernels::Vector d = b.x[b.slot_of(k, lane)] - b.x[b.slot_of(k + 1, lane)];
    e[k] = kernels::length(d) - static_cast<double>(b.rows[k].rest[lane]);
  }
  return e;
}

/// Where one exact linear solve takes the particles of a lane.
std::vector<kernels::Vector> solved_densely(const Block& b, std::uint32_t lane) {
  const auto n = directions(b, b.x, lane);
  return solved_densely(b, lane, b.x, n, n, length_errors(b, lane));
}

/// Vectors of up to `size`, or beside those given.
kernels::Vectors scattered(kernels::Vectors v, double size) {
  Random random(11);
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec3 d = random.in_box(size);
    v.set(i, v[i] + kernels::Vector{d.x, d.y, d.z});
  }
  return v;
}

/// With one family, which is its own preconditioner, the first step is the solution.
void solve_system(Block& b, const simd::Yarns& yarns, const simd::Table& table) {
  kernels::AlignedVector<float> t(b.u.size());
  const simd::YarnProducts before = table.yarn_precondition(yarns, b.block(), 0);
  table.yarn_push(yarns, b.block(), 0, b.quads(t));
  const float curvature = table.yarn_pull(yarns, b.block(), b.quads(t));
  CHECK(before.product / curvature == doctest::Approx(1).epsilon(1e-5));
  const auto after = table.yarn_precondition(yarns, b.block(), before.product / curvature);
  CHECK(after.worst < 1e-4f * before.worst);
  table.yarn_finish(yarns, b.block(), b.quads(b.u));
}

TEST_CASE("positions that do not move come back from two floats to the last bit") {
  for (const simd::Isa isa : supported_isas()) {
    Block b;
    for (std::size_t i = 0; i < b.x.size(); ++i) b.x.x[i] += 1000;
    b.start(simd::table(isa));
    const kernels::Vectors back = b.end(simd::table(isa));
    for (std::size_t i = 0; i < b.x.size(); ++i) {
      CHECK(kernels::length(back[i] - b.x[i]) == 0);
    }
  }
}

TEST_CASE("a sweep over a block solves each of its yarns exactly") {
  const Block untouched;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected = solved_densely(untouched, lane);
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 3e-8);
      }
    }
  }
}

TEST_CASE("what conjugate gradients are made of agrees with one exact solve") {
  const Block untouched;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
    CHECK(table.yarn_precondition(b.yarns(), b.block(), 0).worst ==
          doctest::Approx(0.01).epsilon(0.05));
    solve_system(b, b.yarns(), table);
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected = solved_densely(untouched, lane);
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
      }
    }
  }
}

/// A block whose system has p, z and q of a second iteration.
Block in_conjugate_gradients(const simd::Table& table) {
  Block b;
  b.start(table);
  table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
  table.yarn_precondition(b.yarns(), b.block(), 0);
  table.yarn_push(b.yarns(), b.block(), 0, b.quads(b.t));
  table.yarn_pull(b.yarns(), b.block(), b.quads(b.t));
  table.yarn_precondition(b.yarns(), b.block(), 0.5f);
  return b;
}

TEST_CASE("pushing first is pushing onto nothing") {
  constexpr float kBeta = 0.25f;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    Block onto = in_conjugate_gradients(table), first = onto;
    std::ranges::fill(onto.t, 0.f);
    std::ranges::fill(first.t, 7.f);
    table.yarn_push(onto.yarns(), onto.block(), kBeta, onto.quads(onto.t));
    table.yarn_push_first(first.yarns(), first.block(), kBeta, first.quads(first.t));
    for (const std::uint32_t slot : onto.slot) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(first.t[4 * slot + axis] == onto.t[4 * slot + axis]);
      }
    }
    CHECK(table.yarn_pull(onto.yarns(), onto.block(), onto.quads(onto.t)) > 0);
    CHECK(first.p() == onto.p());
  }
}

TEST_CASE("elimination leaves nothing that changes a length, errors and all") {
  const Block untouched;
  const kernels::Vectors pushed = scattered(kernels::Vectors(untouched.x.size()), 0.01);
  for (const simd::Isa isa : supported_isas()) {
    for (const bool errors : {false, true}) {
      CAPTURE(text(isa));
      CAPTURE(errors);
      Block b;
      const simd::Table& table = simd::table(isa);
      b.start(table);
      table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
      b.push(pushed);
      table.yarn_eliminate(b.yarns(), b.block(), b.quads(b.t), errors, b.scratch.data());
      for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
        const auto n = directions(untouched, untouched.x, lane);
        Eigen::VectorXd e = length_errors(untouched, lane);
        if (!errors) e.setZero();
        for (std::uint32_t k = 0; k < n.size(); ++k) {
          const kernels::Vector d = pushed[b.slot_of(k, lane)] - pushed[b.slot_of(k + 1, lane)];
          e[k] += kernels::dot(n[k], d);
        }
        const auto expected = solved_densely(untouched, lane, pushed, n, n, e);
        for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
          CHECK(kernels::length(b.t_of(k, lane) - expected[k]) < 1e-7);
        }
      }
    }
  }
}

TEST_CASE("slots in fours, or one by one: the same bits") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    Block one_by_one, in_fours;
    in_fours.stand_in_fours();
    one_by_one.stand_in_fours();
    in_fours.in_fours = true;
    for (Block* b : {&one_by_one, &in_fours}) {
      b->start(table);
      const simd::Displacements u = b->quads(b->u), t = b->quads(b->t);
      table.yarn_sweep(b->yarns(), b->block(), u, b->scratch.data());
      table.yarn_linearise(b->yarns(), b->block(), u);
      table.yarn_precondition(b->yarns(), b->block(), 0);
      table.yarn_push_first(b->yarns(), b->block(), 0, t);
      table.yarn_push(b->yarns(), b->block(), 0.5f, t);
      table.yarn_pull(b->yarns(), b->block(), t);
      table.yarn_eliminate(b->yarns(), b->block(), t, true, b->scratch.data());
    }
    CHECK(in_fours.u == one_by_one.u);
    CHECK(in_fours.t == one_by_one.t);
    CHECK(in_fours.p() == one_by_one.p());
    CHECK(std::ranges::count(in_fours.t, 0.f) < std::ssize(in_fours.t) * 7 / 8);
  }
}

TEST_CASE("quads are added slot by slot") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    kernels::AlignedVector<float> u(4 * 3 * kLanes), t(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = static_cast<float>(i);
      t[i] = 0.5f;
    }
    simd::table(isa).add_quads({u.data(), 1, 4}, {t.data(), 1, 4}, kLanes, 2 * kLanes);
    for (std::size_t i = 0; i < u.size(); ++i) {
      const bool inside = i >= 4 * kLanes && i < 8 * kLanes;
      CHECK(u[i] == static_cast<float>(i) + (inside ? 0.5f : 0.f));
    }
  }
}

TEST_CASE("a link whose ends coincide is solved together with its neighbour") {
  constexpr std::uint32_t kLane = 3;  // of three particles
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    Block b;
    const double rest = static_cast<double>(b.rows[0].rest[kLane]);
    for (std::uint32_t k = 0; k < 3; ++k) {
      b.rows[k].inverse_mass[kLane] = 1;
      b.x.set(b.slot_of(k, kLane), {0, k < 2 ? 0 : -rest, 0});
    }
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const kernels::Vector expected{0, (2.0 / 3 - k) * rest, 0};
      CHECK(kernels::length(moved[b.slot_of(k, kLane)] - expected) < 3e-8);
    }
  }
}

TEST_CASE("rows remember the base, or it is fetched: the same bits") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    Block kept, fetched;
    fetched.from_memory = true;
    for (Block* b : {&fetched, &kept}) {
      b->start(table);
      table.yarn_sweep(b->yarns(), b->block(), b->quads(b->u), b->scratch.data());
    }
    kept.placed = true;
    for (Block* b : {&fetched, &kept}) {
      table.yarn_sweep(b->yarns(), b->block(), b->quads(b->u), b->scratch.data());
    }
    CHECK(fetched.u == kept.u);
  }
}

TEST_CASE("rattle: a sweep solves each yarn exactly, along the directions at the start") {
  const Block untouched;
  const kernels::Vectors q = scattered(untouched.x, 0.02);
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    const simd::Table& table = simd::table(isa);
    b.keep_start(table, q);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected =
          solved_densely(untouched, lane, untouched.x, directions(untouched, untouched.x, lane),
                         directions(untouched, q, lane), length_errors(untouched, lane));
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
      }
    }
  }
}

TEST_CASE("rattle: the linear system has the directions at the start, and the errors at x") {
  const Block untouched;
  const kernels::Vectors q = scattered(untouched.x, 0.02);
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    const simd::Table& table = simd::table(isa);
    b.keep_start(table, q);
    b.start(table);
    table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
    solve_system(b, b.yarns(), table);
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto s = directions(untouched, q, lane);
      const auto expected =
          solved_densely(untouched, lane, untouched.x, s, s, length_errors(untouched, lane));
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
      }
    }
  }
}

TEST_CASE("velocities: the linear system takes them out along each link") {
  const Block untouched;
  const kernels::Vectors v = scattered(kernels::Vectors(untouched.x.size()), 1);
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    const simd::Table& table = simd::table(isa);
    simd::Yarns yarns = b.yarns();
    yarns.velocities = true;
    b.start(table);
    table.yarn_linearise(yarns, b.block(), b.quads(b.u));
    kernels::Vectors copy = v;
    table.split_positions(copy.view(), b.quads(b.base), b.quads(b.u), 0, v.size());
    table.yarn_read(yarns, b.block(), b.quads(b.base), b.quads(b.u));
    solve_system(b, yarns, table);
    const kernels::Vectors moved = b.end(table, v);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto n = directions(untouched, untouched.x, lane);
      Eigen::VectorXd e(static_cast<Eigen::Index>(n.size()));
      for (std::uint32_t k = 0; k < n.size(); ++k) {
        e[k] = kernels::dot(n[k], v[b.slot_of(k, lane)] - v[b.slot_of(k + 1, lane)]);
      }
      const auto expected = solved_densely(untouched, lane, v, n, n, e);
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 2e-5);
      }
    }
  }
}

TEST_CASE("yarns: AVX2 and AVX-512 give the same bits") {
  if (!simd::supported(simd::Isa::avx512)) return;
  std::vector<std::vector<float>> results;
  for (const simd::Isa isa : {simd::Isa::avx2, simd::Isa::avx512}) {
    std::vector<float>& result = results.emplace_back();
    Block b;
    const simd::Table& table = simd::table(isa);
    const kernels::Vectors q = scattered(b.x, 0.02);
    for (const bool rattle : {false, true}) {
      if (rattle) b.keep_start(table, q);
      b.start(table);
      table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
      table.yarn_linearise(b.yarns(), b.block(), b.quads(b.u));
      for (const bool velocities : {false, true}) {
        if (velocities) table.yarn_read(b.yarns(), b.block(), b.quads(b.base), b.quads(b.u));
        const auto p = table.yarn_precondition(b.yarns(), b.block(), 0);
        result.push_back(p.product);
        result.push_back(p.worst);
        table.yarn_push_first(b.yarns(), b.block(), 0, b.quads(b.t));
        table.yarn_push(b.yarns(), b.block(), 0.5f, b.quads(b.t));
        table.yarn_eliminate(b.yarns(), b.block(), b.quads(b.t), velocities, b.scratch.data());
        result.push_back(table.yarn_pull(b.yarns(), b.block(), b.quads(b.t)));
        table.yarn_precondition(b.yarns(), b.block(), 0.25f);
        table.yarn_finish(b.yarns(), b.block(), b.quads(b.t));
      }
      table.add_quads(b.quads(b.u), b.quads(b.t), 0, b.x.size());
      result.insert(result.end(), b.u.begin(), b.u.end());
    }
  }
  CHECK(results[0] == results[1]);
}

TEST_CASE("a straight yarn between two fixed ends, which no impulse can shorten, stays finite") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    Block b;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        b.x.set(b.slot_of(k, lane), {0.09 * k, 0, 0});
        const bool end = k == 0 || k + 1 == Block::length(lane);
        b.rows[k].inverse_mass[lane] = end ? 0.f : 1.f;
      }
    }
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.quads(b.u), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k < Block::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)]) < 2);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test
