/// Reads what the viewer's sources write, by the formats that their headers describe and by nothing
/// of them.
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weft::tools::reading {

class Integers {
 public:
  explicit Integers(std::string_view bytes) : bytes_(bytes) {}
  std::vector<std::int32_t> read(std::size_t count) {
    std::vector<std::int32_t> list;
    while (list.size() < count) read_block(list, std::min<std::size_t>(256, count - list.size()));
    return list;
  }
  std::vector<std::int32_t> read_differences(std::size_t count) {
    std::vector<std::int32_t> list = read(count);
    for (std::size_t i = 1; i < count; ++i) list[i] += list[i - 1];
    return list;
  }
  std::size_t bytes_read() const { return bit_ / 8; }

 private:
  void read_block(std::vector<std::int32_t>& list, std::size_t count) {
    const std::uint32_t low_bits = take(8);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t ones = 0;
      while (ones < 24 && take(1) == 1) ++ones;
      const std::uint32_t z = ones == 24 ? take(32) : (ones << low_bits) + take(low_bits);
      const auto half = static_cast<std::int32_t>(z / 2);
      list.push_back(z % 2 == 0 ? half : -half - 1);
    }
    bit_ = (bit_ + 7) / 8 * 8;
  }
  std::uint32_t take(std::uint32_t count) {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < count; ++i, ++bit_) {
      REQUIRE(bit_ / 8 < bytes_.size());
      const auto byte = static_cast<unsigned char>(bytes_[bit_ / 8]);
      bits |= (byte >> (bit_ % 8) & 1u) << i;
    }
    return bits;
  }
  std::string_view bytes_;
  std::size_t bit_ = 0;
};

struct Motion {
  nlohmann::json header;
  std::string sections;

  explicit Motion(const std::string& file) {
    constexpr std::size_t kSeal = 28;
    REQUIRE(file.size() > kSeal + 4);
    std::uint32_t size = 0;
    std::memcpy(&size, file.data() + kSeal, sizeof size);
    header = nlohmann::json::parse(file.substr(kSeal + 4, size));
    sections = file.substr(kSeal + 4 + size);
  }
  std::string_view section(const std::string& name) const {
    return std::string_view(sections).substr(header["sections"][name]["at"]);
  }
  std::size_t count(const std::string& name) const { return header["sections"][name]["count"]; }
  std::vector<std::int32_t> numbers(const std::string& name) const {
    return Integers(section(name)).read_differences(count(name));
  }
  std::vector<float> floats(const std::string& name) const {
    std::vector<float> list(count(name));
    std::memcpy(list.data(), section(name).data(), list.size() * sizeof(float));
    return list;
  }
  /// x of all particles, then y, then z; sample by sample, in m.
  std::vector<std::vector<double>> places() const {
    const std::size_t particles = header["particles"], samples = header["samples"];
    const double quantum = header["quantum"];
    Integers reader(section("places"));
    std::vector<std::vector<std::int64_t>> quanta;
    std::vector<std::vector<double>> all;
    for (std::size_t t = 0; t < samples; ++t) {
      quanta.emplace_back();
      all.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto rest = t == 0 ? reader.read_differences(particles) : reader.read(particles);
        for (std::size_t i = 0; i < particles; ++i) {
          const std::size_t at = axis * particles + i;
          std::int64_t value = rest[i];
          if (t == 1) value += quanta[0][at];
          if (t > 1) value += 2 * quanta[t - 1][at] - quanta[t - 2][at];
          quanta[t].push_back(value);
          all[t].push_back(header["origin"][axis].get<double>() +
                           quantum * static_cast<double>(value));
        }
      }
    }
    return all;
  }
};

}  // namespace weft::tools::reading
