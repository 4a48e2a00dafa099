/// The parts of a motion that are bytes, one after the other, and the table of where each is.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/program/files/json_output.h"

namespace weft::tools {

class Sections {
 public:
  /// Each of these appends a part. Names are unique.
  void add(const std::string& name, std::string_view bytes);
  /// By append_differences.
  void add_numbers(const std::string& name, std::span<const std::int32_t> numbers);
  void add_triangles(const std::string& name,
                     std::span<const std::array<std::uint32_t, 3>> triangles);
  /// Little-endian, x y z of each point.
  void add_floats(const std::string& name, std::span<const float> numbers);

  /// {"name": {"at": byte, "count": numbers}}; of a part that is only bytes, their number.
  Json table() const;
  const std::string& bytes() const { return bytes_; }

 private:
  struct Entry {
    std::string name;
    std::size_t at, count;
  };
  void begin(const std::string& name, std::size_t count);
  std::vector<Entry> entries_;
  std::string bytes_;
};

}  // namespace weft::tools
