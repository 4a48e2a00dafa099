/// One pass over a batch against plain scalar code: every bit that kernels write, and nothing
/// written beyond.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "tests/support/kernel_data.h"

namespace weft::test::kernels_simd_relax {
namespace {

enum class Kind { distance, rope };

/// Visits constraint c between two slots; whether it was corrected.
bool visit(const Rounding& rounding, KernelData& data, std::uint32_t c, std::uint32_t a,
           std::uint32_t b, Kind kind, float threshold) {
  const float e = data.error(rounding, c, a, b);
  if (!(std::abs(e) > threshold)) return false;
  const float change = kind == Kind::rope ? std::max(e, -data.impulse[c]) : e;
  if (change == 0) return false;
  const Lane lane = data.lane(c);
  if (kind == Kind::rope) data.impulse[c] += change;
  data.move(rounding, a, change * lane.gain_a, lane);
  data.move(rounding, b, change * lane.gain_b, lane);
  return true;
}

std::uint32_t visit_run(const Rounding& rounding, KernelData& data, const Run& run, Kind kind,
                        float threshold) {
  std::uint32_t corrections = 0;
  for (std::uint32_t k = 0; k < run.length; ++k) {
    corrections += visit(rounding, data, run.constraint + k, run.a + k, run.b + k, kind, threshold);
  }
  return corrections;
}

std::uint32_t visit_singles(const Rounding& rounding, KernelData& data, std::uint32_t first,
                            std::uint32_t last, Kind kind, float threshold) {
  std::uint32_t corrections = 0;
  for (std::uint32_t c = first; c < last; ++c) {
    corrections += visit(rounding, data, c, data.a[c], data.b[c], kind, threshold);
  }
  return corrections;
}

/// The same of constraints that may be springs.
bool visit_spring(const Rounding& rounding, KernelData& data, std::uint32_t c, std::uint32_t a,
                  std::uint32_t b, bool rope, float threshold) {
  const float sum = data.impulse[c];
  float change = rounding.fused(-data.compliance_share[c], sum, data.error(rounding, c, a, b));
  if (!(std::abs(change) > threshold)) return false;
  if (rope) change = std::max(change, -(data.held[c] + sum));
  if (change == 0) return false;
  const Lane lane = data.lane(c);
  data.impulse[c] += change;
  data.move(rounding, a, change * lane.gain_a, lane);
  data.move(rounding, b, change * lane.gain_b, lane);
  return true;
}

std::uint32_t visit_spring_run(const Rounding& rounding, KernelData& data, bool rope,
                               float threshold) {
  const Run& run = data.run;
  std::uint32_t corrections = 0;
  for (std::uint32_t k = 0; k < run.length; ++k) {
    corrections +=
        visit_spring(rounding, data, run.constraint + k, run.a + k, run.b + k, rope, threshold);
  }
  return corrections;
}

std::uint32_t visit_spring_singles(const Rounding& rounding, KernelData& data, bool rope,
                                   float threshold) {
  std::uint32_t corrections = 0;
  for (std::uint32_t c = data.first; c < data.last; ++c) {
    corrections += visit_spring(rounding, data, c, data.a[c], data.b[c], rope, threshold);
  }
  return corrections;
}

/// f(isa, table, threshold, data) for every instruction set, length and threshold: some corrected,
/// all corrected, none corrected.
template <class F>
void for_every_length(F f) {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const float threshold : {1.0f, 0.0f, 1e9f}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(threshold);
        f(isa, simd::table(isa), threshold, KernelData(length, length + 5));
      }
    }
  }
}

/// The kernel's count, as a test that can fail: some but not all at threshold 1.
void check_count(std::uint32_t found, std::uint32_t expected, std::uint32_t length,
                 float threshold) {
  CHECK(found == expected);
  if (threshold == 1) CHECK((found > 0 && found < length));
  if (threshold == 0) CHECK(found > length / 2);
  if (threshold > 1) CHECK(found == 0);
}

TEST_CASE("runs of distance constraints and of ropes") {
  for (const Kind kind : {Kind::distance, Kind::rope}) {
    for (const bool from_memory : {false, true}) {
      for_every_length(
          [&](simd::Isa isa, const simd::Table& table, float threshold, KernelData found) {
            KernelData expected = found;
            simd::BlockRelaxation r = found.relaxation(threshold);
            r.from_memory = from_memory;
            const auto kernel = kind == Kind::rope ? table.relax_rope_run : table.relax_run;
            for (int pass = 0; pass < 3; ++pass) {
              const auto count = kernel(r, found.run);
              const auto wanted = visit_run(Rounding(isa), expected, expected.run, kind, threshold);
              if (pass == 0) check_count(count, wanted, found.run.length, threshold);
              REQUIRE(count == wanted);
              REQUIRE(same(found, expected));
            }
          });
    }
  }
}

TEST_CASE("singles of distance constraints and of ropes") {
  for (const Kind kind : {Kind::distance, Kind::rope}) {
    for_every_length(
        [&](simd::Isa isa, const simd::Table& table, float threshold, KernelData found) {
          KernelData expected = found;
          const simd::BlockRelaxation r = found.relaxation(threshold);
          const auto kernel = kind == Kind::rope ? table.relax_rope_singles : table.relax_singles;
          for (int pass = 0; pass < 3; ++pass) {
            const auto count = kernel(r, found.first, found.last);
            const auto wanted =
                visit_singles(Rounding(isa), expected, found.first, found.last, kind, threshold);
            if (pass == 0) check_count(count, wanted, found.run.length, threshold);
            REQUIRE(count == wanted);
            REQUIRE(same(found, expected));
          }
        });
  }
}

