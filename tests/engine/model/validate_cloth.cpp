/// Every setting, time step and state that a Cloth refuses, and that a refusal changes nothing.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/clothes.h"

namespace weft::test::engine_model_validate_cloth {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check_message(const std::string& message, const std::vector<std::string>& parts) {
  CAPTURE(message);
  CHECK(message.find('\n') == std::string::npos);
  for (const std::string& part : parts) {
    CAPTURE(part);
    CHECK(message.find(part) != std::string::npos);
  }
}

void check_setting(const std::function<void(Settings&)>& spoil,
                   const std::vector<std::string>& parts) {
  Settings settings;
  spoil(settings);
  const auto cloth = Cloth::create(model_of(scene_of("hang", 4)), settings);
  REQUIRE_FALSE(cloth);
  check_message(cloth.error(), parts);
}

TEST_CASE("tolerances must be finite and positive") {
  for (const auto& [name, field] :
       {std::pair{"tolerance", &Settings::tolerance},
        std::pair{"contact_tolerance", &Settings::contact_tolerance},
        std::pair{"velocity_tolerance", &Settings::velocity_tolerance}}) {
    const auto set = [field = field](double value) {
      return [=](Settings& s) { s.*field = value; };
    };
    check_setting(set(0), {name, "0"});
    check_setting(set(-0.25), {name, "-0.25"});
    check_setting(set(kNan), {name, "nan"});
    check_setting(set(kInfinity), {name, "inf"});
  }
}

TEST_CASE("a tolerance of the motion is for small steps, whose number is not given") {
  const auto spoil = [](auto Settings::*field, auto value) {
    return [=](Settings& s) {
      s.motion_tolerance = 0.125;
      s.*field = value;
    };
  };
  for (const double value : {-0.25, kNan, kInfinity, 1e-6})
    check_setting([=](auto& s) { s.motion_tolerance = value; }, {"motion_tolerance"});
  for (const Solver solver : {Solver::gauss_seidel, Solver::direct, Solver::yarn}) {
    check_setting(spoil(&Settings::solver, solver),
                  {"motion_tolerance", "0.125", name(solver).data()});
  }
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle})
    check_setting(spoil(&Settings::scheme, scheme), {"motion_tolerance", name(scheme).data()});
  check_setting(spoil(&Settings::velocity_correction, true),
                {"motion_tolerance", "velocity_correction"});
  check_setting(spoil(&Settings::substeps, 4), {"motion_tolerance", "automatic substeps"});
  check_setting(spoil(&Settings::iterations, 4), {"motion_tolerance", "iterations"});
}

// In floats an error of 1e-40 m over 1e-40 m is not a number, and nothing would be out of
// tolerance.
TEST_CASE("the simd backend refuses what floats cannot square") {
  const char* range = "from 1e-18 to 1e18";
  check_setting([](auto& s) { s.tolerance = 1e-40; }, {"tolerance * constraints[", range});
  const auto velocities = [](auto& s) {
    s.velocity_correction = true;
    s.velocity_tolerance = 1e20;
  };
  check_setting(velocities, {"velocity_tolerance", range, "1e+20"});
  const Settings contacts{.contact_tolerance = 1e-20};
  const auto touching = Cloth::create(model_of(scene_of("hang_sphere", 4)), contacts);
  REQUIRE_FALSE(touching);
  check_message(touching.error(), {"contact_tolerance", range, "1e-20"});
  SceneDescription scene = scene_of("hang", 4);
  scene.constraints[5].rest_length = 1e-30;
  const auto cloth = Cloth::create(model_of(scene), {});
  REQUIRE_FALSE(cloth);
  check_message(cloth.error(), {"constraints[5].rest_length", range, "1e-30"});
  CHECK(Cloth::create(model_of(scene), on(Backend::reference, Settings{})));
}

bool fits_lanes(double rest, const Settings& settings) {
  SceneDescription scene = free_bar(1, 1);
  scene.constraints[0].rest_length = rest;
  scene.spheres = {0};
  scene.radii = {0.1, 0};
  return static_cast<bool>(Cloth::create(model_of(scene), settings));
}

