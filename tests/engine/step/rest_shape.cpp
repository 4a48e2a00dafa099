/// Shapes at rest that change (Cloth::set_rest_shape), against closed forms.
#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/model/change.h"
#include "tests/support/clothes.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_step_rest_shape {
namespace {

constexpr double kLength = 0.5, kWidth = 0.1;  // m

/// A strip that hangs from its topmost row: of quads, or of triangles.
MeshDescription strip(const Material& material, Cut cut, std::uint32_t rows) {
  MeshDescription mesh = sheet(
      rows + 1, 5,
      [rows](double row, double column) {
        return Vec3{kWidth * column / 4, -kLength * row / rows, 0};
      },
      [cut](std::uint32_t, std::uint32_t) { return cut; });
  mesh.material = material;
  mesh.pins = {0, 1, 2, 3, 4};
  return mesh;
}

/// Soft along the warp, heavy, and damped so that it comes to rest soon.
Material soft(double stiffness) {
  return {.density = 0.4, .warp = stiffness, .weft = stiffness, .shear = stiffness / 10};
}

double lowest(const Cloth& cloth) { return -cloth.bounds().least.y; }

/// It hangs at `scale` times its length, and is as much longer by its weight as at first: a strip
/// of any size is under the same load, and longer by the load over the stiffness per width.
TEST_CASE("a strip that grows hangs at as many times its length, at any frame rate" *
          doctest::test_suite("long")) {
  for (const double stiffness : {40., 400.}) {
    for (const Cut cut : {Cut::none, Cut::first}) {
      for (const int rate : {30, 60, 240}) {
        for (const double scale : {0.7, 1.5}) {
          CAPTURE(stiffness);
          CAPTURE(rate);
          CAPTURE(scale);
          SceneDescription scene = made(strip(soft(stiffness), cut, 20)).scene;
          scene.damping.motion = 4;
          Cloth cloth = cloth_of(scene, {.threads = 1});
          for (int k = 1; k <= rate; ++k) {
            REQUIRE(cloth.set_rest_shape(scene, 1 + (scale - 1) * k / rate));
            CHECK(step(cloth, 1. / rate).status == Status::converged);
          }
          // The pins are a rod that keeps its width.
          run(cloth, 1. / rate, 2 * rate);
          const double weight = 0.4 * kLength * kWidth * 10;
          const double longer = kLength * weight / (2 * stiffness * kWidth);
          CHECK(lowest(cloth) == doctest::Approx(scale * kLength + longer).epsilon(0.02));
        }
      }
    }
  }
}

TEST_CASE("strain is measured against the new shape, at once") {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}};
  scene.masses = {1, 1};
  scene.constraints = {{0, 1, 1, ConstraintKind::distance, 1e-3}};
  Cloth cloth = cloth_of(scene, {});
  REQUIRE(cloth.set_rest_shape(scene, 0.8));
  CHECK(cloth.strain().max == doctest::Approx(0.25));
  REQUIRE(cloth.set_rest_shape(scene, 2));  // a scale does not add up
  CHECK(cloth.strain().max == doctest::Approx(0.5));
  CHECK(cloth.energy().elastic == doctest::Approx(0.5 * 1 / 1e-3));
}

/// m^2
double area(const Cloth& cloth, const SceneDescription& scene) {
  double sum = 0;
  for (const auto& [a, b, c] : scene.surface) {
    const Vec3 x = cloth.position(a);
    sum += 0.5 * length(cross(cloth.position(b) - x, cloth.position(c) - x));
  }
  return sum;
}

