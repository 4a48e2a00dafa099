/// glTF and VTK files of a run, read again by their formats and held against the point cache.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/tools/run_program.h"
#include "tools/program/formats/vtu.h"

namespace weft::tools {
namespace {

template <class Number>
std::vector<Number> numbers_at(const std::string& bytes, std::size_t at, std::size_t count) {
  std::vector<Number> numbers(count);
  REQUIRE(at + count * sizeof(Number) <= bytes.size());
  std::memcpy(numbers.data(), bytes.data() + at, count * sizeof(Number));
  return numbers;
}

/// All samples of a .pc2 file.
std::vector<float> samples_of(const std::string& cache) {
  return numbers_at<float>(cache, 32, (cache.size() - 32) / sizeof(float));
}

struct Glb {
  nlohmann::json json;
  std::string binary;

  explicit Glb(const std::string& file) {
    const auto head = numbers_at<std::uint32_t>(file, 0, 5);
    CHECK(head[0] == 0x46546c67);
    CHECK(head[1] == 2);
    CHECK(head[2] == file.size());
    CHECK(head[4] == 0x4e4f534a);
    json = nlohmann::json::parse(file.substr(20, head[3]));
    const auto chunk = numbers_at<std::uint32_t>(file, 20 + head[3], 2);
    CHECK(chunk[1] == 0x004e4942);
    CHECK(28 + head[3] + chunk[0] == file.size());
    binary = file.substr(28 + head[3]);
  }
  template <class Number>
  std::vector<Number> accessor(std::size_t number) const {
    const auto& accessor = json["accessors"][number];
    const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t count = view["byteLength"].get<std::size_t>() / sizeof(Number);
    const std::size_t components = accessor["type"] == "VEC3" ? 3 : 1;
    CHECK(accessor["count"].get<std::size_t>() * components == count);
    return numbers_at<Number>(binary, view["byteOffset"], count);
  }
};

TEST_CASE("a .glb has each frame of the point cache as a morph target") {
  const TemporaryFolder folder;
  report_of(folder, "drape --size 9 --steps 12 --out " + folder.file("a.glb") + " --out " +
                        folder.file("a.pc2"));
  const std::vector<float> samples = samples_of(folder.read("a.pc2"));
  const Glb glb(folder.read("a.glb"));
  const auto& primitive = glb.json["meshes"][0]["primitives"][0];
  const auto start = glb.accessor<float>(primitive["attributes"]["POSITION"]);
  REQUIRE(start.size() * 13 == samples.size());
  REQUIRE(primitive["targets"].size() == 12);
  double most = 0;
  for (std::size_t t = 0; t <= 12; ++t) {
    std::vector<float> target(start.size());
    if (t > 0) target = glb.accessor<float>(primitive["targets"][t - 1]["POSITION"]);
    for (std::size_t i = 0; i < start.size(); ++i)
      most = std::max(most, std::abs(double{start[i]} + target[i] - samples[t * start.size() + i]));
  }
  CHECK(most < 2e-7);  // a rounding of floats near 1
  CHECK(glb.accessor<std::uint32_t>(primitive["indices"]).size() == 3 * 2 * 64);
  const auto& sampler = glb.json["animations"][0]["samplers"][0];
  const auto times = glb.accessor<float>(sampler["input"]);
  const auto weights = glb.accessor<float>(sampler["output"]);
  REQUIRE(times.size() == 13);
  REQUIRE(weights.size() == 13 * 12);
  for (std::size_t t = 0; t < 13; ++t) {
    CHECK(times[t] == doctest::Approx(0.01 * static_cast<double>(t)));
    for (std::size_t k = 0; k < 12; ++k) CHECK(weights[12 * t + k] == (k + 1 == t ? 1 : 0));
  }
}

TEST_CASE("a .glb turns z up, and has lines") {
  const TemporaryFolder folder;
  const std::string mesh =
      folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 2\nf 1 2 3\nl 3 4\n");
  report_of(folder, mesh + " --up z --pin 0 --steps 2 --out " + folder.file("a.glb"));
  const Glb glb(folder.read("a.glb"));
  const auto turn = glb.json["nodes"][0]["rotation"].get<std::vector<double>>();
  const double x = turn[0], w = turn[3];  // (0, 0, 1) goes to (0, 2 (y z - x w), 1 - 2 x x)
  CHECK(-2 * x * w == doctest::Approx(1));
  CHECK(1 - 2 * x * x == doctest::Approx(0));
  const auto& primitives = glb.json["meshes"][0]["primitives"];
  REQUIRE(primitives.size() == 2);
  CHECK(primitives[1]["mode"] == 1);
  CHECK(glb.accessor<std::uint32_t>(primitives[1]["indices"]) == std::vector<std::uint32_t>{2, 3});
}

/// The numbers of an array of a .vtu file.
template <class Number>
std::vector<Number> vtu_array(const std::string& file, const std::string& name) {
  const std::size_t at = file.find("Name=\"" + name + "\"");
  REQUIRE(at != file.npos);
  const std::size_t offset = std::stoul(file.substr(file.find("offset=\"", at) + 8));
  const std::size_t data = file.find("\n_", file.find("<AppendedData")) + 2 + offset;
  const std::size_t size = numbers_at<std::uint64_t>(file, data, 1).front();
  return numbers_at<Number>(file, data + 8, size / sizeof(Number));
}

TEST_CASE("a .pvd lists a .vtu for each frame, with places, strains and tensions") {
  const TemporaryFolder folder;
  report_of(folder, "hang --size 7 --material cotton --steps 8 --out " + folder.file("a.pvd") +
                        " --out " + folder.file("a.pc2"));
  const std::string list = folder.read("a.pvd");
  CHECK(list.find("timestep=\"0.08\" part=\"0\" file=\"a_0008.vtu\"") != list.npos);
  CHECK_FALSE(std::filesystem::exists(folder.file("a_0009.vtu")));
  const std::vector<float> samples = samples_of(folder.read("a.pc2"));
  const std::string last = folder.read("a_0008.vtu");
  const auto points = vtu_array<double>(last, "Points");
  REQUIRE(points.size() * 9 == samples.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    CHECK(static_cast<float>(points[i]) == samples[8 * points.size() + i]);
  const auto corners = vtu_array<std::int64_t>(last, "connectivity");
  const auto ends = vtu_array<std::int64_t>(last, "offsets");
  const auto kinds = vtu_array<std::uint8_t>(last, "types");
  const auto strain = vtu_array<double>(last, "strain"),
             tension = vtu_array<double>(last, "tension");
  REQUIRE(kinds.size() == ends.size());
  REQUIRE(strain.size() == ends.size());
  CHECK(static_cast<std::size_t>(ends.back()) == corners.size());
  std::size_t lines = 0;
  double most = 0;
  for (std::size_t cell = 0; cell < kinds.size(); ++cell) {
    if (kinds[cell] != 3) continue;
    const auto a = static_cast<std::size_t>(corners[static_cast<std::size_t>(ends[cell]) - 2]);
    const auto b = static_cast<std::size_t>(corners[static_cast<std::size_t>(ends[cell]) - 1]);
    const auto along = [&](std::size_t axis) {
      return points[3 * a + axis] - points[3 * b + axis];
    };
    const double length = std::hypot(along(0), along(1), along(2));
    const bool is_side = std::abs(length - 1.0 / 6) < 0.03;
    if (is_side) CHECK(length / (1 + strain[cell]) == doctest::Approx(1.0 / 6));
    CHECK((tension[cell] > 0) == (strain[cell] > 0));
    most = std::max(most, tension[cell]);
    ++lines;
  }
  CHECK(lines == 2 * 42 + 2 * 36);
  CHECK(most > 0.01);
}

TEST_CASE("triangles of fabric have tensions of warp and weft") {
  const TemporaryFolder folder;
  report_of(folder, "tunic --size 25 --steps 5 --out " + folder.file("a.pvd"));
  const std::string last = folder.read("a_0005.vtu");
  const auto strain = vtu_array<double>(last, "warp_strain");
  const auto tension = vtu_array<double>(last, "warp_tension");
  std::size_t found = 0;
  for (std::size_t i = 0; i < strain.size(); ++i) {
    if (std::isnan(strain[i]) || strain[i] <= 0) continue;
    CHECK(tension[i] / strain[i] > 100);  // N/m
    ++found;
  }
  CHECK(found > 20);
}

TEST_CASE("names in a list are those of XML") {
  CHECK(pvd_text({{0.5, "a&\"<.vtu"}}).find("file=\"a&amp;&quot;&lt;.vtu\"") != std::string::npos);
}

}  // namespace
}  // namespace weft::tools
