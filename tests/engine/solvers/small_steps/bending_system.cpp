/// The linear system of bending against dense matrices: its rows, its solutions by every
/// preconditioner, and how many steps these take.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/bending_system.h"
#include "tests/support/bending.h"
#include "tests/support/clothes.h"
#include "tests/support/dense.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"
#include "tests/support/teams.h"

namespace weft::test::engine_solvers_small_steps_bending_system {
namespace {

SceneDescription make(std::string_view name, int size) {
  auto scene = scenes::make(name, {.size = size});
  REQUIRE(scene);
  return scene.value();
}

/// The same with the twist of each square of n x n particles.
SceneDescription with_twist(SceneDescription scene, std::uint32_t n, double stiffness) {
  const double dx = scene.constraints.front().rest_length;
  for (std::uint32_t i = 0; i + n < n * n; ++i) {
    if (i % n + 1 == n) continue;
    scene.bending.push_back(
        {{i, i + 1, i + n, i + n + 1}, {1, -1, -1, 1}, 0, dx * dx / (2 * stiffness)});
  }
  return scene;
}

SceneDescription woven(std::uint32_t n, double stiffness) {
  return with_twist(with_rows(make("corners", static_cast<int>(n)), n, stiffness), n, stiffness);
}

/// Of triangles; woven; and a strip whose clamp is in a chain.
std::vector<SceneDescription> all_kinds() {
  return {with_hinges(make("cape", 14), 1e-4), woven(13, 1e-3), cantilever({.segments = 21})};
}

struct System {
  std::shared_ptr<const Model> model;
  BendingRows rows;
  BendingFronts fronts;

  explicit System(const SceneDescription& scene)
      : model(model_of(scene)),
        rows(make_bending_rows(*model)),
        fronts(make_bending_fronts(rows)) {}
  Eigen::Index size() const { return static_cast<Eigen::Index>(rows.slots()); }

  /// Of free particles; the others have a 1 on the diagonal.
  Eigen::MatrixXd dense(const BendingLaw& law) const {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size(), size());
    const BendingStore& store = model->bending;
    for (std::size_t e = 0; e < store.size(); ++e) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          a(store.slots[e][i], store.slots[e][j]) +=
              law.stiffness * store.weights[e][i] * store.weights[e][j] / store.compliance[e];
        }
      }
    }
    for (Eigen::Index slot = 0; slot < size(); ++slot) {
      const double w = model->inverse_mass[static_cast<std::size_t>(slot)];
      if (w > 0) {
        a(slot, slot) += law.inertia / w;
        continue;
      }
      a.row(slot).setZero();
      a.col(slot).setZero();
      a(slot, slot) = 1;
    }
    return a;
  }
  /// Four numbers for each slot; 0 where nothing moves.
  std::vector<double> random_vector() const {
    Random random(3);
    std::vector<double> vector(4 * rows.slots());
    for (std::size_t slot = 0; slot < rows.slots(); ++slot) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value = random.between(-1, 1);
        if (rows.bends(slot)) vector[4 * slot + axis] = value;
      }
    }
    return vector;
  }
  template <class Real>
  Eigen::MatrixXd columns(const Real* of) const {
    Eigen::MatrixXd matrix(size(), 3);
    for (Eigen::Index slot = 0; slot < size(); ++slot) {
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        matrix(slot, axis) = static_cast<double>(of[4 * slot + axis]);
    }
    return matrix;
  }
};

double largest(const Eigen::MatrixXd& matrix) { return matrix.cwiseAbs().maxCoeff(); }

/// A solver, by a factorisation or along the diagonal.
template <class Real>
struct Solver {
  const System& system;
  BendingSystem<Real> solver;

  Solver(const System& of, bool by_factor, const BendingLaw& law, simd::Isa isa = simd::best_isa(),
         bool exactly = false)
      : system(of), solver(of.rows, simd::table(isa)) {
    if constexpr (std::is_same_v<Real, double>) {
      if (by_factor) solver.prepare_factor(of.fronts, law, exactly);
    }
    if (!by_factor) solver.prepare_diagonal(law);
  }
  /// From nothing. Returns what is left.
  double solve(const std::vector<double>& right, const BendingLaw& law, const BendingLimits& limits,
               Team& team) {
    solver.forget_guess();
    std::ranges::transform(right, solver.residual(),
                           [](double number) { return static_cast<Real>(number); });
    return solver.solve(law, limits, team);
  }
  Eigen::MatrixXd change() const { return system.columns(solver.change()); }
};

