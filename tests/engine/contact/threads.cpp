/// Threads touch all along their length: cloth, each other, themselves, and bodies that are meshes.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/model/threads.h"
#include "kernels/reference/distances.h"
#include "tests/support/body_meshes.h"
#include "tests/support/clothes.h"
#include "tests/support/crossing_triangles.h"
#include "tests/support/isas.h"
#include "tests/support/layers.h"
#include "tests/support/vectors.h"

namespace weft::test::engine_contact_threads {
namespace {

constexpr double kThickness = 1e-3;        // m
constexpr std::array kRates{30, 60, 240};  // Hz
constexpr std::array kMaterials{"cotton", "silk"};

/// Sheets and threads that become one scene.
class Pieces {
 public:
  /// From 0 to 1 along both. Returns its first vertex.
  std::uint32_t add_sheet(std::uint32_t rows, std::uint32_t columns,
                          const std::function<Vec3(double u, double v)>& place) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i <= rows; ++i) {
      for (std::uint32_t j = 0; j <= columns; ++j)
        mesh.positions.push_back(
            place(static_cast<double>(i) / rows, static_cast<double>(j) / columns));
    }
    for (std::uint32_t i = 0; i < rows; ++i) {
      for (std::uint32_t j = 0; j < columns; ++j) {
        const std::uint32_t at = first + i * (columns + 1) + j;
        mesh.face_sizes.push_back(4);
        for (const std::uint32_t corner : {at, at + columns + 1, at + columns + 2, at + 1})
          mesh.corners.push_back(corner);
      }
    }
    return first;
  }
  /// So many links from 0 to 1. Returns its first vertex.
  std::uint32_t add_thread(std::uint32_t links, const std::function<Vec3(double at)>& place) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i <= links; ++i) {
      mesh.positions.push_back(place(static_cast<double>(i) / links));
      if (i > 0) mesh.lines.push_back({first + i - 1, first + i});
    }
    return first;
  }
  /// From a vertex on, each link by `way`.
  void hang(std::uint32_t vertex, std::uint32_t links, Vec3 way) {
    for (std::uint32_t i = 0; i < links; ++i) {
      mesh.positions.push_back(mesh.positions[vertex] + way);
      const auto next = static_cast<std::uint32_t>(mesh.positions.size() - 1);
      mesh.lines.push_back({vertex, next});
      vertex = next;
    }
  }
  void pin(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) mesh.pins.push_back(first + i);
  }
  SceneDescription scene(const char* material) {
    mesh.material = find_material(material).value();
    SceneDescription made = cloth_from_mesh(mesh).value().scene;
    made.air = {};
    made.damping.motion = 4;  // 1/s: a chain that is caught swings for long otherwise
    made.self_contact = {.on = true, .thickness = kThickness, .friction = 0.3};
    return made;
  }

  MeshDescription mesh;
};

Cloth cloth_from(const SceneDescription& scene, int substeps = kAutomaticSubsteps) {
  return cloth_of(scene, {.substeps = substeps, .solver = Solver::small_steps, .threads = 1});
}

/// Pairs of faces and threads that cross, by exact predicates.
int crossings_of(const Cloth& cloth, const SceneDescription& scene) {
  auto triangles = scene.surface;
  for (const auto& [a, b] : threads_of(*model_of(scene))) triangles.push_back({a, b, b});
  return count_self_crossings({positions(cloth), triangles});
}

/// m, where a cord is that hangs between two pins.
double sagging(double at, double sag) { return -4 * sag * at * (1 - at); }

/// A cord between two pins along z.
std::uint32_t add_line(Pieces& pieces, std::uint32_t links, double width, double sag = 0.04) {
  const auto first = pieces.add_thread(links, [=](double at) {
    return Vec3{0, sagging(at, sag), width * (at - 0.5)};
  });
  pieces.pin(first, 1);
  pieces.pin(first + links, 1);
  return first;
}

