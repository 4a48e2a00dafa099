#include "tools/program/text/numbered_name.h"

#include <doctest/doctest.h>

namespace weft::tools {
namespace {

TEST_CASE("a name of a series has a number in it, as wide as it says") {
  CHECK(NumberedName::of("frame_%04d.obj")->with(7) == "frame_0007.obj");
  CHECK(NumberedName::of("frame_%04d.obj")->with(12345) == "frame_12345.obj");
  CHECK(NumberedName::of("%d.json")->with(0) == "0.json");
  CHECK(NumberedName::of("f%3d.obj")->with(7) == "f  7.obj");
  CHECK(NumberedName::of("100%/f%02d.obj")->with(7) == "100%/f07.obj");
}

TEST_CASE("other names are names") {
  for (const char* text : {"frame.obj", "100%.obj", "f%s.obj", "f%-3d.obj", "f%99d.obj", "%"}) {
    CAPTURE(text);
    CHECK_FALSE(NumberedName::of(text));
  }
}

}  // namespace
}  // namespace weft::tools
