/// The anticipating form of relaxation against the displacement form: the same iterates, up to
/// float rounding.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/solvers/sweeps/pull_layout.h"
#include "perf/workbench.h"
#include "tests/support/isas.h"

namespace weft::test::kernels_simd_anticipate {
namespace {

using perf::Piece;
using perf::Workbench;

void renew(Workbench& bench, const simd::Table& table, const simd::BlockRelaxation& r) {
  const simd::Geometry g = bench.geometry();
  for (const Piece& piece : bench.pieces) {
    if (piece.singles) {
      table.renew_singles(g, r, piece.first(), piece.last());
    } else {
      table.renew_run(g, r, piece.run);
    }
  }
}

std::uint32_t sweep(const Workbench& bench, const simd::Table& table,
                    const simd::BlockRelaxation& r) {
  std::uint32_t corrections = 0;
  for (const Piece& piece : bench.pieces) {
    corrections += piece.singles ? table.relax_singles(r, piece.first(), piece.last())
                                 : table.relax_run(r, piece.run);
  }
  return corrections;
}

std::uint32_t sweep(Workbench& bench, const simd::Table& table, const simd::Anticipation& p) {
  std::uint32_t corrections = 0;
  for (const Piece& piece : bench.pieces) {
    bench.pulls().for_each_stretch(
        piece.first(), piece.last(), [&](std::uint32_t first, std::uint32_t last, bool scattered) {
          corrections += scattered ? table.relax_anticipated_singles(p, first, last)
                                   : table.relax_anticipated_run(p, {0, 0, first, last - first});
        });
  }
  return corrections;
}

void renew_products(Workbench& bench, const simd::Table& table, const simd::Anticipation& p,
                    const simd::BlockRelaxation& r) {
  for (const Piece& piece : bench.pieces) {
    bench.pulls().for_each_stretch(piece.first(), piece.last(),
                                   [&](std::uint32_t first, std::uint32_t last, bool scattered) {
                                     if (scattered) {
                                       table.renew_products_singles(p, r, first, last);
                                     } else {
                                       table.renew_products_run(p, r, {0, 0, first, last - first});
                                     }
                                   });
  }
}

void apply_sums(const Workbench& bench, const simd::Table& table, const simd::Anticipation& p,
                const simd::BlockRelaxation& r) {
  for (const Piece& piece : bench.pieces) {
    if (piece.singles) {
      table.apply_sums_singles(p, r, piece.first(), piece.last());
    } else {
      table.apply_sums_run(p, r, piece.run);
    }
  }
}

void refresh_errors(const Workbench& bench, const simd::Table& table, const simd::Anticipation& p,
                    const simd::BlockRelaxation& r) {
  for (const Piece& piece : bench.pieces) {
    if (piece.singles) {
      table.refresh_errors_singles(p, r, piece.first(), piece.last());
    } else {
      table.refresh_errors_run(p, r, piece.run);
    }
  }
}

/// Displacements of all slots, x y z.
std::vector<float> displacements(const Workbench& bench, const simd::BlockRelaxation& r) {
  std::vector<float> all;
  for (const float* axis : {r.u.x, r.u.y(), r.u.z()}) {
    for (std::size_t slot = 0; slot < bench.slots(); ++slot) all.push_back(axis[slot * r.u.step]);
  }
  return all;
}

struct Difference {
  float largest = 0, scale = 0;
  std::uint32_t corrections[2] = {0, 0};
};

Difference compare(Workbench& bench, const simd::Table& table, float threshold, int sweeps,
                   bool in_quads = false) {
  Difference d;
  simd::BlockRelaxation r = bench.relaxation(in_quads);
  r.threshold = threshold;
  renew(bench, table, r);
  for (int i = 0; i < sweeps; ++i) d.corrections[0] += sweep(bench, table, r);
  const std::vector<float> expected = displacements(bench, r);

  r = bench.relaxation(in_quads);  // back to the start
  renew(bench, table, r);
  const simd::Anticipation p = bench.anticipation(threshold);
  renew_products(bench, table, p, r);
  for (int i = 0; i < sweeps; ++i) d.corrections[1] += sweep(bench, table, p);
  apply_sums(bench, table, p, r);
  const std::vector<float> found = displacements(bench, r);
  for (std::size_t i = 0; i < found.size(); ++i) {
    d.largest = std::max(d.largest, std::abs(found[i] - expected[i]));
    d.scale = std::max(d.scale, std::abs(expected[i]));
  }
  return d;
}

struct Mesh {
  const char* name;
  int size;
  bool singles;
};
constexpr Mesh kMeshes[] = {
    {"grid", 2, false}, {"grid", 20, false},      {"grid", 90, false},  // several tiles
    {"grid", 20, true}, {"irregular", 20, false}, {"irregular", 90, false},
};

TEST_CASE("both forms move every particle to the same place") {
  perf::Workshop workshop;
  for (const Mesh& mesh : kMeshes) {
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(mesh.name);
      CAPTURE(mesh.size);
      CAPTURE(mesh.singles);
      CAPTURE(static_cast<int>(isa));
      Workbench& bench = workshop.get(mesh.name, mesh.size, mesh.singles);
      // Sums of some forty corrections, each rounded to a part in 10^7.
      for (const bool in_quads : {false, true}) {
        if (in_quads && !bench.runs.empty() && !bench.pieces.front().singles) continue;
        CAPTURE(in_quads);
        const Difference d = compare(bench, simd::table(isa), 0, 40, in_quads);
        CHECK(d.scale > 0);
        CHECK(d.largest <= 2e-5f * d.scale);
      }
    }
  }
}

/// Errors, changes and sums after some passes and what ends them.
TEST_CASE("sums are applied once, and errors are those of the displacements they become") {
  perf::Workshop workshop;
  for (const Mesh& mesh : kMeshes) {
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(mesh.name);
      CAPTURE(mesh.size);
      CAPTURE(mesh.singles);
      CAPTURE(static_cast<int>(isa));
      Workbench& bench = workshop.get(mesh.name, mesh.size, mesh.singles);
      const simd::Table& table = simd::table(isa);
      const bool in_quads = bench.pieces.front().singles;
      const simd::BlockRelaxation r = bench.relaxation(in_quads);
      renew(bench, table, r);
      const simd::Anticipation p = bench.anticipation(0);
      renew_products(bench, table, p, r);
      for (int i = 0; i < 3; ++i) sweep(bench, table, p);
      apply_sums(bench, table, p, r);
      const std::vector<float> once = displacements(bench, r);
      apply_sums(bench, table, p, r);
      CHECK(displacements(bench, r) == once);
      refresh_errors(bench, table, p, r);
      float largest = 0, off = 0;
      for (std::size_t c = 0; c < bench.constraint_slots(); ++c) {
        const simd::ConstraintBlock& block = r.blocks[c / kLanes];
        const std::size_t lane = c % kLanes;
        const std::size_t a = r.a[c] * r.u.step, b = r.b[c] * r.u.step;
        const double e = block.e0[lane] + double{block.nx[lane]} * (r.u.x[a] - r.u.x[b]) +
                         double{block.ny[lane]} * (r.u.y()[a] - r.u.y()[b]) +
                         double{block.nz[lane]} * (r.u.z()[a] - r.u.z()[b]);
        largest = std::max(largest, std::abs(block.e0[lane]));
        off = std::max(off, std::abs(static_cast<float>(e) - p.error[c]));
        REQUIRE(p.change[c] == 0);
        REQUIRE(p.sum[c] == 0);
      }
      CHECK(largest > 0);
      CHECK(off <= 1e-6f * largest);
    }
  }
}

