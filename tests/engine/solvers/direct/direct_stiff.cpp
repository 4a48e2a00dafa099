/// The stiff attempt of the direct solver alone: when it is made, and how far it goes.
#include "engine/solvers/direct/direct_stiff.h"
#include "engine/solvers/direct/direct_layout.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "tests/support/clothes.h"

namespace weft::test::engine_solvers_direct_direct_stiff {
namespace {

/// Particles of 1 kg that hang on each other, the last one heavier; their edges are stretched by
/// `strain`.
SceneDescription hanging_chain(double end_mass, double strain = 0) {
  SceneDescription scene;
  for (std::uint32_t i = 0; i < 5; ++i) {
    scene.positions.push_back({0, -0.1 * i * (1 + strain), 0});
    scene.masses.push_back(i == 4 ? end_mass : 1);
    if (i > 0) scene.constraints.push_back({i - 1, i, 0.1});
  }
  scene.fixed = {0};
  return scene;
}

struct Trial {
  std::shared_ptr<const Model> model;
  kernels::Vectors x;
  kernels::LoopResult result;

  explicit Trial(const SceneDescription& scene)
      : model(model_of(scene)), x(model->initial_position) {}
  void move_all(kernels::Vector d) {
    for (std::size_t p = 0; p < x.size(); ++p) {
      if (model->inverse_mass[p] > 0) x.view().add(p, d);
    }
  }
  bool solve(double tolerance) {
    const SphereContacts contacts = make_sphere_contacts(*model);
    DirectSystem system(*model, tight(tolerance));
    DirectFactor factor(model->direct(), simd::table(simd::best_isa()));
    DirectBalance balance(*model);
    DirectStiff stiff(*model);
    system.start(contacts, true);
    balance.start(x.view());
    result = {};
    return stiff.iterate(system, factor, balance, x.view(), contacts, 1000, result) ==
           DirectOutcome::converged;
  }
};

TEST_CASE("masses that differ by a hundred times call for it, where there are no spheres") {
  CHECK_FALSE(DirectStiff(*model_of(hanging_chain(30))).wanted());
  CHECK(DirectStiff(*model_of(hanging_chain(300))).wanted());
  CHECK(DirectStiff(*model_of(hanging_chain(0.003))).wanted());
  SceneDescription scene = hanging_chain(300);
  scene.spheres = {4};
  scene.radii.assign(scene.positions.size(), 0.01);
  CHECK_FALSE(DirectStiff(*model_of(scene)).wanted());
}

TEST_CASE("errors of up to half the tolerance are left where nothing has moved") {
  constexpr double kTolerance = 1e-3;
  for (const double tolerances : {0.25, 0.75}) {
    CAPTURE(tolerances);
    Trial trial(hanging_chain(1000, tolerances * kTolerance));
    CHECK(trial.solve(kTolerance));
    CHECK((trial.result.iterations == 0) == (tolerances < 0.5));
  }
}

TEST_CASE("it ends where particles are within a tenth of the tolerance of where they belong") {
  const auto solved = [](double end_mass, double tolerance) {
    Trial trial(hanging_chain(end_mass));
    trial.move_all({0.005, -0.002, 0});
    REQUIRE(trial.solve(tolerance));
    return trial.x;
  };
  for (const double end_mass : {1e3, 1e4}) {
    const kernels::Vectors exact = solved(end_mass, 1e-8);
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      CAPTURE(end_mass);
      CAPTURE(tolerance);
      const kernels::Vectors x = solved(end_mass, tolerance);
      double apart = 0;
      for (std::size_t p = 0; p < x.size(); ++p) {
        apart = std::max(apart, kernels::length(x[p] - exact[p]));
      }
      CHECK(apart < 0.2 * tolerance * 0.1);
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_direct_direct_stiff
