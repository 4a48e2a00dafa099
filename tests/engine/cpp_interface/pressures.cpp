/// A cloth with pressures: what is refused, what steps that fail leave, what is saved and copied.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <limits>
#include <string>

#include "engine/isa.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/pressed.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_cpp_interface_pressures {
namespace {

std::string refusal(Cloth& cloth, const std::vector<Pressure>& pressures) {
  const std::uint64_t before = cloth.state_hash();
  const auto set = cloth.set_pressure(pressures);
  CHECK(cloth.state_hash() == before);
  CHECK(cloth.pressures().empty());
  return set ? "" : set.error();
}

TEST_CASE("what is wrong with a pressure is refused by field and value, and changes nothing") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto begins = [](const std::string& error, const char* with) {
    CAPTURE(error);
    CHECK(error.starts_with(with));
    CHECK(error.find('\n') == std::string::npos);
  };
  Cloth open = cloth_of(plate(1), {});
  begins(refusal(open, {{.pressure = kNan}}), "pressures[0].pressure: must be finite (nan)");
  begins(refusal(open, {{.pressure = 1}, {.pressure = 1, .triangles = {3, 99}}}),
         "pressures[1].triangles[1]: no such triangle, the surface has 32 (99)");
  begins(refusal(open, {{.pressure = 1, .triangles = {3, 5, 3}}}),
         "pressures[0].triangles: lists a triangle twice (3)");
  begins(refusal(open, {{.pressure = 1, .gas = true}}), "pressures[0].gas: its triangles do not");
  CHECK_FALSE(open.set_pressure(kNan));

  const TriangleMesh ball = icosphere(kBalloonRadius, 1);
  Cloth closed = cloth_of(loose(ball.vertices, triangles_of(ball), 1), {});
  begins(refusal(closed, {{.pressure = -2e5, .gas = true}}),
         "pressures[0].pressure: a gas has more than none");
  begins(refusal(closed, {{.pressure = 1, .gas = true, .volume = -1}}), "pressures[0].volume: ");
  begins(refusal(closed, {{.pressure = 1, .gas = true, .ambient = 0}}), "pressures[0].ambient: ");
  SceneDescription inside_out = loose(ball.vertices, triangles_of(ball), 1);
  for (auto& t : inside_out.surface) std::swap(t[1], t[2]);
  Cloth turned = cloth_of(inside_out, {});
  begins(refusal(turned, {{.pressure = 1, .gas = true}}), "pressures[0].gas: its normals must");
  CHECK(closed.set_pressure({}));

  Cloth bar = cloth_of(free_bar(1, 1), {});
  begins(refusal(bar, {{.pressure = 1}}), "pressures[0]: needs the triangles of `surface`");
  Cloth by_yarns = cloth_of(flap(), {.solver = Solver::direct});
  begins(refusal(by_yarns, {{.pressure = 1}}), "pressures: needs solver small_steps (direct)");
  SceneDescription scene = flap();
  scene.pressures = {{.pressure = 1}};
  const auto refused = Cloth::create(model_of(scene), {.solver = Solver::direct});
  REQUIRE_FALSE(refused);
  begins(refused.error(), "pressures: is solved by small_steps only");
  scene.pressures = {{.pressure = kNan}};
  CHECK(build_model(scene).error().starts_with("pressures[0].pressure: "));
  scene = flap();
  scene.air.ram = -1;
  CHECK(build_model(scene).error().starts_with("air.ram: "));
  scene.air.ram = 1;
  CHECK(build_model(scene).error().starts_with("air.ram: given without air.triangles"));
}

TEST_CASE("a cloth goes on by small steps with a pressure, and no pressure changes nothing") {
  Cloth cloth = cloth_of(scene_of("hang", 6), {}), other = cloth_of(scene_of("hang", 6), {});
  REQUIRE(other.set_pressure(0));
  run(cloth, 0.01, 5);
  run(other, 0.01, 5);
  CHECK(cloth.state_hash() == other.state_hash());
  SceneDescription scene = flap();
  Cloth chosen = cloth_of(scene, {});
  run(chosen, 0.01, 2);
  REQUIRE(chosen.set_pressure(5));
  CHECK(chosen.settings().solver == Solver::small_steps);
  REQUIRE(chosen.change({.masses = {{2, 2}}}));
  CHECK(chosen.pressures().size() == 1);
  step(chosen, 0.01);
  CHECK(length(chosen.velocity(2)) > 0);
}