template <class Real>
void check_rows() {
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    const std::vector<double> from = system.random_vector();
    constexpr std::size_t kAround = 16;  // a product reads beyond both ends
    kernels::AlignedVector<Real> around(from.size() + 2 * kAround), q(from.size());
    Real* const p = around.data() + kAround;
    std::ranges::transform(from, p, [](double n) { return static_cast<Real>(n); });
    const BendingLaw law{1e5, 1.5};
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(text(isa));
      const auto& kernels = [&]() -> const simd::BendingKernels<Real>& {
        if constexpr (std::is_same_v<Real, float>)
          return simd::table(isa).bend_floats;
        else
          return simd::table(isa).bend_doubles;
      }();
      const auto values = system.rows.values_by_groups<Real>();
      const double product = kernels.multiply(system.rows.matrix<Real>(law, values.data()), p,
                                              q.data(), 0, system.rows.groups());
      const Eigen::MatrixXd x = system.columns(p);
      const Eigen::MatrixXd expected = test::product(system.dense(law), x);
      const double rounding = std::is_same_v<Real, float> ? 1e-6 : 1e-14;
      CHECK(largest(system.columns(q.data()) - expected) < 10 * rounding * largest(expected));
      CHECK(product == doctest::Approx(x.cwiseProduct(expected).sum()).epsilon(100 * rounding));
    }
  }
}

TEST_CASE("rows are the sum of all elements, of free particles alone") {
  check_rows<double>();
  check_rows<float>();
}

template <class Real>
void check_solutions(bool by_factor, double part, double apart) {
  Team team;
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    const std::vector<double> right = system.random_vector();
    for (const double inertia : {1e2, 1e5, 1e8}) {
      if (std::is_same_v<Real, float> && inertia < 1e5) continue;  // too stiff for floats
      const BendingLaw law{inertia, 1.25};
      const Eigen::MatrixXd expected = solved(system.dense(law), system.columns(right.data()));
      for (const simd::Isa isa : supported_isas()) {
        CAPTURE(inertia);
        CAPTURE(by_factor);
        Solver<Real> solver(system, by_factor, {1.1 * inertia, 1.25}, isa);
        solver.solve(right, law, {part, 0, 5000}, team);
        CHECK(largest(solver.change() - expected) < apart * largest(expected));
      }
    }
  }
}

TEST_CASE("every preconditioner leads to the solution of the dense matrix") {
  check_solutions<double>(false, 1e-9, 1e-7);
  check_solutions<double>(true, 1e-9, 1e-7);
  check_solutions<float>(false, 1e-5, 1e-3);
}

TEST_CASE("a solution from a guess is the same, and a right guess takes no steps") {
  Team team;
  const System system(woven(13, 1e-3));
  const BendingLaw law{1e5, 1.5};
  const std::vector<double> right = system.random_vector();
  const Eigen::MatrixXd b = system.columns(right.data());
  const Eigen::MatrixXd expected = solved(system.dense(law), b);
  for (const double share : {0.5, 1.}) {
    Solver<double> solver(system, false, law);
    const Eigen::MatrixXd guess = share * expected;
    // b - stiffness K guess = b - (A - inertia M) guess
    const Eigen::MatrixXd left = b - test::product(system.dense(law), guess);
    for (std::size_t slot = 0; slot < system.rows.slots(); ++slot) {
      const auto row = static_cast<Eigen::Index>(slot);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const std::size_t at = 4 * slot + static_cast<std::size_t>(axis);
        const double mass = system.rows.mass[slot];
        solver.solver.guess()[at] = mass > 0 ? guess(row, axis) : 0;
        solver.solver.residual()[at] =
            mass > 0 ? left(row, axis) + law.inertia * mass * guess(row, axis) : 0;
      }
    }
    const double is_left = solver.solver.solve(law, {1e-9, 0, 1000}, team);
    CHECK(is_left <= 1e-9);
    if (share == 1) {
      CHECK(solver.solver.steps() == 0);
      continue;
    }
    CHECK(solver.solver.steps() > 1);
    CHECK(largest(guess + solver.change() - expected) < 1e-7 * largest(expected));
  }
}

TEST_CASE("a factorisation of the same substep leaves nothing to a second step") {
  Team team;
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    const double inertia = 0x1p10;  // a round number, whose own factorisation is made
    Solver<double> solver(system, true, {inertia, 1});
    solver.solve(system.random_vector(), {inertia, 1}, {1e-8, 0, 100}, team);
    CHECK(solver.solver.steps() == 1);
    // Another substep that is a little longer needs few.
    solver.solve(system.random_vector(), {0.9 * inertia, 1}, {1e-3, 0, 100}, team);
    CHECK(solver.solver.steps() <= 3);
  }
}

