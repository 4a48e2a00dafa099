/// The linear system of bending against dense matrices: its rows, its solutions by every
/// preconditioner, and how many steps these take.
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>
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
  Eigen::MatrixXd dense(double inertia, double stiffness) const {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size(), size());
    const BendingStore& store = model->bending;
    for (std::size_t e = 0; e < store.size(); ++e) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          a(store.slots[e][i], store.slots[e][j]) +=
              stiffness * store.weights[e][i] * store.weights[e][j] / store.compliance[e];
        }
      }
    }
    for (Eigen::Index slot = 0; slot < size(); ++slot) {
      const double w = model->inverse_mass[static_cast<std::size_t>(slot)];
      if (w > 0) {
        a(slot, slot) += inertia / w;
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
        if (rows.mass[slot] > 0) vector[4 * slot + axis] = value;
      }
    }
    return vector;
  }
  static Eigen::MatrixXd columns(const double* of, Eigen::Index size) {
    Eigen::MatrixXd matrix(size, 3);
    for (Eigen::Index slot = 0; slot < size; ++slot) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) matrix(slot, axis) = of[4 * slot + axis];
    }
    return matrix;
  }
};

double largest(const Eigen::MatrixXd& matrix) { return matrix.cwiseAbs().maxCoeff(); }

constexpr BendingMethod kMethods[] = {BendingMethod::diagonal, BendingMethod::factor};

void prepare(BendingSystem& solver, BendingMethod method, const System& system, double inertia,
             double stiffness) {
  if (method == BendingMethod::factor)
    solver.prepare_factor(system.fronts, inertia, stiffness);
  else
    solver.prepare_diagonal(inertia, stiffness);
}

TEST_CASE("rows are the sum of all elements, of free particles alone") {
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    const std::vector<double> from = system.random_vector();
    kernels::AlignedVector<double> p(from.begin(), from.end()), q(p.size());
    for (const simd::Isa isa : supported_isas()) {
      CAPTURE(text(isa));
      const double product = simd::table(isa).multiply_bending(
          system.rows.matrix(1e5, 1.5), p.data(), q.data(), 0, system.rows.groups());
      const Eigen::MatrixXd x = System::columns(p.data(), system.size());
      const Eigen::MatrixXd expected = test::product(system.dense(1e5, 1.5), x);
      const double scale = largest(expected);
      CHECK(largest(System::columns(q.data(), system.size()) - expected) < 1e-12 * scale);
      CHECK(product == doctest::Approx(x.cwiseProduct(expected).sum()));
    }
  }
}

TEST_CASE("every preconditioner leads to the solution of the dense matrix") {
  Team team;
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    const std::vector<double> right = system.random_vector();
    for (const double inertia : {1e2, 1e5, 1e8}) {
      const Eigen::MatrixXd expected =
          solved(system.dense(inertia, 1.25), System::columns(right.data(), system.size()));
      for (const simd::Isa isa : supported_isas()) {
        for (const BendingMethod method : kMethods) {
          CAPTURE(inertia);
          CAPTURE(static_cast<int>(method));
          BendingSystem solver(system.rows, simd::table(isa));
          prepare(solver, method, system, 1.1 * inertia, 1.25);
          std::ranges::copy(right, solver.residual());
          solver.solve(inertia, 1e-9, 0, 5000, team);
          const Eigen::MatrixXd x = System::columns(solver.solution(), system.size());
          CHECK(largest(x - expected) < 1e-7 * largest(expected));
        }
      }
    }
  }
}

TEST_CASE("a factorisation of the same substep leaves nothing to a second step") {
  Team team;
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    BendingSystem solver(system.rows, simd::table(simd::best_isa()));
    const double inertia = 0x1p10;  // a round number, whose own factorisation is made
    solver.prepare_factor(system.fronts, inertia, 1);
    std::ranges::copy(system.random_vector(), solver.residual());
    solver.solve(inertia, 1e-8, 0, 100, team);
    CHECK(solver.iterations() == 1);
    // Another substep that is a little longer needs few.
    std::ranges::copy(system.random_vector(), solver.residual());
    solver.solve(0.9 * inertia, 1e-3, 0, 100, team);
    CHECK(solver.iterations() <= 3);
  }
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
    double stiffest = 0, heaviest = 0;
    for (std::size_t slot = 0; slot < system.rows.slots(); ++slot) {
      stiffest = std::max(stiffest, system.rows.diagonal[slot]);
      heaviest = std::max(heaviest, system.rows.mass[slot]);
    }
    const double inertia = stiffest / (20 * share * heaviest);
    BendingSystem solver(system.rows, simd::table(simd::best_isa()));
    solver.prepare_diagonal(inertia, 1);
    std::ranges::copy(system.random_vector(), solver.residual());
    solver.solve(inertia, 1e-2, 0, 100, team);
    CAPTURE(share);
    CHECK(solver.iterations() <= most);
  }
}

TEST_CASE("any number of threads, AVX2 or AVX-512: the same bits") {
  const System system(woven(45, 1e-3));
  for (const BendingMethod method : kMethods) {
    std::vector<double> first;
    for (const simd::Isa isa : supported_isas()) {
      if (isa == simd::Isa::sse2) continue;  // rounds twice
      for (const int threads : {1, 4}) {
        in_team_of(threads, [&](Team& team) {
          BendingSystem solver(system.rows, simd::table(isa));
          prepare(solver, method, system, 3e5, 1);
          std::ranges::copy(system.random_vector(), solver.residual());
          solver.solve(2e5, 1e-6, 0, 100, team);
          const std::vector<double> x(solver.solution(), solver.solution() + 4 * system.size());
          if (first.empty()) first = x;
          CHECK(x == first);
        });
      }
    }
  }
}

TEST_CASE("what is left is told, however few steps there are") {
  Team team;
  for (const SceneDescription& scene : all_kinds()) {
    const System system(scene);
    for (const BendingMethod method : kMethods) {
      BendingSystem solver(system.rows, simd::table(simd::best_isa()));
      prepare(solver, method, system, 1e5, 1);
      std::ranges::copy(system.random_vector(), solver.residual());
      CHECK(solver.solve(1e4, 1e-4, 0, 1000, team) <= 1e-4);
      std::ranges::copy(system.random_vector(), solver.residual());
      const double left = solver.solve(1e4, 1e-4, 0, 2, team);
      CHECK(left > 0);
      CHECK(left > 1e-4);
    }
  }
}

TEST_CASE("what is nearly nothing is left") {
  Team team;
  const System system(woven(13, 1e-3));
  BendingSystem solver(system.rows, simd::table(simd::best_isa()));
  solver.prepare_diagonal(1e5, 1);
  std::ranges::copy(system.random_vector(), solver.residual());
  double all = 0;  // r . r / diagonal
  for (std::size_t slot = 0; slot < system.rows.slots(); ++slot) {
    if (system.rows.mass[slot] == 0) continue;
    for (std::size_t k = 4 * slot; k < 4 * slot + 3; ++k) {
      const double r = solver.residual()[k];
      all += r * r / (1e5 * system.rows.mass[slot] + system.rows.diagonal[slot]);
    }
  }
  CHECK(solver.solve(1e5, 1e-3, 1.01 * all, 100, team) == 0);
  CHECK(solver.iterations() == 0);
  CHECK(largest(System::columns(solver.solution(), system.size())) == 0);
}

}  // namespace
}  // namespace weft::test::engine_solvers_small_steps_bending_system
