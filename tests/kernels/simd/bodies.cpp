/// Particles against bodies in lanes, against the same in double, on every instruction set, in
/// quads and woven rows.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/bodies/body_shape.h"
#include "engine/bodies/pose.h"
#include "engine/solvers/small_steps/body_frame.h"
#include "kernels/reference/bodies.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace weft::test::kernels_simd_bodies {
namespace {

using kernels::kLanes;
using kernels::Vector;

constexpr double kH = 1e-3, kRate = 1.5 / kH, kMomentumShare = 1.5, kFar = 0.004;

Vector random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}
Vec3 to_public(Vector v) { return {v.x, v.y, v.z}; }

/// A body that moves and turns about the origin.
struct MovingBody {
  std::shared_ptr<const BodyShape> shape;
  reference::BodyMotion motion;
  std::vector<simd::BodyFace> faces;
  simd::BodyFrame frame;

  MovingBody(const ShapeDescription& description, Random& random)
      : shape(build_shape(description).value()) {
    const auto pose = [&] {
      const Vector turn = random_vector(random, 0.02);
      return Pose{to_public(random_vector(random, 1e-3)), {turn.x, turn.y, turn.z, 1}};
    };
    const Pose from = pose(), to = pose();
    const PoseTravel travel({from.position, normalized(from.rotation)},
                            {to.position, normalized(to.rotation)});
    motion = {.form = shape->form(),
              .from = travel.at(0),
              .to = travel.at(1),
              .velocity = (1 / kH) * travel.way(),
              .spin = (1 / kH) * travel.turn(),
              .thickness = 0.002,
              .friction = random.between(0, 1),
              .h = kH};
    faces.resize(motion.form->faces().size());
    write_frame(frame, faces, motion, {});
  }
  MovingBody(const MovingBody&) = delete;
  MovingBody& operator=(const MovingBody&) = delete;
};

/// Particles that begin about at the surface of a body and move by some millimetres.
struct TouchedBlock {
  bool woven;
  kernels::AlignedVector<float> base, u, u_before, predicted, v;
  simd::BodyBlock block{};
  simd::BodyContactSums sums{};
  std::array<float, kLanes> spared{};
  std::uint16_t touching = 0, moved = 0, quick = 0;

  TouchedBlock(bool is_woven, const reference::BodyMotion& body, Random& random) : woven(is_woven) {
    for (auto* array : {&base, &u, &u_before, &predicted, &v}) array->resize(4 * kLanes);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Vector near = random_vector(random, 0.15);
      const reference::Gap gap = gap_of(*body.form, body.thickness, body.from.from_place(near));
      const Vector start =
          near + (random.between(-3e-3, 5e-3) - gap.gap) * body.from.turned(gap.normal);
      write(u_before, lane, start);
      write(u, lane, start + random_vector(random, 4e-3));
      write(predicted, lane, read(u, lane) + random_vector(random, 1e-3));
      write(v, lane, random_vector(random, 2));
      block.mass[lane] = lane % 7 == 6 ? 0 : static_cast<float>(random.between(0.5, 2));
      block.radius[lane] = lane % 5 == 4 ? 0.001f : 0.f;
      block.far[lane] = static_cast<float>(kFar * kFar);
      sums.pushed[lane] = lane % 3 == 0 ? 1e-4f : 0.f;
      sums.came_out[lane] = lane % 4 == 0 ? 2e-5f : 0.f;
      sums.thinned_by[lane] = lane % 6 == 1 ? 4e-4f : 0.f;
      sums.retreat[lane] = lane % 12 == 1 ? 1e-4f : 0.f;
      spared[lane] = lane % 6 == 1 ? 3e-4f : 0.f;
    }
  }
  std::size_t place(std::size_t lane) const { return woven ? lane : 4 * lane; }
  std::size_t next() const { return woven ? kLanes : 1; }
  Vector read(const kernels::AlignedVector<float>& from, std::size_t lane) const {
    const std::size_t at = place(lane);
    return {double{from[at]}, double{from[at + next()]}, double{from[at + 2 * next()]}};
  }
  void write(kernels::AlignedVector<float>& to, std::size_t lane, Vector value) const {
    const std::size_t at = place(lane);
    to[at] = static_cast<float>(value.x);
    to[at + next()] = static_cast<float>(value.y);
    to[at + 2 * next()] = static_cast<float>(value.z);
  }
  Vector settled(std::size_t lane) const {
    return read(v, lane) + kRate * (read(u, lane) - read(predicted, lane));
  }
  simd::BodySolve hold(const MovingBody& body, const simd::BodyPair& pair) {
    return {.flight = {.u = u.data(),
                       .u_before = u_before.data(),
                       .predicted = predicted.data(),
                       .v = v.data(),
                       .led_to = u.data()},
            .base = base.data(),
            .blocks = &block,
            .pairs = &pair,
            .frames = &body.frame,
            .sums = &sums,
            .touching = &touching,
            .moved = &moved,
            .quick = &quick,
            .woven = woven,
            .rate = static_cast<float>(kRate),
            .momentum_share = static_cast<float>(kMomentumShare),
            .h = static_cast<float>(kH),
            .spared = spared.data()};
  }
};

