#include "tools/program/viewer/sections.h"

#include <bit>
#include <nlohmann/json.hpp>

#include "tools/program/viewer/integers.h"

namespace weft::tools {

static_assert(std::endian::native == std::endian::little, "floats are little-endian");

void Sections::begin(const std::string& name, std::size_t count) {
  entries_.push_back({name, bytes_.size(), count});
}

void Sections::add(const std::string& name, std::string_view bytes) {
  begin(name, bytes.size());
  bytes_ += bytes;
}

void Sections::add_numbers(const std::string& name, std::span<const std::int32_t> numbers) {
  begin(name, numbers.size());
  append_differences(bytes_, numbers);
}

void Sections::add_triangles(const std::string& name,
                             std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<std::int32_t> corners;
  corners.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle)
      corners.push_back(static_cast<std::int32_t>(corner));
  }
  add_numbers(name, corners);
}

void Sections::add_floats(const std::string& name, std::span<const float> numbers) {
  begin(name, numbers.size());
  bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
}

Json Sections::table() const {
  Json table = Json::object();
  for (const auto& [name, at, count] : entries_) table[name] = {{"at", at}, {"count", count}};
  return table;
}

}  // namespace weft::tools