TEST_CASE(
    "a balloon that grows has as many times its area, and its pressure falls with its volume") {
  for (const int rate : {30, 60, 240}) {
    CAPTURE(rate);
    MeshDescription mesh;  // a cube whose faces have 4 x 4 cells, as a ball
    constexpr int kCells = 4;
    const auto add_face = [&](Vec3 o, Vec3 u, Vec3 v) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (int i = 0; i <= kCells; ++i) {
        for (int j = 0; j <= kCells; ++j) {
          const Vec3 p = o + (1. / kCells * i) * u + (1. / kCells * j) * v;
          mesh.positions.push_back((0.1 / length(p)) * p);
        }
      }
      for (std::uint32_t i = 0; i < kCells; ++i) {
        for (std::uint32_t j = 0; j < kCells; ++j) {
          const std::uint32_t a = first + i * (kCells + 1) + j, b = a + kCells + 1;
          for (const std::uint32_t corner : {a, b, b + 1, a, b + 1, a + 1})
            mesh.corners.push_back(corner);
        }
      }
    };
    add_face({-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
    add_face({-1, -1, -1}, {0, 2, 0}, {2, 0, 0});
    add_face({1, -1, -1}, {0, 2, 0}, {0, 0, 2});
    add_face({-1, -1, -1}, {0, 0, 2}, {0, 2, 0});
    add_face({-1, 1, -1}, {0, 0, 2}, {2, 0, 0});
    add_face({-1, -1, -1}, {2, 0, 0}, {0, 0, 2});
    mesh.weld_distance = 1e-6;
    mesh.material = Material{.density = 0.2, .warp = 2000, .weft = 2000, .shear = 600};
    SceneDescription scene = made(mesh).scene;
    scene.gravity = {};
    scene.damping.motion = 3;
    scene.pressures = {{.pressure = 20, .gas = true}};
    Cloth cloth = cloth_of(scene, {.threads = 1});
    run(cloth, 1. / rate, rate);
    const double before = area(cloth, scene), gas = cloth.pressures()[0].volume;
    constexpr double kScale = 1.001;
    for (int k = 1; k <= rate; ++k) {
      REQUIRE(cloth.set_rest_shape(scene, 1 + (kScale - 1) * k / rate));
      CHECK(step(cloth, 1. / rate).status == Status::converged);
    }
    run(cloth, 1. / rate, rate);
    CHECK(cloth.pressures()[0].volume > gas);
    CHECK(cloth.pressures()[0].pressure < 20);
    REQUIRE(cloth.set_pressure(std::span<const Pressure>{}));
    for (int k = 1; k <= rate; ++k) {
      REQUIRE(cloth.set_rest_shape(scene, kScale + (1.5 - kScale) * k / rate));
      step(cloth, 1. / rate);
    }
    run(cloth, 1. / rate, rate);
    CHECK(area(cloth, scene) == doctest::Approx(1.5 * 1.5 * before).epsilon(0.01));
  }
}

/// A sheet that is bent by 60 degrees along its middle, at rest.
TEST_CASE("angles at rest stay as the shape grows") {
  const double slope = std::tan(M_PI / 6);
  MeshDescription mesh = sheet(
      3, 5,
      [slope](double row, double column) {
        return Vec3{0.1 * column, 0.1 * row, 0.1 * slope * std::abs(column - 2)};
      },
      [](std::uint32_t row, std::uint32_t column) {
        return (row + column) % 2 == 0 ? Cut::first : Cut::second;
      });
  mesh.material = Material{.density = 0.1, .warp = 500, .weft = 500, .shear = 200, .bending = 1e-3};
  SceneDescription scene = made(mesh).scene;
  scene.gravity = {};
  scene.damping = {.motion = 5};
  const auto fold = [&](const Cloth& cloth) {  // cosine between the borders' planes
    const auto at = [&](std::uint32_t i) { return cloth.position(i); };
    const Vec3 left = at(2) - at(0), right = at(4) - at(2);
    return dot(left, right) / (length(left) * length(right));
  };
  Cloth cloth = cloth_of(scene, {.threads = 1});
  const double before = fold(cloth);
  for (int k = 1; k <= 60; ++k) {
    REQUIRE(cloth.set_rest_shape(scene, 1 + 0.5 * k / 60));
    step(cloth, 1. / 60);
  }
  run(cloth, 1. / 60, 60);
  CHECK(fold(cloth) == doctest::Approx(before).epsilon(0.01));
  CHECK(cloth.strain().max < 0.01);
  CHECK(distance(cloth.position(0), cloth.position(10)) == doctest::Approx(0.3).epsilon(0.01));
  CHECK(bending_energy(with_rest_shape(*cloth.model(), scene, 1.5).value(), positions(cloth)) <
        1e-6);
}

TEST_CASE("a cloth with another shape is one of the description that has it, to the last bit") {
  for (const Cut cut : {Cut::none, Cut::first}) {
    const SceneDescription scene = made(strip(soft(200), cut, 8)).scene;
    Cloth cloth = cloth_of(scene, {.threads = 1});
    REQUIRE(cloth.set_rest_shape(scene, 1.2));
    Cloth built = cloth_of(with_rest_shape(*model_of(scene), scene, 1.2).value(), {.threads = 1});
    for (int k = 0; k < 5; ++k) {
      step(cloth, 0.01);
      step(built, 0.01);
      CHECK(cloth.state_hash() == built.state_hash());
    }
    Cloth same = cloth_of(scene, {.threads = 1}), other = cloth_of(scene, {.threads = 1});
    run(same, 0.01, 5);
    run(other, 0.01, 5);
    REQUIRE(other.set_rest_shape(scene));
    run(same, 0.01, 5);
    run(other, 0.01, 5);
    CHECK(same.state_hash() == other.state_hash());
    Cloth loaded = cloth_of(scene, {.threads = 1});  // by its model and its state
    loaded = Cloth::create(load_model(save_model(*cloth.model())).value(), {.threads = 1}).value();
    REQUIRE(loaded.load_state(cloth.save_state()));
    run(loaded, 0.01, 5);
    run(cloth, 0.01, 5);
    CHECK(loaded.state_hash() == cloth.state_hash());
  }
}

TEST_CASE("layers keep the distances that they have in the new shape") {
  MeshDescription mesh = strip(soft(200), Cut::first, 20);
  SceneDescription scene = made(mesh).scene;  // cells of 25 mm
  scene.self_contact = {.on = true, .thickness = 0.02};
  scene.gravity = {};
  scene.fixed = {};
  Cloth cloth = cloth_of(scene, {.threads = 1});
  for (int k = 1; k <= 60; ++k) {
    REQUIRE(cloth.set_rest_shape(scene, 1 - 0.5 * k / 60));  // cells of half the thickness
    step(cloth, 1. / 60);
  }
  run(cloth, 1. / 60, 30);
  CHECK(lowest(cloth) - -cloth.bounds().most.y == doctest::Approx(0.5 * kLength).epsilon(0.03));
  CHECK(cloth.bounds().most.z - cloth.bounds().least.z < 2e-3);
}

TEST_CASE("shapes that are none, or of another cloth, are refused and change nothing") {
  const SceneDescription scene = made(strip(soft(200), Cut::first, 4)).scene;
  Cloth cloth = cloth_of(scene, {.threads = 1});
  const auto model = cloth.model();
  const auto refusal = [&](auto&& change, double scale = 1) {
    SceneDescription other = scene;
    change(other);
    const auto done = cloth.set_rest_shape(other, scale);
    CHECK(cloth.model() == model);
    return done ? std::string() : done.error();
  };
  const auto nothing = [](SceneDescription&) {};
  CHECK(refusal(nothing, 0) == "scale: must be finite and greater than 0 (0)");
  CHECK(refusal(nothing, -1).find("scale") == 0);
  CHECK(refusal(nothing, std::numeric_limits<double>::infinity()).find("scale") == 0);
  CHECK(refusal([](auto& s) { s.membrane.pop_back(); }).find("membrane: ") == 0);
  CHECK(refusal([](auto& s) {
          std::swap(s.membrane[0], s.membrane[3]);
        }).find("membrane[0].particles") == 0);
  CHECK(refusal([](auto& s) {
          s.membrane[1].rest[2] = s.membrane[1].rest[0];
        }).find("membrane[1].rest") == 0);
  CHECK(refusal(nothing, 1e-200).find("membrane[0].rest") == 0);
  SceneDescription bar;
  bar.positions = {{0, 0, 0}, {1, 0, 0}};
  bar.masses = {1, 1};
  bar.constraints = {{0, 1, 1}};
  Cloth rigid = cloth_of(bar, {});
  bar.constraints[0].rest_length = -2;
  CHECK(rigid.set_rest_shape(bar).error() ==
        "constraints[0].rest_length: must be finite and greater than 0 (-2)");
}

}  // namespace
}  // namespace weft::test::engine_step_rest_shape
