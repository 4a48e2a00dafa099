/// Scenes and settings drawn by chance (tests/support/random_cases.h): whatever they are, a step
/// keeps what weft.h promises.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "kernels/simd/isa.h"
#include "tests/support/clothes.h"
#include "tests/support/membrane.h"
#include "tests/support/motion.h"
#include "tests/support/random_cases.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_random_cases {
namespace {

struct State {
  std::vector<Vec3> positions, velocities;
};

State state_of(const Cloth& cloth) { return {positions(cloth), velocities(cloth)}; }

bool finite(const std::vector<Vec3>& vectors) {
  return std::ranges::all_of(vectors, [](Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  });
}

/// A length is known to a few roundings, and an error in lanes is compared with its tolerance as a
/// float.
constexpr double kRounding = 1e-14;
constexpr double kAsFloat = 0x1p-23;
/// Strains whose squares, multiplied, are numbers.
constexpr double kSquared = 1e70;
/// What triangles are deformed by, to a few of their heights over their sides.
constexpr double kFabricRounding = 1e-11;

/// Two that should be the same length, or strain, but for rounding.
bool same(double a, double b, double rounding = kRounding) {
  return std::abs(a - b) <= rounding * (1 + std::abs(a));
}

void check_strain(const RandomCase& c, const StepReport& report, const State& now) {
  const std::vector<double> all = strains(c.scene, now.positions);
  const std::vector<bool> fixed = are_fixed(c.scene);
  double largest = 0, squares = 0, active = 0, counted = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (fixed[c.scene.constraints[i].a] && fixed[c.scene.constraints[i].b]) continue;
    largest = std::max(largest, all[i]);
    squares += all[i] * all[i];
    ++active;
  }
  counted = active;
  const double of_constraints = largest;
  double shear = 0;
  const auto laws = fabric_laws(c.scene, now.positions);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const auto& [p, q, r] = c.scene.membrane[i].particles;
    if (fixed[p] && fixed[q] && fixed[r]) continue;
    const auto [warp, weft, angle] = laws[i];
    largest = std::max({largest, std::abs(warp), std::abs(weft)});
    shear = std::max(shear, std::abs(angle));
    squares += 0.5 * (warp * warp + weft * weft);
    ++counted;
  }
  const double slack = laws.empty() ? kRounding : kFabricRounding;
  CHECK(same(report.max_strain, largest, slack));
  CHECK(same(report.rms_strain, counted > 0 ? std::sqrt(squares / counted) : 0, slack));
  if (largest < kSquared) CHECK(same(report.max_shear, shear, slack));
  if (active == 0) {
    CHECK(report.worst_constraint == kNoIndex);
    return;
  }
  REQUIRE(report.worst_constraint < all.size());
  CHECK(same(all[report.worst_constraint], of_constraints));
}

/// Known as well as the radii that it is the sum of.
void check_penetration(const RandomCase& c, const StepReport& report, const State& now) {
  const double deepest = max_penetration(c.scene, now.positions);
  double largest = 0;
  for (const double radius : c.scene.radii) largest = std::max(largest, radius);
  CHECK(std::abs(report.max_penetration - deepest) <= kRounding * largest);
}

/// n . (v_a - v_b) of bars, and of ropes that are taut and lengthen all the same.
double largest_speed(const RandomCase& c, const State& now) {
  const std::vector<bool> fixed = are_fixed(c.scene);
  double largest = 0;
  for (const Constraint& link : c.scene.constraints) {
    const Vec3 d = now.positions[link.a] - now.positions[link.b];
    if ((fixed[link.a] && fixed[link.b]) || length(d) == 0) continue;
    const double speed = dot(d, now.velocities[link.a] - now.velocities[link.b]) / length(d);
    if (link.kind == ConstraintKind::distance) largest = std::max(largest, std::abs(speed));
    const double taut = (1 - c.settings.tolerance) * link.rest_length * (1 + kRounding);
    if (link.kind == ConstraintKind::rope && length(d) > taut) largest = std::max(largest, speed);
  }
  return largest;
}

double fastest(const State& now) {
  double speed = 0;
  for (const Vec3 v : now.velocities) speed = std::max(speed, length(v));
  return speed;
}

bool has_laws(const RandomCase& c) {
  return !c.scene.membrane.empty() ||
         std::ranges::any_of(c.scene.constraints,
                             [](const Constraint& link) { return link.compliance > 0; });
}

/// Where there are springs, of what is rigid.
double largest_rigid_strain(const RandomCase& c, const State& now) {
  const std::vector<double> all = strains(c.scene, now.positions);
  double largest = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (c.scene.constraints[i].compliance == 0) largest = std::max(largest, all[i]);
  }
  return largest;
}

