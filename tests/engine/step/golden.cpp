/// Fingerprints of whole runs on AVX2, AVX-512 and NEON: no change of the compiler, the machine or
/// the code may change a bit unnoticed. (SSE2 does not fuse, and has bits of its own.)
///
/// If a change is meant to change results, say so in its commit and put in the new table, which
///
///     WEFT_PRINT_HASHES=1 build/tests/weft_tests --source-file='*/step/golden.cpp'
///
/// prints. Only scenes made by additions, multiplications and square roots are here: the bits of
/// sines are the C library's.
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "engine/isa.h"
#include "tests/support/clothes.h"
#include "tests/support/mesh_scenes.h"

namespace weft::test::engine_step_golden {
namespace {

/// exact: what automatic is with scheme paper.
enum class Way : std::uint8_t { paper, exact, automatic };
constexpr const char* kWays[] = {"paper", "exact", "automatic"};

struct Golden {
  Way way;
  const char* scene;
  int size;
  int steps;
  bool velocity_correction;
  std::uint64_t hash;
};

constexpr Golden kGolden[] = {
    {Way::paper, "hang", 20, 40, false, 0xc094f3d1e626dce1},
    {Way::paper, "hang", 41, 12, true, 0xc39e5792680cba6d},
    {Way::paper, "hang", 90, 6, false, 0x47afac2e7a4f92a5},
    {Way::paper, "hang_sphere", 21, 40, false, 0x46f7d4ffee199d4c},
    {Way::paper, "hang_sphere", 41, 8, true, 0xef0eba083a1fdb76},
    {Way::paper, "corners", 21, 20, false, 0xda4df41750b6bf85},
    {Way::paper, "ropes", 33, 10, true, 0x1155b4cb72c5a2a8},
    {Way::paper, "random", 33, 10, false, 0x90abc61cb7cbea3b},
    {Way::paper, "hub", 17, 6, true, 0xfa09a294848129c1},
    {Way::exact, "hang", 20, 40, false, 0x34659492361c62d5},
    {Way::exact, "hang", 41, 12, true, 0xc0b2049c8aaa226e},
    {Way::exact, "hang", 90, 30, false, 0x7370395af0d084b5},
    {Way::exact, "hang_sphere", 21, 40, false, 0xbf61027ec9503ea8},
    {Way::exact, "sphere_drop", 21, 40, false, 0x21e8b637d6e4e5b7},
    {Way::exact, "corners", 41, 20, false, 0x1287a0fb7e6335fc},
    {Way::exact, "banner", 21, 20, false, 0xa0eb7f2b5b9d5a74},
    {Way::exact, "ropes", 33, 10, true, 0xa949244dd37813dc},
    {Way::exact, "random", 33, 10, false, 0xc6766fc95781ffdf},
    {Way::exact, "hub", 17, 6, true, 0x439aea5723cae410},
    {Way::automatic, "hang", 20, 40, false, 0xfc5c1d9e43d0a7a7},
    {Way::automatic, "hang", 90, 30, false, 0x7635537cee4c48db},
    {Way::automatic, "hang_sphere", 21, 40, false, 0x5b1ab0df5c6d1abc},
    {Way::automatic, "corners", 41, 20, false, 0xd18306d477c2d089},
    {Way::automatic, "banner", 21, 20, false, 0xc93a2fe2e580b4a3},
    {Way::automatic, "four_pins", 21, 20, false, 0xb5e9b96b64714f27},
    {Way::automatic, "ropes", 33, 10, false, 0x94c66e026c01cda1},
    {Way::automatic, "random", 33, 10, false, 0x50d5bcfea7dbe026},
    {Way::automatic, "hub", 17, 6, false, 0x7b4fbde0a98af0c7},
};

SceneDescription describe(const Golden& golden) {
  const std::string scene = golden.scene;
  const auto size = static_cast<std::uint32_t>(golden.size);
  if (scene == "ropes") return roped_sheet(size);
  if (scene == "random") return random_sheet(size, 8);
  if (scene == "hub") return hub_sheet(size);
  return scene_of(golden.scene, golden.size);
}

std::uint64_t hash_of(const Golden& golden, Isa isa) {
  Settings settings = golden.way == Way::paper ? paper_settings() : Settings{};
  if (golden.way == Way::exact) settings.scheme = Scheme::paper;
  settings.isa = isa;
  settings.velocity_correction = golden.velocity_correction;
  Cloth cloth = cloth_of(describe(golden), settings);
  for (int k = 0; k < golden.steps; ++k) {
    REQUIRE(step(cloth, 0.005).status == Status::converged);
  }
  return cloth.state_hash();
}

std::vector<Isa> fusing_isas() {
  std::vector<Isa> isas;
  for (const Isa isa : {Isa::avx2, Isa::avx512, Isa::neon}) {
    if (simd::supported(to_kernel(isa))) isas.push_back(isa);
  }
  return isas;
}

void print(const Golden& golden, std::uint64_t hash) {
  std::printf("    {Way::%s, \"%s\", %d, %d, %s, 0x%016llx},\n",
              kWays[static_cast<int>(golden.way)], golden.scene, golden.size, golden.steps,
              golden.velocity_correction ? "true" : "false", static_cast<unsigned long long>(hash));
}

TEST_CASE("runs have the fingerprints that they had") {
  const std::vector<Isa> isas = fusing_isas();
  if (isas.empty()) MESSAGE("this machine has neither avx2 nor neon: not tested");
  const bool wanted = std::getenv("WEFT_PRINT_HASHES") != nullptr;
  for (const Golden& golden : kGolden) {
    CAPTURE(std::string(kWays[static_cast<int>(golden.way)]));
    CAPTURE(std::string(golden.scene));
    CAPTURE(golden.size);
    for (const Isa isa : isas) {
      CAPTURE(std::string(name(isa)));
      const std::uint64_t hash = hash_of(golden, isa);
      if (wanted && isa == isas.front()) print(golden, hash);
      CHECK(hash == golden.hash);
    }
  }
}

}  // namespace
}  // namespace weft::test::engine_step_golden
