/// Values of all kinds that an input stands for. An input that has ended stands for zeros.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace weft::fuzz {

class Drawing {
 public:
  Drawing(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}

  bool is_done() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }
  /// The bound is at most 256.
  std::uint32_t below(std::uint32_t bound) { return byte() % bound; }
  bool flag() { return byte() % 2 != 0; }
  /// Once in so many bytes.
  bool rarely(std::uint32_t times = 32) { return byte() % times == times - 1; }

  std::uint64_t word() {
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
    return bits;
  }

  /// Mostly from -2 to 2, else anything that a double may be.
  double number() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kSpecial[] = {
        0.,    -0.,    kInfinity, -kInfinity,  std::numeric_limits<double>::quiet_NaN(),
        1e-3,  1e3,    1e-9,      1e9,         1e-18,
        1e18,  1e-150, 1e150,     1e-308,      5e-324,
        1e308, -1e308, -1e9,      2147483648., 4294967296.};
    const std::uint8_t tag = byte();
    if (tag <= 200) return (static_cast<int>(tag) - 100) / 50.;
    if (tag - 201u < std::size(kSpecial)) return kSpecial[tag - 201u];
    return std::bit_cast<double>(word());
  }
  /// Mostly the usual one.
  double near(double usual) { return rarely(8) ? number() : usual; }
  /// Mostly from 0 to 10, else anything that an int may be.
  int integer() {
    const std::uint8_t tag = byte();
    if (tag < 240) return tag % 11;
    return static_cast<int>(static_cast<std::uint32_t>(word() >> (tag % 32)));
  }
  /// Mostly a number of `count` things, else any.
  std::uint32_t index(std::size_t count) {
    const std::uint8_t tag = byte();
    if (tag == 255) return static_cast<std::uint32_t>(word());
    return count == 0 ? tag : static_cast<std::uint32_t>(tag % count);
  }

  /// `usual` all over, or drawn one by one.
  std::vector<double> numbers(std::size_t count, double usual) {
    std::vector<double> values(count, usual);
    if (flag()) {
      for (double& value : values) value = near(usual);
    }
    return values;
  }
  /// In order, or drawn one by one.
  std::vector<std::uint32_t> indices(std::size_t count, std::size_t things) {
    const bool in_order = !flag();
    std::vector<std::uint32_t> values;
    for (std::size_t i = 0; i < count; ++i) {
      const auto next = static_cast<std::uint32_t>(things == 0 ? i : i % things);
      values.push_back(in_order ? next : index(things));
    }
    return values;
  }
  std::vector<std::uint8_t> bytes(std::size_t count) {
    std::vector<std::uint8_t> values(count);
    for (std::uint8_t& value : values) value = byte();
    return values;
  }
  std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace weft::fuzz