double depth_where_it_ends(const reference::BodyMotion& body, Vector x, double radius) {
  return -gap_of(*body.form, body.thickness + radius, body.to.from_place(x)).gap;
}

/// Returns how many particles touched the body.
int check_against_reference(const simd::Table& table, bool woven, const ShapeDescription& shape,
                            std::uint32_t seed) {
  Random random(seed);
  const MovingBody body(shape, random);
  const TouchedBlock before(woven, body.motion, random);
  TouchedBlock after = before;
  const simd::BodyPair pair;
  table.solve_body_contacts(after.hold(body, pair), 0, 1);
  int count = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    CAPTURE(seed);
    CAPTURE(lane);
    const Vector start = before.read(before.u_before, lane), x = before.read(before.u, lane);
    reference::ContactSums sums{
        .pushed = double{before.sums.pushed[lane]},
        .came_out = double{before.sums.came_out[lane]},
        .thinning = {double{before.sums.thinned_by[lane]}, double{before.sums.retreat[lane]}}};
    const double radius = double{before.block.radius[lane]};
    if ((after.quick >> lane & 1) != 0) {  // it is left to the reference
      CHECK(after.read(after.u, lane) == x);
      continue;
    }
    const reference::Touch touch = find_touch(body.motion, start, x, radius);
    const reference::ContactResult expected =
        solve_contact(body.motion, touch, start, x, before.settled(lane), radius, sums);
    const bool is_free = before.block.mass[lane] > 0;
    const bool touches = is_free && expected.is_touching;
    if (!(expected.push > 0 && expected.push < 1e-6))  // else rounding decides
      CHECK((after.touching >> lane & 1) == (touches ? 1 : 0));
    if (!touches || (after.touching >> lane & 1) == 0) {
      CHECK(length(after.read(after.u, lane) - (is_free ? expected.x : x)) < 1e-6);
      continue;
    }
    CHECK(length(after.read(after.u, lane) - expected.x) < 2e-7);
    CHECK(length(after.settled(lane) - expected.v) < 1e-3);
    CHECK(double{after.sums.pushed[lane]} == doctest::Approx(sums.pushed).epsilon(1e-3));
    CHECK(std::abs(double{after.sums.came_out[lane]} - sums.came_out) < 2e-7);
    const double momentum = double{before.block.mass[lane]} * kMomentumShare;
    const Vector impulse = momentum * (expected.v - before.settled(lane));
    const Vector given{double{after.sums.linear.x[lane]}, double{after.sums.linear.y[lane]},
                       double{after.sums.linear.z[lane]}};
    CHECK(length(given - impulse) < 2e-3);
    ++count;
  }
  double deepest = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!(after.block.mass[lane] > 0)) continue;
    const Vector start = after.read(after.u_before, lane), x = after.read(after.u, lane);
    const double radius = double{after.block.radius[lane]};
    const bool is_quick = (after.quick >> lane & 1) != 0;  // it is measured where it ends
    const double depth = is_quick ? depth_where_it_ends(body.motion, x, radius)
                                  : depth_of(body.motion, start, x, radius);
    deepest = std::max(deepest, depth - double{after.spared[lane]});
  }
  const float found = table.deepest_in_bodies(after.hold(body, pair), 0, 1);
  CHECK(std::abs(double{found} - deepest) < 1e-6);
  return count;
}

TEST_CASE("contacts of particles with bodies are solved as in double") {
  const std::vector<ShapeDescription> shapes = closed_forms_of_size(0.2);
  for (const simd::Isa isa : supported_isas()) {
    for (const bool woven : {false, true}) {
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        CAPTURE(k);
        int touching = 0;
        for (std::uint32_t seed = 1; seed <= 60; ++seed)
          touching += check_against_reference(simd::table(isa), woven, shapes[k], seed);
        CHECK(touching > 100);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::kernels_simd_bodies
