/// The yarn solver: where its chains stand, and what it promises of a step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "engine/model/model.h"
#include "engine/solvers/yarn/yarn_layout.h"
#include "tests/support/clothes.h"
#include "tests/support/isas.h"
#include "tests/support/mesh_scenes.h"
#include "tests/support/meshes.h"
#include "tests/support/motion.h"

namespace weft::test::engine_solvers_yarn_yarn {
namespace {

Settings yarn(double tolerance, int substeps = 1) {
  Settings settings;
  settings.solver = Solver::yarn;
  settings.tolerance = tolerance;
  settings.substeps = substeps;
  return settings;
}

/// A closed hoop of particles around the y axis, one of them fixed.
SceneDescription hoop(std::uint32_t particles) {
  SceneDescription scene;
  const double radius = 0.1 / (2 * std::sin(std::numbers::pi / particles));
  for (std::uint32_t i = 0; i < particles; ++i) {
    const double angle = 2 * std::numbers::pi * i / particles;
    scene.positions.push_back({radius * std::cos(angle), 0, radius * std::sin(angle)});
    scene.masses.push_back(0.01);
    scene.constraints.push_back({i, (i + 1) % particles, 0.1});
  }
  scene.fixed = {0};
  return scene;
}

/// Per row and lane; what is no particle's is model.slots().
std::vector<std::uint32_t> slots_of_rows(const Model& model) {
  const YarnLayout& layout = model.yarns();
  if (!layout.places.woven()) return layout.slot;
  std::map<std::size_t, std::uint32_t> slot_at;
  for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
    if (model.ordering.particle_at[slot] == kNoIndex) continue;
    CHECK(slot_at.emplace(layout.places.of(slot), slot).second);
  }
  const auto slot_of = [&](std::size_t place) {
    const auto found = slot_at.find(place);
    return found == slot_at.end() ? static_cast<std::uint32_t>(model.slots()) : found->second;
  };
  std::vector<std::uint32_t> slots(layout.rows() * kLanes, kNoIndex);
  for (const simd::YarnBlock& block : layout.blocks) {
    const std::uint32_t rows = block.last - block.first;
    std::uint32_t* of_block = &slots[std::size_t{block.first} * kLanes];
    for (std::uint32_t i = 0; i < rows * kLanes && block.access == simd::YarnAccess::in_place;
         ++i) {
      of_block[i] = slot_of(block.place + std::size_t{i / kLanes} * 3 * kLanes + i % kLanes);
    }
    for (std::uint32_t i = block.first_patch; i < block.last_patch; ++i) {
      const simd::YarnPatch& patch = layout.patches[i];
      for (std::uint32_t k = 0; k < (patch.single ? 1 : kLanes); ++k) {
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
          const std::uint32_t slot = slot_of(std::size_t{patch.place[lane]} + k);
          if (patch.row[k] < rows) {
            CHECK(of_block[patch.row[k] * kLanes + lane] == kNoIndex);
            of_block[patch.row[k] * kLanes + lane] = slot;
          } else {
            CHECK(slot == model.slots());
          }
        }
      }
    }
  }
  return slots;
}

void check_layout(const Model& model) {
  const YarnLayout& layout = model.yarns();
  const std::vector<std::uint32_t> slots = slots_of_rows(model);
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> expected, found;
  const auto pair = [](std::uint32_t a, std::uint32_t b) {
    return std::pair(std::min(a, b), std::max(a, b));
  };
  for (std::size_t c = 0; c < model.constraints.plain; ++c) {
    expected.insert(pair(model.constraints.a[c], model.constraints.b[c]));
  }
  for (std::size_t f = 0; f < layout.families(); ++f) {
    std::set<std::uint32_t> in_family;
    for (std::uint32_t i = layout.family_begin[f]; i < layout.family_begin[f + 1]; ++i) {
      const simd::YarnBlock block = layout.blocks[i];
      CHECK(block.last_patch + block.patches_ahead <= layout.patches.size());
      for (std::uint32_t k = block.first; k < block.last; ++k) {
        const simd::YarnRow& row = layout.kinds[layout.kind[k]];
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
          const std::size_t at = k * kLanes + lane;
          const std::uint32_t slot = slots[at];
          REQUIRE(slot != kNoIndex);
          if (slot >= model.slots()) {
            CHECK(row.rest[lane] == 0);
          } else {
            CHECK(in_family.insert(slot).second);
            CHECK(lane < block.lanes);
          }
          if (row.rest[lane] > 0) found.insert(pair(slot, slots[at + kLanes]));
        }
      }
    }
  }
  CHECK(found == expected);
}

