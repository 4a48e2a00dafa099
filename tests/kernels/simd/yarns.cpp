/// Yarns against dense solutions in double, on every instruction set.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "engine/solvers/yarn/yarn_layout.h"
#include "tests/support/isas.h"
#include "tests/support/yarn_block.h"

namespace weft::test::kernels_simd_yarns {
namespace {

TEST_CASE("positions that do not move come back from two floats to the last bit") {
  for (const simd::Isa isa : supported_isas()) {
    BlockOfYarns b;
    for (std::size_t i = 0; i < b.x.size(); ++i) b.x.x[i] += 1000;
    b.start(simd::table(isa));
    const kernels::Vectors back = b.end(simd::table(isa));
    for (std::size_t i = 0; i < b.x.size(); ++i) {
      CHECK(kernels::length(back[i] - b.x[i]) == 0);
    }
  }
}

TEST_CASE("a sweep over a block solves each of its yarns exactly") {
  const BlockOfYarns untouched;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BlockOfYarns b;
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected = solved_densely(untouched, lane);
      for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 3e-8);
      }
    }
  }
}

TEST_CASE("a sweep solves springs exactly, and adds their impulses to their sums") {
  BlockOfYarns untouched;
  untouched.soften();
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    for (const Stand stand : kStands) {
      BlockOfYarns b(stand);
      b.soften();
      b.start(table);
      table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
      const kernels::Vectors moved = b.end(table);
      for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
        const auto expected = solved_densely(untouched, lane);
        for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
          CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 3e-8);
        }
      }
      CHECK(largest_strain(b, moved) < 0.1 * largest_strain(untouched, untouched.x));
      BlockOfYarns at_once(stand);
      at_once.soften();
      at_once.start(table);
      const simd::Swept swept = table.yarn_sweep_watched(
          at_once.yarns(), at_once.block(), at_once.u.data(), at_once.scratch.data(), 1e-5f, 20);
      CHECK(swept.within);
      CHECK(swept.solves > 1);
      CHECK(largest_strain(at_once, at_once.end(table)) < 1.1e-5);
    }
  }
}

/// What all kernels make of a block, one after the other.
std::vector<float> worked_on(BlockOfYarns& b, const simd::Table& table) {
  std::vector<float> result;
  const auto note = [&](const kernels::AlignedVector<float>& array) {
    const std::vector<float> values = b.of_particles(array);
    result.insert(result.end(), values.begin(), values.end());
  };
  float *u = b.u.data(), *t = b.t.data();
  simd::YarnScratch* scratch = b.scratch.data();
  const kernels::Vectors q = scattered(b.x, 0.02);
  for (const bool rattle : {false, true}) {
    if (rattle) b.keep_start(table, q);
    b.start(table);
    for (const float enough : {3e-4f, 1e-4f, 3e-5f, 1e-5f, 0.f}) {
      const auto swept = table.yarn_sweep_watched(b.yarns(), b.block(), u, scratch, enough, 4);
      result.push_back(static_cast<float>(swept.solves) + (swept.within ? 0.5f : 0.f));
    }
    note(b.u);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), u, scratch);
    note(b.u);
    table.yarn_linearise(b.yarns(), b.block(), u, scratch);
    for (const bool velocities : {false, true}) {
      if (velocities) result.push_back(table.yarn_read(b.yarns(), b.block(), u, scratch));
      const auto p = table.yarn_precondition(b.yarns(), b.block(), 0);
      result.push_back(p.product);
      result.push_back(p.worst);
      table.yarn_push_first(b.yarns(), b.block(), 0, t, scratch);
      table.yarn_push(b.yarns(), b.block(), 0.5f, t, scratch);
      note(b.t);
      const auto what = velocities ? simd::YarnElimination::errors : simd::YarnElimination::changes;
      table.yarn_eliminate(b.yarns(), b.block(), t, what, scratch);
      note(b.t);
      result.push_back(table.yarn_pull(b.yarns(), b.block(), t, scratch));
      table.yarn_precondition(b.yarns(), b.block(), 0.25f);
      table.yarn_finish(b.yarns(), b.block(), t, scratch);
      note(b.t);
    }
    table.yarn_add(u, t, 0, b.u.size());
    note(b.u);
  }
  return result;
}

TEST_CASE("in quads, in place or in patches: the same bits, and nothing beside the particles") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    for (const bool from_memory : {false, true}) {
      BlockOfYarns in_quads;
      in_quads.from_memory = from_memory;
      const std::vector<float> expected = worked_on(in_quads, simd::table(isa));
      CHECK(std::ranges::count(expected, 0.f) < std::ssize(expected) / 8);
      for (const Stand stand : {Stand::in_place, Stand::patches, Stand::singles}) {
        for (const std::uint32_t patches_ahead : {0u, 1u, 2u}) {
          CAPTURE(static_cast<int>(stand));
          CAPTURE(patches_ahead);
          BlockOfYarns b(stand);
          b.from_memory = from_memory;
          if (stand != Stand::in_place) b.add_patches_ahead(patches_ahead);
          CHECK(worked_on(b, simd::table(isa)) == expected);
          b.for_each_component([&](std::size_t, std::size_t place) { b.u[place] = 0; });
          CHECK(std::ranges::count(b.u, 0.f) == std::ssize(b.u));
        }
      }
    }
  }
}