TEST_CASE("the simd backend takes lengths and tolerances from 1e-18 to 1e18") {
  for (const double fits : {1e-18, 1.01e-18, 0.99e18, 1e18}) {
    CAPTURE(fits);
    CHECK(fits_lanes(fits, {.tolerance = 1}));
    CHECK(fits_lanes(1, {.tolerance = fits}));
    CHECK(fits_lanes(1, {.contact_tolerance = fits}));
    CHECK(fits_lanes(1, {.velocity_tolerance = fits, .velocity_correction = true}));
    CHECK(fits_lanes(1, {.velocity_tolerance = fits, .scheme = Scheme::rattle}));
  }
  for (const double beyond : {0.99e-18, 1.01e18}) {
    CAPTURE(beyond);
    CHECK_FALSE(fits_lanes(beyond, {.tolerance = 1 / beyond}));
    CHECK_FALSE(fits_lanes(1, {.tolerance = beyond}));
    CHECK_FALSE(fits_lanes(1, {.contact_tolerance = beyond}));
    CHECK_FALSE(fits_lanes(1, {.velocity_tolerance = beyond, .velocity_correction = true}));
    CHECK_FALSE(fits_lanes(1, {.velocity_tolerance = beyond, .scheme = Scheme::rattle}));
  }
}

TEST_CASE("tolerances that nothing uses may be anything") {
  const auto hang = model_of(scene_of("hang", 4));
  CHECK(Cloth::create(hang, {.contact_tolerance = 1e-20, .velocity_tolerance = 1e20}));
  CHECK(Cloth::create(hang, {.tolerance = 1e-40, .iterations = 3}));
}

TEST_CASE("iterations, their bound and the impulse limit must be in range") {
  check_setting([](auto& s) { s.iterations = -3; }, {"iterations", "-3"});
  check_setting([](auto& s) { s.max_iterations = 0; }, {"max_iterations", "0"});
  check_setting([](auto& s) { s.max_iterations = -1; }, {"max_iterations", "-1"});
  check_setting([](auto& s) { s.measuring.impulse_limit = -0.5; }, {"impulse_limit", "-0.5"});
  check_setting([](auto& s) { s.measuring.impulse_limit = kNan; }, {"impulse_limit", "nan"});
  check_setting([](auto& s) { s.measuring.impulse_limit = kInfinity; }, {"impulse_limit", "inf"});
}

TEST_CASE("threads must be in range") {
  check_setting([](auto& s) { s.threads = -1; }, {"threads", "-1", "64"});
  check_setting([](auto& s) { s.threads = kMaxThreads + 1; }, {"threads", "65", "64"});
  for (const int threads : {0, 1, kMaxThreads}) {
    Settings settings;
    settings.threads = threads;
    const auto cloth = Cloth::create(model_of(scene_of("hang", 4)), settings);
    REQUIRE(cloth);
    CHECK(cloth.value().settings().threads == threads);
  }
}

TEST_CASE("directions must not be renewed after a negative number of iterations") {
  check_setting([](auto& s) { s.measuring.renew_after = -1; }, {"renew_after", "-1"});
}

TEST_CASE("only the reference limits impulses") {
  check_setting([](auto& s) { s.measuring.impulse_limit = 0.5; },
                {"impulse_limit", "reference", "0.5"});
  Settings settings = on(Backend::reference);
  settings.measuring.impulse_limit = 0.5;
  CHECK(Cloth::create(model_of(scene_of("hang", 4)), settings));
}

TEST_CASE("products are for Gauss-Seidel in lanes that anticipates") {
  const auto products = [](Solver solver, Backend backend, bool anticipate) {
    return [=](auto& s) {
      s.measuring.anticipate_products = true;
      s.solver = solver;
      s.backend = backend;
      s.measuring.anticipate = anticipate;
    };
  };
  check_setting(products(Solver::gauss_seidel, Backend::reference, true),
                {"anticipate_products", "simd", "reference"});
  for (const Solver solver :
       {Solver::automatic, Solver::yarn, Solver::direct, Solver::small_steps}) {
    check_setting(products(solver, Backend::simd, true),
                  {"anticipate_products", "gauss_seidel", name(solver).data()});
  }
  check_setting(products(Solver::gauss_seidel, Backend::simd, false),
                {"anticipate_products", "anticipate", "off"});
  Settings settings;
  products(Solver::gauss_seidel, Backend::simd, true)(settings);
  CHECK(Cloth::create(model_of(scene_of("hang", 4)), settings));
}

