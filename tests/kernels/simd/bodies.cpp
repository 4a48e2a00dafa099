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
#include "kernels/reference/bodies.h"
#include "kernels/simd/table.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"

namespace weft::test::kernels_simd_bodies {
namespace {

using kernels::kLanes;
using kernels::Vector;

constexpr double kH = 1e-3, kRate = 1.5 / kH, kMomentumShare = 1.5, kFar = 0.004;

Vector random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}
Vec3 to_public(Vector v) { return {v.x, v.y, v.z}; }
void set(float (&to)[3], Vector v) {
  to[0] = static_cast<float>(v.x);
  to[1] = static_cast<float>(v.y);
  to[2] = static_cast<float>(v.z);
}

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
    motion = {.solid = shape->solid(),
              .from = travel.at(0),
              .to = travel.at(1),
              .velocity = (1 / kH) * travel.way(),
              .spin = (1 / kH) * travel.turn(),
              .thickness = 0.002,
              .friction = random.between(0, 1),
              .h = kH};
    write_frame();
  }
  MovingBody(const MovingBody&) = delete;
  MovingBody& operator=(const MovingBody&) = delete;

  void write_frame() {
    const reference::Solid& solid = motion.solid;
    for (const reference::Face& face : solid.faces) {
      simd::BodyFace& to = faces.emplace_back();
      const auto put = [&](float(&out)[4], const reference::Placement& at) {
        const Vector n = at.turned(face.normal);
        const double offset = face.offset + motion.thickness + dot(n, at.centre);
        out[0] = static_cast<float>(n.x);
        out[1] = static_cast<float>(n.y);
        out[2] = static_cast<float>(n.z);
        out[3] = static_cast<float>(offset);
      };
      put(to.from, motion.from);
      put(to.to, motion.to);
    }
    set(frame.origin, {});
    frame.faces = faces.data();
    frame.face_count = static_cast<std::uint32_t>(faces.size());
    set(frame.a, motion.to.placed(solid.a));
    set(frame.axis, motion.to.turned(solid.axis));
    frame.length = static_cast<float>(solid.length);
    frame.radius = static_cast<float>(solid.radius + motion.thickness);
    frame.taper = static_cast<float>(solid.taper);
    frame.lean = static_cast<float>(solid.taper / std::sqrt(1 - solid.taper * solid.taper));
    frame.short_way = 1e30f;
    set(frame.centre_from, motion.from.centre);
    set(frame.way, motion.to.centre - motion.from.centre);
    const std::array<Vector, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector turned = motion.to.turned(motion.from.turned_back(axes[k])) - axes[k];
      frame.turn[3 * k] = static_cast<float>(turned.x);
      frame.turn[3 * k + 1] = static_cast<float>(turned.y);
      frame.turn[3 * k + 2] = static_cast<float>(turned.z);
    }
    set(frame.centre_to, motion.to.centre);
    set(frame.velocity, motion.velocity);
    set(frame.spin, motion.spin);
    frame.friction = static_cast<float>(motion.friction);
  }
};

/// Particles that begin about at the surface of a body and move by some millimetres.
struct TouchedBlock {
  bool woven;
  kernels::AlignedVector<float> base, u, u_before, predicted, v;
  simd::BodyBlock block{};
  simd::BodyContactSums sums{};
  std::array<float, kLanes> spared{};
  std::uint16_t touching = 0, moved = 0, quick = 0;

  TouchedBlock(bool is_woven, Random& random) : woven(is_woven) {
    for (auto* array : {&base, &u, &u_before, &predicted, &v}) array->resize(4 * kLanes);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Vector out = random_vector(random, 1);
      const Vector start = (random.between(0.098, 0.106) / length(out)) * out;
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

/// Returns how many particles touched the body.
int check_against_reference(const simd::Table& table, bool woven, const ShapeDescription& shape,
                            std::uint32_t seed) {
  Random random(seed);
  const MovingBody body(shape, random);
  const TouchedBlock before(woven, random);
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
    const reference::Touch touch =
        find_touch(body.motion, start, x, double{before.block.radius[lane]});
    const reference::ContactResult expected =
        reference::solve_contact(body.motion, touch, start, x, before.settled(lane), sums);
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
    const reference::Touch touch =
        find_touch(body.motion, after.read(after.u_before, lane), after.read(after.u, lane),
                   double{after.block.radius[lane]});
    if (touch.is_near) deepest = std::max(deepest, -touch.gap - double{after.spared[lane]});
  }
  const float found = table.deepest_in_bodies(after.hold(body, pair), 0, 1);
  CHECK(std::abs(double{found} - deepest) < 1e-6);
  return count;
}

TEST_CASE("contacts of particles with bodies are solved as in double") {
  const std::array<ShapeDescription, 4> shapes{Plane{{0.2, 1, 0.1}, 0.03}, Ball{{}, 0.1},
                                               Capsule{{0, -0.03, 0}, {0, 0.02, 0}, 0.08, 0.1},
                                               box({0.17, 0.15, 0.16})};
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