TEST_CASE("lanes without yarns are passed over: the same bits, whatever the scratch holds") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    for (const Stand stand : kStands) {
      CAPTURE(static_cast<int>(stand));
      for (const std::uint32_t lanes : {2u, 4u, 5u, 8u, 9u, 12u}) {
        CAPTURE(lanes);
        BlockOfYarns all(stand), some(stand);
        for (BlockOfYarns* b : {&all, &some}) {
          for (simd::YarnRow& row : b->rows) {
            std::fill(row.rest + lanes, row.rest + kLanes, 0.f);
            std::fill(row.inverse_mass + lanes, row.inverse_mass + kLanes, 0.f);
          }
        }
        some.lanes = lanes;
        std::memset(some.scratch.data(), 0xff, some.scratch.size() * sizeof(simd::YarnScratch));
        CHECK(worked_on(some, simd::table(isa)) == worked_on(all, simd::table(isa)));
      }
    }
  }
}

TEST_CASE("a link whose ends coincide is solved together with its neighbour") {
  constexpr std::uint32_t kLane = 3;  // of three particles
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    BlockOfYarns b;
    const double rest = static_cast<double>(b.rows[0].rest[kLane]);
    for (std::uint32_t k = 0; k < 3; ++k) {
      b.rows[k].inverse_mass[kLane] = 1;
      b.x.set(b.slot_of(k, kLane), {0, k < 2 ? 0 : -rest, 0});
    }
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const kernels::Vector expected{0, (2.0 / 3 - k) * rest, 0};
      CHECK(kernels::length(moved[b.slot_of(k, kLane)] - expected) < 3e-8);
    }
  }
}

/// Ends that are as far apart as coinciding ones are taken to be, the other way.
void collapse_exactly(BlockOfYarns& b, std::uint32_t lane) {
  b.x.set(b.slot_of(0, lane), {0, 0, 0});
  b.x.set(b.slot_of(1, lane), {0, 0x1p-24 * b.cell, 0});
}

TEST_CASE("a link of length 0, after all, is swept finitely") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    BlockOfYarns b;
    collapse_exactly(b, 3);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    CHECK(std::ranges::all_of(b.u, [](float v) { return std::isfinite(v); }));
  }
}

TEST_CASE("a link of length 0 has a direction in the linear system, and others their solution") {
  constexpr std::uint32_t kLane = 3;
  for (const simd::Isa isa : supported_isas()) {
    for (const bool rattle : {false, true}) {
      CAPTURE(text(isa));
      CAPTURE(rattle);
      const simd::Table& table = simd::table(isa);
      BlockOfYarns usual, b;
      for (BlockOfYarns* each : {&usual, &b}) {
        kernels::Vectors q = each->x;
        if (each == &b) collapse_exactly(b, kLane);
        if (rattle) each->keep_start(table, each->x);
        each->x = rattle ? q : each->x;
        each->start(table);
        float* t = each->t.data();
        simd::YarnScratch* scratch = each->scratch.data();
        table.yarn_linearise(each->yarns(), each->block(), each->u.data(), scratch);
        const auto before = table.yarn_precondition(each->yarns(), each->block(), 0);
        table.yarn_push(each->yarns(), each->block(), 0, t, scratch);
        const float curvature = table.yarn_pull(each->yarns(), each->block(), t, scratch);
        const float alpha = before.product / curvature;
        CHECK(alpha == doctest::Approx(1).epsilon(1e-4));
        CHECK(table.yarn_precondition(each->yarns(), each->block(), alpha).worst < 1e-5f);
        table.yarn_finish(each->yarns(), each->block(), each->u.data(), scratch);
      }
      const kernels::Vectors moved = b.end(table), expected = usual.end(table);
      for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
        for (std::uint32_t k = 0; lane != kLane && k < BlockOfYarns::length(lane); ++k) {
          const std::uint32_t slot = b.slot_of(k, lane);
          CHECK(kernels::length(moved[slot] - expected[slot]) < 1e-6);
        }
      }
    }
  }
}

TEST_CASE("a base is a whole number of cells, and u what is left") {
  for (const simd::Isa isa : supported_isas()) {
    for (const double cell : {0x1p-4, 0x1p-10, 0x1p-20}) {
      BlockOfYarns b;
      b.cell = cell;
      b.start(simd::table(isa));
      for (std::size_t i = 0; i < b.base.size(); ++i) {
        CHECK(std::remainder(static_cast<double>(b.base[i]), cell) == 0);
        CHECK(std::abs(static_cast<double>(b.u[i])) <= cell / 2);
      }
    }
  }
}

