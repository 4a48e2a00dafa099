/// What C lets a caller do wrong is said, and nothing crashes or changes.
#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "engine/c_interface/calls.h"
#include "engine/c_interface/scene_arrays.h"
#include "engine/c_interface/settings.h"
#include "tests/support/c_interface.h"
#include "tests/support/clothes.h"

namespace weft::test::engine_c_interface_misuse {
namespace {

void check_refused(weft_result result, const std::string& message) {
  CHECK(result == WEFT_REFUSED);
  CHECK(std::string(weft_last_message()).find(message) != std::string::npos);
}

struct Pendulum {
  std::vector<double> positions{0, 0, 0, 1, 0, 0}, masses{1, 1}, lengths{1};
  std::vector<std::uint32_t> ends{0, 1}, fixed{0};
  weft_scene scene = initial(weft_init_scene);

  Pendulum() {
    scene.particle_count = 2, scene.positions = positions.data(), scene.masses = masses.data();
    scene.constraint_count = 1, scene.constraint_particles = ends.data();
    scene.rest_lengths = lengths.data();
    scene.fixed_count = 1, scene.fixed = fixed.data();
  }
  Owned<weft_cloth> cloth() const {
    const auto model =
        made<weft_model>([&](weft_model** out) { return weft_build_model(&scene, out); });
    return made<weft_cloth>(
        [&](weft_cloth** out) { return weft_create_cloth(model.get(), nullptr, out); });
  }
};

TEST_CASE("the defaults are those of C++") {
  const auto scene = c_interface::read_scene(nullptr);
  check_refused(scene ? WEFT_OK : c_interface::fail(WEFT_REFUSED, scene.error()), "scene");
  const auto empty = initial(weft_init_scene);
  const SceneDescription usual, read = c_interface::read_scene(&empty).value();
  CHECK(read.gravity.y == usual.gravity.y);
  CHECK(read.friction == usual.friction);
  CHECK(read.self_contact == usual.self_contact);
  CHECK(read.air.density == usual.air.density);
  const auto settings = initial(weft_init_settings);
  const Settings s;
  CHECK(settings.tolerance == s.tolerance);
  CHECK(settings.max_iterations == s.max_iterations);
  CHECK(settings.renew_after == s.measuring.renew_after);
  CHECK(settings.solver == static_cast<int>(s.solver));
  CHECK(settings.skip == 1);
  CHECK(initial(weft_init_paper_settings).solver == WEFT_GAUSS_SEIDEL);
  const auto body = initial(weft_init_body);
  CHECK(body.thickness == Body{}.thickness);
  CHECK(body.friction == Body{}.friction);
  CHECK(body.rotation[3] == 1);
  const auto mesh = initial(weft_init_mesh);
  CHECK(mesh.mass == MeshDescription{}.mass);
  CHECK(mesh.thread_density == MeshDescription{}.thread_density);
  CHECK(mesh.seam_force == MeshDescription{}.seam_force);
  CHECK(initial(weft_init_material).friction == Material{}.friction);
  CHECK(initial(weft_init_report).worst_constraint == WEFT_NO_INDEX);
}

TEST_CASE("null handles, null structs and null places for results are named") {
  double three[3] = {};
  std::uint32_t id = 0;
  weft_model* model = nullptr;
  weft_cloth* cloth = nullptr;
  Pendulum pendulum;
  check_refused(weft_build_model(nullptr, &model), "scene: must not be NULL");
  check_refused(weft_build_model(&pendulum.scene, nullptr), "out: must not be NULL");
  check_refused(weft_create_cloth(nullptr, nullptr, &cloth), "model: must not be NULL");
  check_refused(weft_step(nullptr, 0.01, nullptr, nullptr), "cloth: must not be NULL");
  check_refused(weft_position(nullptr, 0, three), "cloth: must not be NULL");
  check_refused(weft_add_body(nullptr, nullptr, &id), "cloth: must not be NULL");
  check_refused(weft_find_material(nullptr, nullptr), "name: must not be NULL");
  check_refused(weft_init_settings(nullptr, sizeof(weft_settings)), "settings: must not be NULL");
  check_refused(weft_load_model(nullptr, 10, &model), "bytes: must not be NULL");
  CHECK(weft_particle_count(nullptr) == 0);
  CHECK(std::string(weft_last_message()) == "cloth: must not be NULL");
  CHECK(weft_state_hash(nullptr) == 0);
  CHECK(weft_cells(nullptr) == nullptr);
  CHECK(weft_surface_triangles(nullptr) == nullptr);
  weft_free_model(nullptr), weft_free_cloth(nullptr), weft_free_bytes(nullptr);
  const auto its = pendulum.cloth();
  auto body = initial(weft_init_body);
  check_refused(weft_add_body(its.get(), &body, &id), "body.shape: must not be NULL");
  CHECK(model == nullptr);
  CHECK(cloth == nullptr);
}

TEST_CASE("null arrays with counts, and counts beyond all sense") {
  Pendulum p;
  weft_model* model = nullptr;
  p.scene.rest_lengths = nullptr;
  check_refused(weft_build_model(&p.scene, &model), "rest_lengths: must not be NULL (1)");
  p.scene.rest_lengths = p.lengths.data();
  p.scene.particle_count = std::numeric_limits<std::size_t>::max();
  check_refused(weft_build_model(&p.scene, &model), "positions: there may be 4294967295 at most");
  p.scene.particle_count = 2;
  p.ends[1] = 7;
  check_refused(weft_build_model(&p.scene, &model), "constraints[0].b");
  p.ends[1] = 1;
  const auto cloth = p.cloth();
  const std::uint64_t before = weft_state_hash(cloth.get());
  check_refused(weft_write_positions(cloth.get(), 2, nullptr), "in: must not be NULL (2)");
  check_refused(weft_write_positions(cloth.get(), 1, p.positions.data()), "(1)");
  check_refused(weft_move_fixed(cloth.get(), 1, nullptr, p.positions.data()), "particles");
  check_refused(weft_read_float_positions(cloth.get(), {nullptr, 6, 3}, nullptr), "out");
  check_refused(weft_read_positions(cloth.get(), 2, nullptr), "out");
  double place[3] = {5, 5, 5};
  check_refused(weft_position(cloth.get(), 2, place), "particle: the cloth has 2 (2)");
  CHECK(place[0] == 5);
  check_refused(weft_step_all(1, nullptr, nullptr), "steps: must not be NULL");
  check_refused(weft_step(cloth.get(), -1, nullptr, nullptr), "dt");
  CHECK(weft_state_hash(cloth.get()) == before);
}

TEST_CASE("choices that there are none of keep their value in the message") {
  const auto model = made<weft_model>([&](weft_model** out) {
    Pendulum p;
    return weft_build_model(&p.scene, out);
  });
  weft_cloth* cloth = nullptr;
  auto settings = initial(weft_init_settings);
  settings.solver = 256;
  check_refused(weft_create_cloth(model.get(), &settings, &cloth),
                "solver: must be from 0 to 4 (256)");
  settings = initial(weft_init_settings);
  settings.isa = -1;
  check_refused(weft_create_cloth(model.get(), &settings, &cloth), "isa: must be from 0 to 4 (-1)");
  CHECK(std::string(weft_solver_name(256)) == "unknown");
  CHECK(std::string(weft_solver_name(WEFT_YARN)) == "yarn");
  CHECK(std::string(weft_status_name(WEFT_NON_FINITE)) == "non_finite");
  CHECK(std::string(weft_stage_name(5)) == "report");
  CHECK(weft_committed(WEFT_PASSED_THROUGH) == 1);
  CHECK(weft_committed(WEFT_NON_FINITE) == 0);
  CHECK(weft_committed(-1) == 0);
  CHECK(weft_material_name(weft_material_count()) == nullptr);
  CHECK(std::string(weft_material_name(0)) == materials()[0].name);
  CHECK(std::string(weft_material_source(0)) == materials()[0].source);
}

TEST_CASE("structs of older and newer programs") {
  struct Newer {
    weft_settings known;
    double field;
  } newer;
  REQUIRE(weft_init_settings(&newer.known, sizeof newer) == WEFT_OK);
  CHECK(newer.field == 0);
  CHECK(c_interface::read_settings(&newer.known));
  newer.field = 1;
  CHECK(!c_interface::read_settings(&newer.known));

  struct Older {
    std::size_t size;
    double tolerance;
    double behind;
  } older{0, 0, 77};
  const std::size_t size = offsetof(Older, behind);
  REQUIRE(weft_init_settings(reinterpret_cast<weft_settings*>(&older), size) == WEFT_OK);
  CHECK(older.tolerance == Settings{}.tolerance);
  CHECK(older.behind == 77);
  older.tolerance = 0.25;
  alignas(weft_settings) std::byte bytes[sizeof(weft_settings)];
  std::memset(bytes, 0xff, sizeof bytes);
  std::memcpy(bytes, &older, size);
  const auto read = c_interface::read_settings(reinterpret_cast<const weft_settings*>(bytes));
  REQUIRE(read);
  CHECK(read.value().tolerance == 0.25);
  CHECK(read.value().max_iterations == Settings{}.max_iterations);

  weft_settings unset;
  std::memset(&unset, 0, sizeof unset);
  const auto refused = c_interface::read_settings(&unset);
  REQUIRE(!refused);
  CHECK(refused.error().find("settings.size") == 0);
  unset.size = 1u << 20;
  CHECK(!c_interface::read_settings(&unset));
}

TEST_CASE("exceptions become results") {
  CHECK(c_interface::call([]() -> Result<void> { throw std::bad_alloc(); }) == WEFT_OUT_OF_MEMORY);
  CHECK(c_interface::call([]() -> Result<void> { throw std::runtime_error("why"); }) ==
        WEFT_FAILED);
  CHECK(std::string(weft_last_message()) == "why");
  CHECK(c_interface::call([]() -> Result<void> { throw 7; }) == WEFT_FAILED);
  CHECK(c_interface::fail(WEFT_REFUSED, std::string(5000, 'x')) == WEFT_REFUSED);
  CHECK(std::strlen(weft_last_message()) == 1023);
}

TEST_CASE("bytes that are no state and no model") {
  const auto cloth = Pendulum().cloth();
  const char bytes[] = "neither";
  weft_model* model = nullptr;
  CHECK(weft_load_state(cloth.get(), bytes, sizeof bytes) == WEFT_REFUSED);
  CHECK(weft_load_model(bytes, sizeof bytes, &model) == WEFT_REFUSED);
  CHECK(model == nullptr);
}

}  // namespace
}  // namespace weft::test::engine_c_interface_misuse
