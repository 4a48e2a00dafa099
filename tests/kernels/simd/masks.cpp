/// Skipping by masks: the same corrections as without, wherever the masks tell the truth.
#include <doctest/doctest.h>

#include "tests/support/kernel_data.h"

namespace weft::test::kernels_simd_masks {
namespace {

constexpr std::uint64_t kBit = std::uint64_t{1} << 37;

bool out_of_tolerance(const Rounding& rounding, const KernelData& data, std::uint32_t k) {
  return std::abs(data.error(rounding, data.first + k, data.run.a + k, data.run.b + k)) > 1;
}

/// Marks constraint k of the run at one end, or not at all.
void mark(KernelData& data, std::uint32_t k, std::uint32_t choice) {
  data.mask[data.run.a + k] = choice == 1 ? kBit | 5 : 6;
  data.mask[data.run.b + k] = choice == 2 ? kBit | 9 : 10;
}

TEST_CASE("masked runs correct as others do, and the masks follow") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      CAPTURE(text(isa));
      CAPTURE(length);
      const Rounding rounding(isa);
      Random random(length);
      KernelData found(length, length + 6);
      for (std::uint32_t k = 0; k < length; ++k) {
        mark(found, k, out_of_tolerance(rounding, found, k) ? 1 + k % 2 : random.below(3));
      }
      KernelData expected = found;
      const auto wanted = simd::table(isa).relax_run(expected.relaxation(1), expected.run);
      std::uint32_t left = 0;
      for (std::uint32_t k = 0; k < length; ++k) {
        const bool corrected = out_of_tolerance(rounding, found, k);
        const bool still = out_of_tolerance(rounding, expected, k);
        left += corrected && still;
        for (const std::uint32_t end : {found.run.a + k, found.run.b + k}) {
          std::uint64_t& mask = expected.mask[end];
          mask = !corrected ? mask & ~kBit : still ? ~std::uint64_t{0} : ~kBit;
        }
      }
      CHECK(left > 0);  // the gains of this data are no exact ones
      std::uint64_t visits = 100;
      const auto count =
          simd::table(isa).relax_masked_run(found.relaxation(1), found.run, kBit, visits);
      CHECK(count == wanted);
      CHECK(count > 0);
      CHECK(visits >= 100 + count);
      CHECK(visits <= 100 + length);
      CHECK(same(found, expected));
    }
  }
}

TEST_CASE("vectors without a mark are not even looked at") {
  for (const simd::Isa isa : supported_isas()) {
    CAPTURE(text(isa));
    KernelData data(64, 12);
    std::uint32_t wrong = 0;
    for (std::uint32_t k = 0; k < 64; ++k) {
      mark(data, k, k < 48 ? 0 : 1);
      wrong += k < 48 && out_of_tolerance(Rounding(isa), data, k);
    }
    REQUIRE(wrong > 0);
    KernelData expected = data;
    std::uint64_t visits = 0;
    const auto count =
        simd::table(isa).relax_masked_run(data.relaxation(1), data.run, kBit, visits);
    const Run tail{data.run.a + 48, data.run.b + 48, data.run.constraint + 48, 16};
    CHECK(visits == 16);
    CHECK(count == simd::table(isa).relax_run(expected.relaxation(1), tail));
    CHECK(data.u == expected.u);
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_masks