void sweep_twice(BlockOfYarns& b, const simd::Table& table, bool remember) {
  b.start(table);
  table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
  b.placed = remember;
  table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
}

TEST_CASE("rows remember the base, or it is fetched: the same bits") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    for (const bool from_memory : {false, true}) {
      BlockOfYarns kept, fetched;
      kept.from_memory = fetched.from_memory = from_memory;
      sweep_twice(kept, simd::table(isa), true);
      sweep_twice(fetched, simd::table(isa), false);
      CHECK(kept.u == fetched.u);
      const auto before = kept.u;
      std::ranges::fill(kept.base, std::numeric_limits<float>::quiet_NaN());
      simd::table(isa).yarn_sweep(kept.yarns(), kept.block(), kept.u.data(), kept.scratch.data());
      CHECK(kept.u != before);
      CHECK(std::ranges::all_of(kept.u, [](float f) { return std::isfinite(f); }));
    }
  }
}

TEST_CASE("links too long for rows to remember are solved all the same") {
  constexpr std::uint32_t kLane = 9;
  struct Case {
    double cell;
    kernels::Vector stretch;  // of one link
  };
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    for (const Case c : {Case{0x1p-10, {511 * 0x1p-10, 0, 0}},
                         {0x1p-10, {513 * 0x1p-10, 0, 0}},
                         {0x1p-10, {0, 513 * 0x1p-10, 0}},
                         {0x1p-10, {0, 0, 513 * 0x1p-10}},
                         {0x1p-10, {1e6, 0, 0}},
                         {0x1p-30, {0, 0, 0}},
                         {0, {0, 0, 0}}}) {
      CAPTURE(c.cell);
      CAPTURE(c.stretch.x);
      CAPTURE(c.stretch.y);
      CAPTURE(c.stretch.z);
      BlockOfYarns kept, fetched;
      for (BlockOfYarns* b : {&kept, &fetched}) {
        b->cell = c.cell;
        const kernels::Vector end = b->x[b->slot_of(kLane - 2, kLane)];
        if (kernels::length(c.stretch) > 0) b->x.set(b->slot_of(kLane - 1, kLane), end - c.stretch);
      }
      sweep_twice(kept, simd::table(isa), true);
      sweep_twice(fetched, simd::table(isa), false);
      CHECK(kept.u == fetched.u);
    }
  }
}

TEST_CASE("what in patches is nobody's stays 0, whatever the scratch held") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    const simd::Table& table = simd::table(isa);
    BlockOfYarns b(Stand::patches);
    b.start(table);
    table.yarn_linearise(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    for (simd::YarnScratch& row : b.scratch) {
      std::ranges::fill(row.floats, 1e30f);
    }
    table.yarn_push_first(b.yarns(), b.block(), 0, b.t.data(), b.scratch.data());
    b.for_each_component([&](std::size_t, std::size_t place) { b.t[place] = 0; });
    CHECK(std::ranges::all_of(b.t, [](float t) { return t == 0; }));
  }
}

TEST_CASE("rattle: a sweep solves each yarn exactly, along the directions at the start") {
  const BlockOfYarns untouched;
  const kernels::Vectors q = scattered(untouched.x, 0.02);
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BlockOfYarns b;
    const simd::Table& table = simd::table(isa);
    b.keep_start(table, q);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      const auto expected =
          solved_densely(untouched, lane, untouched.x, directions(untouched, untouched.x, lane),
                         directions(untouched, q, lane), length_errors(untouched, lane));
      for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)] - expected[k]) < 1e-7);
      }
    }
  }
}

TEST_CASE("yarns: AVX2 and AVX-512 give the same bits") {
  if (!simd::supported(simd::Isa::avx512)) return;
  for (const Stand stand : kStands) {
    BlockOfYarns one(stand), other(stand);
    CHECK(worked_on(one, simd::table(simd::Isa::avx2)) ==
          worked_on(other, simd::table(simd::Isa::avx512)));
  }
}

TEST_CASE("a straight yarn between two fixed ends, which no impulse can shorten, stays finite") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    BlockOfYarns b;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
        b.x.set(b.slot_of(k, lane), {0.09 * k, 0, 0});
        const bool end = k == 0 || k + 1 == BlockOfYarns::length(lane);
        b.rows[k].inverse_mass[lane] = end ? 0.f : 1.f;
      }
    }
    const simd::Table& table = simd::table(isa);
    b.start(table);
    table.yarn_sweep(b.yarns(), b.block(), b.u.data(), b.scratch.data());
    const kernels::Vectors moved = b.end(table);
    for (std::uint32_t lane = 2; lane < kLanes; ++lane) {
      for (std::uint32_t k = 0; k < BlockOfYarns::length(lane); ++k) {
        CHECK(kernels::length(moved[b.slot_of(k, lane)]) < 2);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_yarns
