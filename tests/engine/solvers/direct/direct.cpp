/// The direct solver: its linear algebra against dense matrices, and what it promises of a step.
#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <thread>

#include "tests/support/clothes.h"
#include "tests/support/dense.h"
#include "tests/support/meshes.h"
#include "tests/support/motion.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_direct_direct {
namespace {

Settings direct(Settings settings = paper_settings()) {
  settings.solver = Solver::direct;
  return settings;
}

// ------------------------------------------------------------------ the linear system, densely

/// J, e and M^-1 of a scene's bars at some positions.
struct Dense {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd error, inverse_mass;

  Dense(const SceneDescription& scene, const std::vector<Vec3>& x) {
    const auto rows = static_cast<Eigen::Index>(scene.constraints.size());
    const auto columns = static_cast<Eigen::Index>(3 * x.size());
    jacobian = Eigen::MatrixXd::Zero(rows, columns);
    error.resize(rows);
    inverse_mass.resize(columns);
    for (Eigen::Index i = 0; i < columns; ++i) {
      inverse_mass[i] = 1 / scene.masses[static_cast<std::size_t>(i / 3)];
    }
    for (const std::uint32_t p : scene.fixed)
      inverse_mass.segment<3>(3 * Eigen::Index{p}).setZero();
    for (Eigen::Index k = 0; k < rows; ++k) {
      const Constraint& c = scene.constraints[static_cast<std::size_t>(k)];
      const Vec3 d = x[c.a] - x[c.b];
      const double l = length(d);
      const Eigen::RowVector3d n(d.x / l, d.y / l, d.z / l);
      jacobian.block<1, 3>(k, 3 * Eigen::Index{c.a}) = n;
      jacobian.block<1, 3>(k, 3 * Eigen::Index{c.b}) = -n;
      error[k] = l - c.rest_length;
    }
  }
  /// M^-1 J^T A^-1 e.
  Eigen::VectorXd correction(const Eigen::VectorXd& e) const {
    const Eigen::VectorXd impulse = solved(impulse_matrix(jacobian, inverse_mass), e);
    return motion_by(impulse, jacobian, inverse_mass);
  }
  /// How far a diagonal raised by `shift` of itself turns the correction, relatively, in the norm
  /// of M: by shift * max diag A / min eigenvalue of A; and what rounding adds.
  double deviation(double shift) const {
    const Eigen::MatrixXd a = impulse_matrix(jacobian, inverse_mass);
    const Eigen::VectorXd values = eigenvalues(a);
    return (shift * a.diagonal().maxCoeff() + 1e-13 * values.maxCoeff()) / values.minCoeff();
  }
};

/// A random tree plus some more links, so that no constraint is redundant in space; unequal masses;
/// some particles fixed; at rest but for random velocities.
SceneDescription random_mesh(std::uint32_t particles, std::uint32_t more, std::uint32_t hub_links,
                             std::uint32_t seed) {
  Random random(seed);
  SceneDescription scene;
  for (std::uint32_t i = 0; i < particles; ++i) {
    scene.positions.push_back(random.in_box(1));
    scene.velocities.push_back(random.in_box(1));
    scene.masses.push_back(random.between(0.5, 5));
  }
  scene.fixed = {1, 5, particles / 2};
  scene.gravity = {1, -10, 2};
  const auto is_fixed = [&](std::uint32_t p) {
    return std::ranges::find(scene.fixed, p) != scene.fixed.end();
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    const bool known = std::ranges::any_of(scene.constraints, [&](const Constraint& c) {
      return (c.a == a && c.b == b) || (c.a == b && c.b == a);
    });
    if (a == b || known || (is_fixed(a) && is_fixed(b))) return;
    scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
  };
  for (std::uint32_t i = 1; i < particles; ++i) {
    i < hub_links ? join(i, 0) : join(i, random.below(i));
  }
  for (std::uint32_t i = 0; i < more; ++i) join(random.below(particles), random.below(particles));
  return scene;
}

/// One solve of a step, and the same with dense matrices. Masses differ tenfold: 4 > sqrt(10) for
/// the change of norm.
void check_one_solve(const SceneDescription& scene, double shift) {
  Settings settings = direct(on(Backend::reference));
  settings.iterations = 1;
  settings.velocity_correction = true;
  Cloth cloth = cloth_of(scene, settings);
  const double h = 0.01;
  std::vector<Vec3> x = scene.positions, v = scene.velocities;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::ranges::find(scene.fixed, i) != scene.fixed.end()) {
      v[i] = {0, 0, 0};
      continue;
    }
    x[i] = x[i] + h * v[i] + (0.5 * h * h) * scene.gravity;
    v[i] = v[i] + h * scene.gravity;
  }
  const Dense at_prediction(scene, x);
  const Eigen::VectorXd change = at_prediction.correction(at_prediction.error);
  const Eigen::VectorXd expected = flat(x) - change;
  CHECK(step(cloth, h).iterations == 1);
  const std::vector<Vec3> reached = positions(cloth);
  const double bound = 4 * at_prediction.deviation(shift);
  REQUIRE(bound < 1e-2);
  CHECK((flat(reached) - expected).norm() <= bound * change.norm());
  const Dense at_end(scene, reached);
  const Eigen::VectorXd pushed = flat(v) - change / h;
  const Eigen::VectorXd correction = at_end.correction(product(at_end.jacobian, pushed));
  CHECK((flat(velocities(cloth)) - (pushed - correction)).norm() <=
        4 * at_end.deviation(shift) * correction.norm() + 2 * bound * change.norm() / h);
}

