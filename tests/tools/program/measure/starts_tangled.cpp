#include "tools/program/measure/starts_tangled.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"

namespace weft::tools {
namespace {

/// Two triangles of which one is through the other by its first corner.
SceneDescription pierced() {
  SceneDescription scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0.2, -1, 0.2}, {0.3, 1, 0.2}, {0.2, 1, 0.3}};
  scene.masses.assign(6, 1);
  scene.surface = {{0, 1, 2}, {3, 4, 5}};
  scene.self_contact.on = true;
  return scene;
}

TEST_CASE("pairs of triangles that cross are counted, but for those that a seam joins") {
  SceneDescription scene = pierced();
  CHECK(starts_tangled(scene) == 1);
  scene.seams.push_back({.a = 1, .b = 5});
  CHECK(starts_tangled(scene) == 0);
  scene.seams.clear();
  scene.self_contact.on = false;
  CHECK(starts_tangled(scene) == 0);
}

/// A level sheet of 20 cm, and one that leans through it from a place within it to beyond its
/// border.
std::string two_sheets() {
  constexpr int kSide = 7;
  std::string text;
  for (int sheet = 0; sheet < 2; ++sheet) {
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const double x = 0.2 * i / (kSide - 1), z = 0.2 * j / (kSide - 1);
        text += sheet == 0
                    ? fmt::format("v {} 0 {}\n", x, z)
                    : fmt::format("v {} {} {}\n", x + 0.153, 0.8 * (z - 0.103), 0.6 * z + 0.04);
      }
    }
  }
  for (int sheet = 0; sheet < 2; ++sheet) {
    for (int i = 0; i + 1 < kSide; ++i) {
      for (int j = 0; j + 1 < kSide; ++j) {
        const int at = 1 + kSide * (kSide * sheet + i) + j;
        text += fmt::format("f {} {} {} {}\n", at, at + 1, at + kSide + 1, at + kSide);
      }
    }
  }
  return text;
}

TEST_CASE("weft run draws apart what begins tangled, and says when it has come out") {
  const TemporaryFolder folder;
  const std::string mesh = folder.write("sheets.obj", two_sheets());
  const std::string options = " --material cotton --self-contact on --plane 0,1,0,-9 --steps ";
  const Outcome out = run_program(folder, "run " + mesh + options + "90");
  CHECK(out.err.find("pairs of triangles of the cloth begin tangled, and are drawn apart") !=
        std::string::npos);
  CHECK(out.err.find("weft: what began tangled has come out") != std::string::npos);
  const Outcome cut = run_program(folder, "run " + mesh + options + "2");
  CHECK(cut.err.find("tangled in the end") != std::string::npos);
  const Outcome clear = run_program(folder, "run hang --size 5 --steps 1 --self-contact on");
  CHECK(clear.err.find("tangled") == std::string::npos);
}

}  // namespace
}  // namespace weft::tools
