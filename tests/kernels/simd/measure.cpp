/// Strain against plain scalar code, and against its definition.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <vector>

#include "tests/support/kernel_data.h"

namespace weft::test::kernels_simd_measure {
namespace {

using kernels::Vector;

double strain(const Rounding& rounding, const KernelData& data, std::uint32_t c, Vector d,
              bool rope) {
  if (data.is_padding(c)) return 0;
  const double stretch = std::sqrt(data.inverse_square[c] * rounding.dot(d, d)) - 1;
  return rope ? std::max(stretch, 0.0) : std::abs(stretch);
}

Vector between_ends(const KernelData& data, std::uint32_t c, bool singles) {
  const std::uint32_t k = c - data.first;
  return data.position[singles ? data.a[c] : data.run.a + k] -
         data.position[singles ? data.b[c] : data.run.b + k];
}

/// Sixteen columns, whatever the width of a vector, then the columns in order.
simd::StrainSums expected_sums(const Rounding& rounding, const KernelData& data, bool singles,
                               bool rope) {
  double squares[kLanes] = {};
  simd::StrainSums sums;
  for (std::uint32_t c = data.first; c < data.last; ++c) {
    const std::uint32_t k = c - data.first;
    const double s = strain(rounding, data, c, between_ends(data, c, singles), rope);
    sums.largest = std::max(sums.largest, s);
    squares[k % kLanes] = rounding.fused(s, s, squares[k % kLanes]);
  }
  for (const double column : squares) sums.squares += column;
  return sums;
}

TEST_CASE("strains are those of the positions, ropes' and padding's left out where they should") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const bool singles : {false, true}) {
        for (const bool rope : {false, true}) {
          CAPTURE(text(isa));
          CAPTURE(length);
          CAPTURE(singles);
          CAPTURE(rope);
          KernelData data(length, length + 9);
          const KernelData before = data;
          const simd::Table& table = simd::table(isa);
          const simd::StrainSums sums =
              singles ? table.strain_singles(data.geometry(), data.first, data.last, rope)
                      : table.strain_run(data.geometry(), data.run, rope);
          const simd::StrainSums wanted = expected_sums(Rounding(isa), data, singles, rope);
          CHECK(sums.largest == wanted.largest);
          CHECK(sums.squares == wanted.squares);
          CHECK(sums.largest > 0);
          CHECK(same(data, before));
        }
      }
    }
  }
}

/// Every third constraint is no spring.
struct Stiffness {
  std::vector<double> compliance, inverse_masses;

  explicit Stiffness(const KernelData& data) {
    for (std::uint32_t c = 0; c < data.last; ++c) {
      const bool is_spring = !data.is_padding(c) && c % 3 != 0;
      compliance.push_back(is_spring ? 1e-4 * (1 + c % 7)
                                     : std::numeric_limits<double>::infinity());
      inverse_masses.push_back(is_spring ? 10. * (1 + c % 5) : 0);
    }
  }
};

double expected_energy(const Rounding& rounding, const KernelData& data, const Stiffness& s,
                       double give, bool singles, bool rope) {
  double columns[kLanes] = {}, sum = 0;
  for (std::uint32_t c = data.first; c < data.last; ++c) {
    const Vector d = between_ends(data, c, singles);
    double stretch = std::sqrt(rounding.dot(d, d)) - data.rest_length[c];
    if (rope) stretch = std::max(stretch, 0.);
    const double compliance = rounding.fused(give, s.inverse_masses[c], s.compliance[c]);
    columns[(c - data.first) % kLanes] += 0.5 * stretch * stretch / compliance;
  }
  for (const double column : columns) sum += column;
  return sum;
}

TEST_CASE("the energy of springs is stretch^2 / (2 compliance), of what is rigid nothing") {
  constexpr double kGive = 1e-5;
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const bool singles : {false, true}) {
        for (const bool rope : {false, true}) {
          CAPTURE(text(isa));
          CAPTURE(length);
          CAPTURE(singles);
          CAPTURE(rope);
          KernelData data(length, length + 3);
          const Stiffness stiffness(data);
          const simd::SpringStiffness s{stiffness.compliance.data(),
                                        stiffness.inverse_masses.data(), kGive};
          const simd::Table& table = simd::table(isa);
          const double energy =
              singles ? table.spring_energy_singles(data.geometry(), s, data.first, data.last, rope)
                      : table.spring_energy_run(data.geometry(), s, data.run, rope);
          CHECK(energy == expected_energy(Rounding(isa), data, stiffness, kGive, singles, rope));
          CHECK(energy > 0);
        }
      }
    }
  }
}

