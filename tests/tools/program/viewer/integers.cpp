/// Numbers in few bytes, and bytes as text.
#include "tools/program/viewer/integers.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/tools/program/viewer/reading.h"
#include "tools/program/viewer/base64.h"
#include "tools/program/viewer/moving_points.h"

namespace weft::tools {
namespace {

using List = std::vector<std::int32_t>;

TEST_CASE("integers of every size survive, and small ones take few bits") {
  std::mt19937 random(1);
  for (const std::size_t count : {0, 1, 7, 255, 256, 257, 1000}) {
    for (std::uint32_t bits = 1; bits <= 32; ++bits) {
      List list;
      for (std::size_t i = 0; i < count; ++i)
        list.push_back(static_cast<std::int32_t>(random() << (32 - bits)) >> (32 - bits));
      std::string bytes;
      append_integers(bytes, list);
      reading::Integers reader(bytes);
      CAPTURE(count);
      CAPTURE(bits);
      CHECK(reader.read(count) == list);
      CHECK(reader.bytes_read() == bytes.size());
      const double most = bits <= 24 ? bits + 2.5 : 24 + 32;  // a bit for the sign, one or two ones
      CHECK(8.0 * static_cast<double>(bytes.size()) <=
            most * static_cast<double>(count) + 16.0 * 5);
    }
  }
}

TEST_CASE("the ends of the range, and calm beside wild, survive") {
  const auto least = std::numeric_limits<std::int32_t>::min();
  const auto most = std::numeric_limits<std::int32_t>::max();
  List list{least, most, 0, -1, 1, least, most};
  list.resize(600);
  list[599] = most;
  std::string bytes = "before";
  append_integers(bytes, list);
  CHECK(bytes.starts_with("before"));
  CHECK(reading::Integers(std::string_view(bytes).substr(6)).read(list.size()) == list);
  std::string calm;
  append_integers(calm, List(2560, 0));
  CHECK(calm.size() == 10 * (1 + 256 / 8));
}

TEST_CASE("differences are small where neighbours are alike") {
  List list;
  for (std::int32_t i = 0; i < 1000; ++i) list.push_back(1000000 + 3 * i);
  std::string bytes, plain;
  append_differences(bytes, list);
  append_integers(plain, list);
  CHECK(reading::Integers(bytes).read_differences(list.size()) == list);
  CHECK(bytes.size() < plain.size() / 4);
}

/// On parabolas, which cost least, then jumps.
TEST_CASE("points that move come back within half a quantum, wherever they go") {
  constexpr double kQuantum = 1e-5;
  const Vec3 origin{0.5, -2, 3};
  MovingPoints moving(origin, kQuantum);
  nlohmann::json header{{"particles", 3}, {"samples", 20}, {"quantum", kQuantum}};
  header["origin"] = {origin.x, origin.y, origin.z};
  std::vector<std::vector<Vec3>> samples;
  for (int t = 0; t < 20; ++t) {
    const double s = 0.01 * t;
    samples.push_back(
        {{s, -5 * s * s, 1}, {0.1, std::sin(90 * s), -s}, {t == 9 ? 2000.0 : 0, 0, 3}});
    moving.add_sample(samples.back());
  }
  reading::Motion motion(std::string(28, ' ') + std::string("\2\0\0\0{}", 6) + moving.bytes());
  header["sections"]["places"]["at"] = 0;
  motion.header = header;
  const auto places = motion.places();
  for (std::size_t t = 0; t < 20; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = samples[t][i];
      CHECK(std::abs(places[t][i] - p.x) <= 0.5001 * kQuantum);
      CHECK(std::abs(places[t][3 + i] - p.y) <= 0.5001 * kQuantum);
      CHECK(std::abs(places[t][6 + i] - p.z) <= 0.5001 * kQuantum);
    }
  }
}

TEST_CASE("places beyond the range are cut") {
  CHECK(quanta_of(1e30, 1e-5) == 1 << 28);
  CHECK(quanta_of(-1e30, 1e-5) == -(1 << 28));
  CHECK(quanta_of(-1.26e-5, 1e-5) == -1);
}

TEST_CASE("base64 is that of RFC 4648") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("\xff\xfe\xfd") == "//79");
  std::string bytes;
  for (int i = 0; i < 1000; ++i) {
    bytes.push_back(static_cast<char>(i * 7));
    CHECK(bytes_of_base64(base64(bytes)) == bytes);
  }
  for (const char* wrong : {"Zg=", "Z", "Zm9*", "Zg==Zg==", "Zm 9"})
    CHECK_FALSE(bytes_of_base64(wrong));
}

}  // namespace
}  // namespace weft::tools
