/// Sheets that tear: loads, strengths and cracks against closed forms.
#include <doctest/doctest.h>
#include <weft/mesh.h>
#include <weft/weft.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/model/change.h"
#include "tests/support/clothes.h"
#include "tools/scenes/rest_scale.h"

namespace weft::test::engine_step_tearing {
namespace {

constexpr double kRates[] = {30, 60, 240};  // Hz

/// A strip of fabric, `across` cells wide and twice as long, in the plane of x and
/// y. A notch reaches from x = 0 over `cut` vertices in the middle. Pinned at both ends.
constexpr double kStiffness = 200;  // N/m
constexpr double kStretch = 0.1;    // at which it tears
struct Strip {
  MeshCloth cloth;
  std::uint32_t across = 0;
  std::vector<std::uint32_t> top;
  double length = 0.4;
};
Strip strip(std::uint32_t across, std::uint32_t cut, bool is_grid, double strength,
            double shear = 0, double stiffness = kStiffness) {
  const double width = 0.2, h = width / across;
  const std::uint32_t rows = 2 * across, middle = rows / 2;
  MeshDescription mesh;
  const auto add = [&](double x, double y) {
    mesh.positions.push_back({x, y, 0});
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
  };
  Strip made;
  made.across = across;
  std::vector<std::vector<std::uint32_t>> below(rows + 1), above(rows + 1);
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= across; ++i) {
      const bool is_inner = i > 0 && i < across && j > 0 && j < rows && j != middle;
      const double jitter = is_grid || !is_inner ? 0 : 0.15 * h * std::sin(12.9 * i + 78.2 * j);
      const std::uint32_t v = add(i * h + jitter, j * h + 0.7 * jitter);
      below[j].push_back(v);
      above[j].push_back(j == middle && i < cut ? add(i * h, j * h + 1e-7) : v);
      if (j == 0 || j == rows) mesh.pins.push_back(v);
      if (j == rows) made.top.push_back(v);
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < across; ++i) {
      const std::uint32_t a = above[j][i], b = above[j][i + 1], c = below[j + 1][i + 1],
                          d = below[j + 1][i];
      if (is_grid) {
        mesh.corners.insert(mesh.corners.end(), {a, b, c, d});
        mesh.face_sizes.push_back(4);
      } else if ((i + j) % 2 == 0) {
        mesh.corners.insert(mesh.corners.end(), {a, b, c, a, c, d});
      } else {
        mesh.corners.insert(mesh.corners.end(), {a, b, d, b, c, d});
      }
    }
  }
  Material material{.density = 0.5,
                    .warp = stiffness,
                    .weft = stiffness,
                    .shear = shear,
                    .bending = 1e-6,
                    .damping_motion = 3};
  material.strength = strength;
  mesh.material = material;
  mesh.warp = {{0, 1, 0}};
  auto cloth = cloth_from_mesh(mesh);
  REQUIRE_MESSAGE(cloth, cloth.error());
  made.cloth = std::move(cloth).value();
  made.cloth.scene.gravity = {0, 0, 0};
  for (std::uint32_t& v : made.top) v = made.cloth.particle_of_vertex[v];
  return made;
}

void pull(Cloth& cloth, const Strip& strip, double stretch) {
  for (const std::uint32_t i : strip.top) {
    const Vec3 x = strip.cloth.scene.positions[i];
    REQUIRE(cloth.move_fixed(i, {x.x, x.y + stretch * strip.length, x.z}));
  }
}

/// Whether any element leads from one particle to the other.
bool joins(const SceneDescription& scene, std::uint32_t from, std::uint32_t to) {
  std::vector<std::uint32_t> first(scene.positions.size());
  std::iota(first.begin(), first.end(), 0u);
  const auto first_of = [&](std::uint32_t i) {
    while (first[i] != i) i = first[i];
    return i;
  };
  const auto join = [&](const auto& particles) {
    for (const std::uint32_t p : particles) {
      if (p == kNoIndex) continue;
      const auto [low, high] = std::minmax({first_of(particles[0]), first_of(p)});
      first[high] = low;
    }
  };
  for (const Constraint& c : scene.constraints)
    if (c.strength > 0) join(std::array{c.a, c.b});
  for (const MembraneElement& e : scene.membrane) join(e.particles);
  for (const auto& triangle : scene.surface) join(triangle);
  for (const BendingElement& e : scene.bending)
    if (e.weights[0] != 0 || e.weights[1] != 0) join(e.particles);
  return first_of(from) == first_of(to);
}