TEST_CASE("a solve is the dense matrix's, for unequal masses and fixed particles") {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    check_one_solve(random_mesh(30, 20, 0, seed), 1e-12);
  }
}

// The spring of a link between bodies gives by 1e-8 of its ends' inverse masses.
TEST_CASE("a hub beside the matrix makes no difference") {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    check_one_solve(random_mesh(120, 30, 100, seed), 1e-8);
  }
}

// ------------------------------------------------------------------------------ bars alone

TEST_CASE("any tolerance is reached in a few solves") {
  for (const Backend backend : kBackends) {
    for (const char* name : {"hang", "corners"}) {
      CAPTURE(std::string(name));
      const SceneDescription scene = scene_of(name, 15);
      Settings settings = direct(on(backend, tight(1e-9)));
      settings.substeps = 4;
      Cloth cloth = cloth_of(scene, settings);
      std::int64_t most = 0;
      for (int k = 0; k < 100; ++k) {
        const StepReport report = step(cloth, 0.01);
        REQUIRE(report.status == Status::converged);
        REQUIRE(report.max_strain <= 1e-9);
        REQUIRE(max_strain(scene, positions(cloth)) <= 1e-9 * (1 + 1e-5));
        most = std::max(most, report.iterations);
      }
      CHECK(most <= 4 * 8);
    }
  }
}

// Both solve the same sequence of linear systems, the one exactly, the other (directions never
// renewed early) up to the tolerance: each of K solves leaves |e| <= tolerance * rest in each of C
// constraints, which moves equal masses by at most sqrt(C) * tolerance * rest / sigma, sigma the
// smallest singular value of J. Later solves pass an earlier difference on without enlarging it
// much: 2 for that.
TEST_CASE("positions agree with Gauss-Seidel as far as the tolerance allows") {
  constexpr double kTolerance = 1e-10;
  const SceneDescription scene = scene_of("hang", 6);
  Settings settings = on(Backend::reference, tight(kTolerance));
  settings.measuring.renew_after = 0;
  Cloth one = cloth_of(scene, direct(settings)), other = cloth_of(scene, settings);
  for (int k = 0; k < 30; ++k) {
    REQUIRE(other.write_positions(positions(one)));
    REQUIRE(other.write_velocities(velocities(one)));
    const StepReport report = step(one, 0.01);
    const StepReport swept = step(other, 0.01);
    REQUIRE(report.status == Status::converged);
    REQUIRE(swept.status == Status::converged);
    const Dense dense(scene, positions(one));
    Eigen::VectorXd free = Eigen::VectorXd::Ones(dense.jacobian.cols());
    for (const std::uint32_t p : scene.fixed) free.segment<3>(3 * Eigen::Index{p}).setZero();
    const double sigma = std::sqrt(eigenvalues(impulse_matrix(dense.jacobian, free)).minCoeff());
    const double residual = std::sqrt(static_cast<double>(scene.constraints.size())) * kTolerance *
                            scene.constraints[0].rest_length;
    const auto solves =
        static_cast<double>(std::max(report.direction_updates, swept.direction_updates));
    REQUIRE(sigma > 1e-4);
    CHECK(largest_distance(positions(one), positions(other)) <= 2 * solves * residual / sigma);
  }
}

