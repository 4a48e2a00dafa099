/// Hinges that are folded at rest: cloth comes to the side of its folds, from flat and from the
/// other side, and gains nothing by it.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/clothes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_small_steps_folds {
namespace {

constexpr double kCell = 0.01, kDegree = std::numbers::pi / 180;
constexpr std::uint32_t kPer = 4, kFolds = 3, kWide = 4, kLong = kPer * (kFolds + 1) + 1;

/// A strip of panels along x, as long as kPer cells each, whose folds turn up and down by turns.
MeshDescription pleats(bool has_triangles, double angle, const Material& material) {
  const auto place = [](double row, double column) { return Vec3{kCell * column, 0, kCell * row}; };
  const auto cut = [&](std::uint32_t row, std::uint32_t column) {
    return !has_triangles ? Cut::none : (row + column) % 3 == 0 ? Cut::first : Cut::second;
  };
  MeshDescription mesh = sheet(kWide, kLong, place, cut);
  mesh.material = material;
  mesh.rest_positions = mesh.positions;
  double x = 0, y = 0;
  for (std::uint32_t i = 0; i < kLong; ++i) {
    for (std::uint32_t j = 0; j < kWide; ++j)
      mesh.rest_positions[j * kLong + i] = {x, y, kCell * j};
    const double slope = kDegree * angle * ((i / kPer) % 2 == 0 ? 0.5 : -0.5);
    x += kCell * std::cos(slope);
    y += kCell * std::sin(slope);
  }
  for (std::uint32_t j = 0; j < kWide; ++j) mesh.pins.push_back(j * kLong);
  return mesh;
}

Material dry(const char* name) {
  Material material = find_material(name).value();
  material.damping_motion = 10;
  return material;
}

/// In degrees, of each fold, positive as the first one is at rest.
std::vector<double> folds_of(const std::vector<Vec3>& x) {
  std::vector<double> folds;
  for (std::uint32_t k = 1; k <= kFolds; ++k) {
    double sum = 0;
    for (std::uint32_t j = 0; j < kWide; ++j) {
      const Vec3 at = x[j * kLong + k * kPer];
      const Vec3 a = at - x[j * kLong + (k - 1) * kPer], b = x[j * kLong + (k + 1) * kPer] - at;
      const double sine = b.x * a.y - b.y * a.x, cosine = a.x * b.x + a.y * b.y;
      sum += std::atan2(sine, cosine) / kDegree / kWide;
    }
    folds.push_back(k % 2 == 1 ? sum : -sum);
  }
  return folds;
}

SceneDescription begun(MeshDescription mesh, double noise, std::uint32_t seed) {
  Random random(seed);
  for (Vec3& p : mesh.positions) p.y += random.between(-noise, noise);
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {};
  return scene;
}

TEST_CASE("pleats that were pressed flat fold to the side that they have at rest") {
  for (const char* material : {"cotton", "denim"}) {
    for (const bool has_triangles : {false, true}) {
      for (const double angle : {30., 60., 120., -30., -60., -120.}) {
        for (const double rate : {30., 60., 240.}) {
          CAPTURE(material);
          CAPTURE(has_triangles);
          CAPTURE(angle);
          CAPTURE(rate);
          const MeshDescription mesh = pleats(has_triangles, angle, dry(material));
          Cloth cloth = cloth_of(begun(mesh, 2e-4, 7), {});
          for (int frame = 0; frame < 4 * rate; ++frame)
            REQUIRE(step(cloth, 1 / rate).status == Status::converged);
          for (const double fold : folds_of(positions(cloth)))
            CHECK(std::abs(fold - angle) < 0.03 * std::abs(angle));
        }
      }
    }
  }
}

TEST_CASE("in double, too, and from flat without noise") {
  for (const Backend backend : kBackends) {
    for (const double angle : {60., -120.}) {
      Settings settings;
      settings.solver = Solver::small_steps;
      settings.backend = backend;
      Cloth cloth = cloth_of(begun(pleats(false, angle, dry("denim")), 0, 1), settings);
      run(cloth, 1. / 60, 240);
      for (const double fold : folds_of(positions(cloth)))
        CHECK(std::abs(fold - angle) < 0.03 * std::abs(angle));
    }
  }
}

/// One fold in the middle of a strip that is held at one end, in degrees.
class Pleat {
 public:
  Pleat(bool has_triangles, double angle, const char* name, const Settings& settings)
      : cloth_(cloth_of(scene(has_triangles, angle, name), settings)) {}
  void run(double dt, double seconds) {
    for (int frame = 0; frame < std::lround(seconds / dt); ++frame)
      missed_ += step(cloth_, dt).status != Status::converged;
  }
  int missed() const { return missed_; }
  double angle() const {
    const Vec3 way = cloth_.position(kAlong) - cloth_.position(kAlong / 2);
    return std::atan2(way.y, way.x) / kDegree;
  }

