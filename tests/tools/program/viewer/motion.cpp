/// Runs as files and pages, against the files and reports that the same run leaves.
#include "tools/program/viewer/motion.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/tools/program/viewer/reading.h"
#include "tests/tools/run_program.h"
#include "tools/program/viewer/base64.h"

namespace weft::tools {
namespace {

using reading::Integers;
using reading::Motion;

double float_at(const std::string& bytes, std::size_t number) {
  float value = 0;
  std::memcpy(&value, bytes.data() + 32 + 4 * number, sizeof value);
  return value;
}

/// The largest of a figure over the frames.
double most_of(const Motion& motion, const std::string& figure) {
  double most = 0;
  for (const auto& value : motion.header["figures"][figure]) {
    if (!value.is_null()) most = std::max(most, value.get<double>());
  }
  return most;
}

double mean_of(const Motion& motion, const std::string& figure) {
  double sum = 0;
  int frames = 0;
  for (const auto& value : motion.header["figures"][figure]) {
    if (value.is_null()) continue;
    sum += value.get<double>();
    ++frames;
  }
  return sum / frames;
}

TEST_CASE("a motion has the places of the point cache and the figures of the report") {
  const TemporaryFolder folder;
  const auto report =
      report_of(folder, "corners --size 11 --steps 40 --out " + folder.file("a.motion") +
                            " --out " + folder.file("a.pc2"));
  const std::string bytes = folder.read("a.motion"), cache = folder.read("a.pc2");
  CHECK(check_motion(bytes));
  const Motion motion(bytes);
  const auto& header = motion.header;
  const double quantum = header["quantum"];
  CHECK(header["scene"] == "corners");
  CHECK(header["samples"] == 41);
  CHECK(header["dt"] == 0.01);
  CHECK(quantum == doctest::Approx(1.0 / 65535));
  const auto places = motion.places();
  double most = 0;
  for (std::size_t t = 0; t < 41; ++t) {
    for (std::size_t i = 0; i < 121; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        most = std::max(
            most, std::abs(places[t][121 * axis + i] - float_at(cache, 3 * (121 * t + i) + axis)));
    }
  }
  CHECK(most <= 0.5 * quantum + 1e-7);  // the cache has floats
  CHECK(most > 0.4 * quantum);
  CHECK(motion.numbers("pins") == std::vector<std::int32_t>{0, 10});
  CHECK(motion.count("triangles") == 3 * 2 * 100);
  CHECK(most_of(motion, "max_strain") ==
        doctest::Approx(report["max_strain"].get<double>()).epsilon(1e-9));
  CHECK(mean_of(motion, "motion_error") ==
        doctest::Approx(report["motion_error"].get<double>()).epsilon(1e-12));
  CHECK(header["figures"]["energy"][40] == report["energy_end"]);
  CHECK(header["figures"]["energy"][0].is_null());
  CHECK(header["figures"]["status"][40] == "converged");
}

/// The strain of each edge, from the places.
TEST_CASE("the stretch of a particle is the strain of its edges") {
  const TemporaryFolder folder;
  report_of(folder, "corners --size 11 --steps 40 --out " + folder.file("a.motion"));
  const Motion motion(folder.read("a.motion"));
  const auto places = motion.places().back();
  const auto ends = motion.numbers("link ends");
  std::vector<double> expected(121);
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    const auto a = static_cast<std::size_t>(ends[i]), b = static_cast<std::size_t>(ends[i + 1]);
    const auto along = [&](std::size_t axis) {
      return places[121 * axis + a] - places[121 * axis + b];
    };
    const double strain = std::hypot(along(0), along(1), along(2)) / 0.1 - 1;
    for (const std::size_t end : {a, b}) {
      if (std::abs(strain) > std::abs(expected[end])) expected[end] = strain;
    }
  }
  std::vector<std::int32_t> quanta(121);
  Integers reader(motion.section("stretch"));
  for (int t = 0; t < 41; ++t) {
    const auto change = reader.read(121);
    for (std::size_t i = 0; i < 121; ++i) quanta[i] += change[i];
  }
  double most = 0;
  for (std::size_t i = 0; i < 121; ++i) {
    const double stretch = motion.header["stretch_quantum"].get<double>() * quanta[i];
    most = std::max(most, std::abs(std::abs(stretch) - std::abs(expected[i])));
  }
  CHECK(most < 1.5e-4 + 2 * motion.header["quantum"].get<double>() / 0.1);
  CHECK(most_of(motion, "max_strain") > 1e-3);
}

TEST_CASE("constraints of one colour share no particle, and yarns are rows and columns") {
  const TemporaryFolder folder;
  report_of(folder, "hang --size 9 --steps 1 --out " + folder.file("a.motion"));
  const Motion motion(folder.read("a.motion"));
  const auto ends = motion.numbers("link ends"), colours = motion.numbers("link colours");
  REQUIRE(ends.size() == 2 * colours.size());
  CHECK(colours.size() == 2 * 9 * 8 - 8);  // without those between pins
  std::vector<std::pair<int, int>> seen;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    REQUIRE(colours[i] >= 0);
    seen.emplace_back(colours[i], ends[2 * i]);
    seen.emplace_back(colours[i], ends[2 * i + 1]);
  }
  std::ranges::sort(seen);
  CHECK(std::ranges::adjacent_find(seen) == seen.end());
  const auto yarns = motion.numbers("link yarns");
  CHECK(std::ranges::max(yarns) + 1 == 9 + 8);
}