/// From doubles to two floats and back; what does not move comes back to the last bit.
void check_places(const Model& model) {
  const YarnPlaces& places = model.yarns().places;
  Random random(3);
  kernels::Vectors x(model.slots());
  for (std::size_t i = 0; i < x.size(); ++i) x.set(i, model.initial_position[i]);
  for (const simd::Isa isa : supported_isas()) {
    const simd::Table& table = simd::table(isa);
    kernels::AlignedVector<float> base(places.floats), u(places.floats);
    for (std::size_t first = 0; first < model.slots(); first += kLanes) {
      places.split(table, x.view(), 0x1p-10, first, first + kLanes, base.data(), u.data());
    }
    kernels::Vectors same = x, moved = x;
    places.join(table, same.view(), 0, model.slots(), base.data(), u.data());
    for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
      CHECK(kernels::length(same[slot] - x[slot]) == 0);
      if (model.ordering.particle_at[slot] == kNoIndex) continue;
      const std::size_t y = places.of(slot) + places.stride;
      CHECK(std::abs(double{base[y]} + double{u[y]} - x[slot].y) < 1e-9);
      u[y] += 1;
    }
    const auto has_moved = [&](std::uint32_t slot) {
      return moved[slot].y - x[slot].y == doctest::Approx(1).epsilon(1e-6);
    };
    const std::vector<Tile>& tiles = model.ordering.tiles;
    for (const Tile& tile : tiles) {
      places.join(table, moved.view(), tile.first_slot, tile.last_slot, base.data(), u.data());
      for (std::uint32_t slot = 0; slot < tiles.back().last_slot; ++slot) {
        const bool particle = model.ordering.particle_at[slot] != kNoIndex;
        CHECK(has_moved(slot) == (particle && slot < tile.last_slot));
      }
    }
    places.join(table, moved.view(), tiles.back().last_slot, model.slots(), base.data(), u.data());
    for (std::uint32_t slot = 0; slot < model.slots(); ++slot) {
      CHECK(has_moved(slot) == (model.ordering.particle_at[slot] != kNoIndex));
    }
  }
}

TEST_CASE("a particle that nothing is joined to does not matter, however light") {
  const auto iterations = [](const SceneDescription& scene) {
    Cloth cloth = cloth_of(scene, yarn(0.01));
    std::int64_t sum = 0;
    for (int k = 0; k < 20; ++k) sum += step(cloth, 0.01).iterations;
    return sum;
  };
  SceneDescription scene = scene_of("hang", 20);
  const std::int64_t alone = iterations(scene);
  scene.positions.push_back({0, 5, 0});
  scene.masses.push_back(1e-45);
  CHECK(iterations(scene) == alone);
}

TEST_CASE("every constraint is in one yarn, no particle twice in a family") {
  for (const SceneDescription& scene :
       {scene_of("hang", 20), scene_of("hang", 41), scene_of("corners", 21),
        scene_of("hang_sphere", 7), scene_of("sphere_drop", 40), hoop(12), scene_of("chain", 20),
        random_sheet(20, 3), scene_of(both(grid(42, 40), grid(20, 10))),
        scene_of(both(grid(100, 40), grid(80, 60)))}) {
    const auto model = model_of(scene);
    check_layout(*model);
    check_places(*model);
  }
}

TEST_CASE("sheets are woven, what has no sides to stand side by side is not") {
  const auto woven = [](const SceneDescription& scene) {
    return model_of(scene)->yarns().places.woven();
  };
  for (const int size : {20, 40, 41, 100}) CHECK(woven(scene_of("hang", size)));
  CHECK(woven(scene_of(both(grid(100, 40), grid(80, 60)))));
  CHECK(!woven(random_sheet(20, 3)));
  CHECK(!woven(hoop(40)));
  CHECK(!woven(scene_of("chain", 40)));
}

TEST_CASE("a step ends within tolerance, and no step gains energy") {
  for (const std::string scene : {"hang", "corners", "hang_sphere"}) {
    for (const double tolerance : {0.01, 0.0001}) {
      for (const int substeps : {1, 4}) {
        CAPTURE(scene);
        CAPTURE(tolerance);
        CAPTURE(substeps);
        Cloth cloth = cloth_of(scene_of(scene, 21), yarn(tolerance, substeps));
        const double start = cloth.energy().total();
        for (int i = 0; i < 60; ++i) {
          const StepReport report = step(cloth, 0.01);
          REQUIRE(report.status == Status::converged);
          CHECK(report.max_strain <= tolerance);
          CHECK(report.max_penetration <= cloth.settings().contact_tolerance);
          CHECK(cloth.energy().total() - start < 1e-4);
        }
      }
    }
  }
}

TEST_CASE("one step is that of the direct solver") {
  for (const std::string scene : {"hang", "corners"}) {
    CAPTURE(scene);
    Settings direct = yarn(1e-7);
    direct.solver = Solver::direct;
    Cloth one = cloth_of(scene_of(scene, 15), yarn(1e-6)),
          other = cloth_of(scene_of(scene, 15), direct);
    for (int i = 0; i < 10; ++i) {
      REQUIRE(step(one, 0.002).status == Status::converged);
      REQUIRE(step(other, 0.002).status == Status::converged);
    }
    CHECK(largest_distance(positions(one), positions(other)) < 1e-5);
  }
}