double highest(const Cloth& cloth, std::uint32_t first, std::uint32_t count) {
  double most = -1e9;
  for (std::uint32_t i = 0; i < count; ++i) most = std::max(most, cloth.position(first + i).y);
  return most;
}

double mean_height(const Cloth& cloth, std::uint32_t first, std::uint32_t count) {
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) sum += cloth.position(first + i).y;
  return sum / count;
}

/// Nothing crosses when a frame ends, and there is no more energy than at the start. (A chain that
/// is caught loses some when it is taut, and gets that back as it swings: tests/README.md.)
void run_without_crossing(
    Cloth& cloth, const SceneDescription& scene, int rate, double seconds,
    const std::function<void()>& check = [] {}) {
  const double energy = cloth.energy().total();
  double unit = 0;  // J, of 1 % of 0.15 m
  for (const double mass : scene.masses) unit += 10 * mass * 0.01 * 0.15;
  const int frames = static_cast<int>(seconds * rate);
  for (int frame = 0; frame < frames; ++frame) {
    CAPTURE(frame);
    const StepReport report = step(cloth, 1.0 / rate);
    REQUIRE(committed(report.status));
    CHECK(report.tangled == 0);
    if (frame % std::max(1, rate / 30) == 0) CHECK(crossings_of(cloth, scene) == 0);
    CHECK(cloth.energy().total() < energy + unit);
    check();
  }
}

void for_each_setting(const std::function<void(int rate, const char* material)>& check) {
  for (const int rate : kRates) {
    for (const char* material : kMaterials) {
      INFO(rate << " Hz, " << material);
      check(rate, material);
    }
  }
}

/// A pinned strip along z, 8 mm wide.
std::uint32_t add_strip(Pieces& pieces, std::uint32_t rows, std::uint32_t columns) {
  const auto first = pieces.add_sheet(rows, columns, [](double u, double v) {
    return Vec3{0.008 * (v - 0.5), 0, 0.2 * (u - 0.5)};
  });
  pieces.pin(first, (rows + 1) * (columns + 1));
  return first;
}

TEST_CASE("a chain falls on a strip that is narrower than its links, and stays") {
  for_each_setting([](int rate, const char* material) {
    for (const std::uint32_t columns : {2u, 4u}) {
      // Straight above a row of points, beside it, and askew.
      struct Beside {
        double z, turned;
      };
      for (const Beside beside : {Beside{0, 0}, Beside{0.003, 0}, Beside{0.001, 0.4}}) {
        CAPTURE(columns);
        CAPTURE(beside.z);
        Pieces pieces;
        add_strip(pieces, 20, columns);
        const auto chain = pieces.add_thread(5, [&](double at) {
          const double x = 0.15 * (at - 0.5);
          return Vec3{x * std::cos(beside.turned), 0.02, beside.z + x * std::sin(beside.turned)};
        });
        const SceneDescription scene = pieces.scene(material);
        Cloth cloth = cloth_from(scene);
        run_without_crossing(cloth, scene, rate, 0.7);
        CHECK(highest(cloth, chain, 6) > -0.02);
      }
    }
  });
}

/// The least distance of two chains.
double apart(const Cloth& cloth, std::uint32_t a, std::uint32_t as, std::uint32_t b,
             std::uint32_t bs) {
  const auto at = [&](std::uint32_t i) {
    const Vec3 x = cloth.position(i);
    return kernels::Vector{x.x, x.y, x.z};
  };
  double least = 1;
  for (std::uint32_t i = a; i < a + as; ++i) {
    for (std::uint32_t j = b; j < b + bs; ++j)
      least = std::min(least,
                       length(reference::nearest_of_edges(at(i), at(i + 1), at(j), at(j + 1)).r));
  }
  return least;
}

