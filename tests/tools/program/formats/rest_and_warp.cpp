#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/formats/scene_file.h"

namespace weft::tools {
namespace {

/// Two squares of 1 m, in centimetres, that begin folded along the edge from 2 to 3. Their texture
/// coordinates lie apart, in units of 2 m; the last corner names the first of them.
const std::string kFolded =
    "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nv 20 0 60\nv 20 100 60\n"
    "vt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\nvt 2 2\nvt 2 2.5\nvt 2.5 2\nvt 2.5 2.5\n"
    "f 1/1 2/2 3/3 4/4\nf 2/5 5/7 6/8 3/6\n";
const std::string kFlat =
    "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nv 200 0 0\nv 200 100 0\nf 1 2 3 4\nf 2 5 6 3\n";

class Written {
 public:
  SceneDescription operator()(const std::string& mesh, const std::string& options) const {
    const std::string file = folder_.file("scene.json");
    const Outcome outcome = run_program(folder_, "scene " + folder_.write("mesh.obj", mesh) +
                                                     " --out " + file + " --scale 0.01 " + options);
    REQUIRE_MESSAGE(outcome.exit_code == 0, outcome.err);
    return read_scene_file(file).value().description;
  }
  std::string error(const std::string& mesh, const std::string& options) const {
    const std::string path = folder_.write("mesh.obj", mesh);
    const Outcome outcome = run_program(folder_, "run " + path + ' ' + options);
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

TEST_CASE("a mesh has the rest shape of another file, or of its texture coordinates") {
  const Written written;
  const std::string rest = written.folder().write("rest.obj", kFlat);
  for (const std::string material : {"", " --material cotton"}) {
    const SceneDescription flat = written(kFlat, material);
    for (const std::string& given : {rest, std::string("uv:2")}) {
      CAPTURE(given);
      const SceneDescription folded = written(kFolded, "--rest " + given + material);
      CHECK(folded.masses == flat.masses);
      CHECK(folded.positions[4].z == doctest::Approx(0.6));
      REQUIRE(folded.constraints.size() == flat.constraints.size());
      for (std::size_t i = 0; i < flat.constraints.size(); ++i) {
        CHECK(folded.constraints[i].rest_length ==
              doctest::Approx(flat.constraints[i].rest_length));
        CHECK(folded.constraints[i].compliance == doctest::Approx(flat.constraints[i].compliance));
      }
    }
  }
  const SceneDescription half = written(kFolded, "--rest uv --material cotton");
  CHECK(half.constraints[0].rest_length == 0.5);
}

TEST_CASE("a rest shape that does not fit the mesh is refused in one line") {
  const Written written;
  const auto rest = [&](const std::string& name, const std::string& text) {
    return written.folder().write(name, text);
  };
  const std::string start = "weft: " + written.folder().file("mesh.obj") + ": ";
  const std::string fewer = rest("fewer.obj", kFlat.substr(8));
  CHECK(written.error(kFlat, "--rest " + fewer).starts_with(start + "--rest: " + fewer));
  const std::string more = rest("more.obj", "v 1 2 3\n" + kFlat);
  CHECK(written.error(kFlat, "--rest " + more) ==
        start + "--rest: " + more + ": 7 vertices, where the mesh has 6\n");
  const std::string face = rest("face.obj", kFlat + "f 1 2 3\n");
  CHECK(written.error(kFlat, "--rest " + face) ==
        start + "--rest: " + face + ": 3 faces, where the mesh has 2\n");
  std::string other_faces = kFlat;
  other_faces.replace(other_faces.rfind("2 5"), 3, "1 5");
  const std::string other = rest("other.obj", other_faces);
  CHECK(written.error(kFlat, "--rest " + other) ==
        start + "--rest: " + other +
            ": face 1, counted from 0, has other vertices than in the mesh\n");
  CHECK(written.error(kFlat, "--rest uv") ==
        start + "--rest: face 0, counted from 0, has a corner without texture coordinates\n");
  CHECK(written.error(kFolded + "f 1/1 2/99 3/3\n", "--rest uv") ==
        start + "--rest: face 2, counted from 0, has a corner without texture coordinates\n");
  CHECK(written.error(kFolded + "vt x 0\nf 1/1 2/9 3/3\n", "--rest uv")
            .starts_with(start + "--rest: face 2"));
  CHECK(written.error(kFolded + "f 1/1 2/1 3/1\n", "--rest uv") ==
        start + "rest_corners: face 2 has no area at rest\n");
  for (const std::string given : {"flat", "uv:", "uv:0", "uv:-1", "uv2", "mesh.json"}) {
    CAPTURE(given);
    CHECK(written.error(kFolded, "--rest " + given) ==
          start + "--rest: '" + given + "' is not an .obj file, uv, or uv:SCALE\n");
  }
  CHECK(written.error(kFlat, "--rest nowhere.obj").find("nowhere.obj") != std::string::npos);
  CHECK(run_program(written.folder(), "run hang --rest uv").err ==
        "weft: --rest: only for .obj meshes, not for 'hang'\n");
}

TEST_CASE("the warp runs where the program is told, or along v of the texture") {
  const Written written;
  const std::string sheet =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0 1\nvt 1 1\nvt 1 0\nvt 0.7 1.7\n"
      "f 1/1 2/2 3/3 4/4\n";
  const auto first_is_warp = [&](const std::string& warp) {
    const SceneDescription scene = written(sheet, "--material cotton --shear 0 " + warp);
    REQUIRE(scene.constraints.size() == 4);
    return scene.constraints[0].compliance < scene.constraints[1].compliance;
  };
  CHECK_FALSE(first_is_warp(""));
  CHECK_FALSE(first_is_warp("--warp 0,-2,0"));
  CHECK(first_is_warp("--warp 1,0,0"));
  CHECK(first_is_warp("--warp uv"));
  CHECK(first_is_warp("--rest uv"));
  CHECK_FALSE(first_is_warp("--rest uv --warp 1,0,0"));  // along u
}

TEST_CASE("a warp that means nothing is refused in one line") {
  const Written written;
  const std::string start = "weft: " + written.folder().file("mesh.obj") + ": ";
  CHECK(written.error(kFlat, "--material silk --warp uv") ==
        start + "--warp: face 0, counted from 0, has a corner without texture coordinates\n");
  CHECK(written.error(kFolded + "f 1/1 2/1 3/1\n", "--material silk --warp uv") ==
        start + "--warp: texture: face 2 has no area\n");
  for (const std::string given : {"x", "1,2", "uv:2"}) {
    CAPTURE(given);
    CHECK(written.error(kFlat, "--material silk --warp " + given) ==
          start + "--warp: '" + given + "' is not x,y,z, or uv\n");
  }
  CHECK(written.error(kFlat, "--warp 0,1,0") == "weft: --warp: only cloth of a material has one\n");
}

TEST_CASE("texture coordinates that nobody asks for may be anything") {
  const Written written;
  CHECK(written(kFlat + "vt x\nvt\nf 1/7 2 3/1\n", "").positions.size() == 6);
}

}  // namespace
}  // namespace weft::tools
