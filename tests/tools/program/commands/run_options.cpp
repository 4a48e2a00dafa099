/// The options of a run, and what its report says of them.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/run_program.h"
#include "tests/tools/temporary_folder.h"
#include "tools/program/formats/scene_file.h"
#include "tools/scenes/irregular_mesh.h"
#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

TEST_CASE("every built-in scene runs with its default size and reaches its tolerance") {
  const TemporaryFolder folder;
  for (const scenes::BuiltIn& scene : scenes::list()) {
    CAPTURE(scene.name);
    const Outcome outcome =
        run_program(folder, "run " + std::string(scene.name) + " --steps 3 --json -");
    CHECK(outcome.exit_code == 0);
    CHECK(nlohmann::json::parse(outcome.out)["max_error"] <= 0.01);
  }
}

TEST_CASE("every built-in grid of cotton reaches its tolerance") {
  const TemporaryFolder folder;
  for (const std::string name : {"hang", "hang_sphere", "corners", "banner", "four_pins"}) {
    CAPTURE(name);
    const auto report = report_of(folder, name + " --size 11 --material cotton --steps 20");
    CHECK(report["springs"] == report["constraints"]);
    CHECK(report["max_error"] <= 0.01);
  }
}

TEST_CASE("every solver and scheme can be asked for, and the report names it") {
  const TemporaryFolder folder;
  using nlohmann::json;
  const struct {
    std::string arguments;
    json reported;
  } calls[] = {
      {"--solver gauss_seidel --scheme paper --backend reference --threads 1 --substeps 1",
       {{"solver", "gauss_seidel"},
        {"solver_used", "gauss_seidel"},
        {"scheme", "paper"},
        {"backend", "reference"},
        {"threads", 1},
        {"substeps", 1}}},
      {"--solver yarn --substeps 2 --backend simd",
       {{"solver", "yarn"}, {"solver_used", "yarn"}, {"backend", "simd"}, {"substeps", 2}}},
      {"--solver auto --substeps auto", {{"solver", "auto"}, {"scheme", "paper"}}},
      {"--solver direct", {{"solver", "direct"}, {"solver_used", "direct"}}},
      {"--scheme rattle", {{"solver", "auto"}, {"scheme", "rattle"}}},
  };
  for (const auto& call : calls) {
    CAPTURE(call.arguments);
    const Outcome outcome =
        run_program(folder, "run hang --size 4 --steps 2 " + call.arguments + " --json -");
    CHECK(outcome.exit_code == 0);
    const json report = json::parse(outcome.out);
    for (const auto& [key, value] : call.reported.items()) {
      CAPTURE(key);
      CHECK(report[key] == value);
    }
  }
}

TEST_CASE("the report tells which solver auto came to") {
  const TemporaryFolder folder;
  const struct {
    std::string arguments;
    std::string used;
  } kChoices[] = {{"hang --size 12 --tolerance 0.01%", "yarn"},
                  {"hang --size 4 --iterations 3", "gauss_seidel"},
                  {"cape --size 9 --tolerance 1%", "small_steps"}};
  for (const auto& choice : kChoices) {
    CAPTURE(choice.arguments);
    const std::string arguments = "run " + choice.arguments + " --steps 2";
    const auto json = nlohmann::json::parse(run_program(folder, arguments + " --json -").out);
    CHECK(json["solver"] == "auto");
    CHECK(json["solver_used"] == choice.used);
    const std::string table = run_program(folder, arguments).out;
    CHECK(table.find("solver    auto (" + choice.used + "), scheme") != std::string::npos);
  }
}

TEST_CASE("the direct solver is available") {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(
      folder, "run corners --size 7 --steps 5 --tolerance 1e-6 --solver direct --json -");
  CHECK(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["solver"] == "direct");
  CHECK(json["max_strain"] <= 1e-6);
}