 private:
  static constexpr std::uint32_t kAlong = 32, kAcross = 8;
  static constexpr double kSmall = 0.0025;
  static SceneDescription scene(bool has_triangles, double angle, const char* name) {
    const auto place = [](double row, double column) {
      return Vec3{kSmall * column, 0, kSmall * row};
    };
    const auto cut = [&](std::uint32_t row, std::uint32_t column) {
      return !has_triangles ? Cut::none : (row + column) % 3 == 0 ? Cut::first : Cut::second;
    };
    MeshDescription mesh = sheet(kAcross + 1, kAlong + 1, place, cut);
    mesh.material = dry(name);
    mesh.rest_positions = mesh.positions;
    const double middle = kSmall * kAlong / 2;
    for (Vec3& p : mesh.rest_positions) {
      const double beyond = std::max(0.0, p.x - middle);
      p.x += beyond * (std::cos(kDegree * angle) - 1);
      p.y = beyond * std::sin(kDegree * angle);
    }
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
      if (mesh.positions[i].x < middle / 2) mesh.pins.push_back(i);
    }
    return begun(mesh, 0, 1);
  }
  Cloth cloth_;
  int missed_ = 0;
};

TEST_CASE("a sharp pleat of small cells comes to rest at its angle" * doctest::test_suite("long")) {
  for (const char* material : {"wool", "denim"}) {
    for (const bool has_triangles : {false, true}) {
      for (const double angle : {90., 120., -120.}) {
        for (const double rate : {30., 60., 240.}) {
          CAPTURE(std::string(material));
          CAPTURE(has_triangles);
          CAPTURE(angle);
          CAPTURE(rate);
          Pleat pleat(has_triangles, angle, material, {.tolerance = 1e-3});
          pleat.run(1 / rate, 3);
          CHECK(pleat.missed() == 0);
          const double rest = pleat.angle();
          CHECK(rest == doctest::Approx(angle).epsilon(2e-3));
          pleat.run(1 / rate, 0.2);
          CHECK(pleat.angle() == doctest::Approx(rest).epsilon(5e-4));
        }
      }
    }
  }
}

TEST_CASE("eight given substeps of 60 Hz hold a sharp pleat, by lanes and in double") {
  for (const Backend backend : kBackends) {
    Settings settings;
    settings.tolerance = 1e-3;
    settings.solver = Solver::small_steps;
    settings.backend = backend;
    settings.substeps = 8;
    Pleat pleat(false, -120, "denim", settings);
    pleat.run(1. / 60, 3);
    CHECK(pleat.angle() == doctest::Approx(-120).epsilon(1e-3));
  }
}

TEST_CASE("what begins in its rest shape stays there") {
  for (const bool has_triangles : {false, true}) {
    MeshDescription mesh = pleats(has_triangles, 120, dry("denim"));
    mesh.positions = mesh.rest_positions;
    Cloth cloth = cloth_of(begun(mesh, 0, 1), {});
    const std::vector<Vec3> start = positions(cloth);
    run(cloth, 1. / 60, 60);
    CHECK(largest_distance(positions(cloth), start) < 1e-5);
  }
}

