/// Random scenes of bars against a dense solution in double (tests/support/dense_projection.h).
///
/// Newton's method takes the errors out along directions that it renews in between. So do frozen
/// directions that are kept until nothing is left along them, and the direct solver: they end where
/// it ends, but for the errors of up to a tolerance that each renewal leaves. An error of 1 calls
/// for motions of up to kappa = |M^-1 J^T A^-1|, so they may be apart by
///
///     2 kappa x tolerance x rest x renewals                                            (1)
///
/// Whoever renews directions on the way pulls along others. They differ by angles of up to theta =
/// 2 D / rest, D being the largest sum of motions that bars ask of a particle, and so does what
/// they move, by D theta; the errors that this leaves, of up to twice that, call for kappa times as
/// much motion:
///
///     2 (1 + 2 kappa) D theta                                                          (2)
///
/// and lanes round each of these motions to float.
///
/// Directions that turn within the step may bring in energy. Where that is more than a share of
/// what the impulses are worth, solvers but for the paper's loop slow all velocities down by one
/// factor, so that none is gained (engine/step/energy.h).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/tuning.h"
#include "tests/support/clothes.h"
#include "tests/support/dense_projection.h"
#include "tests/support/motion.h"
#include "tests/support/random_cases.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_random_solutions {
namespace {

constexpr double kLeastCondition = 1e-3;  // of matrices that Gauss-Seidel solves in good time

struct Solution {
  bool known = false;
  std::vector<Vec3> start, predicted, positions, velocities, corrected;
  double motion_per_error = 0, largest_share = 0;
};

Vec3 acceleration(const RandomCase& c, std::size_t i) {
  if (c.forces.empty()) return c.scene.gravity;
  return c.scene.gravity + (1 / c.scene.masses[i]) * c.forces[i];
}

Solution solve(const RandomCase& c) {
  const double h = c.dt;
  const std::vector<bool> fixed = are_fixed(c.scene);
  std::vector<Vec3> x = c.scene.positions;
  Solution s;
  if (describe(*model_of(c.scene)).constraints == 0) return s;
  if (max_strain(c.scene, x) > c.settings.tolerance) {  // a start is put right, at no speed
    DenseProjection start(c.scene);
    if (!start.project_positions(x) || start.reciprocal_condition() < kLeastCondition) return s;
    s.largest_share = start.largest_share();
  }
  s.start = x;
  s.predicted = x;
  s.velocities.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (fixed[i]) continue;
    const Vec3 v = c.scene.velocities.empty() ? Vec3{} : c.scene.velocities[i];
    s.predicted[i] = x[i] + h * v + (h * h / 2) * acceleration(c, i);
  }
  s.positions = s.predicted;
  DenseProjection dense(c.scene);
  s.known = dense.project_positions(s.positions) && dense.reciprocal_condition() > kLeastCondition;
  if (!s.known) return s;
  s.motion_per_error = dense.motion_per_error();
  s.largest_share += dense.largest_share();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (fixed[i]) continue;
    s.velocities[i] = (1 / h) * (s.positions[i] - x[i]) + (h / 2) * acceleration(c, i);
  }
  s.corrected = s.velocities;
  dense.project_velocities(s.positions, s.corrected);
  return s;
}

double longest(const SceneDescription& scene) {
  double length = 0;
  for (const Constraint& c : scene.constraints) length = std::max(length, c.rest_length);
  return length;
}

double shortest(const SceneDescription& scene) {
  double length = longest(scene);
  for (const Constraint& c : scene.constraints) length = std::min(length, c.rest_length);
  return length;
}

/// (1), and what doubles round.
double newtons_distance(const RandomCase& c, const Solution& s, std::int64_t renewals) {
  const double left = 2 * s.motion_per_error * c.settings.tolerance * longest(c.scene) *
                      static_cast<double>(renewals);
  double farthest = 0;
  for (const Vec3 p : s.positions) farthest = std::max(farthest, length(p));
  return left + 1e-13 * farthest * (1 + s.motion_per_error);
}

/// (2), the angles and the floats.
double others_distance(const RandomCase& c, const Solution& s) {
  const double angle = 2 * s.largest_share / shortest(c.scene) + 32 * 0x1p-24;
  return 2 * (1 + 2 * s.motion_per_error) * s.largest_share * angle;
}

struct Outcome {
  StepReport report;
  std::vector<Vec3> positions, velocities;
};

Outcome outcome(const RandomCase& c, const Settings& settings) {
  Cloth cloth = cloth_of(c.scene, settings);
  REQUIRE(cloth.write_forces(c.forces));
  Outcome o;
  o.report = step(cloth, c.dt);
  o.positions = positions(cloth);
  o.velocities = velocities(cloth);
  return o;
}

/// Twice the energies of a step to Newton's positions, at velocities v.
struct Energies {
  double gain = 0, allowed = 0, kinetic = 0;
  double unknown = 0;  // by how much gain - allowed is off where velocities are off by `most`
};