TEST_CASE("substeps are done and reported") {
  const TemporaryFolder folder;
  const auto hash = [&](const std::string& arguments, int substeps) {
    const Outcome outcome =
        run_program(folder, "run hang --size 5 --solver yarn --json - " + arguments);
    REQUIRE(outcome.exit_code == 0);
    const auto json = nlohmann::json::parse(outcome.out);
    CHECK(json["substeps"] == substeps);
    return json["state_hash"].get<std::string>();
  };
  const std::string split = hash("--dt 0.02 --steps 10 --substeps 2", 2);
  CHECK(split == hash("--dt 0.01 --steps 20", 1));
}

TEST_CASE("a fixed number of iterations is exactly that") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program(folder, "run hang --size 6 --steps 5 --iterations 7 --json -");
  CHECK(outcome.exit_code == 0);
  const auto json = nlohmann::json::parse(outcome.out);
  CHECK(json["status"] == "fixed_iterations");
  CHECK(json["iterations_per_step"] == 7);
}

TEST_CASE("the way of iterating can be chosen") {
  const TemporaryFolder folder;
  for (const std::string method :
       {"--anticipate off --skip off --directions each", "--anticipate on --skip off",
        "--anticipate products", "--anticipate products --skip off --directions each",
        "--anticipate off --skip on --directions frozen", "--velocity-correction on"}) {
    CAPTURE(method);
    const Outcome outcome = run_program(folder, "run hang --size 6 --steps 10 --json - " + method);
    CHECK(outcome.exit_code == 0);
    CHECK(nlohmann::json::parse(outcome.out)["max_strain"] <= 0.01);
  }
}

TEST_CASE("a tighter tolerance of contacts leaves less of them") {
  const TemporaryFolder folder;
  const std::string run =
      "hang_sphere --size 9 --steps 60 --solver gauss_seidel --contact-tolerance ";
  CHECK(report_of(folder, run + "1e-6")["max_penetration"] <= 1e-6);
  CHECK(report_of(folder, run + "1e-2")["max_penetration"] > 1e-3);
}

TEST_CASE("a tolerance of the motion takes more substeps, and is told beside what is estimated") {
  const TemporaryFolder folder;
  const auto plain = report_of(folder, "hang --size 9 --steps 40");
  const auto close = report_of(folder, "hang --size 9 --steps 40 --motion-tolerance 1e-3");
  CHECK(plain["motion_tolerance"] == 0);
  CHECK(close["motion_tolerance"] == 1e-3);
  CHECK(close["substeps"] > plain["substeps"]);
  CHECK(close["motion_error"] < 1e-3);
  CHECK(plain["motion_error"] > 1e-3);
  CHECK(close["max_motion_error"] >= close["motion_error"]);
  CHECK(close["energy_lost"] < plain["energy_lost"]);
}

TEST_CASE("a tighter tolerance of velocities takes more iterations") {
  const TemporaryFolder folder;
  const auto iterations = [&](const std::string& tolerance) {
    return report_of(folder,
                     "hang --size 9 --steps 5 --solver gauss_seidel --velocity-correction "
                     "on --velocity-tolerance " +
                         tolerance)["velocity_iterations_per_step"]
        .get<double>();
  };
  CHECK(iterations("1e-5") > 2 * iterations("1e-2"));
}

TEST_CASE("limited impulses are more of them") {
  const TemporaryFolder folder;
  const std::string run = "hang --size 5 --steps 5 --tolerance 1e-4 --backend reference ";
  const int unlimited = report_of(folder, run)["corrections"];
  CHECK(report_of(folder, run + "--impulse-limit 1e-5")["corrections"] > 2 * unlimited);
}

TEST_CASE("frozen directions are renewed as often as is asked") {
  const TemporaryFolder folder;
  const auto report = report_of(
      folder, "hang --size 9 --steps 5 --solver gauss_seidel --tolerance 1e-4 --renew-after 1");
  CHECK(report["direction_updates_per_step"] == report["iterations_per_step"]);
}

