#include "tools/program/formats/pc2_writer.h"

#include <fmt/format.h>

#include <bit>
#include <cstdio>
#include <cstring>
#include <vector>

namespace weft::tools {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

Result<Pc2Writer> Pc2Writer::open(const std::string& path) {
  auto file = PendingFile::open(path);
  if (!file) return Error{file.error()};
  if (std::ftell(file.value().stream()) < 0) {
    return Error{
        fmt::format("cannot write '{}': a .pc2 file must be one that can be rewound", path)};
  }
  Pc2Writer writer(std::move(file.value()));
  writer.write_header();
  return writer;
}

void Pc2Writer::write_header() const {
  struct Header {
    char signature[12] = "POINTCACHE2";
    std::int32_t version = 1;
    std::int32_t points;
    float first_frame = 0;
    float frames_per_sample = 1;
    std::int32_t samples;
  };
  static_assert(sizeof(Header) == 32);
  const Header header{.points = points_, .samples = samples_};
  file_.write({reinterpret_cast<const char*>(&header), sizeof header});
}

void Pc2Writer::add_sample(std::span<const Vec3> points) {
  std::vector<float> packed;
  packed.reserve(3 * points.size());
  for (const Vec3& point : points) {
    for (const double coordinate : {point.x, point.y, point.z}) {
      packed.push_back(static_cast<float>(coordinate));
    }
  }
  file_.write({reinterpret_cast<const char*>(packed.data()), packed.size() * sizeof(float)});
  points_ = static_cast<std::int32_t>(points.size());
  ++samples_;
}

Result<void> Pc2Writer::finish() {
  std::rewind(file_.stream());
  write_header();
  return file_.commit();
}

}  // namespace weft::tools
