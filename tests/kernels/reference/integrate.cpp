#include "kernels/reference/integrate.h"

#include <doctest/doctest.h>

#include <array>

namespace weft::test::kernels_reference_integrate {
namespace {

using kernels::Vector;
using kernels::Vectors;

void check_near(Vector a, Vector b) { CHECK(length(a - b) < 1e-15); }

/// A free particle of 2 kg and a fixed one.
struct Particles {
  std::array<double, 2> inverse_mass{0.5, 0};
  Vectors position{2}, velocity{2}, force{2}, predicted{2}, solved{2};

  Particles() {
    for (std::size_t i = 0; i < 2; ++i) {
      position.set(i, {1, 2, 3});
      force.set(i, {8, 0, 4});
    }
    velocity.set(0, {1, 0, -1});
  }

  reference::Motion view() {
    reference::Motion m;
    m.particles = 2;
    m.inverse_mass = inverse_mass.data();
    m.gravity = {0, -10, 0};
    m.force = force.view();
    m.position = position.view();
    m.velocity = velocity.view();
    m.predicted = predicted.view();
    m.solved = solved.view();
    return m;
  }
};

TEST_CASE("the prediction is a parabola; the fixed stay") {
  Particles particles;
  predict(particles.view(), 0.1);
  check_near(particles.predicted[0], {1 + 0.1 + 0.02, 2 - 0.05, 3 - 0.1 + 0.01});
  check_near(particles.solved[0], particles.predicted[0]);
  check_near(particles.predicted[1], {1, 2, 3});
}

TEST_CASE("without forces only gravity pulls") {
  Particles particles;
  reference::Motion motion = particles.view();
  motion.force = {};
  predict(motion, 0.1);
  check_near(particles.predicted[0], {1.1, 1.95, 2.9});
}

TEST_CASE("the commit takes the preview along, and what was corrected becomes velocity") {
  Particles particles;
  const reference::Motion motion = particles.view();
  predict(motion, 0.1);
  const Vector corrected = particles.solved[0] + Vector{0.5, 0, 0.25};
  particles.solved.set(0, corrected);
  Vectors velocity{2};
  commit(motion, 0.1, velocity.view());
  CHECK(length(velocity[0] - Vector{1 + 0.4 + 5, -1, -1 + 0.2 + 2.5}) < 1e-14);
  check_near(velocity[1], {0, 0, 0});
  check_near(particles.solved[0], corrected);
  check_near(particles.position[0], {1, 2, 3});
  check_near(particles.velocity[0], {1, 0, -1});
}

TEST_CASE("impulses: of the corrected position, of the corrected velocity, and the energy gained") {
  Particles particles;
  const reference::Motion motion = particles.view();
  predict(motion, 0.1);
  particles.solved.set(0, particles.solved[0] + Vector{0.5, 0, 0});
  Vectors velocity{2};
  commit(motion, 0.1, velocity.view());
  velocity.set(0, velocity[0] + Vector{0, 0, 3});
  const kernels::ImpulseEnergy impulses = measure_impulses(motion, 0.1, velocity.view());
  CHECK(impulses.first == doctest::Approx(2 * 5 * 5).epsilon(1e-13));
  CHECK(impulses.second == doctest::Approx(2 * 3 * 3).epsilon(1e-13));
  const Vector v = particles.velocity[0], next = velocity[0], a{4, -10, 2};
  const Vector way = particles.solved[0] - particles.position[0];
  CHECK(impulses.gain ==
        doctest::Approx(2 * (dot(next, next) - dot(v, v) - 2 * dot(a, way))).epsilon(1e-13));
  CHECK(impulses.energy == doctest::Approx(2 * dot(next, next)).epsilon(1e-13));
}

}  // namespace
}  // namespace weft::test::kernels_reference_integrate