void check_status(const RandomCase& c, const StepReport& report, const State& now) {
  const Settings& s = c.settings;
  if (s.iterations > 0) {
    const int substeps = std::max(s.substeps, 1);  // those of iterations are never automatic
    CHECK(report.iterations <= (substeps + report.scheme_fallbacks) * s.iterations);
  } else {
    constexpr int kParts = 16;  // of a substep, each of which does one at least, by each scheme
    const int least = 2 * kParts * std::max(s.substeps, report.substeps);
    CHECK(report.iterations <= s.max_iterations + least);
    CHECK(report.velocity_iterations <= s.max_iterations + least);
  }
  const bool passed = report.status == Status::passed_through;
  if (s.iterations > 0) CHECK((report.status == Status::fixed_iterations || passed));
  if (report.status != Status::converged) return;
  const double rounding_of_lengths = kRounding * (1 + report.max_strain);
  CHECK(report.max_error <= s.tolerance * (1 + kAsFloat) + rounding_of_lengths);
  CHECK(largest_rigid_strain(c, now) <= s.tolerance * (1 + kAsFloat) + kRounding);
  if (!has_laws(c)) CHECK(report.max_error == report.max_strain);
  CHECK(report.max_penetration <= s.contact_tolerance * (1 + kAsFloat));
  const bool corrected = s.velocity_correction || s.scheme == Scheme::rattle;
  if (!corrected || c.moves_pins) return;  // a pin under way has a speed of its own
  // In lanes a velocity is the sum of a double and a float.
  const double rounding = kRounding * fastest(now);
  CHECK(largest_speed(c, now) <= s.velocity_tolerance * (1 + kAsFloat) + rounding);
}

void check_fixed(const RandomCase& c, const State& before, const State& now) {
  for (const std::uint32_t i : c.scene.fixed) {
    CHECK(distance(before.positions[i], now.positions[i]) == 0);
    CHECK(length(now.velocities[i]) == 0);
  }
}

void check_step(const RandomCase& c, int k, Cloth& cloth) {
  const State before = state_of(cloth);
  const std::uint64_t hash = cloth.state_hash();
  const StepReport report = step(cloth, c.frame(k));
  CAPTURE(name(report.status));
  const State now = state_of(cloth);
  CHECK(finite(now.positions));
  CHECK(finite(now.velocities));
  check_strain(c, report, now);
  check_penetration(c, report, now);
  check_fixed(c, before, now);
  CHECK((report.failed_particle == kNoIndex) == committed(report.status));
  if (committed(report.status)) {
    check_status(c, report, now);
  } else {
    CHECK(cloth.state_hash() == hash);
  }
}

Cloth start(const RandomCase& c, const Settings& settings) {
  Cloth cloth = cloth_of(c.scene, settings);
  REQUIRE(cloth.write_forces(c.forces));
  return cloth;
}

/// Pins wander, where they do, by a little in each step.
void move_pins(const RandomCase& c, int step, Cloth& cloth) {
  if (!c.moves_pins) return;
  Random random(c.seed + static_cast<std::uint32_t>(step));
  for (const std::uint32_t i : c.scene.fixed) {
    const double way =
        0.01 * (c.scene.constraints.empty() ? 1 : c.scene.constraints[0].rest_length);
    REQUIRE(cloth.move_fixed(i, cloth.position(i) + random.in_box(way)));
  }
}

TEST_CASE("random cases: the state is finite, the report true, and what converged in tolerance") {
  for_each_case(4000, random_case, [](const RandomCase& c) {
    INFO(text(c));
    Cloth cloth = start(c, c.settings);
    for (int k = 0; k < c.steps; ++k) {
      CAPTURE(k);
      move_pins(c, k, cloth);
      check_step(c, k, cloth);
    }
  });
}

TEST_CASE("random cases of springs: finite, true, and what converged in tolerance of its laws") {
  for_each_case(2000, softened_case, [](const RandomCase& c) {
    INFO(text(c));
    Cloth cloth = start(c, c.settings);
    for (int k = 0; k < c.steps; ++k) {
      CAPTURE(k);
      move_pins(c, k, cloth);
      check_step(c, k, cloth);
    }
  });
}

TEST_CASE("random cases of fabric: finite, true, and what converged in tolerance of its laws") {
  for_each_case(2000, fabric_case, [](const RandomCase& c) {
    INFO(text(c));
    Cloth cloth = start(c, c.settings);
    for (int k = 0; k < c.steps; ++k) {
      CAPTURE(k);
      move_pins(c, k, cloth);
      check_step(c, k, cloth);
    }
  });
}

// ------------------------------------------------------------------------------- changes