TEST_CASE("springs and ropes that are springs: in runs, as singles, and one after the other") {
  for (const bool rope : {false, true}) {
    CAPTURE(rope);
    for_every_length(
        [&](simd::Isa isa, const simd::Table& table, float threshold, KernelData start) {
          KernelData found[3] = {start, start, start}, expected[3] = {start, start, start};
          for (int pass = 0; pass < 3; ++pass) {
            const std::uint32_t first = start.first, last = start.last;
            const std::uint32_t counts[3] = {
                table.relax_spring_run(found[0].relaxation(threshold), start.run, rope),
                table.relax_spring_singles(found[1].relaxation(threshold), first, last, rope),
                table.relax_spring_serial(found[2].relaxation(threshold), first, last, rope)};
            const Rounding rounding(isa);
            const std::uint32_t wanted[3] = {
                visit_spring_run(rounding, expected[0], rope, threshold),
                visit_spring_singles(rounding, expected[1], rope, threshold),
                visit_spring_singles(rounding, expected[2], rope, threshold)};
            for (int i = 0; i < 3; ++i) {
              CAPTURE(i);
              if (pass == 0) check_count(counts[i], wanted[i], start.run.length, threshold);
              REQUIRE(counts[i] == wanted[i]);
              REQUIRE(same(found[i], expected[i]));
            }
          }
        });
  }
}

TEST_CASE("serial constraints see what the one before them did, in any number") {
  for (const Kind kind : {Kind::distance, Kind::rope}) {
    for_every_length([&](simd::Isa isa, const simd::Table& table, float threshold,
                         KernelData found) {
      for (std::uint32_t c = found.first; c < found.last; ++c) found.a[c] = 7;  // a hub
      for (std::uint32_t& slot : found.b) slot += slot == 7;
      KernelData expected = found;
      const simd::BlockRelaxation r = found.relaxation(threshold);
      const auto kernel = kind == Kind::rope ? table.relax_rope_serial : table.relax_serial;
      for (const std::uint32_t last : {found.first, found.first + 1, found.last - 3}) {
        const auto count = kernel(r, found.first, last);
        CHECK(count == visit_singles(Rounding(isa), expected, found.first, last, kind, threshold));
        CHECK(same(found, expected));
      }
    });
  }
}

TEST_CASE("many runs in one call: those that are wanted, one by one") {
  for_every_length([](simd::Isa isa, const simd::Table& table, float threshold, KernelData found) {
    std::vector<Run> runs;
    std::vector<std::uint8_t> wanted;
    for (std::uint32_t k = 0; k < found.run.length; k += kLanes) {
      runs.push_back({found.run.a + k, found.run.b + k, found.run.constraint + k, kLanes});
      wanted.push_back(runs.size() % 3 != 2);
    }
    for (const bool all : {true, false}) {
      KernelData data = found, expected = found;
      std::vector<std::uint32_t> counts(runs.size() + 1, 77);
      table.relax_runs(data.relaxation(threshold), runs.data(), runs.size(),
                       all ? nullptr : wanted.data(), counts.data());
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const bool visited = all || wanted[i] != 0;
        CHECK(
            counts[i] ==
            (visited ? visit_run(Rounding(isa), expected, runs[i], Kind::distance, threshold) : 0));
      }
      CHECK(counts.back() == 77);
      CHECK(same(data, expected));
    }
  });
}

TEST_CASE("padding moves nothing, not even where its slots are far out") {
  for (const simd::Isa isa : supported_isas()) {
    for (const float threshold : {0.0f, 1.0f}) {
      CAPTURE(text(isa));
      CAPTURE(threshold);
      KernelData data(64, 9);
      for (std::uint32_t c = data.first; c < data.last; ++c) data.make_padding(c);
      for (std::size_t i = 0; i < data.u.size(); i += 2) data.u[i] *= 1e30f;
      const KernelData before = data;
      const simd::BlockRelaxation r = data.relaxation(threshold);
      const simd::Table& t = simd::table(isa);
      std::uint64_t visits = 0;
      std::ranges::fill(data.mask, 1u);
      std::uint32_t corrections = t.relax_run(r, data.run) + t.relax_rope_run(r, data.run) +
                                  t.relax_singles(r, data.first, data.last) +
                                  t.relax_rope_singles(r, data.first, data.last) +
                                  t.relax_serial(r, data.first, data.last) +
                                  t.relax_rope_serial(r, data.first, data.last) +
                                  t.relax_masked_run(r, data.run, 1, visits);
      CHECK(corrections == 0);
      data.mask = before.mask;
      CHECK(same(data, before));
    }
  }
}

TEST_CASE("a rope pulls only, and gives back no more than it pulled") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    KernelData data(128, 10);
    const simd::BlockRelaxation r = data.relaxation(0);
    float before = 0, after = 0;
    for (std::uint32_t c = data.first; c < data.last; ++c) before += data.impulse[c];
    for (int pass = 0; pass < 5; ++pass) {
      simd::table(isa).relax_rope_run(r, data.run);
      for (std::uint32_t c = data.first; c < data.last; ++c) {
        REQUIRE(data.impulse[c] >= 0);
        if (!data.is_padding(c)) data.blocks[c / kLanes].e0[c % kLanes] -= 1;  // ever slacker
      }
    }
    for (std::uint32_t c = data.first; c < data.last; ++c) after += data.impulse[c];
    CHECK(after < 0.1f * before);
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_relax
