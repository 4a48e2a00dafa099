/// The sparse factorisation against Eigen's.
#include <doctest/doctest.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "engine/model/model.h"
#include "engine/solvers/direct/direct_factor.h"
#include "engine/solvers/direct/direct_layout.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/random.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_solvers_direct_direct_factor {
namespace {

/// A matrix on the pattern of a model's constraints, of random directions.
struct Problem {
  std::shared_ptr<const Model> model;
  const DirectLayout& layout;
  std::vector<double> entry, diagonal;
  Eigen::SparseMatrix<double> matrix;

  Problem(const SceneDescription& scene, std::uint32_t seed)
      : model(model_of(scene)), layout(model->direct()) {
    Random random(seed);
    std::vector<kernels::Vector> n;
    std::vector<Eigen::Triplet<double>> triplets;
    const auto add = [&](std::size_t i, std::size_t j, double value) {
      triplets.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
    };
    for (std::size_t k = 0; k < layout.rows(); ++k) {
      const Vec3 d = random.in_box(1);
      const kernels::Vector v{d.x, d.y, d.z};
      n.push_back((1 / length(v)) * v);
      diagonal.push_back(layout.diagonal[k]);
      add(k, k, (1 + DirectFactor::kShift) * diagonal[k]);
    }
    for (std::size_t e = 0; e < layout.entry_row.size(); ++e) {
      const std::uint32_t k = layout.entry_row[e], j = layout.entry_with[e];
      entry.push_back(layout.entry_weight[e] * dot(n[k], n[j]));
      add(k, j, entry[e]);
      add(j, k, entry[e]);
    }
    const auto rows = static_cast<Eigen::Index>(layout.rows());
    matrix.resize(rows, rows);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
  }
  std::vector<double> solution(simd::Isa isa, int times = 1) const {
    DirectFactor factor(layout, simd::table(isa));
    std::vector<double> b;
    for (int i = 0; i < times; ++i) {
      factor.factorise([&](std::size_t e) { return entry[e]; },
                       [&](std::size_t k) { return diagonal[k]; });
      b = right_side();
      factor.solve(b.data());
    }
    return b;
  }
  std::vector<double> right_side() const {
    std::vector<double> b(layout.rows());
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(static_cast<double>(i + 1));
    return b;
  }
};

/// Two sheets that know nothing of each other, two single bars, and a hub.
SceneDescription several_parts() {
  SceneDescription scene;
  const auto append = [&](const SceneDescription& part) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), part.positions.begin(), part.positions.end());
    scene.masses.insert(scene.masses.end(), part.masses.begin(), part.masses.end());
    for (const std::uint32_t p : part.fixed) scene.fixed.push_back(first + p);
    for (Constraint c : part.constraints) {
      c.a += first;
      c.b += first;
      scene.constraints.push_back(c);
    }
  };
  append(drifting_sheet(7, 5));
  append(scene_of("hang", 9));
  append(free_bar(1, 2));
  append(free_bar(3, 1));
  SceneDescription star;
  Random random(9);
  for (std::uint32_t i = 0; i < 40; ++i) {
    star.positions.push_back(random.in_box(1));
    star.masses.push_back(random.between(1, 2));
    if (i > 0) star.constraints.push_back({0, i, distance(star.positions[0], star.positions[i])});
  }
  append(star);
  return scene;
}

TEST_CASE("a solution is Eigen's, on every instruction set") {
  for (const SceneDescription& scene :
       {scene_of("corners", 21), scene_of("hang", 30), drifting_sheet(2, 1), several_parts(),
        scene_of("sphere_drop", 12), free_bar(1, 1)}) {
    const Problem problem(scene, 21);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> eigen(problem.matrix);
    REQUIRE(eigen.info() == Eigen::Success);
    const std::vector<double> b = problem.right_side();
    const auto size = static_cast<Eigen::Index>(b.size());
    const Eigen::VectorXd expected = eigen.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), size));
    for (const simd::Isa isa : supported_isas()) {
      const std::vector<double> x = problem.solution(isa);
      const Eigen::Map<const Eigen::VectorXd> found(x.data(), size);
      CHECK((found - expected).norm() <= 1e-10 * expected.norm());
    }
  }
}

TEST_CASE("a factor that is used again gives the same bits; so do avx2 and avx512") {
  const Problem problem(scene_of("corners", 15), 4);
  const std::vector<double> once = problem.solution(simd::best_isa());
  CHECK(once == problem.solution(simd::best_isa(), 3));
  if (!simd::supported(simd::Isa::avx512)) return;
  CHECK(once == problem.solution(simd::Isa::avx2));
}

// Every front's children come before it, and every row of L has its column once.
TEST_CASE("fronts hold every column once, children before parents") {
  const auto model = model_of(scene_of("corners", 31));
  const DirectLayout& layout = model->direct();
  const DirectFronts& fronts = layout.fronts;
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < fronts.fronts.size(); ++i) {
    const DirectFront& front = fronts.fronts[i];
    CHECK(front.first == next);
    next += front.count;
    CHECK(std::ranges::is_sorted(fronts.rows[i]));
    for (const std::uint32_t row : fronts.rows[i]) CHECK(row >= next);
    for (const std::uint32_t child : fronts.children[i]) {
      CHECK(child < i);
      CHECK(fronts.fronts[child].parent == i);
      CHECK(fronts.fronts[child].level != front.level);
    }
  }
  CHECK(next == layout.rows());
}

}  // namespace
}  // namespace weft::test::engine_solvers_direct_direct_factor