/// Pulls until it tears. Returns the stretch, over that at which the threads carry the strength.
double stretch_at_tear(Cloth& cloth, const Strip& made, double rate) {
  for (double stretch = 0; stretch < 2; stretch += 0.5 / rate) {
    pull(cloth, made, stretch * kStretch);
    if (step(cloth, 1 / rate).torn > 0) return stretch;
  }
  return 2;
}

TEST_CASE("a strip without shear tears where its uncut threads carry the strength" *
          doctest::test_suite("long")) {
  for (const std::uint32_t across : {8u, 16u}) {
    for (const std::uint32_t cut : {0u, across / 4}) {
      for (const double rate : kRates) {
        CAPTURE(across);
        CAPTURE(cut);
        CAPTURE(rate);
        const Strip made = strip(across, cut, true, kStiffness * kStretch);
        const Settings settings{.tolerance = 1e-3, .substeps = static_cast<int>(7680 / rate)};
        Cloth cloth = cloth_of(made.cloth.scene, settings);
        CHECK(stretch_at_tear(cloth, made, rate) == doctest::Approx(1).epsilon(0.03));
        REQUIRE(!cloth.torn().empty());
        CHECK(cloth.torn()[0].kind == Tear::sheet);
        CHECK(cloth.torn()[0].particle == made.cloth.scene.positions.size());
        const auto surface = cloth.surface();
        CHECK(surface.size() == made.cloth.scene.surface.size());
        CHECK(std::ranges::any_of(surface, [&](const auto& triangle) {
          return std::ranges::find(triangle, cloth.torn()[0].particle) != triangle.end();
        }));
        // It parts, and nothing joins its ends any more.
        for (double stretch = 1; stretch < 4; stretch += 1 / rate) {
          pull(cloth, made, stretch * kStretch);
          step(cloth, 1 / rate);
        }
        CHECK(!joins(description_of(*cloth.model()), made.top[0], 0));
      }
    }
  }
}

TEST_CASE("a strip of triangles tears where its tension is the strength" *
          doctest::test_suite("long")) {
  for (const std::uint32_t across : {8u, 16u}) {
    for (const double rate : kRates) {
      CAPTURE(across);
      CAPTURE(rate);
      const Strip made = strip(across, 0, false, kStiffness * kStretch, kStiffness / 2);
      REQUIRE(!made.cloth.scene.membrane.empty());
      const Settings settings{.tolerance = 1e-3, .substeps = static_cast<int>(7680 / rate)};
      Cloth cloth = cloth_of(made.cloth.scene, settings);
      CHECK(stretch_at_tear(cloth, made, rate) == doctest::Approx(1).epsilon(0.03));
      REQUIRE(!cloth.torn().empty());
      CHECK(cloth.torn()[0].kind == Tear::sheet);
      CHECK(cloth.torn()[0].load == doctest::Approx(kStiffness * kStretch).epsilon(0.02));
    }
  }
}

TEST_CASE("a strip between pins tears at its strength by automatic substeps" *
          doctest::test_suite("long")) {
  for (const bool is_grid : {true, false}) {
    for (const std::uint32_t across : {8u, 16u}) {
      for (const double stiffness : {kStiffness, 10 * kStiffness}) {
        if (!is_grid && stiffness != kStiffness) continue;
        for (const double rate : kRates) {
          CAPTURE(is_grid);
          CAPTURE(across);
          CAPTURE(stiffness);
          CAPTURE(rate);
          const Strip made = strip(across, 0, is_grid, stiffness * kStretch,
                                   is_grid ? 0 : stiffness / 2, stiffness);
          Cloth cloth = cloth_of(made.cloth.scene, {});
          CHECK(stretch_at_tear(cloth, made, rate) == doctest::Approx(1).epsilon(0.03));
        }
      }
    }
  }
}

