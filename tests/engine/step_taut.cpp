/// Sheets that are as wide as what holds them: nothing in them can move but by the strain that is
/// tolerated.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/support/clothes.h"
#include "tests/support/isas.h"

namespace weft::test {
namespace {

constexpr double kFrame = 1.0 / 60;

/// A banner of 1 kg and 1 m that hangs upright by its upper corners, `wider` apart than in it.
SceneDescription banner(std::uint32_t size, double wider) {
  SceneDescription scene;
  const double edge = 1.0 / (size - 1);
  const auto number = [&](std::uint32_t row, std::uint32_t column) { return row * size + column; };
  for (std::uint32_t row = 0; row < size; ++row) {
    for (std::uint32_t column = 0; column < size; ++column) {
      scene.positions.push_back({edge * column, -edge * row, 0.02 * std::sin(3 * edge * row)});
      scene.masses.push_back(1.0 / (size * size));
      if (column > 0) {
        scene.constraints.push_back({number(row, column - 1), number(row, column), edge});
      }
      if (row > 0)
        scene.constraints.push_back({number(row - 1, column), number(row, column), edge});
    }
  }
  scene.positions[size - 1].x += wider;
  scene.fixed = {0, size - 1};
  return scene;
}

/// Of 1 kg, below a sphere.
SceneDescription taut_on_all_sides(int size, double sphere_mass) {
  scenes::Options options;
  options.size = size;
  options.slack = 0;
  options.sphere_mass = sphere_mass;
  return scenes::make("sphere_drop", options).value();
}

struct Run {
  std::int64_t iterations = 0;  // largest of a step
  double strain = 0;
  double gain = 0;  // J, of a step; not of the first, which may have to put the start right
};

Run run_converging(const SceneDescription& scene, const Settings& settings, double dt, int steps) {
  Cloth cloth = cloth_of(scene, settings);
  Run run;
  for (int k = 0; k < steps; ++k) {
    const double before = cloth.energy().total();
    const StepReport report = step(cloth, dt);
    CAPTURE(k);
    REQUIRE(report.status == Status::converged);
    run.iterations = std::max(run.iterations, report.iterations);
    run.strain = std::max(run.strain, report.max_strain);
    if (k > 0) run.gain = std::max(run.gain, cloth.energy().total() - before);
  }
  return run;
}

// Before spans kept their lengths: 15,000 iterations a frame at 40 x 40 and 1 %.
TEST_CASE("a banner hangs by two corners that are as far apart as in it") {
  for (const double tolerance : {0.01, 0.001, 0.0001}) {
    CAPTURE(tolerance);
    const Run done = run_converging(banner(30, 0), {.tolerance = tolerance}, kFrame, 60);
    CHECK(done.iterations < 600);
    CHECK(done.strain <= std::min(tolerance, 0.003));
    CHECK(done.gain < 0.005);
  }
}

TEST_CASE("and by corners that are farther apart, by a part of the tolerance") {
  for (const double wider : {0.002, 0.005}) {
    CAPTURE(wider);
    const Run done = run_converging(banner(20, wider), {.tolerance = 0.01}, kFrame, 60);
    CHECK(done.iterations < 3000);
    CHECK(done.gain < 0.1);
  }
}

// Before: 300 ms a frame, and steps that did not converge.
TEST_CASE("a sheet that is taut on all sides catches a sphere ten times its weight") {
  const Run done = run_converging(taut_on_all_sides(20, 10), {.tolerance = 0.01}, 0.01, 60);
  CHECK(done.iterations < 5000);
  CHECK(done.gain < 0.05);
}

TEST_CASE("what taut spans keep depends neither on threads nor, fused, on the instruction set") {
  const auto model = model_of(taut_on_all_sides(60, 1));
  const auto hash = [&](Isa isa, int threads) {
    auto cloth = Cloth::create(model, {.tolerance = 0.001, .isa = isa, .threads = threads});
    REQUIRE(cloth);
    run(cloth.value(), 0.01, 5);
    return cloth.value().state_hash();
  };
  CHECK(hash(Isa::automatic, 2) == hash(Isa::automatic, 1));
  if (simd::supported(simd::Isa::avx512)) CHECK(hash(Isa::avx2, 1) == hash(Isa::avx512, 1));
}

}  // namespace
}  // namespace weft::test