TEST_CASE("a run may use as many threads as is asked") {
  const TemporaryFolder folder;
  CHECK(report_of(folder, "hang --size 4 --steps 1 --threads 1")["threads"] == 1);
  CHECK(report_of(folder, "hang --size 4 --steps 1 --threads 3")["threads"] == 3);
}

TEST_CASE("methods of Gauss-Seidel are asked of it; what is named has one substep") {
  const TemporaryFolder folder;
  const std::string run = "hang --size 4 --steps 2 --dt 0.1";
  const auto by_products = report_of(folder, run + " --anticipate products");
  CHECK(by_products["solver"] == "gauss_seidel");
  CHECK(by_products["anticipate_products"] == true);
  for (const std::string method : {"--skip on", "--anticipate on", "--directions frozen"}) {
    CAPTURE(method);
    CHECK(report_of(folder, run + ' ' + method)["solver"] == "gauss_seidel");
    CHECK(report_of(folder, run + " --solver yarn " + method)["solver"] == "yarn");
  }
  CHECK(report_of(folder, run)["substeps"] > 1);
  CHECK(report_of(folder, run + " --solver yarn")["substeps"] == 1);
}

TEST_CASE("what cannot anticipate through products says so, in a line") {
  const TemporaryFolder folder;
  for (const std::string arguments :
       {"--anticipate products --backend reference", "--anticipate products --solver yarn"}) {
    CAPTURE(arguments);
    const Outcome outcome = run_program(folder, "run hang --size 4 " + arguments);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.err.find("anticipate_products") != std::string::npos);
  }
  CHECK(run_program(folder, "run hang --size 4 --anticipate some").exit_code == 2);
}

TEST_CASE("options that have no effect beside others do no harm") {
  const TemporaryFolder folder;
  for (const std::string arguments :
       {"--backend reference --isa auto", "--scheme rattle --velocity-correction on",
        "--iterations 0 --tolerance 1%", "--solver gauss_seidel --skip on --max-iterations 1000",
        "--iterations 5 --skip off --directions each", "--iterations 5 --tolerance 1%",
        "--solver yarn --skip off", "--backend reference --isa sse2"}) {
    CAPTURE(arguments);
    CHECK(run_program(folder, "run hang --size 4 --steps 2 " + arguments).exit_code == 0);
  }
}

TEST_CASE("what is asked of a built-in scene is what is made") {
  const TemporaryFolder folder;
  const struct {
    std::string name;
    std::string arguments;
    scenes::Options options;
  } kScenes[] = {{"hang", "--size 4", {.size = 4}},
                 {"corners", "", {.size = 21}},
                 {"sphere_drop", "--size 5 --slack 0.2", {.size = 5, .slack = 0.2}},
                 {"sphere_drop", "--sphere-mass 7", {.sphere_mass = 7}},
                 {"four_pins", "--diagonals --size 5", {.size = 5, .diagonals = true}},
                 {"corners", "--diagonals", {.size = 21, .diagonals = true}},
                 {"cape", "", {.size = 20}},
                 {"cape", "--ropes --size 9", {.size = 9, .ropes = true}},
                 {"hang", "--ropes diagonals --size 9", {.size = 9, .diagonals = true}},
                 {"corners",
                  "--material silk --size 9",
                  {.size = 9, .material = find_material("silk").value()}},
                 {"chain", "--end-mass 9", {.end_mass = 9}}};
  for (const auto& asked : kScenes) {
    CAPTURE(asked.arguments);
    const std::string file = folder.file("scene.json");
    const std::string arguments = "scene " + asked.name + ' ' + asked.arguments + " --out " + file;
    CHECK(run_program(folder, arguments).exit_code == 0);
    const auto [description, mesh, bodies, moves] =
        scenes::make_scene(asked.name, asked.options).value();
    CHECK(folder.read("scene.json") == scene_text(description, {}, particle_faces(mesh), bodies));
  }
}

}  // namespace
}  // namespace weft::tools
