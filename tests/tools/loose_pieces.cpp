#include "tools/loose_pieces.h"

#include <doctest/doctest.h>

#include <string>

#include "run_program.h"
#include "temporary_folder.h"
#include "tools/scenes/splitmix.h"

namespace weft::tools {
namespace {

TEST_CASE("what constraints and triangles join is a piece; fixed particles and anchors hold it") {
  SceneDescription scene;
  scene.positions.resize(10);
  scene.constraints = {{0, 1, 1}, {3, 4, 1}, {1, 2, 1}};
  scene.membrane = {{{5, 6, 7}}};
  scene.spheres = {4, 8};
  scene.fixed = {2};
  scene.anchors = {{.particle = 6}};
  const Pieces pieces = pieces_of(scene);
  CHECK(pieces.of_particle == std::vector<std::uint32_t>{0, 0, 0, 1, 1, 2, 2, 2, kNoIndex, 3});
  CHECK(pieces.held == std::vector<bool>{true, false, true, false});
  CHECK(pieces.count == 4);
  CHECK(pieces.loose() == 2);
}

/// Two strips of three edges, one above the other.
SceneDescription strips(double gap) {
  SceneDescription scene;
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 4; ++i) scene.positions.push_back({0.1 * i, -gap * row, 0});
  }
  for (const std::uint32_t i : {0u, 1u, 2u, 4u, 5u, 6u})
    scene.constraints.push_back({i, i + 1, 0.1});
  scene.fixed = {0};
  return scene;
}

TEST_CASE("the distance that would join loose pieces is a power of ten, and far below an edge") {
  const auto joining = [](const SceneDescription& scene) {
    return joining_distance(scene, pieces_of(scene));
  };
  CHECK(joining(strips(3e-6)) == doctest::Approx(1e-5));
  CHECK(joining(strips(2e-4)) == doctest::Approx(1e-3));
  CHECK(joining(strips(0.02)) == 0);
  CHECK(joining(strips(0)) == 0);
}

/// A square of n x n cells as loose triangles, whose corners differ by up to a millionth.
std::string soup(int n) {
  scenes::SplitMix random(1);
  std::string text, faces;
  int vertices = 0;
  const auto add = [&](int i, int j) {
    const auto noise = [&] { return 1e-6 * (2 * random.unit() - 1); };
    const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
    text += "v " + std::to_string(x + noise()) + ' ';
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%.9f %.9f\n", y + noise(), noise());
    text += buffer;
    faces += ' ' + std::to_string(++vertices);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      faces += "f", add(i, j), add(i + 1, j), add(i + 1, j + 1), faces += "\nf";
      add(i, j), add(i + 1, j + 1), add(i, j + 1), faces += '\n';
    }
  }
  return text + faces;
}

TEST_CASE("whoever runs loose triangles is told which weld joins them, and the weld does") {
  const TemporaryFolder folder;
  const std::string run =
      folder.write("soup.obj", soup(6)) + " --pin top --material cotton --steps 30";
  const Outcome apart = run_program(folder, "run " + run + " --json -");
  CHECK(apart.exit_code == 0);
  const auto report = nlohmann::json::parse(apart.out);
  CHECK(report["pieces"] == 72);
  const int loose = report["loose_pieces"];
  CHECK(loose >= 60);
  CHECK(apart.err == "weft: " + std::to_string(loose) +
                         " of 72 pieces hang on no pin: --weld 1e-05 would join what lies that "
                         "near\n");
  const Outcome welded = run_program(folder, "run " + run + " --weld 1e-5 --json -");
  CHECK(welded.err.empty());
  const auto joined = nlohmann::json::parse(welded.out);
  CHECK(joined["pieces"] == 1);
  CHECK(joined["loose_pieces"] == 0);
  CHECK(joined["welded_vertices"] == 3 * 72 - 49);
  CHECK(joined["lowest_y"] > -0.1);
}

TEST_CASE("cloth that nothing holds at all was meant to fall") {
  const TemporaryFolder folder;
  CHECK(run_program(folder, "run drape --size 5 --steps 1").err.empty());
}

}  // namespace
}  // namespace weft::tools
