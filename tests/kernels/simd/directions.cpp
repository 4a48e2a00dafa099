/// Directions and errors against plain scalar code, in double, rounded to float once.
#include <doctest/doctest.h>

#include "tests/support/kernel_data.h"

namespace weft::test::kernels_simd_directions {
namespace {

using kernels::Vector;

struct Ends {
  std::uint32_t a, b;
};

Ends ends(const KernelData& data, std::uint32_t c, bool singles) {
  if (singles) return {data.a[c], data.b[c]};
  return {data.run.a + c - data.first, data.run.b + c - data.first};
}

/// What the renewal of constraint c stores.
void renew(const Rounding& rounding, KernelData& data, std::uint32_t c, Ends at, bool velocity) {
  const Vector d = data.position[at.a] - data.position[at.b];
  const double l = std::sqrt(rounding.dot(d, d)), inverse = 1 / l;
  const Vector n = l > 0 ? Vector{d.x * inverse, d.y * inverse, d.z * inverse} : Vector{0, 1, 0};
  const Vector dv = data.velocity[at.a] - data.velocity[at.b];
  const double e = velocity ? rounding.dot(n, dv) : l - data.rest_length[c];
  simd::ConstraintBlock& block = data.blocks[c / kLanes];
  block.nx[c % kLanes] = static_cast<float>(n.x * data.scale[c]);
  block.ny[c % kLanes] = static_cast<float>(n.y * data.scale[c]);
  block.nz[c % kLanes] = static_cast<float>(n.z * data.scale[c]);
  block.e0[c % kLanes] = static_cast<float>(e * data.scale[c]);
}

void renew(const simd::Table& table, KernelData& data, bool singles, bool velocity) {
  const simd::BlockRelaxation r = data.relaxation(1);
  const simd::Geometry g = data.geometry();
  if (singles && velocity) {
    table.renew_velocity_singles(g, data.velocity.view(), r, data.first, data.last);
  } else if (singles) {
    table.renew_singles(g, r, data.first, data.last);
  } else if (velocity) {
    table.renew_velocity_run(g, data.velocity.view(), r, data.run);
  } else {
    table.renew_run(g, r, data.run);
  }
}

/// f(isa, length, singles, velocity)
template <class F>
void for_every_kernel(F f) {
  for (const simd::Isa isa : supported_isas()) {
    for (const bool singles : {false, true}) {
      for (const bool velocity : {false, true}) {
        CAPTURE(text(isa));
        CAPTURE(singles);
        CAPTURE(velocity);
        for (const std::uint32_t length : kLengths) f(isa, length, singles, velocity);
      }
    }
  }
}

TEST_CASE("renewing stores unit directions and true errors, in tolerances") {
  for_every_kernel([](simd::Isa isa, std::uint32_t length, bool singles, bool velocity) {
    CAPTURE(length);
    KernelData found(length, length + 2);
    KernelData expected = found;
    for (std::uint32_t c = found.first; c < found.last; ++c) {
      renew(Rounding(isa), expected, c, ends(expected, c, singles), velocity);
    }
    renew(simd::table(isa), found, singles, velocity);
    CHECK(same(found, expected));
  });
}

TEST_CASE("rattle: directions of the start, true errors") {
  for (const simd::Isa isa : supported_isas()) {
    for (const std::uint32_t length : kLengths) {
      for (const bool singles : {false, true}) {
        CAPTURE(text(isa));
        CAPTURE(length);
        CAPTURE(singles);
        KernelData found(length, length + 5);
        KernelData expected = found;
        for (std::uint32_t c = found.first; c < found.last; ++c) {
          renew(Rounding(isa), expected, c, ends(expected, c, singles), false);
        }
        // Errors are those at `position`, directions those at `solved`.
        KernelData turned = found;
        turned.position = found.solved;
        for (std::uint32_t c = found.first; c < found.last; ++c) {
          renew(Rounding(isa), turned, c, ends(turned, c, singles), false);
          const simd::ConstraintBlock& from = turned.blocks[c / kLanes];
          simd::ConstraintBlock& to = expected.blocks[c / kLanes];
          to.nx[c % kLanes] = from.nx[c % kLanes];
          to.ny[c % kLanes] = from.ny[c % kLanes];
          to.nz[c % kLanes] = from.nz[c % kLanes];
        }
        const simd::Table& table = simd::table(isa);
        const simd::BlockRelaxation r = found.relaxation(1);
        if (singles) {
          table.renew_from_start_singles(found.geometry(), found.solved.view(), r, found.first,
                                         found.last);
        } else {
          table.renew_from_start_run(found.geometry(), found.solved.view(), r, found.run);
        }
        CHECK(same(found, expected));
      }
    }
  }
}

TEST_CASE("padding gets no direction and no error") {
  for_every_kernel([](simd::Isa isa, std::uint32_t length, bool singles, bool velocity) {
    KernelData data(length, length + 3);
    for (std::uint32_t c = data.first; c < data.last; c += 3) data.make_padding(c);
    renew(simd::table(isa), data, singles, velocity);
    for (std::uint32_t c = data.first; c < data.last; c += 3) {
      const Lane lane = data.lane(c);
      REQUIRE((lane.nx == 0 && lane.ny == 0 && lane.nz == 0 && lane.e0 == 0));
    }
  });
}

TEST_CASE("ends that coincide are told apart along y") {
  for_every_kernel([](simd::Isa isa, std::uint32_t length, bool singles, bool velocity) {
    KernelData data(length, length + 4);
    for (const std::uint32_t c : {data.first, data.first + 5, data.last - 1}) {
      const Ends at = ends(data, c, singles);
      data.position.set(at.b, data.position[at.a]);
      data.scale[c] = 4;
    }
    renew(simd::table(isa), data, singles, velocity);
    for (const std::uint32_t c : {data.first, data.first + 5, data.last - 1}) {
      const Lane lane = data.lane(c);
      REQUIRE((lane.nx == 0 && lane.ny == 4 && lane.nz == 0));
      const Ends at = ends(data, c, singles);
      const double e =
          velocity ? data.velocity.y[at.a] - data.velocity.y[at.b] : -data.rest_length[c];
      REQUIRE(lane.e0 == static_cast<float>(e * 4));
    }
  });
}

}  // namespace
}  // namespace weft::test::kernels_simd_directions