TEST_CASE("a step that fails leaves the state as it was, under any pressure") {
  for (const Settings& settings : kSmallSteps) {
    Cloth cloth = cloth_of(balloon(1, 3000, 0), settings);
    REQUIRE(cloth.set_pressure(500));
    run(cloth, 0.01, 3);
    const std::uint64_t before = cloth.state_hash();
    const std::vector<std::byte> saved = cloth.save_state();
    std::vector<Vec3> forces(cloth.particle_count());
    forces[5] = {1e308, 0, 0};
    REQUIRE(cloth.write_forces(forces));
    CHECK(step(cloth, 0.01).status == Status::non_finite_input);
    REQUIRE(cloth.write_forces({}));
    CHECK(cloth.state_hash() == before);
    Cloth other = cloth_of(balloon(1, 3000, 0), settings);
    REQUIRE(other.load_state(saved));
    run(cloth, 0.01, 3);
    run(other, 0.01, 3);
    CHECK(cloth.state_hash() == other.state_hash());
  }
}

TEST_CASE("states are saved, loaded and copied with their pressures, and go on bit for bit") {
  for (const Settings& settings : kSmallSteps) {
    const SceneDescription scene = balloon(1, 3000, 0);
    Cloth cloth = cloth_of(scene, settings);
    const std::vector<Pressure> parts{{.pressure = 900, .gas = true, .ambient = 5000},
                                      {.pressure = -30, .triangles = {4, 7}}};
    REQUIRE(cloth.set_pressure(parts));
    run(cloth, 0.01, 3);
    Cloth loaded = cloth_of(scene, settings);
    Cloth copied = Cloth::create(cloth.model(), settings).value();
    REQUIRE(loaded.load_state(cloth.save_state()));
    REQUIRE(copied.copy_state(cloth));
    CHECK(loaded.pressures()[0].volume == cloth.pressures()[0].volume);
    run(cloth, 0.01, 3);
    run(loaded, 0.01, 3);
    run(copied, 0.01, 3);
    CHECK(loaded.state_hash() == cloth.state_hash());
    CHECK(copied.state_hash() == cloth.state_hash());
    CHECK(loaded.save_state() == cloth.save_state());
  }
}

TEST_CASE("a pressure of a description is one that is set, and stays in models that are saved") {
  SceneDescription scene = balloon(1, 3000, 0);
  Cloth set = cloth_of(scene, {});
  const std::vector<Pressure> parts{{.pressure = 900, .gas = true}};
  REQUIRE(set.set_pressure(parts));
  scene.pressures = parts;
  const auto model = load_model(save_model(*model_of(scene)));
  REQUIRE(model);
  Cloth of_model = cloth_of(scene, {});
  auto of_saved = Cloth::create(model.value(), {});
  run(set, 0.01, 3);
  run(of_model, 0.01, 3);
  run(of_saved.value(), 0.01, 3);
  CHECK(of_model.state_hash() == set.state_hash());
  CHECK(of_saved.value().state_hash() == set.state_hash());
}

TEST_CASE("threads and instruction sets change no bit of pressures") {
  const TriangleMesh ball = icosphere(kBalloonRadius, 5);
  SceneDescription scene = in_air(loose(ball.vertices, triangles_of(ball), 1), {0, -3, 0});
  scene.pressures = {{.pressure = 300, .gas = true}};
  scene.air.triangles.resize(scene.air.triangles.size() / 2);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    for (const Isa isa : {Isa::avx2, Isa::avx512}) {
      if (!resolve(isa)) continue;
      Cloth cloth =
          cloth_of(scene, {.solver = Solver::small_steps, .isa = isa, .threads = threads});
      run(cloth, 1. / 60, 3);
      hashes.push_back(cloth.state_hash());
    }
  }
  for (const std::uint64_t hash : hashes) CHECK(hash == hashes.front());
}

TEST_CASE("a cloth that sleeps wakes where its pressure becomes another one") {
  SceneDescription scene = flap();
  scene.damping.motion = 5;
  scene.gravity = {0, -10, 0};
  Cloth cloth = cloth_of(scene, {.solver = Solver::small_steps, .sleep = true});
  REQUIRE(cloth.set_pressure(1));
  for (int k = 0; k < 2000 && !step(cloth, 1. / 60).asleep; ++k) {
  }
  REQUIRE(step(cloth, 1. / 60).asleep);
  REQUIRE(cloth.set_pressure(1));
  CHECK(step(cloth, 1. / 60).asleep);
  REQUIRE(cloth.set_pressure(40));
  CHECK_FALSE(step(cloth, 1. / 60).asleep);
}

}  // namespace
}  // namespace weft::test::engine_cpp_interface_pressures
