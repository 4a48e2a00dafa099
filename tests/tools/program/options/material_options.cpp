#include "tools/program/options/material_options.h"

#include <doctest/doctest.h>

namespace weft::tools {
namespace {

std::string material_error(const std::string& text) {
  const auto material = parse_material(text);
  REQUIRE_FALSE(material);
  return material.error();
}

TEST_CASE("a material file has the fields of a material by name") {
  const auto material = parse_material(
      R"({"density": 1, "thickness": 2, "warp": 3, "weft": 4, "shear": 5, "bending": 6,
          "damping_stretch": 7, "damping_bending": 8, "damping_motion": 9, "drag": 10, "lift": 11,
          "friction": 12, "ram": 13, "strength": 14, "bending_yield": 15, "bending_hardening": 16,
          "bending_friction": 17, "bending_slip": 18})");
  REQUIRE(material);
  const Material& m = material.value();
  CHECK(m.density == 1);
  CHECK(m.thickness == 2);
  CHECK(m.warp == 3);
  CHECK(m.weft == 4);
  CHECK(m.shear == 5);
  CHECK(m.bending == 6);
  CHECK(m.damping_stretch == 7);
  CHECK(m.damping_bending == 8);
  CHECK(m.damping_motion == 9);
  CHECK(m.drag == 10);
  CHECK(m.lift == 11);
  CHECK(m.friction == 12);
  CHECK(m.ram == 13);
  CHECK(m.strength == 14);
  CHECK(m.bending_yield == 15);
  CHECK(m.bending_hardening == 16);
  CHECK(m.bending_friction == 17);
  CHECK(m.bending_slip == 18);
  CHECK(parse_material("{}").value().friction == 0.3);
}

TEST_CASE("errors of a material file name the field") {
  CHECK(material_error("[]") == "expected an object with the fields of a material");
  CHECK(material_error(R"({"stretch": 1})") == "unknown key 'stretch'");
  CHECK(material_error(R"({"warp": "x"})") == R"(warp: expected a number, not "x")");
  CHECK(material_error(R"({"warp": 1, "warp": 2})") == "the key 'warp' is given twice");
  CHECK(material_error("{").find("parse error") != std::string::npos);
  CHECK(material_error("{\n\"warp\":\n1e999}") == "line 3: number overflow parsing '1e999'");
}

TEST_CASE("options change a named material, or are one by themselves") {
  MaterialOptions options;
  CHECK_FALSE(is_given(options));
  CHECK_FALSE(material_of(options).value().has_value());
  options.material = "denim";
  options.stretch = 5000;
  options.bend = 0;
  const Material denim = find_material("denim").value();
  const Material changed = *material_of(options).value();
  CHECK(changed.warp == 5000);
  CHECK(changed.weft == 5000);
  CHECK(changed.bending == 0);
  CHECK(changed.shear == denim.shear);
  CHECK(changed.damping_bending == denim.damping_bending);
  options.damping = 0.25;
  CHECK(material_of(options).value()->damping_stretch == 0.25);
  CHECK(material_of(options).value()->damping_bending == 0.25);
  options = {};
  options.stretch = 10;
  options.density = 2;
  options.shear = 4;
  options.drag = 5;
  options.lift = 6;
  options.bend_yield = 7;
  options.bend_friction = 8;
  const Material own = *material_of(options).value();
  CHECK(own.weft == 10);
  CHECK(own.density == 2);
  CHECK(own.shear == 4);
  CHECK(own.drag == 5);
  CHECK(own.lift == 6);
  CHECK(own.bending_yield == 7);
  CHECK(own.bending_friction == 8);
  CHECK(own.bending == 0);
}

}  // namespace
}  // namespace weft::tools