TEST_CASE("closed yarns, ropes and hubs converge too") {
  SUBCASE("a hoop") {
    Cloth cloth = cloth_of(hoop(40), yarn(1e-4));
    for (int i = 0; i < 50; ++i) REQUIRE(step(cloth, 0.005).status == Status::converged);
  }
  SUBCASE("ropes across the cells of a sheet") {
    SceneDescription scene = scene_of("hang", 10);
    for (std::uint32_t i = 0; i + 1 < 10; ++i) {
      for (std::uint32_t k = 0; k + 1 < 10; ++k) {
        const double diagonal = std::numbers::sqrt2 / 9;
        scene.constraints.push_back({10 * i + k, 10 * i + k + 11, diagonal, ConstraintKind::rope});
      }
    }
    Cloth cloth = cloth_of(scene, yarn(0.001));
    for (int i = 0; i < 50; ++i) {
      const StepReport report = step(cloth, 0.01);
      REQUIRE(report.status == Status::converged);
      CHECK(report.max_strain <= 0.001);
    }
  }
  SUBCASE("a hub with a hundred spokes") {
    SceneDescription scene;
    scene.positions.push_back({0, 0, 0});
    scene.masses.push_back(0.1);
    for (std::uint32_t i = 1; i <= 100; ++i) {
      const double angle = 2 * std::numbers::pi * i / 100;
      scene.positions.push_back({std::cos(angle), 0, std::sin(angle)});
      scene.masses.push_back(0.01);
      scene.constraints.push_back({0, i, 1});
      if (i > 1) scene.constraints.push_back({i - 1, i, 2 * std::sin(std::numbers::pi / 100)});
    }
    scene.fixed = {1, 50};
    Cloth cloth = cloth_of(scene, yarn(0.001));
    for (int i = 0; i < 30; ++i) REQUIRE(step(cloth, 0.005).status == Status::converged);
  }
}

TEST_CASE("the result depends neither on threads nor, fused, on the instruction set") {
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle}) {
    CAPTURE(name(scheme));
    const auto hash = [scheme](Isa isa, int threads) {
      Settings settings = yarn(0.001, 2);
      settings.scheme = scheme;
      settings.isa = isa;
      settings.threads = threads;
      Cloth cloth = cloth_of(scene_of("corners", 81), settings);
      run(cloth, 0.004, 5);
      return cloth.state_hash();
    };
    const std::uint64_t one = hash(Isa::automatic, 1);
    CHECK(hash(Isa::automatic, 2) == one);
    if (simd::supported(simd::Isa::avx512)) CHECK(hash(Isa::avx2, 1) == hash(Isa::avx512, 1));
  }
}

TEST_CASE("a step too large for the mesh is done in halves, and says so") {
  Cloth cloth = cloth_of(scene_of("corners", 41), yarn(0.001));
  int halvings = 0;
  for (int i = 0; i < 20; ++i) {
    const StepReport report = step(cloth, 0.03);
    REQUIRE(report.status == Status::converged);
    CHECK((report.halvings == 0 || report.substeps > 1));
    halvings += report.halvings;
  }
  CHECK(halvings > 0);
}

TEST_CASE("a step that left the range of numbers leaves nothing behind") {
  // Of the last, some rows are not in fours, and have lanes that are nobody's.
  for (const SceneDescription& scene :
       {scene_of("hang", 10), scene_of("hang", 40), scene_of(both(grid(74, 74), grid(20, 20)))}) {
    for (const int iterations : {0, 3}) {
      Settings settings = yarn(0.001);
      settings.iterations = iterations;
      Cloth cloth = cloth_of(scene, settings), fresh = cloth_of(scene, settings);
      for (const double force : {1e300, 1e45}) {
        REQUIRE(cloth.write_forces(std::vector<Vec3>(scene.positions.size(), {force, 0, force})));
        CHECK(!committed(step(cloth, 0.01).status));
      }
      REQUIRE(cloth.write_forces({}));
      for (int i = 0; i < 3; ++i) {
        CHECK(step(cloth, 0.01).status == step(fresh, 0.01).status);
      }
      CHECK(cloth.state_hash() == fresh.state_hash());
    }
  }
}

TEST_CASE("yarns that bend are straight again after a sweep or two, of several solves") {
  const SceneDescription scene = scene_of("hang", 40);
  const auto constraints = static_cast<std::int64_t>(describe(*model_of(scene)).constraints);
  Cloth cloth = cloth_of(scene, yarn(0.001));
  std::int64_t iterations = 0;
  std::int64_t visits = 0;
  for (int i = 0; i < 40; ++i) {
    const StepReport report = step(cloth, 0.01);
    REQUIRE(report.status == Status::converged);
    iterations += report.iterations;
    visits += report.visits;
  }
  CHECK(iterations < 60);
  CHECK(visits > 3 * constraints / 2 * iterations);
  CHECK(visits < 20 * constraints * iterations);
}

TEST_CASE("automatic substeps follow the motion") {
  Cloth cloth = cloth_of(scene_of("hang", 20), yarn(0.001, kAutomaticSubsteps));
  CHECK(step(cloth, 0.001).substeps == 1);
  CHECK(step(cloth, 0.1).substeps == 3);
  Cloth faster = cloth_of(scene_of("hang", 20), yarn(0.001, kAutomaticSubsteps));
  CHECK(step(faster, 0.15).substeps > 3);
}

}  // namespace
}  // namespace weft::test::engine_solvers_yarn_yarn