TEST_CASE("corners: no energy is gained that the paper's scheme would not gain") {
  const SceneDescription scene = scene_of("corners", 21);
  const auto largest_gain = [&](const Settings& settings) {
    Cloth cloth = cloth_of(scene, settings);
    const double start = cloth.energy().total();
    double gain = -1;
    for (int k = 0; k < 200; ++k) {
      REQUIRE(step(cloth, 0.01).status == Status::converged);
      gain = std::max(gain, cloth.energy().total() - start);
    }
    CHECK(cloth.energy().total() < start - 1);
    return gain;
  };
  Settings settings = tight(1e-3);
  CHECK(largest_gain(direct(settings)) <= std::max(largest_gain(settings), 0.0) + 1e-4);
}

TEST_CASE("a chain under a heavy end holds, and swings as a pendulum" *
          doctest::test_suite("long")) {
  for (const double end_mass : {1.0, 1e3, 1e6}) {
    CAPTURE(end_mass);
    scenes::Options options;
    options.end_mass = end_mass;
    options.size = 20;
    const auto scene = scenes::make("chain", options);
    REQUIRE(scene);
    for (const Backend backend : kBackends) {
      Cloth cloth = cloth_of(scene.value(), direct(on(backend, tight(1e-3))));
      const double start = cloth.energy().total();
      for (int k = 0; k < 100; ++k) {
        const StepReport report = step(cloth, 1.0 / 60);
        REQUIRE(report.status == Status::converged);
        REQUIRE(max_strain(scene.value(), positions(cloth)) <= 1e-3 * (1 + 1e-6));
        REQUIRE(cloth.energy().total() <= start + 1e-3 * end_mass);
      }
    }
  }
}

// Two heavy ends that fly apart sideways, joined by a light chain.
TEST_CASE("momentum is kept to rounding, whatever the attempt") {
  SceneDescription scene;
  for (std::uint32_t i = 0; i < 12; ++i) {
    scene.positions.push_back({0.01 * i, 0, 0});
    scene.velocities.push_back({0, 0, 0});
    scene.masses.push_back(i == 0 ? 1e4 : i == 11 ? 3e4 : 1);
    if (i > 0) scene.constraints.push_back({i - 1, i, 0.01});
  }
  scene.velocities.front() = {0, 0.4, 0.1};
  scene.velocities.back() = {0, -0.5, 0.2};
  scene.gravity = {0, 0, 0};
  Cloth cloth = cloth_of(scene, direct(tight(1e-3)));
  const Vec3 before = momentum(scene.masses, scene.velocities);
  std::int64_t solves = 0;
  for (int k = 0; k < 30; ++k) {
    const StepReport report = step(cloth, 0.02);
    REQUIRE(report.status == Status::converged);
    REQUIRE(max_strain(scene, positions(cloth)) <= 1e-3 * (1 + 1e-6));
    solves = std::max(solves, report.iterations);
  }
  CHECK(solves > 60);
  CHECK(distance(momentum(scene.masses, velocities(cloth)), before) <= 1e-9 * length(before));
}

TEST_CASE("velocities along the constraints vanish after one solve") {
  Settings settings = direct(tight(1e-9));
  settings.velocity_correction = true;
  const SceneDescription scene = scene_of("corners", 9);
  Cloth cloth = cloth_of(scene, settings);
  for (int k = 0; k < 50; ++k) {
    const StepReport report = step(cloth, 0.0025);
    REQUIRE(report.status == Status::converged);
    REQUIRE(report.velocity_iterations <= 2);
    const auto x = positions(cloth), v = velocities(cloth);
    for (const Constraint& c : scene.constraints) {
      const Vec3 d = x[c.a] - x[c.b];
      REQUIRE(std::abs(dot(d, v[c.a] - v[c.b])) <= 1.001e-9 * length(d));
    }
  }
}

// -------------------------------------------------------------------------- singular matrices

/// Converged is converged, and anything else is said; bounded either way.
void check_honest(const SceneDescription& scene, Settings settings, int steps) {
  settings.max_iterations = 2000;
  for (const Backend backend : kBackends) {
    Cloth cloth = cloth_of(scene, direct(on(backend, settings)));
    for (int k = 0; k < steps; ++k) {
      const StepReport report = step(cloth, 0.01);
      const double strain = max_strain(scene, positions(cloth));
      REQUIRE(report.iterations <= 2000 + 16);  // parts of a substep
      REQUIRE((report.status == Status::converged || report.status == Status::iteration_limit));
      REQUIRE((report.status == Status::converged) == (strain <= settings.tolerance * (1 + 1e-6)));
    }
  }
}