TEST_CASE("a torn cloth goes on as it was saved, and as a clone of it does") {
  const Strip made = strip(8, 2, true, kStiffness * kStretch, 20);
  Cloth cloth = cloth_of(made.cloth.scene, {});
  double stretch = 0;
  int torn = 0;
  for (int i = 0; torn < 4 && i < 400; ++i) {
    pull(cloth, made, (stretch += 0.01) * kStretch);
    torn += step(cloth, 1.0 / 60).torn;
  }
  REQUIRE(torn >= 4);
  CHECK(cloth.particle_count() > made.cloth.scene.positions.size());
  Cloth copy = cloth.clone();
  CHECK(copy.torn().empty());
  auto model = load_model(save_model(*cloth.model()));
  REQUIRE_MESSAGE(model, model.error());
  auto loaded = Cloth::create(model.value(), {});
  REQUIRE(loaded);
  REQUIRE(loaded.value().load_state(cloth.save_state()));
  Cloth taken = cloth_of(made.cloth.scene, {});
  REQUIRE(!taken.copy_state(cloth));  // of another origin
  for (int i = 0; i < 60; ++i) {
    pull(cloth, made, (stretch += 0.01) * kStretch);
    pull(copy, made, stretch * kStretch);
    pull(loaded.value(), made, stretch * kStretch);
    const StepReport report = step(cloth, 1.0 / 60);
    CHECK(step(copy, 1.0 / 60).torn == report.torn);
    step(loaded.value(), 1.0 / 60);
    CHECK(copy.torn() == cloth.torn());
    CHECK(loaded.value().torn() == cloth.torn());
    REQUIRE(copy.state_hash() == cloth.state_hash());
    REQUIRE(loaded.value().state_hash() == cloth.state_hash());
  }
}

TEST_CASE("a tear adds no energy, and a strip that is pulled far in one frame does not explode") {
  for (const bool is_grid : {true, false}) {
    for (const double rate : kRates) {
      CAPTURE(is_grid);
      CAPTURE(rate);
      const Strip made = strip(8, 2, is_grid, kStiffness * kStretch, 20);
      // The energy of springs that substeps do not resolve depends on how many these are.
      Cloth cloth = cloth_of(made.cloth.scene, {.substeps = static_cast<int>(7680 / rate)});
      pull(cloth, made, 10 * kStretch);
      step(cloth, 1 / rate);
      const double pulled = cloth.energy().total();
      double before = pulled;
      int torn = 0;
      for (int i = 0; i < 3 * rate; ++i) {
        const StepReport report = step(cloth, 1 / rate);
        CHECK(committed(report.status));
        torn += report.torn;
        const double now = cloth.energy().total();
        CHECK(now <= 1.001 * before);
        before = now;
      }
      CHECK(torn > 5);
      CHECK(before < 0.02 * pulled);
    }
  }
}

/// The strip hangs on rings: those at its top slide on a rod. A bead slides on the row in the
/// middle, where the strip tears.
SceneDescription on_rings(const Strip& made) {
  SceneDescription scene = made.cloth.scene;
  scene.gravity = {0, -10, 0};
  std::erase_if(scene.fixed, [&](std::uint32_t i) { return scene.positions[i].y == made.length; });
  const auto add = [&](Vec3 at, double mass) {
    scene.positions.push_back(at);
    scene.masses.push_back(mass);
    return static_cast<std::uint32_t>(scene.positions.size() - 1);
  };
  for (const double x : {-0.3, 0.5}) {
    scene.rail_particles.push_back(add({x, made.length, 0}, 1));
    scene.fixed.push_back(scene.rail_particles.back());
  }
  for (const std::uint32_t i : made.top) scene.sliders.push_back({.particle = i, .last = 1});
  std::vector<std::pair<double, std::uint32_t>> row;
  for (std::uint32_t i = 0; i < made.cloth.scene.positions.size(); ++i) {
    const Vec3 at = scene.positions[i];
    if (at.y == made.length / 2) row.push_back({at.x, i});
  }
  std::ranges::sort(row);
  for (const auto& [x, i] : row) scene.rail_particles.push_back(i);
  const auto last = static_cast<std::uint32_t>(scene.rail_particles.size()) - 1;
  scene.sliders.push_back({add({0.13, made.length / 2, 0}, 1e-3), 2, last});
  return scene;
}

TEST_CASE("rings and beads slide on along their rails where the cloth tears") {
  const Strip made = strip(8, 2, true, kStiffness * kStretch, 20);
  const SceneDescription scene = on_rings(made);
  const auto rod = static_cast<std::uint32_t>(made.cloth.scene.positions.size());
  for (const double rate : kRates) {
    CAPTURE(rate);
    Cloth cloth = cloth_of(scene, {});
    int torn = 0;
    for (double lift = 0; lift < 4 * kStretch; lift += 0.5 * kStretch / rate) {
      for (const std::uint32_t end : {rod, rod + 1}) {
        const Vec3 x = scene.positions[end];
        REQUIRE(cloth.move_fixed(end, {x.x, x.y + lift * made.length, 0}));
      }
      const StepReport report = step(cloth, 1 / rate);
      torn += report.torn;
      CHECK(report.max_rail_gap <= cloth.settings().contact_tolerance);
    }
    CHECK(torn > 4);
    const SceneDescription now = description_of(*cloth.model());
    CHECK(now.rail_particles == scene.rail_particles);
    CHECK(!joins(now, made.top[0], 0));
    for (const std::uint32_t i : made.top)
      CHECK(cloth.position(i).y == doctest::Approx(cloth.position(rod).y).epsilon(1e-3));
    auto model = load_model(save_model(*cloth.model()));
    REQUIRE(model);
    auto other = Cloth::create(model.value(), {});
    REQUIRE(other);
    REQUIRE(other.value().load_state(cloth.save_state()));
    step(cloth, 1 / rate);
    step(other.value(), 1 / rate);
    CHECK(other.value().state_hash() == cloth.state_hash());
  }
}

