/// What the targets hold the product against. Whatever does not hold ends the process, as what a
/// sanitizer finds does.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// Each target is one function of data and a size. libFuzzer calls it by a name of its own, of one
/// target in a program; replay.cpp, which has all of them, by the target's.
#ifdef WEFT_FUZZ_REPLAY
#define WEFT_FUZZ_TARGET(name) fuzz_##name
#else
#define WEFT_FUZZ_TARGET(name) LLVMFuzzerTestOneInput
#endif

namespace weft::fuzz {

void check(bool holds, std::string_view what);
/// What a refusal says is one line, and not a whole file.
void check_message(std::string_view message);

/// An input that went all the way: of a corpus there must be some.
void note_accepted();
std::size_t accepted_inputs();

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// An argument of the program: up to where its line ends, which messages repeat as it is.
inline std::string_view argument_of(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLongest = 400;
  const std::string_view text = text_of(data, size);
  using namespace std::string_view_literals;
  return text.substr(0, std::min(kLongest, text.find_first_of("\n\r\0"sv)));
}

}  // namespace weft::fuzz