/// Free pleats that fly and spin, folded less than they want to be.
SceneDescription flying(double damping) {
  MeshDescription mesh = pleats(true, 60, find_material("denim").value());
  mesh.pins.clear();
  SceneDescription scene = begun(mesh, 1e-3, 3);
  scene.damping = {.bending = damping};
  scene.air = {};
  for (const Vec3& p : scene.positions)
    scene.velocities.push_back(Vec3{0.3, -0.2, 0.1} + cross({2, 1, 4}, p));
  return scene;
}

TEST_CASE("folds that open and close neither turn nor push the cloth, and gain no energy") {
  for (const Backend backend : kBackends) {
    for (const double damping : {0., 0.01}) {
      const SceneDescription scene = flying(damping);
      const Vec3 spin = angular_momentum(scene.masses, scene.positions, scene.velocities);
      const Vec3 drift = momentum(scene.masses, scene.velocities);
      Settings settings;
      settings.solver = Solver::small_steps;
      settings.backend = backend;
      settings.substeps = 64;
      Cloth cloth = cloth_of(scene, settings);
      const double start = cloth.energy().total();
      for (int frame = 0; frame < 60; ++frame) {
        step(cloth, 1. / 60);
        CHECK(cloth.energy().total() < 1.01 * start);
      }
      const std::vector<Vec3> x = positions(cloth), v = velocities(cloth);
      CHECK(distance(momentum(scene.masses, v), drift) < 1e-3 * length(drift));
      CHECK(distance(angular_momentum(scene.masses, x, v), spin) < 0.01 * length(spin));
    }
  }
}

/// Thick and stiff: most of its elements are stiffer than a substep resolves.
Material card(double bending) {
  Material card = dry("denim");
  card.bending = bending;
  card.warp = card.weft = 2e5;
  card.shear = 1e5;
  card.damping_motion = 50;
  return card;
}

TEST_CASE("card folds to its side, too") {
  for (const double bending : {0.01, 0.1}) {
    for (const double angle : {60., -120.}) {
      CAPTURE(bending);
      CAPTURE(angle);
      Cloth cloth = cloth_of(begun(pleats(true, angle, card(bending)), 2e-4, 5), {});
      run(cloth, 1. / 60, 120);
      for (const double fold : folds_of(positions(cloth)))
        CHECK(std::abs(fold - angle) < 0.03 * std::abs(angle));
    }
  }
}

TEST_CASE("card that is pressed flat gains no energy, in however few substeps") {
  for (const double bending : {0.1, 1.}) {
    for (const int substeps : {4, 16, 64}) {
      CAPTURE(bending);
      CAPTURE(substeps);
      Settings settings;
      settings.substeps = substeps;
      Cloth cloth = cloth_of(begun(pleats(true, 60, card(bending)), 2e-4, 5), settings);
      const double start = cloth.energy().total();
      for (int frame = 0; frame < 60; ++frame) {
        step(cloth, 1. / 60);
        REQUIRE(cloth.energy().total() < 1.1 * start);
      }
    }
  }
}

TEST_CASE("any number of threads, a copy, a saved model: the same bits") {
  const SceneDescription scene = begun(pleats(true, 60, dry("denim")), 2e-4, 5);
  Cloth cloth = cloth_of(scene, {});
  const auto saved = load_model(save_model(*model_of(scene)));
  REQUIRE(saved);
  Cloth again = Cloth::create(saved.value(), {.threads = 4}).value();
  run(cloth, 1. / 60, 10);
  run(again, 1. / 60, 10);
  CHECK(cloth.state_hash() == again.state_hash());
  Cloth copy = cloth.clone();
  run(cloth, 1. / 60, 10);
  run(copy, 1. / 60, 10);
  CHECK(cloth.state_hash() == copy.state_hash());
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_folds