TEST_CASE("choices that do not exist are refused") {
  check_setting([](auto& s) { s.solver = static_cast<Solver>(200); }, {"solver", "200"});
  check_setting([](auto& s) { s.scheme = static_cast<Scheme>(200); }, {"scheme", "200"});
  check_setting([](auto& s) { s.backend = static_cast<Backend>(200); }, {"backend", "200"});
  check_setting([](auto& s) { s.isa = static_cast<Isa>(200); }, {"isa", "200"});
  check_setting([](auto& s) { s.measuring.directions = static_cast<Directions>(200); },
                {"directions", "200"});
}

TEST_CASE("a missing model is refused") {
  const auto cloth = Cloth::create(nullptr, {});
  REQUIRE_FALSE(cloth);
  check_message(cloth.error(), {"model"});
}

/// A moving cloth, a call on it that must fail, and its state before and after.
void check_refusal(const std::function<Result<void>(Cloth&)>& call,
                   const std::vector<std::string>& parts) {
  Cloth cloth = cloth_of(scene_of("hang", 4), {});
  run(cloth, 0.01, 5);
  const std::uint64_t before = cloth.state_hash();
  const auto result = call(cloth);
  REQUIRE_FALSE(result);
  check_message(result.error(), parts);
  CHECK(cloth.state_hash() == before);

  Cloth untouched = cloth_of(scene_of("hang", 4), {});
  run(untouched, 0.01, 10);
  run(cloth, 0.01, 5);
  CHECK(cloth.state_hash() == untouched.state_hash());
}

Result<void> try_step(Cloth& cloth, double dt) {
  auto report = cloth.step(dt);
  if (!report) return Error{report.error()};
  return {};
}

TEST_CASE("time steps must be finite and positive") {
  check_refusal([](Cloth& c) { return try_step(c, 0); }, {"dt", "0"});
  check_refusal([](Cloth& c) { return try_step(c, -0.01); }, {"dt", "-0.01"});
  check_refusal([](Cloth& c) { return try_step(c, kNan); }, {"dt", "nan"});
  check_refusal([](Cloth& c) { return try_step(c, kInfinity); }, {"dt", "inf"});
  check_refusal([](Cloth& c) { return try_step(c, 1e-310); }, {"dt", "inverted", "1e-310"});
}

using Write = Result<void> (Cloth::*)(std::span<const Vec3>);

void check_write(Write write, const char* field) {
  const auto sized = [write](std::size_t size) {
    return [=](Cloth& c) { return (c.*write)(std::vector<Vec3>(size, Vec3{1, 2, 3})); };
  };
  check_refusal(sized(15), {field, "16", "15"});
  check_refusal(sized(17), {field, "16", "17"});
  using Member = double Vec3::*;
  for (const Member component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const auto spoilt = [=](double value) {
      return [=](Cloth& c) {
        std::vector<Vec3> in(16, Vec3{1, 2, 3});
        in[11].*component = value;
        return (c.*write)(in);
      };
    };
    check_refusal(spoilt(kNan), {field, "[11]", "nan"});
    check_refusal(spoilt(-kInfinity), {field, "[11]", "-inf"});
  }
}

TEST_CASE("writes must be finite, one vector per particle, and fail as a whole") {
  check_write(&Cloth::write_positions, "positions");
  check_write(&Cloth::write_velocities, "velocities");
  check_write(&Cloth::write_forces, "forces");
  check_refusal([](Cloth& c) { return c.write_positions({}); }, {"positions", "16", "0"});
  check_refusal([](Cloth& c) { return c.write_velocities({}); }, {"velocities", "16", "0"});
}

