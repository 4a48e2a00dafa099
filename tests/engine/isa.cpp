/// Which instruction set a cloth runs on, and who says so.
#include "engine/isa.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <set>
#include <string>

#include "kernels/simd/table.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/system.h"

namespace weft::test::engine_isa {
namespace {

/// WEFT_ISA for as long as it lives.
class Environment {
 public:
  explicit Environment(const char* value) {
    if (const char* before = std::getenv("WEFT_ISA")) before_ = before;
    set(value);
  }
  ~Environment() { set(before_.empty() ? nullptr : before_.c_str()); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  static void set(const char* value) { set_environment("WEFT_ISA", value); }
  std::string before_;
};

constexpr Isa kNamed[]{Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon};

Isa best() {
  Isa best = Isa::automatic;
  for (const Isa isa : kNamed) {
    if (simd::supported(to_kernel(isa))) best = isa;
  }
  return best;
}

Result<Cloth> try_cloth(Isa isa) {
  Settings settings;
  settings.isa = isa;
  return Cloth::create(model_of(scene_of("hang", 4)), settings);
}

TEST_CASE("left alone a cloth takes the best that the machine has, and says which") {
  for (const char* value : {static_cast<const char*>(nullptr), "", "auto"}) {
    const Environment environment(value);
    const auto cloth = try_cloth(Isa::automatic);
    REQUIRE(cloth);
    CHECK(cloth.value().settings().isa == best());
  }
  CHECK(to_kernel(best()) == simd::best_isa());
}

TEST_CASE("WEFT_ISA names it for cloths that do not") {
  for (const Isa isa : kNamed) {
    if (!simd::supported(to_kernel(isa))) continue;
    CAPTURE(name(isa));
    const Environment environment(std::string(name(isa)).c_str());
    const auto cloth = try_cloth(Isa::automatic);
    REQUIRE(cloth);
    CHECK(cloth.value().settings().isa == isa);
  }
}

TEST_CASE("settings come before WEFT_ISA, even if that is nonsense") {
  for (const char* value : {"sse2", "avx512", "neon", "altivec"}) {
    const Environment environment(value);
    for (const Isa isa : kNamed) {
      if (!simd::supported(to_kernel(isa))) continue;
      const auto cloth = try_cloth(isa);
      REQUIRE(cloth);
      CHECK(cloth.value().settings().isa == isa);
    }
  }
}

TEST_CASE("a name that is none is refused in one line that shows it") {
  for (const char* value : {"altivec", "AVX2", "avx", " avx2", "3"}) {
    const Environment environment(value);
    const auto cloth = try_cloth(Isa::automatic);
    REQUIRE_FALSE(cloth);
    CHECK(cloth.error() ==
          "WEFT_ISA: must be auto, sse2, avx2, avx512 or neon (" + std::string(value) + ")");
  }
}

TEST_CASE("what the machine lacks, and what does not exist, is refused") {
  for (const Isa isa : kNamed) {
    if (simd::supported(to_kernel(isa))) continue;
    const auto cloth = try_cloth(isa);
    REQUIRE_FALSE(cloth);
    CHECK(cloth.error() ==
          "isa: this machine or this library lacks it (" + std::string(name(isa)) + ")");
    const Environment environment(std::string(name(isa)).c_str());
    const auto by_environment = try_cloth(Isa::automatic);
    REQUIRE_FALSE(by_environment);
    CHECK(by_environment.error() ==
          "WEFT_ISA: this machine or this library lacks it (" + std::string(name(isa)) + ")");
  }
  const auto cloth = try_cloth(static_cast<Isa>(200));
  REQUIRE_FALSE(cloth);
  CHECK(cloth.error() == "isa: unknown choice (200)");
}

TEST_CASE("the best instruction set is one that there is; avx512 comes with avx2") {
  CHECK(simd::supported(simd::best_isa()));
  CHECK((simd::supported(simd::Isa::avx2) || !simd::supported(simd::Isa::avx512)));
}

TEST_CASE("each instruction set has kernels of its own") {
  std::set<const simd::Table*> tables;
  for (const simd::Isa isa : supported_isas()) tables.insert(&simd::table(isa));
  CHECK(tables.size() == supported_isas().size());
}

TEST_CASE("the reference takes the choice, too: the search for contacts runs on it") {
  for (const Isa isa : kNamed) {
    if (!simd::supported(to_kernel(isa))) continue;
    Settings settings = on(Backend::reference);
    settings.isa = isa;
    Cloth cloth = cloth_of(scene_of("hang_sphere", 6), settings);
    CHECK(cloth.settings().isa == isa);
    CHECK(step(cloth, 0.01).status == Status::converged);
  }
}

}  // namespace
}  // namespace weft::test::engine_isa
