/// Runs that are interrupted.
#include <doctest/doctest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "tests/tools/run_program.h"
#include "tests/tools/running_program.h"
#include "tests/tools/temporary_folder.h"

namespace weft::tools {
namespace {

// The terminal sends one signal, its shell another.
TEST_CASE("a run whose terminal is closed ends with its frame too") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const Running running(
      folder, {"run", "hang", "--steps", "100000000", "--out", outputs.file("motion.pc2")});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  running.send(SIGHUP);
  running.send(SIGHUP);
  CHECK(running.exit_code() == 128 + SIGHUP);
  CHECK(folder.read("stderr").find("weft: stops after this frame") == 0);
  const std::string motion = outputs.read("motion.pc2");
  REQUIRE(motion.size() > 32);
  CHECK((motion.size() - 32) % (12 * 400) == 0);
}

TEST_CASE("an interrupted run ends with its frame: whole files, a line, 130") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const std::string motion = outputs.file("motion.pc2"), scene = outputs.file("last.json");
  const std::string report = outputs.file("report.json");
  const Running running(folder, {"run", "hang", "--steps", "100000000", "--out", motion, "--out",
                                 scene, "--json", report});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  running.interrupt();
  CHECK(running.exit_code() == 130);
  CHECK(folder.read("stderr").find("weft: stops after this frame") == 0);
  REQUIRE_FALSE(outputs.read("report.json").empty());
  const auto frames = nlohmann::json::parse(outputs.read("report.json"))["steps"].get<int>();
  CHECK(folder.read("stderr").find("weft: interrupted in frame " + std::to_string(frames) +
                                   " of 100000000,") != std::string::npos);
  CHECK(outputs.read("motion.pc2").size() ==
        32 + (static_cast<std::size_t>(frames) + 1) * 12 * 400);

  // The last state is that of a run of so many frames.
  const Outcome same = run_program(
      folder, "run hang --steps " + std::to_string(frames) + " --out " + folder.file("same.json"));
  CHECK(same.exit_code == 0);
  CHECK(folder.read("same.json") == outputs.read("last.json"));
}

TEST_CASE("an interrupted repeat leaves the report of a whole run") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const std::string scene = outputs.file("last.json"), report = outputs.file("report.json");
  const Running running(folder, {"run", "hang", "--size", "5", "--steps", "50", "--repeat",
                                 "100000000", "--out", scene, "--json", report});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  running.interrupt();
  CHECK(running.exit_code() == 130);
  CHECK(folder.read("stderr").find("weft: interrupted in repeat ") != std::string::npos);
  CHECK(nlohmann::json::parse(outputs.read("report.json"))["steps"] == 50);
  const Outcome same =
      run_program(folder, "run hang --size 5 --steps 50 --out " + folder.file("same.json"));
  CHECK(same.exit_code == 0);
  CHECK(folder.read("same.json") == outputs.read("last.json"));
}

TEST_CASE("a second interrupt ends a frame that takes too long, and leaves no file") {
  const TemporaryFolder folder;
  const TemporaryFolder outputs;
  const Running running(folder, {"run", "corners", "--size", "301", "--tolerance", "0.0001%",
                                 "--out", outputs.file("last.obj")});
  wait_for([&] { return !outputs.is_empty(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  running.interrupt();
  wait_for([&] { return folder.read("stderr").find("once more") != std::string::npos; });
  running.interrupt();
  CHECK(running.exit_code() == 130);
  CHECK(folder.read("stderr").ends_with("weft: interrupted\n"));
  CHECK(outputs.is_empty());
}

}  // namespace
}  // namespace weft::tools