/// Whether an end of one is an end of the other.
bool meet(const Ordering& ordering, std::size_t c, std::size_t j) {
  const auto is_end = [&](std::uint32_t slot) {
    return slot == ordering.a[c] || slot == ordering.b[c];
  };
  return is_end(ordering.a[j]) || is_end(ordering.b[j]);
}

/// Of constraint c alone, whose error is 1, when none that it meets has changed and all others have
/// diverged.
float change_among_diverged(Workbench& bench, const simd::Table& table, std::size_t c) {
  const simd::BlockRelaxation r = bench.relaxation(bench.pieces.front().singles);
  const simd::Anticipation p = bench.anticipation(0);
  renew(bench, table, r);
  r.blocks[c / kLanes].e0[c % kLanes] = 1;
  const auto for_each_other = [&](auto&& diverge) {
    for (std::size_t j = 0; j < bench.constraint_slots(); ++j) {
      if (!meet(bench.ordering, c, j)) diverge(j);
    }
  };
  for_each_other([&](std::size_t j) {
    r.blocks[j / kLanes].nx[j % kLanes] = std::numeric_limits<float>::quiet_NaN();
  });
  renew_products(bench, table, p, r);
  std::fill_n(p.change, bench.constraint_slots(), 0.f);
  for_each_other([&](std::size_t j) { p.change[j] = std::numeric_limits<float>::infinity(); });
  const auto first = static_cast<std::uint32_t>(c / kLanes * kLanes);
  bench.pulls().for_each_stretch(first, first + kLanes, [&](auto begin, auto end, bool scattered) {
    scattered ? table.relax_anticipated_singles(p, begin, end)
              : table.relax_anticipated_run(p, {0, 0, begin, end - begin});
  });
  return p.change[c];
}

// Lanes without a neighbour read all the same.
TEST_CASE("a constraint pulls nothing from those that it does not meet, even if they diverge") {
  perf::Workshop workshop;
  for (const Mesh& mesh : {Mesh{"grid", 12, false}, {"grid", 12, true}, {"irregular", 9, false}}) {
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(mesh.name);
      CAPTURE(mesh.singles);
      CAPTURE(static_cast<int>(isa));
      Workbench& bench = workshop.get(mesh.name, mesh.size, mesh.singles);
      std::size_t checked = 0;
      for (std::size_t c = 0; c < bench.constraint_slots(); ++c) {
        if (bench.ordering.link_at[c] == kNoIndex) continue;
        REQUIRE(change_among_diverged(bench, simd::table(isa), c) == 1);
        ++checked;
      }
      CHECK(checked == bench.constraints);
    }
  }
}

TEST_CASE("both forms correct the same constraints where some are within tolerance") {
  perf::Workshop workshop;
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(static_cast<int>(isa));
    Workbench& bench = workshop.get("grid", 12, false);
    const Difference d = compare(bench, simd::table(isa), 0.005f, 10);
    CHECK(d.corrections[0] > 0);
    CHECK(d.corrections[0] < 10 * bench.constraints / 2);
    CHECK(d.corrections[1] == d.corrections[0]);
    CHECK(d.largest <= 1e-5f * d.scale);
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_anticipate
