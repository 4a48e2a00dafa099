/// The visit of one constraint: what its impulse is, what it may be, and what it does.
#include "kernels/reference/relaxation.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

namespace weft::test::kernels_reference_relaxation {
namespace {

using kernels::Vector;
using kernels::Vectors;
using reference::Relaxation;

/// Three constraints between the particles 0 and 1: a bar, a rope and a contact.
struct Problem {
  std::array<std::uint32_t, 3> a{0, 0, 0};
  std::array<std::uint32_t, 3> b{1, 1, 1};
  std::array<double, 3> target{2, 2, 2};
  std::array<double, 3> tolerance{0.01, 0.01, 0.01};
  std::array<double, 3> effective_mass{0.75, 0.75, 0.75};
  std::array<double, 2> inverse_mass{1.0 / 3, 1};
  std::array<double, 3> impulse{};
  Vectors x{2}, n{3};

  Relaxation view() {
    Relaxation r;
    r.particles = 2;
    r.plain = r.bilateral = 1;
    r.pulling = 2;
    r.count = 3;
    r.a = a.data();
    r.b = b.data();
    r.target = target.data();
    r.tolerance = tolerance.data();
    r.effective_mass = effective_mass.data();
    r.inverse_mass = inverse_mass.data();
    r.impulse = impulse.data();
    r.x = x.view();
    r.n = n.view();
    return r;
  }
};

constexpr std::size_t kBar = 0;
constexpr std::size_t kRope = 1;
constexpr std::size_t kContact = 2;

TEST_CASE("an error within tolerance calls for nothing, one beyond for its whole removal") {
  Problem problem;
  const Relaxation r = problem.view();
  CHECK(impulse_change(r, kBar, 0.01, 0) == 0);
  CHECK(impulse_change(r, kBar, -0.01, 0) == 0);
  CHECK(impulse_change(r, kBar, 0.02, 0) == doctest::Approx(0.015).epsilon(1e-15));
  CHECK(impulse_change(r, kBar, -0.02, 0) == doctest::Approx(-0.015).epsilon(1e-15));
}

TEST_CASE("a rope's sum of impulses pulls, a contact's pushes") {
  Problem problem;
  const Relaxation r = problem.view();
  CHECK(impulse_change(r, kRope, 4, 0) == 3);
  CHECK(impulse_change(r, kRope, -4, 0) == 0);
  CHECK(impulse_change(r, kRope, -4, 1) == -1);
  CHECK(impulse_change(r, kRope, -4, 5) == -3);
  CHECK(impulse_change(r, kContact, -4, 0) == -3);
  CHECK(impulse_change(r, kContact, 4, 0) == 0);
  CHECK(impulse_change(r, kContact, 4, -1) == 1);
  CHECK(impulse_change(r, kContact, 4, -5) == 3);
}

TEST_CASE("the limit bounds each change, not the sum") {
  Problem problem;
  Relaxation r = problem.view();
  r.limit = 0.5;
  CHECK(impulse_change(r, kBar, 4, 100) == 0.5);
  CHECK(impulse_change(r, kBar, -4, 0) == -0.5);
  CHECK(impulse_change(r, kRope, 4, 100) == 0.5);
  CHECK(impulse_change(r, kContact, 4, -0.25) == 0.25);
}

TEST_CASE("a fresh direction is a unit vector and its error the true one; the impulse removes it") {
  Problem problem;
  const Relaxation r = problem.view();
  problem.x.set(0, {1, 2, 3});
  problem.x.set(1, {2, 4, 5});
  const double e = renew_direction(r, kBar);
  CHECK(e == doctest::Approx(1).epsilon(1e-15));
  CHECK(length(r.n[kBar]) == doctest::Approx(1).epsilon(1e-15));
  CHECK(error(r, kBar) == doctest::Approx(e).epsilon(1e-15));
  apply(r, kBar, impulse_change(r, kBar, e, 0));
  CHECK(std::abs(error(r, kBar)) < 1e-15);
  CHECK(std::abs(length(problem.x[0] - problem.x[1]) - 2) < 1e-15);
  // The ends share the way as 1/3 to 1.
  CHECK(length(problem.x[0] - Vector{1, 2, 3}) == doctest::Approx(0.25).epsilon(1e-14));
  CHECK(length(problem.x[1] - Vector{2, 4, 5}) == doctest::Approx(0.75).epsilon(1e-14));
}

TEST_CASE("rattle: the direction is that of the start, the error the true one; a contact's at x") {
  Problem problem;
  Vectors start{2};
  std::array<double, 3> start_target{0, 0, 2};
  Relaxation r = problem.view();
  r.start = start.view();
  r.rest_length = problem.target.data();
  r.target = r.start_target = start_target.data();
  problem.x.set(0, {3, 4, 0});
  start.set(0, {7, 0, 0});
  for (const std::size_t c : {kBar, kRope}) {
    CHECK(renew_direction(r, c) == doctest::Approx(3).epsilon(1e-15));
    CHECK(length(r.n[c] - Vector{1, 0, 0}) < 1e-15);
    CHECK(error(r, c) == doctest::Approx(3).epsilon(1e-15));
  }
  CHECK(renew_direction(r, kContact) == doctest::Approx(3).epsilon(1e-15));
  CHECK(length(r.n[kContact] - Vector{0.6, 0.8, 0}) < 1e-15);
  // What moves an end along the start's direction takes as much off the error.
  problem.x.set(0, {2, 4, 0});
  CHECK(error(r, kBar) == doctest::Approx(2).epsilon(1e-15));
}

TEST_CASE("particles that coincide get some unit direction") {
  Problem problem;
  const Relaxation r = problem.view();
  CHECK(renew_direction(r, kBar) == -2);
  CHECK(length(r.n[kBar]) == 1);
}

}  // namespace
}  // namespace weft::test::kernels_reference_relaxation
