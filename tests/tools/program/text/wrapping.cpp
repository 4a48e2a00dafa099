#include "tools/program/text/wrapping.h"

#include <doctest/doctest.h>

namespace weft::tools {
namespace {

const std::string ten = "123456789 ";  // with its space

TEST_CASE("lines end at the last space that fits, and go on in the column they began in") {
  CHECK(wrapped("short", 10) == "short");
  CHECK(wrapped("", 10).empty());
  const std::string fits = "1234567890" + std::string(60, 'x');
  CHECK(wrapped(fits, 10) == fits);
  CHECK(wrapped(fits + " y", 10) == fits + "\n          y");
  CHECK(wrapped(ten + ten + "end", 60) == "123456789 123456789\n" + std::string(60, ' ') + "end");
}

TEST_CASE("words that are longer than a line stay whole") {
  const std::string path(90, '/');
  CHECK(wrapped(path, 10) == path);
  CHECK(wrapped("in " + path + " it is", 10) == "in\n          " + path + "\n          it is");
}

TEST_CASE("a line counts characters, not bytes") {
  std::string accents;
  for (int i = 0; i < 70; ++i) accents += "é";
  CHECK(wrapped(accents, 10) == accents);
  CHECK(wrapped(accents + " x", 10) == accents + "\n          x");
}

TEST_CASE("figures stay with their units where a comma comes late enough") {
  const std::string text = "123 contacts, 0.75 m deepest, 0.0625 J by friction";
  CHECK(wrapped(text, 40, Break::at_commas) ==
        "123 contacts, 0.75 m deepest,\n" + std::string(40, ' ') + "0.0625 J by friction");
  CHECK(wrapped("a, no comma comes late enough in here", 60, Break::at_commas) ==
        "a, no comma comes\n" + std::string(60, ' ') + "late enough in here");
}

TEST_CASE("a name that reaches the second column has a line of its own") {
  CHECK(in_columns("  ab", "what it is", 8) == "  ab    what it is\n");
  CHECK(in_columns("  abcde", "what it is", 8) == "  abcde\n        what it is\n");
}

}  // namespace
}  // namespace weft::tools
