#include "tests/fuzz/checks.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace weft::fuzz {
namespace {

std::size_t accepted = 0;

}  // namespace

void check(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

void check_message(std::string_view message) {
  constexpr std::size_t kLongest = 1000;
  const auto breaks = [](char c) { return c == '\n' || c == '\r' || c == '\0'; };
  const bool is_line = !message.empty() && std::ranges::none_of(message, breaks);
  if (is_line && message.size() <= kLongest) return;
  std::fprintf(stderr, "fuzz: the message: '%.*s'\n", static_cast<int>(message.size()),
               message.data());
  check(is_line, "a message is one line");
  check(false, "a message is short");
}

void note_accepted() { ++accepted; }
std::size_t accepted_inputs() { return accepted; }

}  // namespace weft::fuzz