TEST_CASE("only fixed particles are moved and placed, and only where one can be") {
  using Put = Result<void> (Cloth::*)(std::uint32_t, Vec3);
  for (const Put put : {Put(&Cloth::move_fixed), Put(&Cloth::place_fixed)}) {
    const auto check = [&](std::uint32_t particle, Vec3 to, const std::vector<std::string>& words) {
      check_refusal([&](Cloth& c) { return (c.*put)(particle, to); }, words);
    };
    check(16, {0, 0, 0}, {"particle", "16"});
    check(kNoIndex, {0, 0, 0}, {"particle", "4294967295"});
    check(9, {0, 0, 0}, {"fixed", "9"});
    check(2, {0, kNan, 0}, {"position", "2", "nan"});
    check(2, {0, 0, kInfinity}, {"position", "2", "inf"});
  }
}

TEST_CASE("changes are of what there is, each once, and by values that it may have") {
  const auto check = [](const Changes& changes, const std::vector<std::string>& words) {
    check_refusal([&](Cloth& c) { return c.change(changes); }, words);
  };
  check({.fix = {9, 16}}, {"fix[1]: no such particle, the scene has 16 (16)"});
  check({.fix = {9, 8, 9}}, {"fix[2]: particle is listed twice (9)"});
  check({.fix = {9, 2}}, {"fix[1]: is fixed already (2)"});
  check({.release = {kNoIndex}}, {"release[0]: no such particle", "4294967295"});
  check({.release = {1, 1}}, {"release[1]: particle is listed twice (1)"});
  check({.release = {1, 7}}, {"release[1]: is not fixed (7)"});
  check({.masses = {{16, 1}}}, {"masses[0]: no such particle, the scene has 16 (16)"});
  check({.masses = {{3, 1}, {3, 1}}}, {"masses[1]: particle is listed twice (3)"});
  for (const double mass : {0., -1., kNan, kInfinity})
    check({.masses = {{3, mass}}}, {"masses[0]"});
  check({.masses = {{3, 1}, {4, 1e-200}}}, {"masses[1]: must be from 1e-150 to 1e150"});
  const std::string constraints = std::to_string(scene_of("hang", 4).constraints.size());
  check({.rest_lengths = {{500, 1}}},
        {"rest_lengths[0]: no such constraint, the scene has " + constraints + " (500)"});
  check({.rest_lengths = {{5, 1}, {5, 1}}}, {"rest_lengths[1]: constraint is listed twice (5)"});
  for (const double rest : {0., -1., kNan, 1e160})
    check({.rest_lengths = {{5, rest}}}, {"rest_lengths[0]"});
  check({.rest_lengths = {{5, 1e-30}}}, {"rest_length", "simd backend", "1e-30"});
  check({.compliances = {{5, -1}}}, {"compliances[0]: must be finite and at least 0 (-1)"});
  check({.compliances = {{5, kNan}}}, {"compliances[0]", "nan"});
  check({.membrane = {{0, 1, 1, 1}}}, {"membrane[0]: no such triangle"});
  check({.bending = {{7, 1}}}, {"bending[0]: no such bending element"});
  check({.damping = Damping{.motion = -1}}, {"damping.motion", "-1"});
  check({.air = ChangedAir{.drag = kNan}}, {"air.drag", "nan"});
  check({.air = ChangedAir{.drag = 0.5}}, {"air.drag: given without air.triangles"});
  check({.compliances = {{5, 1}, {5, 1}}}, {"compliances[1]: constraint is listed twice (5)"});
  check({.fix = {9}, .masses = {{3, -1}}}, {"masses[0]"});
}

TEST_CASE("what a solver does not know no change brings in") {
  Cloth cloth = cloth_of(scene_of("hang", 4), {.scheme = Scheme::rattle});
  const auto refused = cloth.change({.fix = {9}, .compliances = {{5, 1e-3}}});
  REQUIRE_FALSE(refused);
  check_message(refused.error(), {"scheme", "compliance", "rattle"});
  CHECK(cloth.change({.fix = {9}}));  // it was not
}

TEST_CASE("what has an anchor is not fixed") {
  SceneDescription scene = scene_of("hang", 4);
  scene.anchors = {{.particle = 9, .max_distance = 0.5}};
  Cloth cloth = cloth_of(scene, {});
  const auto refused = cloth.change({.fix = {10, 9}});
  REQUIRE_FALSE(refused);
  check_message(refused.error(), {"fix[1]", "has an anchor", "9"});
  CHECK(cloth.change({.fix = {10}}));
}

