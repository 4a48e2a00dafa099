/// A rule of --pin, and the lists of --seam, for a small mesh: the first letter says which.
#include "tools/program/formats/pin_rule.h"

#include <algorithm>
#include <string>

#include <fmt/ranges.h>

#include "tests/fuzz/checks.h"
#include "tools/program/formats/obj_mesh.h"

namespace weft::fuzz {
namespace {

/// 3 x 3 vertices, of which the last is in no face.
constexpr const char* kMesh =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 1\n"
    "f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\n";
constexpr std::uint32_t kUsed = 8;

std::string list_of(const std::vector<std::uint32_t>& numbers) {
  return fmt::format("{}", fmt::join(numbers, ","));
}

void try_pins(std::string_view rule) {
  const auto pins = tools::parse_obj(kMesh, {.pin = std::string(rule)});
  if (!pins) return check_message(pins.error());
  const std::vector<std::uint32_t>& fixed = pins.value().description.fixed;
  check(fixed.empty() == (rule == "none"), "a rule that matches nothing is refused");
  check(std::ranges::all_of(fixed, [](std::uint32_t i) { return i < kUsed; }),
        "what is pinned is in a face");
  check(std::ranges::is_sorted(fixed, std::less_equal()) || fixed.size() < 2 ||
            std::ranges::adjacent_find(fixed, std::greater_equal()) == fixed.end(),
        "pins ascend");
  if (fixed.empty()) return;
  const auto again = tools::parse_obj(kMesh, {.pin = list_of(fixed)});
  check(again && again.value().description.fixed == fixed, "a list of the pins is the same rule");
  note_accepted();
}

void try_seams(std::string_view seam) {
  const auto sewn = tools::parse_obj(kMesh, {.seams = {std::string(seam)}});
  if (!sewn) return check_message(sewn.error());
  check(sewn.value().description.positions.size() <= kUsed, "a seam adds no particle");
  note_accepted();
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(pin_rule)(const std::uint8_t* data, std::size_t size) {
  using namespace weft::fuzz;
  if (size == 0) return 0;
  const std::string_view text = argument_of(data + 1, size - 1);
  if (data[0] == 's') {
    try_seams(text);
  } else {
    try_pins(text);
  }
  return 0;
}
