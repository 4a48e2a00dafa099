/// The same bits from every run, with any number of threads, whatever is passed over, and from
/// AVX2 as from AVX-512. tests/engine/step/golden.cpp holds the bits themselves.
#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/mesh_scenes.h"

namespace weft::test::engine_step_determinism {
namespace {

#ifdef WEFT_SANITIZE_THREAD
constexpr int kMostSteps = 2;  // later ones have dozens of iterations, then hundreds
#else
constexpr int kMostSteps = 100;
#endif

struct Case {
  NamedScene scene;
  int steps;
  double dt = 0.01;
  std::shared_ptr<const Model> model = model_of(scene.scene);
};

/// Sheets of several tiles, sheets that are worth a second thread, and small ones.
const std::vector<Case>& cases() {
  static const std::vector<Case> all{{{"hang, 41", scene_of("hang", 41)}, 12},
                                     {{"hang, 90", scene_of("hang", 90)}, 8},
                                     {{"hang, 130", scene_of("hang", 130)}, 2},
                                     {{"hang_sphere, 41", scene_of("hang_sphere", 41)}, 10},
                                     {{"sphere_drop, 33", scene_of("sphere_drop", 33)}, 4},
                                     {{"corners, 41", scene_of("corners", 41)}, 4},
                                     {{"ropes, 70", roped_sheet(70)}, 6},
                                     {{"random mesh, 41", random_sheet(41, 5)}, 6},
                                     {{"random mesh, 75", random_sheet(75, 6)}, 4},
                                     {{"hub, 33", hub_sheet(33)}, 4, 0.001}};
  return all;
}

std::uint64_t hash_after(const Case& c, const Settings& settings) {
  auto cloth = Cloth::create(c.model, on(Backend::simd, settings));
  REQUIRE_MESSAGE(cloth, cloth.error());
  for (int k = 0; k < std::min(c.steps, kMostSteps); ++k) {
    REQUIRE(step(cloth.value(), c.dt).status == Status::converged);
  }
  return cloth.value().state_hash();
}

/// In an arena of its own: as many threads as it says, the caller's included.
std::uint64_t hash_after(const Case& c, const Settings& settings, int threads) {
  tbb::task_arena arena(threads);
  return arena.execute([&] { return hash_after(c, settings); });
}

/// f(case, settings) for frozen directions, and for others with velocity correction.
template <class F>
void for_every_case(F f) {
  for (const Case& c : cases()) {
    for (const bool other : {false, true}) {
      Settings settings = paper_settings();
      settings.measuring.directions = other ? Directions::each : Directions::frozen;
      settings.velocity_correction = other;
      CAPTURE(c.scene.name);
      CAPTURE(name(settings.measuring.directions));
      f(c, settings);
    }
  }
}

TEST_CASE("the cases are as large as they should be") {
  int several_tiles = 0, two_threads = 0;
  for (const Case& c : cases()) {
    const ModelInfo info = describe(*c.model);
    several_tiles += info.tiles > 1;
    two_threads += info.particles >= 1000;
  }
  CHECK(several_tiles >= 3);
  CHECK(two_threads >= 8);
}

TEST_CASE("a model built anew changes no bit") {
  for (const Case& c : cases()) {
    CAPTURE(c.scene.name);
    Case again = c;
    again.model = model_of(c.scene.scene);
    CHECK(hash_after(again, paper_settings()) == hash_after(c, paper_settings()));
  }
}

TEST_CASE("the number of threads changes no bit") {
  for_every_case([](const Case& c, Settings settings) {
    settings.threads = 1;
    const std::uint64_t alone = hash_after(c, settings);
    CHECK(hash_after(c, settings, 2) == alone);
    settings.threads = 2;
    CHECK(hash_after(c, settings, 2) == alone);
    CHECK(hash_after(c, settings, 1) == alone);
    settings.threads = 0;
    CHECK(hash_after(c, settings, 2) == alone);
    CHECK(hash_after(c, settings, 3) == alone);
  });
}

TEST_CASE("what is passed over changes no bit, on one thread as on two") {
  for_every_case([](const Case& c, Settings settings) {
    settings.measuring.anticipate = settings.measuring.skip = false;
    const std::uint64_t all = hash_after(c, settings);
    for (const bool anticipate : {false, true}) {
      CAPTURE(anticipate);
      settings.measuring.anticipate = anticipate;
      settings.measuring.skip = true;
      CHECK(hash_after(c, settings) == all);
      CHECK(hash_after(c, settings, 2) == all);
    }
  });
}

TEST_CASE("AVX2 and AVX-512 give the same bits, SSE2 about the same motion") {
  if (!simd::supported(simd::Isa::avx512)) {
    MESSAGE("this machine lacks avx512: not tested");
    return;
  }
  for_every_case([](const Case& c, Settings settings) {
    for (const bool masks : {false, true}) {
      settings.measuring.anticipate = !masks;
      settings.isa = Isa::avx2;
      const std::uint64_t narrow = hash_after(c, settings);
      settings.isa = Isa::avx512;
      CHECK(hash_after(c, settings) == narrow);
      settings.isa = Isa::sse2;
      CHECK(hash_after(c, settings) != narrow);  // it does run something else
    }
  });
}

TEST_CASE("through products: threads, what is passed over, AVX2 or AVX-512 change no bit") {
  const bool has_both = simd::supported(simd::Isa::avx512);
  for_every_case([&](const Case& c, Settings settings) {
    settings.measuring.anticipate_products = true;
    if (has_both) settings.isa = Isa::avx512;
    settings.threads = 1;
    const std::uint64_t alone = hash_after(c, settings);
    settings.threads = 0;
    CHECK(hash_after(c, settings, 2) == alone);
    CHECK(hash_after(c, settings, 3) == alone);
    settings.measuring.skip = false;
    CHECK(hash_after(c, settings) == alone);
    CHECK(hash_after(c, settings, 2) == alone);
    if (!has_both) return;
    settings.isa = Isa::avx2;
    CHECK(hash_after(c, settings) == alone);
  });
}

TEST_CASE("skipping leaves out much of what is at rest") {
  SceneDescription scene = scene_of("hang", 41);
  scene.gravity = {0, 0, 0};
  std::vector<Vec3> v(scene.positions.size());
  v.back() = {0, 0, 30};  // one corner is pulled away
  std::int64_t visits[3];
  for (int method = 0; method < 3; ++method) {
    Settings settings = paper_settings();
    settings.measuring.skip = method > 0;
    settings.measuring.anticipate = method != 1;
    Cloth cloth = cloth_of(scene, settings);
    REQUIRE(cloth.write_velocities(v));
    visits[method] = step(cloth, 0.01).visits;
  }
  CHECK(visits[1] < visits[0] / 2);       // by masks
  CHECK(visits[2] < visits[0] * 8 / 10);  // by chunks
}

}  // namespace
}  // namespace weft::test::engine_step_determinism