Energies energies(const RandomCase& c, const Solution& s, const std::vector<Vec3>& v, double most) {
  const double h = c.dt;
  const std::vector<bool> fixed = are_fixed(c.scene);
  Energies e;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (fixed[i]) continue;
    const double m = c.scene.masses[i];
    const Vec3 before = c.scene.velocities.empty() ? Vec3{} : c.scene.velocities[i];
    const Vec3 a = acceleration(c, i), impulse = (1 / h) * (s.positions[i] - s.predicted[i]);
    const double square = dot(v[i], v[i]);
    e.kinetic += m * square;
    e.gain += m * (square - dot(before, before) - 2 * dot(a, s.positions[i] - s.start[i]));
    e.allowed += m * (tuning::kMostGain * dot(impulse, impulse) + tuning::kEnergyRounding * square +
                      h * h / 4 * dot(a, a));
    e.unknown += m * most * (3 * most + 2 * length(v[i]) + 2 * h * length(a) + length(impulse));
  }
  return e;
}

/// From Newton's velocities to those of a step that are known to `most`, or by how much that is
/// more from those that are slowed down, if the step gains too much. Where it is unknown whether it
/// does, the less.
double velocity_distance(const RandomCase& c, const Solution& s, const std::vector<Vec3>& newtons,
                         const std::vector<Vec3>& v, double most) {
  const double plain = largest_distance(v, newtons);
  if (c.settings.solver == Solver::gauss_seidel) return plain;
  const Energies e = energies(c, s, newtons, most);
  if (e.gain <= e.allowed - e.unknown) return plain;
  std::vector<Vec3> slowed;
  const double share = std::sqrt(std::max(0.0, 1 - e.gain / e.kinetic));
  double fastest = 0;
  for (const Vec3 u : newtons) {
    slowed.push_back(share * u);
    fastest = std::max(fastest, length(u));
  }
  const double share_unknown = e.unknown / (2 * share * e.kinetic);
  const double guarded = largest_distance(v, slowed) - fastest * share_unknown;
  return e.gain > e.allowed + e.unknown ? guarded : std::min(plain, guarded);
}

/// A length between two fixed particles that differs from what it has at rest. The others are
/// solved all the same.
bool excludes_a_length(const RandomCase& c) {
  const std::vector<bool> fixed = are_fixed(c.scene);
  return std::ranges::any_of(c.scene.constraints, [&](const Constraint& of) {
    const double now = length(c.scene.positions[of.a] - c.scene.positions[of.b]);
    return fixed[of.a] && fixed[of.b] && std::abs(now / of.rest_length - 1) > c.settings.tolerance;
  });
}

/// Positions within `most`, velocities likewise: a displacement is seen in them as itself / h, and
/// so are directions that differ by 2 most / rest. The velocity loop leaves its own tolerance.
void check_outcome(const RandomCase& c, const Solution& s, const Outcome& o, double most) {
  REQUIRE(o.report.status == (excludes_a_length(c) ? Status::infeasible : Status::converged));
  CHECK(largest_distance(o.positions, s.positions) <= most);
  const double kappa = s.motion_per_error;
  const double apart = 2 * most / c.dt;
  if (!c.settings.velocity_correction) {
    CHECK(velocity_distance(c, s, s.velocities, o.velocities, apart) <= apart);
    return;
  }
  const std::vector<Vec3> rest(s.velocities.size());
  const double turned = 2 * most / shortest(c.scene) * largest_distance(s.velocities, rest);
  const double known =
      2 * kappa * c.settings.velocity_tolerance + (1 + 2 * kappa) * (apart + 2 * turned);
  CHECK(velocity_distance(c, s, s.corrected, o.velocities, known) <= known);
}

TEST_CASE("random solutions: exact solvers end where Newton's method ends") {
  int known = 0;
  for_each_case(1000, gentle_case, [&](RandomCase c) {
    const Solution s = solve(c);
    if (!s.known) return;
    ++known;
    INFO(text(c));
    c.settings.backend = Backend::reference;
    c.settings.measuring.anticipate_products = false;
    c.settings.measuring.renew_after = 0;
    c.settings.measuring.directions = Directions::frozen;
    for (const Solver solver : {Solver::gauss_seidel, Solver::direct}) {
      CAPTURE(name(solver));
      c.settings.solver = solver;
      const Outcome o = outcome(c, c.settings);
      check_outcome(c, s, o, newtons_distance(c, s, o.report.direction_updates));
    }
  });
  CHECK(known >= seeds(1000).count / 3);
}

TEST_CASE("random solutions: every method, solver and backend ends near it") {
  for_each_case(1000, gentle_case, [&](const RandomCase& c) {
    const Solution s = solve(c);
    if (!s.known) return;
    INFO(text(c));
    const Outcome o = outcome(c, c.settings);
    check_outcome(c, s, o,
                  newtons_distance(c, s, o.report.direction_updates) + others_distance(c, s));
  });
}

}  // namespace
}  // namespace weft::test::engine_random_solutions
