/// Passes in trips through memory against the same passes one by one, to the last bit.
#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include "engine/measure/simd_layout.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/sweeps/simd_loop.h"
#include "engine/solvers/sweeps/simd_system.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/teams.h"

namespace weft::test::engine_solvers_sweeps_simd_trips {
namespace {

constexpr int kManyPasses = 243;

struct Passed {
  kernels::Vectors x;
  kernels::Sweep sweep;
};

/// Passes over a sheet that somebody has pulled at.
Passed pass(const Model& model, int passes, bool in_trips, int threads, bool products = false) {
  Settings settings;
  settings.iterations = passes;
  settings.measuring.anticipate_products = products;
  SimdSystem system(model, settings, simd::table(supported_isas().back()));
  Passed passed{model.initial_position, {}};
  for (std::size_t i = 0; i < passed.x.size(); i += 7) passed.x.z[i] += 0.01;
  in_team_of(threads, [&](Team& team) {
    SimdLoop loop(system, {.x = passed.x.view()}, team);
    loop.renew();
    if (in_trips)
      passed.sweep = loop.sweeps(passes);
    else
      for (int i = 0; i < passes; ++i) passed.sweep += loop.sweep();
    loop.finish();
  });
  return passed;
}

bool same(const kernels::Vectors& a, const kernels::Vectors& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

#ifdef WEFT_SANITIZE_THREAD
constexpr std::size_t kMostParticles = 4000;  // of a sheet that is passed over hundreds of times
#else
constexpr std::size_t kMostParticles = 100000;
#endif

/// Seams between neighbours, and nothing else between tiles.
bool takes_trips(const Model& model) {
  return model.simd().seams_join_neighbours &&
         model.ordering.batches.size() <= model.ordering.between_tiles + 1;
}

TEST_CASE("passes in trips are passes one by one") {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 5);
  int trips = 0, tiles = 0;
  for (const SceneDescription& scene :
       {scene_of("hang", 60), scene_of("hang", 100), scene_of("hang", 180),
        scene_of("corners", 161), scene_of("hang", 260), roped_sheet(101), random_sheet(75, 8)}) {
    const auto model = model_of(scene);
    CAPTURE(model->ordering.tiles.size());
    trips += takes_trips(*model) ? 1 : 0;
    tiles = std::max(tiles, static_cast<int>(model->ordering.tiles.size()));
    for (const int passes : {1, 2, 3, 8, kManyPasses}) {
      if (passes == kManyPasses && scene.positions.size() > kMostParticles) continue;
      CAPTURE(passes);
      const Passed one_by_one = pass(*model, passes, false, 1);
      for (const int threads : {1, 2, 3, 5}) {
        CAPTURE(threads);
        const Passed in_trips = pass(*model, passes, true, threads);
        CHECK(same(in_trips.x, one_by_one.x));
        CHECK(in_trips.sweep.visits == one_by_one.sweep.visits);
        CHECK(in_trips.sweep.corrections == one_by_one.sweep.corrections);
      }
    }
  }
  CHECK(trips >= 4);
  CHECK(tiles >= 15);
}

TEST_CASE("passes through products in trips are passes one by one") {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 5);
  for (const SceneDescription& scene :
       {scene_of("hang", 100), scene_of("hang", 180), roped_sheet(101), random_sheet(75, 8)}) {
    const auto model = model_of(scene);
    CAPTURE(model->ordering.tiles.size());
    for (const int passes : {1, 2, 3, 8}) {
      CAPTURE(passes);
      const Passed one_by_one = pass(*model, passes, false, 1, true);
      for (const int threads : {1, 2, 3, 5}) {
        CAPTURE(threads);
        const Passed in_trips = pass(*model, passes, true, threads, true);
        CHECK(same(in_trips.x, one_by_one.x));
        CHECK(in_trips.sweep.corrections == one_by_one.sweep.corrections);
      }
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_solvers_sweeps_simd_trips