TEST_CASE("anchors are moved all at once, to where they can be") {
  SceneDescription scene = scene_of("hang", 4);
  scene.anchors = {{9, {}, {0, 1, 0}, 0.5, 0, 1}, {10, {}, {}, 0.5, 0, 0}};
  Cloth cloth = cloth_of(scene, {});
  const std::vector<Vec3> two{{1, 2, 3}, {4, 5, 6}}, up{{0, 1, 0}, {0, 0, 0}};
  Cloth untouched = cloth.clone();
  const auto check = [&](std::vector<Vec3> points, const std::vector<Vec3>& normals,
                         const std::vector<std::string>& parts) {
    const auto moved = cloth.move_anchors(points, normals);
    REQUIRE_FALSE(moved);
    check_message(moved.error(), parts);
  };
  check({{1, 2, 3}}, {}, {"points", "2", "1"});
  check(two, {{0, 1, 0}}, {"normals", "2", "1"});
  check({{1, 2, 3}, {4, kNan, 6}}, up, {"points[1]", "nan"});
  check(two, {{0, 1, 0}, {0, kInfinity, 0}}, {"normals[1]", "inf"});
  check(two, {{0, 0, 0}, {0, 0, 0}}, {"normals[0]", "a length"});
  run(cloth, 0.01, 2);
  run(untouched, 0.01, 2);
  CHECK(cloth.state_hash() == untouched.state_hash());
  CHECK(cloth.move_anchors(two, up));
  CHECK(cloth.move_anchors(two));
  check_refusal([](Cloth& c) { return c.move_anchors(std::vector<Vec3>(1)); }, {"points", "0"});
}

TEST_CASE("reads into a span of the wrong size copy nothing") {
  const Backend backend = each_backend();
  Cloth cloth = cloth_of(scene_of("hang", 4), on(backend));
  for (const std::size_t size : {0u, 15u, 17u}) {
    std::vector<Vec3> out(size, Vec3{7, 7, 7});
    const auto p = cloth.read_positions(std::span<Vec3>(out));
    const auto v = cloth.read_velocities(out);
    REQUIRE_FALSE(p);
    REQUIRE_FALSE(v);
    check_message(p.error(), {"16", std::to_string(size).c_str()});
    check_message(v.error(), {"16", std::to_string(size).c_str()});
    for (const Vec3& x : out) CHECK((x.x == 7 && x.y == 7 && x.z == 7));
  }
  const auto check_floats = [&](std::size_t size, std::size_t stride,
                                const std::vector<std::string>& parts) {
    std::vector<float> floats(size, 7.0f);
    const auto p = cloth.read_positions({floats, stride});
    const auto v = cloth.read_velocities({floats, stride});
    REQUIRE_FALSE(p);
    REQUIRE_FALSE(v);
    check_message(p.error(), parts);
    check_message(v.error(), parts);
    for (const float x : floats) CHECK(x == 7.0f);
  };
  for (const std::size_t size : {0u, 45u, 47u, 51u})
    check_floats(size, 3, {"out", "16 vectors of stride 3", std::to_string(size)});
  for (const std::size_t size : {15u * 8, 15u * 8 + 2, 16u * 8 + 3})
    check_floats(size, 8, {"out", "16 vectors of stride 8", std::to_string(size)});
  for (const std::size_t stride : {0u, 1u, 2u})
    check_floats(48, stride, {"out", "stride of 3 at least", std::to_string(stride)});
  check_floats(48, ~std::size_t{0}, {"out", "16 vectors", "48"});
  std::vector<float> packed(48, 7.0f);
  const auto far = cloth.read_positions({packed}, {0, kInfinity, 0});
  REQUIRE_FALSE(far);
  check_message(far.error(), {"origin", "must be finite", "inf"});
  CHECK(packed == std::vector<float>(48, 7.0f));
}

}  // namespace
}  // namespace weft::test::engine_model_validate_cloth