TEST_CASE("a cord that falls on another cord hangs over it") {
  for_each_setting([](int rate, const char* material) {
    for (const std::uint32_t links : {5u, 11u}) {
      for (const double aside : {0.0, 0.004}) {
        CAPTURE(links);
        CAPTURE(aside);
        Pieces pieces;
        const auto under = add_line(pieces, links, 0.2);
        const auto over = pieces.add_thread(links, [=](double at) {
          return Vec3{0.2 * (at - 0.5), 0.01, aside};
        });
        const SceneDescription scene = pieces.scene(material);
        Cloth cloth = cloth_from(scene);
        run_without_crossing(cloth, scene, rate, 0.5);
        CHECK(highest(cloth, over, links + 1) > -0.06);
        CHECK(apart(cloth, under, links, over, links) > 0.5 * kThickness);
      }
    }
  });
}

/// A taut cord bears cloth by a tension that many short substeps alone can carry. (While substeps
/// become shorter a frame may miss the tolerance, and tells it.)
TEST_CASE("cloth lies over a cord whose links are longer than its cells, and is not thrown up" *
          doctest::test_suite("long")) {
  for_each_setting([](int rate, const char* material) {
    for (const std::uint32_t cells : {8u, 13u}) {
      for (const double sag : {0.04, 0.0}) {
        CAPTURE(cells);
        CAPTURE(sag);
        constexpr double kHeight = 0.01;
        Pieces pieces;
        const auto sheet = pieces.add_sheet(cells, cells, [](double u, double v) {
          return Vec3{0.12 * (u - 0.5), kHeight, 0.12 * (v - 0.5)};
        });
        add_line(pieces, 3, 0.3, sag);
        const SceneDescription scene = pieces.scene(material);
        Cloth cloth = cloth_from(scene);
        const std::uint32_t count = (cells + 1) * (cells + 1);
        run_without_crossing(cloth, scene, rate, 0.4,
                             [&] { CHECK(mean_height(cloth, sheet, count) < kHeight); });
        CHECK(highest(cloth, sheet, count) > -0.06);
      }
    }
  });
}

TEST_CASE("cloth with fringes folds over itself and over its fringes") {
  for_each_setting([](int rate, const char* material) {
    for (const std::uint32_t cells : {6u, 9u}) {
      CAPTURE(cells);
      Pieces pieces;
      const auto sheet = pieces.add_sheet(cells, cells, [](double u, double v) {
        return Vec3{0.004 * std::sin(20 * u) + 1e-3 * chance(u, v), 0.07 + 0.15 * u,
                    0.15 * (v - 0.5)};
      });
      for (std::uint32_t k = 0; k <= cells; ++k)
        pieces.hang(sheet + k, 3, {0.0007 * chance(k, 1), -0.02, 0.0007 * chance(k, 2)});
      const SceneDescription scene = pieces.scene(material);
      Cloth cloth = cloth_from(scene);
      add(cloth, {.shape = shape_of(Plane{{0, 1, 0}, 0})});
      run_without_crossing(cloth, scene, rate, 0.5);
    }
  });
}

TEST_CASE("threads come to the same bits by AVX2 and AVX-512, and from a state that was saved") {
  Pieces pieces;
  const auto sheet = pieces.add_sheet(6, 6, [](double u, double v) {
    return Vec3{0.12 * (u - 0.5), 0.01, 0.12 * (v - 0.5)};
  });
  for (std::uint32_t k = 0; k <= 6; ++k) pieces.hang(sheet + k, 3, {-0.015, 0.0004, 0.001 * k});
  add_line(pieces, 3, 0.3);
  const SceneDescription scene = pieces.scene("cotton");
  std::vector<std::uint64_t> hashes;
  for (const Isa isa : {Isa::avx2, Isa::avx512}) {
    if (!simd::supported(isa == Isa::avx2 ? simd::Isa::avx2 : simd::Isa::avx512)) continue;
    const Settings settings{.solver = Solver::small_steps, .isa = isa, .threads = 1};
    Cloth cloth = cloth_of(scene, settings);
    run(cloth, 1.0 / 60, 12);
    Cloth loaded = cloth_of(scene, settings);
    REQUIRE(loaded.load_state(cloth.save_state()));
    run(cloth, 1.0 / 60, 12);
    run(loaded, 1.0 / 60, 12);
    CHECK(loaded.state_hash() == cloth.state_hash());
    hashes.push_back(cloth.state_hash());
  }
  for (const std::uint64_t hash : hashes) CHECK(hash == hashes[0]);
}