simd::StretchRange expected_range(const Rounding& rounding, const KernelData& data, bool singles,
                                  bool rope) {
  simd::StretchRange range;
  for (std::uint32_t c = data.first; c < data.last; ++c) {
    if (data.is_padding(c)) continue;
    const Vector d = between_ends(data, c, singles);
    const double ratio = data.inverse_square[c] * rounding.dot(d, d);
    range.most = std::max(range.most, ratio);
    if (!rope) range.least = std::min(range.least, ratio);
  }
  return range;
}

TEST_CASE("the range of stretches holds the largest strain") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const bool singles : {false, true}) {
        for (const bool rope : {false, true}) {
          CAPTURE(text(isa));
          CAPTURE(length);
          CAPTURE(singles);
          CAPTURE(rope);
          KernelData data(length, length + 5);
          const simd::Table& table = simd::table(isa);
          const simd::StretchRange range =
              singles ? table.stretch_singles(data.geometry(), data.first, data.last, rope)
                      : table.stretch_runs(data.geometry(), &data.run, 1, rope);
          const simd::StretchRange wanted = expected_range(Rounding(isa), data, singles, rope);
          CHECK(range.least == wanted.least);
          CHECK(range.most == wanted.most);
          const double strain = std::max(std::sqrt(range.most) - 1, 1 - std::sqrt(range.least));
          const double largest = expected_sums(Rounding(isa), data, singles, rope).largest;
          CHECK(strain == doctest::Approx(largest).epsilon(1e-14));
        }
      }
    }
  }
}

TEST_CASE("the range of many runs is that of all their constraints") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    KernelData data(5 * kLanes, 3);
    const simd::Table& table = simd::table(isa);
    std::vector<Run> runs;
    simd::StretchRange wanted;
    for (std::uint32_t k = 0; k < data.run.length; k += kLanes) {
      runs.push_back({data.run.a + k, data.run.b + k, data.run.constraint + k, kLanes});
      const simd::StretchRange one = table.stretch_runs(data.geometry(), &runs.back(), 1, false);
      wanted = {std::min(wanted.least, one.least), std::max(wanted.most, one.most)};
    }
    const simd::StretchRange range =
        table.stretch_runs(data.geometry(), runs.data(), runs.size(), false);
    CHECK(range.least == wanted.least);
    CHECK(range.most == wanted.most);
    CHECK(range.most > range.least);
  }
}

TEST_CASE("what is not a number is an infinite stretch, wherever it stands") {
  for (const simd::Isa isa : supported_isas()) {
    for (const bool singles : {false, true}) {
      for (std::uint32_t k = 0; k < 64; ++k) {
        CAPTURE(text(isa));
        CAPTURE(k);
        KernelData data(64, 1);
        const std::uint32_t c = data.first + k;
        if (data.is_padding(c)) continue;
        data.position.x[singles ? data.a[c] : data.run.a + k] = std::nan("");
        const simd::Table& table = simd::table(isa);
        const simd::StretchRange range =
            singles ? table.stretch_singles(data.geometry(), data.first, data.last, false)
                    : table.stretch_runs(data.geometry(), &data.run, 1, false);
        CHECK(range.most == std::numeric_limits<double>::infinity());
      }
    }
  }
}

TEST_CASE("a batch of padding has no strain") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    KernelData data(64, 1);
    for (std::uint32_t c = data.first; c < data.last; ++c) data.make_padding(c);
    const simd::StrainSums run = simd::table(isa).strain_run(data.geometry(), data.run, false);
    CHECK(run.largest == 0);
    CHECK(run.squares == 0);
    const simd::StretchRange range =
        simd::table(isa).stretch_runs(data.geometry(), &data.run, 1, false);
    CHECK(range.least == 1);
    CHECK(range.most == 1);
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_measure
