#include "tools/program/text/parse.h"

#include <doctest/doctest.h>

namespace weft::tools {
namespace {

TEST_CASE("a tolerance is a percentage or a fraction") {
  CHECK(parse_tolerance("--tolerance", "1%").value() == 0.01);
  CHECK(parse_tolerance("--tolerance", "0.01").value() == 0.01);
  CHECK(parse_tolerance("--tolerance", "0.001%").value() == doctest::Approx(1e-5).epsilon(1e-15));
  CHECK(parse_tolerance("--tolerance", "1e-5").value() == 1e-5);
}

TEST_CASE("a tolerance that is no strain above 0 is refused by name and value") {
  for (const std::string text :
       {"", "%", "0", "0%", "-1%", "nan", "inf", "1%%", "1 %", "1e999", "x"}) {
    CAPTURE(text);
    const auto tolerance = parse_tolerance("--tolerance", text);
    REQUIRE_FALSE(tolerance);
    CHECK(tolerance.error().starts_with("--tolerance: '" + text + "'"));
  }
}

TEST_CASE("a time is a number or a fraction above 0") {
  CHECK(parse_seconds("--dt", "0.25").value() == 0.25);
  CHECK(parse_seconds("--dt", "1/60").value() == 1.0 / 60);
  CHECK(parse_seconds("--dt", "0.5/4").value() == 0.125);
  for (const std::string text :
       {"", "0", "-1", "nan", "1/0", "1/", "/60", "1/2/3", "x", "-1/-60x"}) {
    CAPTURE(text);
    const auto seconds = parse_seconds("--dt", text);
    REQUIRE_FALSE(seconds);
    CHECK(seconds.error() == "--dt: '" + text + "' is not a time above 0, like 0.01 or 1/60");
  }
}

TEST_CASE("a vector is three numbers") {
  const Vec3 v = parse_vector("--wind", "1,-2.5,3e2").value();
  CHECK(v.x == 1);
  CHECK(v.y == -2.5);
  CHECK(v.z == 300);
  for (const std::string text : {"", "1", "1,2", "1,2,3,4", "1,2,", "1,2,x", "1 2 3"}) {
    CAPTURE(text);
    CHECK(parse_vector("--wind", text).error() == "--wind: '" + text + "' is not x,y,z");
  }
}

TEST_CASE("ranges of whole numbers go up or down") {
  const auto ranges = parse_ranges("5,7-9,3-2");
  REQUIRE(ranges);
  REQUIRE(ranges->size() == 3);
  CHECK((*ranges)[0].count() == 1);
  CHECK((*ranges)[1].count() == 3);
  CHECK((*ranges)[1].at(2) == 9);
  CHECK((*ranges)[2].count() == 2);
  CHECK((*ranges)[2].at(1) == 2);
  for (const char* text : {"", ",", "1-", "-1", "1.5", "x", "1,"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_ranges(text));
  }
}

TEST_CASE("a switch is on or off") {
  CHECK(parse_switch("--skip", "on").value());
  CHECK_FALSE(parse_switch("--skip", "off").value());
  CHECK(parse_switch("--skip", "yes").error() == "--skip: 'yes' is not one of on, off");
}

TEST_CASE("a number may have a sign, but one only") {
  CHECK(parse_number("+1.5") == 1.5);
  CHECK(parse_number("-1.5") == -1.5);
  for (const char* text : {"+-1", "++1", "-+1", "+", "", "+ 1"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_number(text));
  }
}

TEST_CASE("counts are whole numbers from 0 up") {
  CHECK(parse_count("12") == 12);
  CHECK(parse_count("0") == 0);
  for (const std::string text : {"", "-1", "1.5", "12x", " 1", "99999999999999999999"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_count(text));
  }
}

TEST_CASE("a choice is one of the names of an enum") {
  CHECK(parse_choice<Scheme>("--scheme", "rattle").value() == Scheme::rattle);
  CHECK(parse_choice<Solver>("--solver", "auto").value() == Solver::automatic);
  CHECK(parse_choice<Isa>("--isa", "auto").value() == Isa::automatic);
  for (const std::string text : {"", "ten", "unknown", "automatic", "Paper"}) {
    CAPTURE(text);
    CHECK(parse_choice<Scheme>("--scheme", text).error() ==
          "--scheme: '" + text + "' is not one of paper, rattle, implicit, bdf2, auto");
    CHECK_FALSE(parse_choice<Solver>("--solver", text));
  }
}

}  // namespace
}  // namespace weft::tools