TEST_CASE("a drawstring holds the tunnel that it runs through") {
  for_each_setting([](int rate, const char* material) {
    for (const std::uint32_t around : {7u, 10u}) {
      CAPTURE(around);
      Pieces pieces;
      // A tube along z whose first and last columns are one, by welding.
      const auto tube = pieces.add_sheet(8, around, [&](double u, double v) {
        const double turn = v == 1 ? 0 : 2 * 3.141592653589793 * v;
        const double z = 0.1 * (u - 0.5), at = 0.5 + z / 0.16;
        const double y = 0.012 * std::cos(turn) - 0.0105 + sagging(at, 0.02);
        return Vec3{0.012 * std::sin(turn), y, z};
      });
      pieces.mesh.weld_distance = 1e-9;
      add_line(pieces, 4, 0.16, 0.02);
      const SceneDescription scene = pieces.scene(material);
      // Automatic substeps become longer and shorter in turns here, and each time give a blow.
      Cloth cloth = cloth_from(scene, 3000 / rate);
      run_without_crossing(cloth, scene, rate, 0.5);
      CHECK(highest(cloth, tube, 8 * around) > -0.03);
    }
  });
}

TEST_CASE("a chain falls on a bar of triangles that is narrower than its links, and stays") {
  for_each_setting([](int rate, const char* material) {
    for (const std::uint32_t cuts : {1u, 3u}) {
      for (const double z : {0.0, 0.007}) {
        CAPTURE(cuts);
        CAPTURE(z);
        Pieces pieces;
        const auto chain = pieces.add_thread(5, [=](double at) {
          return Vec3{0.15 * (at - 0.5), 0.02, z};
        });
        SceneDescription scene = pieces.scene(material);
        Cloth cloth = cloth_from(scene);
        add(cloth,
            {.shape = shape_of(box_mesh({0.008, 0.008, 0.1}, cuts)), .thickness = kThickness});
        run_without_crossing(cloth, scene, rate, 0.5);
        CHECK(highest(cloth, chain, 6) > -0.02);
      }
    }
  });
}

TEST_CASE("links that are shorter than the thickness do not push each other") {
  for_each_setting([](int rate, const char* material) {
    for (const double link : {2e-4, 5e-4}) {
      CAPTURE(link);
      Pieces pieces;
      const auto sheet = pieces.add_sheet(3, 3, [](double u, double v) {
        return Vec3{0.02 * u, 0, 0.02 * v};
      });
      pieces.pin(sheet, 16);
      const auto root = static_cast<std::uint32_t>(sheet + 3);
      pieces.hang(root, 20, {0, -link, 0});
      const SceneDescription scene = pieces.scene(material);
      Cloth cloth = cloth_from(scene);
      for (int frame = 0; frame < rate / 3; ++frame) {
        const StepReport report = step(cloth, 1.0 / rate);
        CHECK(report.status == Status::converged);
        CHECK(report.max_strain < 0.011);
      }
    }
  });
}

TEST_CASE("particles that nothing joins keep the thickness from each other") {
  for (const int rate : kRates) {
    CAPTURE(rate);
    Pieces pieces;
    const auto sheet = pieces.add_sheet(2, 2, [](double u, double v) {
      return Vec3{0.1 * u, 0, 0.1 * v};
    });
    pieces.pin(sheet, 9);
    SceneDescription scene = pieces.scene("cotton");
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const double height : {0.003, 0.0042}) {
      scene.positions.push_back({0.031, height, 0.042});
      scene.masses.push_back(1e-4);
    }
    Cloth cloth = cloth_from(scene);
    run(cloth, 1.0 / rate, rate / 3);
    const double low = cloth.position(first).y, high = cloth.position(first + 1).y;
    CHECK(low == doctest::Approx(kThickness).epsilon(0.1));
    CHECK(high - low == doctest::Approx(kThickness).epsilon(0.1));
  }
}