/// Springs keep their lengths: what a changed one puts right at once (engine/step/fast_springs.h)
/// is not what one puts right that begins so.
Changes random_changes(const RandomCase& c) {
  Random random(c.seed);
  const SceneDescription& scene = c.scene;
  Changes changes;
  for (std::uint32_t i = 0; i < scene.positions.size(); ++i) {
    const bool is_fixed = std::ranges::count(scene.fixed, i) > 0;
    if (is_fixed && random.below(2) == 0) changes.release.push_back(i);
    if (!is_fixed && random.below(8) == 0) changes.fix.push_back(i);
    if (random.below(8) == 0)
      changes.masses.push_back({i, random.between(0.5, 2) * scene.masses[i]});
  }
  for (std::uint32_t i = 0; i < scene.constraints.size(); ++i) {
    if (random.below(8) != 0 || scene.constraints[i].compliance > 0) continue;
    changes.rest_lengths.push_back(
        {i, random.between(0.9, 1.1) * scene.constraints[i].rest_length});
  }
  for (std::uint32_t i = 0; i < scene.membrane.size(); ++i) {
    if (random.below(8) != 0) continue;
    const MembraneElement& e = scene.membrane[i];
    changes.membrane.push_back({i, random.between(0, 2) * e.warp, e.weft, 2 * e.shear});
  }
  return changes;
}

RandomCase case_of_any_kind(std::uint32_t seed) {
  return seed % 3 == 0 ? fabric_case(seed) : random_case(seed);
}

TEST_CASE("random cases: a cloth that is changed is one of the changed description, bit for bit") {
  for_each_case(1500, case_of_any_kind, [](const RandomCase& c) {
    INFO(text(c));
    RandomCase changed = c;
    changed.scene = with(c.scene, random_changes(c));
    if (!c.scene.velocities.empty()) {
      for (const std::uint32_t i : c.scene.fixed) changed.scene.velocities[i] = {};  // it stood
    }
    Cloth cloth = start(c, c.settings), built = start(changed, c.settings);
    REQUIRE(cloth.change(random_changes(c)));
    for (int k = 0; k < c.steps; ++k) {
      move_pins(changed, k, cloth);
      move_pins(changed, k, built);
      CHECK(step(cloth, c.frame(k)).status == step(built, c.frame(k)).status);
    }
    CHECK(cloth.state_hash() == built.state_hash());
  });
}

// ------------------------------------------------------------------------------- the same bits

std::uint64_t hash_after(const RandomCase& c, const Settings& settings) {
  Cloth cloth = start(c, settings);
  for (int k = 0; k < c.steps; ++k) {
    move_pins(c, k, cloth);
    step(cloth, c.frame(k));
  }
  return cloth.state_hash();
}

/// Whether positions and speeds are known to much less than their tolerances. Where they are not, a
/// constraint may be out of tolerance as soon as it was corrected: passing it over until something
/// moves is then not the same as visiting it again.
bool is_resolved(const RandomCase& c) {
  Cloth cloth = start(c, c.settings);
  step(cloth, c.dt);
  const State now = state_of(cloth);
  double shortest = 1e300, farthest = 0;
  for (const Constraint& link : c.scene.constraints) {
    shortest = std::min(shortest, link.rest_length);
  }
  for (const Vec3 p : now.positions) farthest = std::max(farthest, length(p));
  return kRounding * farthest < c.settings.tolerance * shortest &&
         kRounding * fastest(now) < c.settings.velocity_tolerance;
}

TEST_CASE("random cases: what is passed over changes no bit") {
  for_each_case(4000, random_case, [](const RandomCase& c) {
    if (c.settings.backend == Backend::reference && !is_resolved(c)) return;
    INFO(text(c));
    Settings other = c.settings;
    other.measuring.skip = !other.measuring.skip;
    if (c.settings.backend == Backend::simd && !c.settings.measuring.anticipate_products) {
      other.measuring.anticipate = !other.measuring.anticipate;
    }
    CHECK(hash_after(c, other) == hash_after(c, c.settings));
  });
}

TEST_CASE("random cases of springs: what is passed over, and threads, change no bit") {
  for_each_case(2000, softened_case, [](const RandomCase& c) {
    if (c.settings.backend == Backend::reference && !is_resolved(c)) return;
    INFO(text(c));
    const std::uint64_t hash = hash_after(c, c.settings);
    Settings other = c.settings;
    other.measuring.skip = !other.measuring.skip;
    if (c.settings.backend == Backend::simd)
      other.measuring.anticipate = !other.measuring.anticipate;
    CHECK(hash_after(c, other) == hash);
    other = c.settings;
    other.threads = 1;
    CHECK(hash_after(c, other) == hash);
  });
}

TEST_CASE("random cases: threads, AVX2 or AVX-512 change no bit") {
  for_each_case(6000, case_of_any_kind, [](const RandomCase& c) {
    if (c.settings.backend == Backend::reference) return;
    INFO(text(c));
    const bool has_both = simd::supported(simd::Isa::avx512);
    Settings settings = c.settings;
    if (has_both) settings.isa = Isa::avx512;
    const std::uint64_t hash = hash_after(c, settings);
    Settings other = settings;
    other.threads = 1;
    CHECK(hash_after(c, other) == hash);
    if (!has_both) return;
    other.isa = Isa::avx2;
    CHECK(hash_after(c, other) == hash);
  });
}

}  // namespace
}  // namespace weft::test::engine_random_cases
