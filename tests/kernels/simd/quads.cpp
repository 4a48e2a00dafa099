/// Displacements in quads against planar ones: a layout, not an approximation. The same bits.
#include <doctest/doctest.h>

#include <vector>

#include "perf/workbench.h"
#include "tests/support/isas.h"

namespace weft::test::kernels_simd_quads {
namespace {

using perf::Piece;
using perf::Workbench;

/// Positions after some sweeps over an irregular mesh, pass by pass by another kernel.
std::vector<double> moved(bool in_quads, const simd::Table& table) {
  Workbench bench(perf::irregular(20), {});
  const simd::BlockRelaxation r = bench.relaxation(in_quads);
  std::uint32_t corrections = 0;
  for (int i = 0; i < 5; ++i) {
    for (const Piece& piece : bench.pieces) {
      REQUIRE(piece.singles);
      corrections += table.relax_singles(r, piece.first(), piece.last());
      corrections += table.relax_rope_singles(r, piece.first(), piece.last());
      corrections += table.relax_serial(r, piece.first(), piece.last());
      corrections += table.relax_rope_serial(r, piece.first(), piece.last());
    }
  }
  CHECK(corrections > 0);
  table.apply_displacements(bench.solved.view(), r.u, 0, bench.slots());
  for (std::size_t i = 0; i < bench.slots(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK(r.u.x[i * r.u.step + axis * r.u.stride] == 0);
    }
  }
  std::vector<double> all;
  for (const auto* axis : {&bench.solved.x, &bench.solved.y, &bench.solved.z}) {
    all.insert(all.end(), axis->begin(), axis->end());
  }
  return all;
}

TEST_CASE("quads and planar displacements give the same bits") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(static_cast<int>(isa));
    const bool same = moved(true, simd::table(isa)) == moved(false, simd::table(isa));
    CHECK(same);
  }
}

/// Contacts of one sphere, the last slot, with the first particles.
std::vector<float> touched(bool in_quads, const simd::Table& table) {
  constexpr std::uint32_t kContacts = 3 * kLanes;
  Workbench bench(perf::irregular(20), {});
  simd::BlockRelaxation r = bench.relaxation(in_quads);
  kernels::AlignedVector<simd::ConstraintBlock> blocks(kContacts / kLanes);
  std::vector<std::uint32_t> a(kContacts, static_cast<std::uint32_t>(bench.slots() - 1)), b;
  perf::Random random(3);
  for (std::uint32_t c = 0; c < kContacts; ++c) {
    simd::ConstraintBlock& block = blocks[c / kLanes];
    const std::uint32_t lane = c % kLanes;
    for (float* value : {&block.nx[lane], &block.ny[lane], &block.nz[lane], &block.e0[lane]}) {
      *value = static_cast<float>(random.unit() - 0.5);
    }
    block.gain_a[lane] = -0.1f;
    block.gain_b[lane] = 0.5f;
    b.push_back(c);
  }
  r.blocks = blocks.data();
  r.a = a.data();
  r.b = b.data();
  for (int i = 0; i < 3; ++i) CHECK(table.relax_contacts(r, 0, kContacts) > 0);
  std::vector<float> all;
  for (std::size_t i = 0; i < bench.slots(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all.push_back(r.u.x[i * r.u.step + axis * r.u.stride]);
    }
  }
  return all;
}

TEST_CASE("contacts push the same in quads and planar") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(static_cast<int>(isa));
    const bool same = touched(true, simd::table(isa)) == touched(false, simd::table(isa));
    CHECK(same);
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_quads