TEST_CASE("threads that begin through cloth or a mesh are told until they are out") {
  for_each_setting([](int rate, const char* material) {
    Pieces pieces;
    const auto sheet = pieces.add_sheet(4, 4, [](double u, double v) {
      return Vec3{0.1 * (u - 0.5), 0, 0.1 * (v - 0.5)};
    });
    pieces.pin(sheet, 25);
    pieces.add_thread(1, [](double at) { return Vec3{0.003, 0.02 - 0.03 * at, 0.004}; });
    pieces.add_thread(2, [](double at) { return Vec3{0.011, -0.2, 0.16 * (at - 0.5)}; });
    const SceneDescription scene = pieces.scene(material);
    Cloth cloth = cloth_from(scene);
    add(cloth, {.shape = shape_of(box_mesh({0.03, 0.03, 0.03}, 2)),
                .pose = {.position = {0, -0.2, 0.02}},
                .thickness = kThickness});
    const StepReport first = step(cloth, 1.0 / rate);
    CHECK(first.tangled == crossings_of(cloth, scene));
    CHECK(first.tangled > 0);
    CHECK(first.intersecting > 0);
    for (int frame = 0; frame < rate; ++frame) {
      const StepReport report = step(cloth, 1.0 / rate);
      REQUIRE(committed(report.status));
      CHECK((report.tangled > 0) == (crossings_of(cloth, scene) > 0));
    }
  });
}

/// Pairs of particles, in order.
std::vector<std::array<std::uint32_t, 2>> threads_in(const SceneDescription& scene) {
  auto threads = threads_of(*model_of(scene));
  for (auto& [a, b] : threads)
    if (b < a) std::swap(a, b);
  std::ranges::sort(threads);
  return threads;
}

SceneDescription joined(const std::vector<Vec3>& places,
                        const std::vector<std::array<std::uint32_t, 2>>& links) {
  SceneDescription scene;
  scene.positions = places;
  scene.masses.assign(places.size(), 1e-3);
  for (const auto& [a, b] : links)
    scene.constraints.push_back({a, b, length(places[b] - places[a])});
  return scene;
}

TEST_CASE("threads are constraints beside the surface that brace nothing") {
  using Links = std::vector<std::array<std::uint32_t, 2>>;
  SUBCASE("of a cord links, but not those over every other particle") {
    CHECK(threads_in(joined({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                            {{0, 1}, {1, 2}, {2, 3}, {0, 2}, {1, 3}})) ==
          Links{{0, 1}, {1, 2}, {2, 3}});
  }
  SUBCASE("of a net links, but no diagonals") {
    CHECK(threads_in(joined({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                            {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 2}, {1, 3}})) ==
          Links{{0, 1}, {0, 3}, {1, 2}, {2, 3}});
  }
  SUBCASE("of cloth neither sides nor braces, but what hangs on it or leads to another piece") {
    SceneDescription scene = joined(
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {0, -1, 0}},
        {{0, 1}, {0, 2}, {1, 3}, {1, 4}, {0, 7}, {1, 7}});
    scene.surface = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
    CHECK(threads_in(scene) == Links{{0, 7}, {1, 4}});
  }
  SUBCASE("those between fixed particles, too") {
    SceneDescription scene = joined({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1}, {1, 2}});
    scene.fixed = {0, 1};
    CHECK(threads_in(scene) == Links{{0, 1}, {1, 2}});
  }
}

}  // namespace
}  // namespace weft::test::engine_contact_threads
