#include "tools/program/formats/pc2_writer.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "tests/tools/temporary_folder.h"

namespace weft::tools {
namespace {

template <class Number>
Number number_at(const std::string& bytes, std::size_t offset) {
  Number number;
  REQUIRE(offset + sizeof number <= bytes.size());
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

TEST_CASE("the layout is that of Point Cache 2") {
  const TemporaryFolder folder;
  auto writer = Pc2Writer::open(folder.file("a.pc2"));
  REQUIRE(writer);
  writer.value().add_sample(std::array{Vec3{1, 2, 3}, Vec3{4, 5, 6}});
  writer.value().add_sample(std::array{Vec3{7, 8, 9}, Vec3{10, 11, 12}});
  writer.value().add_sample(std::array{Vec3{}, Vec3{0, 0, -0.5}});
  REQUIRE(writer.value().finish());

  const std::string bytes = folder.read("a.pc2");
  CHECK(bytes.size() == 32 + 3 * 2 * 12);
  CHECK(bytes.substr(0, 12) == std::string("POINTCACHE2\0", 12));
  CHECK(number_at<std::int32_t>(bytes, 12) == 1);
  CHECK(number_at<std::int32_t>(bytes, 16) == 2);
  CHECK(number_at<float>(bytes, 20) == 0);
  CHECK(number_at<float>(bytes, 24) == 1);
  CHECK(number_at<std::int32_t>(bytes, 28) == 3);
  for (std::size_t i = 0; i < 12; ++i) {
    CHECK(number_at<float>(bytes, 32 + 4 * i) == static_cast<float>(i + 1));
  }
  CHECK(number_at<float>(bytes, bytes.size() - 4) == -0.5f);
}

TEST_CASE("a pipe, which cannot be rewound, is refused") {
  const TemporaryFolder folder;
  const std::string path = folder.file("pipe.pc2");
  REQUIRE(mkfifo(path.c_str(), 0600) == 0);
  const int both_ends = open(path.c_str(), O_RDWR);  // nobody waits for the other one
  REQUIRE(both_ends >= 0);
  const auto writer = Pc2Writer::open(path);
  close(both_ends);
  REQUIRE_FALSE(writer);
  CHECK(writer.error().starts_with("cannot write '" + path + "': "));
}

TEST_CASE("a motion that is not finished leaves nothing") {
  const TemporaryFolder folder;
  {
    auto writer = Pc2Writer::open(folder.file("a.pc2"));
    REQUIRE(writer);
    writer.value().add_sample(std::array{Vec3{1, 2, 3}});
  }
  CHECK(folder.is_empty());
}

}  // namespace
}  // namespace weft::tools