TEST_CASE("bodies move with their poses, and touch") {
  const TemporaryFolder folder;
  const auto report =
      report_of(folder, "cushion --size 15 --steps 30 --out " + folder.file("a.motion"));
  const Motion motion(folder.read("a.motion"));
  REQUIRE(motion.header["bodies"].size() == 1);
  CHECK(motion.header["bodies"][0]["shape"] == "ball");
  CHECK(motion.header["bodies"][0]["radius"] == 0.15);
  const auto poses = motion.floats("body 0 poses");
  REQUIRE(poses.size() == 31 * 7);
  CHECK(poses[30 * 7 + 1] < poses[1] - 0.01);  // it is pressed down
  CHECK(poses[30 * 7 + 6] == 1);
  Integers reader(motion.section("contacts"));
  double most = 0;
  for (int t = 0; t < 31; ++t) {
    const auto count = static_cast<std::size_t>(reader.read(1).front());
    const auto touching = reader.read_differences(count);
    CHECK(std::ranges::is_sorted(touching));
    most = std::max(most, static_cast<double>(count));
    const auto& told = motion.header["figures"]["body_contacts"][static_cast<std::size_t>(t)];
    if (!told.is_null()) CHECK(static_cast<int>(count) == told.get<int>());
  }
  CHECK(most == report["body_contacts"].get<double>());
  CHECK(most > 0);
}

TEST_CASE("a body with a mass is shown where it has come to, turned as it is") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.json", R"({"positions": [[9, 0, 0]],
        "masses": [1], "bodies": [{"shape": "box", "size": [0.1, 0.2, 0.4], "density": 1000,
        "position": [0, 1, 0], "velocity": [1, 0, 0], "spin": [0, 2, 0]}]})");
  const auto report =
      report_of(folder, scene + " --dt 1/60 --steps 30 --out " + folder.file("a.motion"));
  const auto poses = Motion(folder.read("a.motion")).floats("body 0 poses");
  REQUIRE(poses.size() == 31 * 7);
  for (std::size_t frame = 0; frame <= 30; ++frame) {
    const double time = static_cast<double>(frame) / 60;
    CHECK(poses[frame * 7] == doctest::Approx(time));
    CHECK(poses[frame * 7 + 1] == doctest::Approx(1 - 5 * time * time));
    CHECK(poses[frame * 7 + 4] == doctest::Approx(std::sin(time)));
    CHECK(poses[frame * 7 + 6] == doctest::Approx(std::cos(time)));
  }
  CHECK(report["free_bodies"][0]["position"][1] == doctest::Approx(poses[30 * 7 + 1]));
}

TEST_CASE("a page has the motion in it, and pages and motions become pages") {
  const TemporaryFolder folder;
  const std::string a = folder.file("a.motion"), page = folder.file("a.html");
  report_of(folder, "hang --size 5 --steps 3 --out " + a + " --out " + page);
  const std::string text = folder.read("a.html"), motion = folder.read("a.motion");
  CHECK(text.find("application/octet-stream\">" + base64(motion) + "</script>") != text.npos);
  CHECK(text.find("three.js authors") != text.npos);
  CHECK(text.find("<!-- results -->") == text.npos);
  CHECK(run_program(folder, "view " + page + " --out " + folder.file("b.html")).exit_code == 0);
  CHECK(folder.read("b.html") == text);
  CHECK(
      run_program(folder, "view " + a + " " + page + " --out " + folder.file("c.html")).exit_code ==
      0);
  const std::string both = folder.read("c.html");
  const std::size_t first = both.find(base64(motion));
  CHECK(both.find(base64(motion), first + 1) != both.npos);
  const Outcome three =
      run_program(folder, "view " + a + " " + folder.file("c.html") + " --out " + page);
  CHECK(three.exit_code == 2);
  CHECK(three.err.find("2 results at most") != std::string::npos);
}

TEST_CASE("what is no result is refused by name") {
  const TemporaryFolder folder;
  const std::string a = folder.file("a.motion");
  report_of(folder, "hang --size 5 --steps 3 --out " + a);
  std::string bytes = folder.read("a.motion");
  bytes[bytes.size() / 2] ^= 1;
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = run_program(folder, "view " + arguments);
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  const std::string out = " --out " + folder.file("x.html");
  CHECK(refused(folder.write("bad.motion", bytes) + out).find("is damaged") != std::string::npos);
  CHECK(refused(folder.write("bad.html", "<html>") + out).find("none that weft wrote") !=
        std::string::npos);
  CHECK(refused(folder.file("none.motion") + out).find("none.motion") != std::string::npos);
  CHECK(refused(a + " --out " + folder.file("x.pdf")).find("does not end in .html") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.file("x.html")));
}

}  // namespace
}  // namespace weft::tools
