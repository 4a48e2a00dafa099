/// What the program says of meshes that are not as they should be.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/scenes/splitmix.h"

namespace weft::tools {
namespace {

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

TEST_CASE("a report, a page and a recording name the file of a scene, not its folders") {
  const TemporaryFolder folder;
  const std::string run = folder.write("soup.obj", soup(2)) + " --weld 1e-5 --steps 2 --out " +
                          folder.file("a.html") + " --out " + folder.file("a.motion") +
                          " --record " + folder.file("a.weft");
  const auto report = report_of(folder, run);
  CHECK(report["scene"] == "soup.obj");
  const std::string place = std::filesystem::path(folder.file("soup.obj")).parent_path().string();
  for (const char* const name : {"a.motion", "a.weft"}) {
    const std::string bytes = folder.read(name);
    CHECK(bytes.find("soup.obj") != std::string::npos);
    CHECK(bytes.find(place) == std::string::npos);
  }
  const Outcome table = run_program(folder, "run " + run);
  CHECK(table.out.find("soup.obj") != std::string::npos);
  CHECK(table.out.find(place) == std::string::npos);
}

TEST_CASE("faces that a file has twice, as two-sided surfaces, are used once and named") {
  const TemporaryFolder folder;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 -1 0\nv 0 -1 0\nv 1 -2 0\nv 0 -2 0\n";
  const std::string front = "f 1 2 3\nf 1 3 4\nf 4 3 5\nf 4 5 6\n";
  const std::string back = "f 3 2 1\nf 4 3 1\nf 5 3 4\nf 6 5 4\n";
  const auto run = [&](const std::string& faces) {
    return folder.write("sheet.obj", vertices + faces) + " --pin top --material cotton --steps 2";
  };
  CHECK(run_program(folder, "run " + run(front)).out.find("twice") == std::string::npos);
  const Outcome shown = run_program(folder, "run " + run(front + back));
  CHECK(shown.out.find("4 faces twice, used once") != std::string::npos);
  const auto once = report_of(folder, run(front)), twice = report_of(folder, run(front + back));
  CHECK(once["double_faces"] == 0);
  CHECK(twice["double_faces"] == 4);
  CHECK(twice["state_hash"] == once["state_hash"]);
}

TEST_CASE("a fringe hangs from a cloth of a material, and its mass is said or given") {
  const TemporaryFolder folder;
  const std::string mesh =
      folder.write("tassel.obj",
                   "v 0 0 0\nv 1 0 0\nv 1 -1 0\nv 0 -1 0\nv 0 -1.1 0\nv 0 -1.2 0\n"
                   "f 1 2 3 4\nl 4 5 6\n") +
      " --pin top --material cotton --steps 60 --dt 1/60";
  const Outcome usual = run_program(folder, "run " + mesh);
  CHECK(usual.exit_code == 0);
  CHECK(usual.err ==
        "weft: lines are threads of 1 g/m: --thread-density says otherwise, in kg/m\n");
  CHECK(usual.out.find("2 lines that are threads") != std::string::npos);
  const auto report = report_of(folder, mesh + " --thread-density 0.5");
  CHECK(report["status"] == "converged");
  CHECK(report["lowest_y"] == doctest::Approx(-1.2).epsilon(0.02));
  CHECK(run_program(folder, "run " + mesh + " --thread-density 0.5").err.empty());
  CHECK(run_program(folder, "run " + mesh + " --thread-density 0").err.find("thread_density") !=
        std::string::npos);
}

TEST_CASE("cloth that nothing holds at all was meant to fall") {
  const TemporaryFolder folder;
  CHECK(run_program(folder, "run drape --size 5 --steps 1").err.empty());
}

}  // namespace
}  // namespace weft::tools
