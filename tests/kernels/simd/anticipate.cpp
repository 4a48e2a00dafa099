/// The anticipating form of relaxation against the displacement form: the same iterates, up to
/// float rounding.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "perf/workbench.h"
#include "tests/support/isas.h"

namespace weft::test {
namespace {

using perf::Piece;
using perf::Workbench;

void renew(Workbench& bench, const simd::Table& table, const simd::Relaxation& r) {
  const simd::Geometry g = bench.geometry();
  for (const Piece& piece : bench.pieces) {
    if (piece.singles) {
      table.renew_singles(g, r, piece.first(), piece.last());
    } else {
      table.renew_run(g, r, piece.run);
    }
  }
}

std::uint32_t sweep(const Workbench& bench, const simd::Table& table, const simd::Relaxation& r) {
  std::uint32_t corrections = 0;
  for (const Piece& piece : bench.pieces) {
    corrections += piece.singles ? table.relax_singles(r, piece.first(), piece.last())
                                 : table.relax_run(r, piece.run);
  }
  return corrections;
}

std::uint32_t sweep(const Workbench& bench, const simd::Table& table, const simd::Anticipation& p) {
  std::uint32_t corrections = 0;
  for (const Piece& piece : bench.pieces) {
    corrections += piece.singles ? table.relax_anticipated_singles(p, piece.first(), piece.last())
                                 : table.relax_anticipated_run(p, piece.run);
  }
  return corrections;
}

void renew_products(Workbench& bench, const simd::Table& table, const simd::Anticipation& p,
                    const simd::Relaxation& r) {
  for (const Piece& piece : bench.pieces) {
    if (piece.singles) {
      table.renew_products_singles(p, r, piece.first(), piece.last());
    } else {
      table.renew_products_run(p, r, piece.run);
    }
  }
}

void apply_sums(const Workbench& bench, const simd::Table& table, const simd::Anticipation& p,
                const simd::Relaxation& r) {
  for (const Piece& piece : bench.pieces) {
    if (piece.singles) {
      table.apply_sums_singles(p, r, piece.first(), piece.last());
    } else {
      table.apply_sums_run(p, r, piece.run);
    }
  }
}

/// Planar displacements of all slots, x y z.
std::vector<float> displacements(const Workbench& bench, const simd::Relaxation& r) {
  std::vector<float> all;
  for (const float* axis : {r.u.x, r.u.y(), r.u.z()}) {
    all.insert(all.end(), axis, axis + bench.slots());
  }
  return all;
}

struct Difference {
  float largest = 0, scale = 0;
  std::uint32_t corrections[2] = {0, 0};
};

Difference compare(Workbench& bench, const simd::Table& table, float threshold, int sweeps) {
  Difference d;
  simd::Relaxation r = bench.relaxation();
  r.threshold = threshold;
  renew(bench, table, r);
  for (int i = 0; i < sweeps; ++i) d.corrections[0] += sweep(bench, table, r);
  const std::vector<float> expected = displacements(bench, r);

  r = bench.relaxation();  // back to the start
  renew(bench, table, r);
  const simd::Anticipation p = bench.pulls().anticipation(threshold);
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
      const Difference d = compare(bench, simd::table(isa), 0, 40);
      CHECK(d.scale > 0);
      CHECK(d.largest <= 2e-5f * d.scale);
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
}  // namespace weft::test
