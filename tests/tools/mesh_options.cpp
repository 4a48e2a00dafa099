/// What the program asks a mesh for: its material, and what it says of rigid triangles.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "run_program.h"
#include "temporary_folder.h"
#include "tools/scene_file.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nf 1 2 3 4\nl 5 3\n";

TEST_CASE("a mesh of a material is what the options say") {
  const TemporaryFolder folder;
  const std::string square = folder.write("square.obj", kSquare);
  const std::string file = folder.file("scene.json");
  const auto written = [&](const std::string& options) {
    const Outcome outcome =
        run_program(folder, "scene " + square + " --out " + file + ' ' + options);
    CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
    return read_scene_file(file).value().description;
  };
  const SceneDescription silk = written("--material silk --ropes diagonals --wind 1,-2,3");
  CHECK(silk.constraints.size() == 6);
  CHECK(std::ranges::count(silk.constraints, ConstraintKind::rope, &Constraint::kind) == 2);
  CHECK(silk.air.triangles.size() == 2);
  CHECK(silk.air.wind.y == -2);
  CHECK(silk.damping.bending > 0);
  const SceneDescription own = written("--stretch 100 --density 2 --damping 0.5");
  CHECK(own.masses == std::vector<double>(4, 0.5));
  CHECK(own.constraints[0].compliance == doctest::Approx(2.0 / 100));
  CHECK(own.damping.stretch == 0.5);
  const std::string material =
      folder.write("heavy.json", R"({"density": 8, "warp": 10, "weft": 10, "bending": 1})");
  CHECK(written("--material " + material).masses == std::vector<double>(4, 2));
  CHECK(written("--material " + material + " --density 4").masses == std::vector<double>(4, 1));
  CHECK(written("--ropes all").constraints[0].kind == ConstraintKind::rope);
  CHECK(run_program(folder, "scene cape --size 9 --material wool --out " + file).exit_code == 0);
  const SceneDescription cape = read_scene_file(file).value().description;
  CHECK(cape.bending.size() > 100);
  CHECK(cape.fixed == scenes::make("cape", {.size = 9}).value().fixed);
}

TEST_CASE("options of a material that mean nothing are refused") {
  const TemporaryFolder folder;
  const std::string square = folder.write("square.obj", kSquare);
  const std::string bad = folder.write("bad.json", R"({"weight": 3})");
  const struct {
    std::string options, error;
  } kRefused[] = {
      {square + " --material tweed",
       "--material: material: there is no 'tweed', there are cotton, denim, linen, polyester, "
       "silk, "
       "wool"},
      {square + " --material " + bad, "--material: " + bad + ": unknown key 'weight'"},
      {square + " --shear 3", "--shear: needs --stretch or --material"},
      {square + " --stretch 3", "--stretch: needs --density or --material"},
      {square + " --material silk --bend -1",
       "material.bending: must be finite and at least 0 (-1)"},
      {square + " --material silk --mass 3", "--mass: a material has a density instead"},
      {square + " --wind 1,2,3", "--wind: only cloth of a material feels it"},
      {square + " --material silk --wind 1,2", "--wind: '1,2' is not x,y,z"},
      {square + " --material silk --wind 1,2,3,4", "--wind: '1,2,3,4' is not x,y,z"},
      {square + " --ropes some", "--ropes: 'some' is not one of all, diagonals"},
      {"chain --material silk",
       "--material: only for .obj meshes and built-in scenes but chain, not for 'chain'"},
      {"hang --wind 1,2,3", "--wind: only cloth of a material feels it"}};
  for (const auto& [options, error] : kRefused) {
    CAPTURE(options);
    const Outcome outcome = run_program(folder, "run " + options);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.find(error) != std::string::npos);
  }
}

TEST_CASE("whoever runs rigid triangles is told what to ask for") {
  const TemporaryFolder folder;
  const std::string triangle = folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string square = folder.write("square.obj", kSquare);
  const auto err = [&](const std::string& options) {
    return run_program(folder, "run --steps 1 " + options).err;
  };
  CHECK(err(triangle) ==
        "weft: triangles of rigid edges lock, so that the cloth hardly folds: ask for --material, "
        "or --ropes all\n");
  CHECK(err(triangle + " --ropes all").empty());
  CHECK(err(square).empty());
}

}  // namespace
}  // namespace weft::tools
