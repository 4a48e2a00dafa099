/// Cloth that carries a load at rest, against closed forms: it is as long as its laws say, or its
/// reports tell (StepReport::law_error).
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/pressed.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_law_errors {
namespace {

constexpr double kTolerance = 0.01;
/// In tolerances: sheets as a whole are off by a quarter of what single elements may be, chains of
/// ropes by half.
constexpr double kMostOfSheet = 2.5, kMostOfChain = 5;

/// A cloth under load, and how far it is stretched as a whole.
struct Loaded {
  SceneDescription scene;
  double (*strain)(const Cloth&) = nullptr;
  double law = 0;  // the strain that its law gives
  double most = kMostOfSheet;
};

double strain_of_ball(const Cloth& cloth) {
  double sum = 0;
  for (const Vec3& x : positions(cloth)) sum += length(x);
  return sum / static_cast<double>(cloth.particle_count()) / kBalloonRadius - 1;
}
/// T = P r / 2 = k e, r = R (1 + e)
Loaded ball(double stiffness) {
  constexpr double kStrain = 0.015;
  const double pressure = 2 * stiffness * kStrain / (kBalloonRadius * (1 + kStrain));
  Loaded loaded{balloon(2, stiffness, 8), strain_of_ball, kStrain};
  loaded.scene.pressures = {{.pressure = pressure}};
  return loaded;
}

constexpr double kLength = 0.6, kWidth = 0.15;  // m
constexpr std::uint32_t kRows = 17, kColumns = 5;

double strain_of_strip(const Cloth& cloth) {
  double lowest = 0;
  for (std::uint32_t k = 0; k < kColumns; ++k)
    lowest += cloth.position((kRows - 1) * kColumns + k).y / kColumns;
  return -lowest / kLength - 1;
}
/// Hangs from its first row, is pulled at its last, and has no weight. woven: of quads, which are
/// springs; else of irregular triangles.
Loaded strip(double stiffness, bool woven) {
  constexpr double kStrain = 0.02;
  Random random(3);
  MeshDescription mesh = sheet(
      kRows, kColumns,
      [&](double row, double column) {
        const bool is_inside = row > 0 && row < kRows - 1 && column > 0 && column < kColumns - 1;
        const Vec3 by = woven || !is_inside ? Vec3{} : random.in_box(0.012);
        return Vec3{kWidth * column / (kColumns - 1) + by.x, -kLength * row / (kRows - 1) + by.y,
                    0};
      },
      [&](std::uint32_t, std::uint32_t) { return woven ? Cut::none : Cut::first; });
  mesh.material = Material{.density = 0.25,
                           .warp = stiffness,
                           .weft = stiffness,
                           .shear = stiffness / 3,
                           .damping_motion = 5};
  for (std::uint32_t k = 0; k < kColumns; ++k) mesh.pins.push_back(k);
  Loaded loaded{cloth_from_mesh(mesh).value().scene, strain_of_strip, kStrain};
  loaded.scene.gravity = {};
  return loaded;
}
/// N, for each particle of a strip.
std::vector<Vec3> pull(double stiffness) {
  std::vector<Vec3> forces(kRows * kColumns);
  for (std::uint32_t k = 0; k < kColumns; ++k) {
    const double share = (k == 0 || k == kColumns - 1 ? 0.5 : 1) / (kColumns - 1);
    forces[(kRows - 1) * kColumns + k].y = -share * 0.02 * stiffness * kWidth;
  }
  return forces;
}

double strain_of_chain(const Cloth& cloth) { return -cloth.bounds().least.y - 1; }
/// Springs in a line, 1 m long, with a weight at its end that is much heavier than they are.
Loaded chain(double stiffness, ConstraintKind kind) {
  constexpr int kLinks = 12;
  constexpr double kStrain = 0.03, kGravity = 10, kMass = 0.02;  // kg, of a particle
  Loaded loaded{{}, strain_of_chain, kStrain, kMostOfChain};
  SceneDescription& scene = loaded.scene;
  for (int i = 0; i <= kLinks; ++i) {
    scene.positions.push_back({0, -1. * i / kLinks, 0});
    scene.masses.push_back(kMass);
    const auto particle = static_cast<std::uint32_t>(i);
    if (i > 0)
      scene.constraints.push_back(
          {particle - 1, particle, 1. / kLinks, kind, 1 / (stiffness * kLinks)});
  }
  scene.masses.back() = kStrain * stiffness / kGravity;
  scene.gravity = {0, -kGravity, 0};
  scene.fixed = {0};
  scene.damping.motion = 5;
  loaded.law += kLinks * kMass / scene.masses.back() * 0.5 * kStrain;
  return loaded;
}

/// In each frame of half a second: within its law as a whole, or told.
/// Returns whether all have converged.
bool check(const Loaded& loaded, const std::vector<Vec3>& forces, int substeps, int rate) {
  CAPTURE(substeps);
  CAPTURE(rate);
  Cloth cloth = cloth_of(
      loaded.scene,
      {.tolerance = kTolerance, .substeps = substeps, .solver = Solver::small_steps, .threads = 1});
  if (!forces.empty()) REQUIRE(cloth.write_forces(forces));
  run(cloth, 1. / rate, rate);
  bool has_converged = true;
  for (int k = 0; k < rate / 2; ++k) {
    const StepReport report = step(cloth, 1. / rate);
    const bool is_within = std::abs(loaded.strain(cloth) - loaded.law) < loaded.most * kTolerance;
    const bool converged = report.status == Status::converged;
    CHECK((is_within || !converged || report.law_error > 10 * kTolerance));
    if (committed(report.status)) CHECK(report.law_error >= report.max_error);
    has_converged = has_converged && converged;
  }
  return has_converged;
}

/// By automatic substeps it converges, whatever the rate and the stiffness.
void check_all(const Loaded& loaded, const std::vector<Vec3>& forces = {}) {
  for (const int rate : {30, 60, 240}) {
    for (const int substeps : {10, 30, 100}) check(loaded, forces, substeps, rate);
    CHECK(check(loaded, forces, kAutomaticSubsteps, rate));
  }
}

TEST_CASE("a ball under pressure is as large as its law says, or its reports tell" *
          doctest::test_suite("long")) {
  for (const double stiffness : {4e3, 1e5}) {
    CAPTURE(stiffness);
    check_all(ball(stiffness));
  }
}

TEST_CASE("a strip that is pulled is as long as its law says, or its reports tell" *
          doctest::test_suite("long")) {
  for (const double stiffness : {4e3, 1e5}) {
    for (const bool woven : {false, true}) {
      CAPTURE(stiffness);
      CAPTURE(woven);
      check_all(strip(stiffness, woven), pull(stiffness));
    }
  }
}

TEST_CASE(
    "a chain of springs or elastic ropes under a weight is as long as its law says, or its "
    "reports tell") {
  for (const double stiffness : {300., 3e3}) {
    for (const ConstraintKind kind : {ConstraintKind::distance, ConstraintKind::rope}) {
      CAPTURE(stiffness);
      check_all(chain(stiffness, kind));
    }
  }
}

TEST_CASE("the error of laws tells that substeps are too few for a load") {
  constexpr double kOfMaterials = 1e-4;  // s, the damping of those that have a name
  for (const Settings& settings : kSmallSteps) {
    for (const double damping : {0., kOfMaterials}) {
      CAPTURE(damping);
      Settings few = settings;
      few.substeps = 20;
      Loaded loaded = ball(1e5);
      loaded.scene.damping.stretch = damping;
      Cloth cloth = cloth_of(loaded.scene, few);
      run(cloth, 1. / 60, 30);
      const StepReport report = step(cloth, 1. / 60);
      CHECK(loaded.strain(cloth) > 3 * loaded.law);
      CHECK(report.max_error < few.tolerance);
      CHECK(report.law_error > 10 * few.tolerance);
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_law_errors
