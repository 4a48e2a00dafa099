/// What the program asks a mesh for: its material, and what it says of rigid triangles.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/formats/scene_file.h"
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
      {square + " --pin 'x\n>0'", "--pin: "},
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
    CHECK(std::ranges::count(outcome.err, '\n') == 1);
  }
}

TEST_CASE("what changes a material changes the cotton of a scene that always has one") {
  const TemporaryFolder folder;
  const std::string file = folder.file("scene.json");
  CHECK(
      run_program(folder, "scene flag --size 5 --density 3 --wind 1,2,3 --out " + file).exit_code ==
      0);
  const SceneDescription flag = read_scene_file(file).value().description;
  CHECK(flag.masses[12] == doctest::Approx(3.0 / 16));
  CHECK(flag.air.wind.y == 2);
  CHECK(flag.damping.bending == find_material("cotton").value().damping_bending);
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

TEST_CASE("whoever runs a mesh in centimetres, or one that cannot move, is told so") {
  const TemporaryFolder folder;
  const std::string large =
      folder.write("large.obj", "v 0 0 0\nv 90 0 0\nv 90 170 0\nv 0 170 0\nf 1 2 3 4\n");
  const auto err = [&](const std::string& options) {
    return run_program(folder, "run --steps 1 " + options).err;
  };
  CHECK(err(large) ==
        "weft: the mesh is 170 m large: if its coordinates are in centimetres, ask for --scale "
        "0.01\n");
  CHECK(err(large + " --scale 0.01").empty());
  CHECK(err(large + " --scale 0.01 --pin top").empty());
  CHECK(err(large + " --scale 0.01 --pin 'y<1 or top'") ==
        "weft: every particle is fixed, so that nothing can move\n");
}

TEST_CASE("errors of a file name the file, also those of what is in it") {
  const TemporaryFolder folder;
  const std::string scene = folder.write(
      "apart.json",
      R"({"positions": [[0,0,0],[1,0,0]], "total_mass": 1, "constraints": [[0, 7, 1]]})");
  const std::string mesh = folder.write("square.obj", kSquare);
  for (const std::string& arguments : {"run " + scene, "scene " + scene + " --out x.json"}) {
    CAPTURE(arguments);
    CHECK(run_program(folder, arguments).err.starts_with("weft: " + scene + ": constraints[0]"));
  }
  for (const std::string options :
       {"--pin 77", "--seam 0:77", "--weld -1", "--mass 0", "--scale -1"}) {
    CAPTURE(options);
    const Outcome outcome = run_program(folder, "run " + mesh + ' ' + options);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.starts_with("weft: " + mesh + ": "));
  }
  CHECK(run_program(folder, "run " + mesh + " --up x").err ==
        "weft: --up: 'x' is not one of y, z\n");
  CHECK(run_program(folder, "run hang --weld 1").err ==
        "weft: --weld: only for .obj meshes, not for 'hang'\n");
}

TEST_CASE("a mesh whose z is up hangs along z, and its report says so") {
  const TemporaryFolder folder;
  const std::string wall = folder.write(
      "wall.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 1 0 2\nv 0 0 2\nf 1 2 3 4\nf 4 3 5 6\n");
  const auto report = report_of(folder, wall + " --up z --pin top --steps 5 --dt 1/60");
  CHECK(report["dt"] == 1.0 / 60);
  CHECK(report["lowest_z"] == doctest::Approx(0).epsilon(0.03));
  CHECK_FALSE(report.contains("lowest_y"));
}

}  // namespace
}  // namespace weft::tools
