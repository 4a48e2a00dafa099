#include "tools/parse.h"

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