/// Tears the strip until `count` breaks have been told.
void tear(Cloth& cloth, const Strip& made, int count) {
  double stretch = 0;
  for (int torn = 0; torn < count;) {
    pull(cloth, made, (stretch += 0.02) * kStretch);
    torn += step(cloth, 1.0 / 60).torn;
    REQUIRE(stretch < 10);
  }
}

/// Whether each length and corner of the first elements is `scale` times that of the scene.
void check_rest(const Cloth& cloth, const SceneDescription& scene, double scale) {
  const SceneDescription now = description_of(*cloth.model());
  for (std::size_t i = 0; i < scene.constraints.size(); ++i)
    CHECK(now.constraints[i].rest_length ==
          doctest::Approx(scale * scene.constraints[i].rest_length).epsilon(1e-12));
  REQUIRE(now.membrane.size() == scene.membrane.size());
  for (std::size_t i = 0; i < scene.membrane.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 2; ++axis)
        CHECK(std::abs(now.membrane[i].rest[k][axis] - scale * scene.membrane[i].rest[k][axis]) <
              1e-12);
    }
  }
}

TEST_CASE("a torn cloth keeps the shape at rest that it was given") {
  for (const bool is_grid : {true, false}) {
    CAPTURE(is_grid);
    const Strip made = strip(8, 2, is_grid, kStiffness * kStretch, 20);
    const SceneDescription& scene = made.cloth.scene;
    Cloth cloth = cloth_of(scene, {});
    REQUIRE(cloth.set_rest_shape(scene, 1.05));
    tear(cloth, made, 4);
    check_rest(cloth, scene, 1.05);
    const auto model = cloth.model();
    const auto refused = cloth.set_rest_shape(scene, 1.1);  // not as it has torn
    REQUIRE(!refused);
    CHECK(refused.error().find("scene: must be of the cloth as it has torn (") == 0);
    CHECK(cloth.model() == model);
    REQUIRE(cloth.set_rest_shape(description_of(*model), 2));
    check_rest(cloth, scene, 2.1);
  }
}

TEST_CASE("the shape at rest of a scene grows on where its cloth tears") {
  for (const bool is_grid : {true, false}) {
    CAPTURE(is_grid);
    const Strip made = strip(8, 2, is_grid, kStiffness * kStretch, 20);
    Cloth cloth = cloth_of(made.cloth.scene, {});
    tools::GrowingRest rest({.times = {0, 1}, .scales = {1, 1.5}}, cloth);
    for (const double time : {0.1, 0.2}) {
      REQUIRE(rest.grow(cloth, time));
      tear(cloth, made, 2);
    }
    REQUIRE(rest.grow(cloth, 0.4));
    check_rest(cloth, made.cloth.scene, 1.2);
    REQUIRE(rest.grow(cloth, 0.6));
    check_rest(cloth, made.cloth.scene, 1.3);
  }
}

TEST_CASE("layers that tear do not cross") {
  for (const bool is_grid : {true, false}) {
    const Strip made = strip(12, 3, is_grid, kStiffness * kStretch, 20);
    SceneDescription scene = made.cloth.scene;
    scene.self_contact = {.on = true, .thickness = 2e-3};
    scene.gravity = {0, 0, -10};
    Cloth cloth = cloth_of(scene, {});
    double stretch = 0;
    int torn = 0;
    for (int i = 0; i < 300; ++i) {
      if (stretch < 2) pull(cloth, made, (stretch += 0.02) * kStretch);
      const StepReport report = step(cloth, 1.0 / 60);
      torn += report.torn;
      CHECK(report.tangled == 0);
    }
    CHECK(torn > 3);
  }
}

}  // namespace
}  // namespace weft::test::engine_step_tearing