TEST_CASE("by a factorisation of the very law one step is the solution") {
  Team team;
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    const std::vector<double> right = system.random_vector();
    const BendingLaw law{1.37e4, 1.25};
    const Eigen::MatrixXd expected = solved(system.dense(law), system.columns(right.data()));
    for (const simd::Isa isa : supported_isas()) {
      Solver<double> solver(system, true, law, isa, true);
      CHECK(solver.solve(right, law, {1e-6, 0, 100}, team) < 1e-9);
      CHECK(solver.solver.steps() == 1);
      CHECK(largest(solver.change() - expected) < 1e-9 * largest(expected));
      // Another law is solved to what was asked for, in a few steps.
      CHECK(solver.solve(right, {1.1 * law.inertia, 1.25}, {1e-6, 0, 100}, team) < 1e-6);
    }
  }
}

TEST_CASE("no swing is stiffer than its bound, which a light particle leaves tight") {
  SceneDescription scene = woven(13, 1e-3);
  scene.masses[6 * 13 + 6] /= 20;
  const System system(scene);
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(system.size(), 1);
  for (Eigen::Index slot = 0; slot < system.size(); ++slot) {
    const double mass = system.rows.mass[static_cast<std::size_t>(slot)];
    if (mass > 0) root(slot, 0) = 1 / std::sqrt(mass);
  }
  const Eigen::MatrixXd k = system.dense({0, 1});
  Eigen::MatrixXd x = root;
  double stiffest = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::MatrixXd scaled = root.cwiseProduct(x);
    x = root.cwiseProduct(test::product(k, scaled));
    stiffest = std::sqrt(x.squaredNorm());
    x /= stiffest;
  }
  CHECK(system.rows.stiffest > (1 - 1e-9) * stiffest);
  CHECK(system.rows.stiffest < 1.1 * stiffest);
}

TEST_CASE("cloth that is soft in a substep takes few steps") {
  Team team;
  // (b h)^2 D / (density dx^4): how stiff a square is in a substep.
  const struct {
    double stiffness;
    int most;
  } cases[] = {{1e-3, 2}, {1e-1, 8}, {1, 20}};
  for (const auto& [share, most] : cases) {
    const System system(woven(31, 1));
    const double stiffest = *std::ranges::max_element(system.rows.diagonal);
    const double heaviest = *std::ranges::max_element(system.rows.mass);
    const BendingLaw law{stiffest / (20 * share * heaviest), 1};
    Solver<float> solver(system, false, law);
    solver.solve(system.random_vector(), law, {1e-2, 0, 100}, team);
    CAPTURE(share);
    CHECK(solver.solver.steps() <= most);
  }
}

template <class Real>
void check_bits(bool by_factor) {
  const System system(woven(45, 1e-3));
  std::vector<Real> first;
  for (const simd::Isa isa : supported_isas()) {
    if (isa == simd::Isa::sse2) continue;  // rounds twice
    for (const int threads : {1, 4}) {
      in_team_of(threads, [&](Team& team) {
        Solver<Real> solver(system, by_factor, {3e5, 1}, isa);
        solver.solve(system.random_vector(), {2e5, 1}, {1e-4, 0, 100}, team);
        const Real* const change = solver.solver.change();
        const std::vector<Real> x(change, change + 4 * system.rows.slots());
        if (first.empty()) first = x;
        CHECK(x == first);
      });
    }
  }
}

TEST_CASE("any number of threads, AVX2 or AVX-512: the same bits") {
  check_bits<double>(false);
  check_bits<double>(true);
  check_bits<float>(false);
}

TEST_CASE("what is left is told, however few steps there are") {
  Team team;
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    for (const bool by_factor : {false, true}) {
      Solver<double> solver(system, by_factor, {1e5, 1});
      const BendingLaw stiff{1e4, 1};
      CHECK(solver.solve(system.random_vector(), stiff, {1e-4, 0, 1000}, team) <= 1e-4);
      CHECK(solver.solve(system.random_vector(), stiff, {1e-4, 0, 2}, team) > 1e-4);
    }
  }
}

TEST_CASE("what is nothing beside the weight is left") {
  Team team;
  const System system(woven(13, 1e-3));
  const std::vector<double> right = system.random_vector();
  const BendingLaw law{1e5, 1};
  double all = 0;  // r . r / diagonal
  for (std::size_t slot = 0; slot < system.rows.slots(); ++slot) {
    if (!system.rows.bends(slot)) continue;
    const double own = law.inertia * system.rows.mass[slot] + system.rows.diagonal[slot];
    for (std::size_t k = 4 * slot; k < 4 * slot + 3; ++k) all += right[k] * right[k] / own;
  }
  Solver<double> solver(system, false, law);
  const double part = 1e-3, enough = all / (part * part);
  const double left = solver.solve(right, law, {part, 1.01 * enough, 100}, team);
  CHECK(left == doctest::Approx(part / std::sqrt(1.01)));
  CHECK(solver.solver.steps() == 0);
  CHECK(solver.solve(right, law, {part, 0.99 * enough, 100}, team) < part);
  CHECK(solver.solver.steps() > 0);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_bending_system