SceneDescription line_between(double gap, double sag) {
  SceneDescription scene;
  for (int i = 0; i <= 10; ++i) {
    scene.positions.push_back({0.1 * i * gap, i % 10 == 0 ? 0 : -sag * i, 0});
    scene.masses.push_back(1);
  }
  for (std::uint32_t i = 0; i < 10; ++i) scene.constraints.push_back({i, i + 1, 0.1});
  scene.fixed = {0, 10};
  return scene;
}

TEST_CASE("straight chains between fixed ends: exact, compressed, overstretched") {
  for (const double gap : {1.0, 0.95, 1.05}) {
    for (const double sag : {0.0, 1e-9, 1e-3}) {
      CAPTURE(gap);
      CAPTURE(sag);
      check_honest(line_between(gap, sag), tight(1e-3), 10);
    }
  }
}

SceneDescription with_diagonals(int size) {
  SceneDescription scene = scene_of("hang", size);
  const auto n = static_cast<std::uint32_t>(size);
  for (std::uint32_t i = 0; i + 1 < n; ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t p = i * n + j;
      for (const auto& [a, b] : {std::pair{p, p + n + 1}, std::pair{p + 1, p + n}}) {
        scene.constraints.push_back({a, b, distance(scene.positions[a], scene.positions[b])});
      }
    }
  }
  return scene;
}

TEST_CASE("both diagonals of every cell: a redundant constraint each") {
  check_honest(with_diagonals(6), tight(1e-2), 40);
}

TEST_CASE("steps too large for Newton's method are answered") {
  const SceneDescription scene = scene_of("hang", 30);
  Cloth cloth = cloth_of(scene, direct(tight(1e-2)));
  bool retried = false;
  for (int k = 0; k < 20; ++k) {
    const StepReport report = step(cloth, 0.1);
    REQUIRE(report.status == Status::converged);
    REQUIRE(max_strain(scene, positions(cloth)) <= 1e-2 * (1 + 1e-6));
    retried = retried || report.halvings > 0;
  }
  CHECK(retried);
}

TEST_CASE("the bound on iterations holds, and the state is committed") {
  Settings settings = direct(tight(1e-9));
  settings.max_iterations = 1;
  Cloth cloth = cloth_of(scene_of("corners", 9), settings);
  const StepReport report = step(cloth, 0.01);
  CHECK(report.status == Status::iteration_limit);
  CHECK(report.iterations == 1);
  CHECK(report.max_strain > 1e-9);
}

TEST_CASE("what overflows changes nothing") {
  for (const bool velocity_correction : {false, true}) {
    Settings settings = direct();
    settings.max_iterations = 1000;
    settings.velocity_correction = velocity_correction;
    Cloth cloth = cloth_of(scene_of("hang_sphere", 4), settings);
    std::vector<Vec3> v = velocities(cloth);
    v[6] = {1e160, 0, 1e160};
    REQUIRE(cloth.write_velocities(v));
    const std::uint64_t before = cloth.state_hash();
    CHECK(step(cloth, 0.01).status == Status::non_finite_input);
    CHECK(cloth.state_hash() == before);
  }
}

// --------------------------------------------------------------------------------- same again

TEST_CASE("two runs agree bit for bit, also side by side on one model") {
  for (const char* name : {"corners", "sphere_drop"}) {
    const auto model = model_of(scene_of(name, 9));
    Settings settings = direct();
    settings.velocity_correction = true;
    auto alone = Cloth::create(model, settings);
    auto left = Cloth::create(model, settings);
    auto right = Cloth::create(model, settings);
    REQUIRE((alone && left && right));
    const auto run_100 = [](Cloth& cloth) {
      for (int k = 0; k < 100; ++k) (void)cloth.step(0.01);
    };
    std::thread first(run_100, std::ref(left.value()));
    std::thread second(run_100, std::ref(right.value()));
    first.join();
    second.join();
    run_100(alone.value());
    CHECK(left.value().state_hash() == alone.value().state_hash());
    CHECK(right.value().state_hash() == alone.value().state_hash());
  }
}

TEST_CASE("direct bears its name and refuses what it cannot do") {
  CHECK(name(Solver::direct) == "direct");
  Settings settings = direct(on(Backend::reference));
  settings.measuring.impulse_limit = 1;
  const auto cloth = Cloth::create(model_of(scene_of("hang", 4)), settings);
  REQUIRE_FALSE(cloth);
  CHECK(cloth.error().find("impulse_limit") != std::string::npos);
}

}  // namespace
}  // namespace weft::test::engine_solvers_direct_direct
