#include <doctest/doctest.h>
#include <weft/mesh.h>

#include <limits>

#include "tests/support/sheets.h"

namespace weft::test::engine_mesh_materials {
namespace {

TEST_CASE("every named material is sound, has a source and is found") {
  CHECK(materials().size() >= 5);
  for (const NamedMaterial& named : materials()) {
    CAPTURE(named.name);
    CHECK(check_material(named.material));
    CHECK_FALSE(named.source.empty());
    const auto found = find_material(named.name);
    REQUIRE(found);
    CHECK(found.value().warp == named.material.warp);
    CHECK(found.value().density == named.material.density);
  }
}

TEST_CASE("named materials are within what was measured of fabrics") {
  for (const NamedMaterial& named : materials()) {
    CAPTURE(named.name);
    const Material& m = named.material;
    CHECK((m.density >= 0.05 && m.density <= 0.5));
    CHECK((m.thickness >= 1e-4 && m.thickness <= 2e-3));
    CHECK((m.warp >= 1000 && m.warp <= 10000));
    CHECK((m.weft >= 1000 && m.weft <= m.warp));
    CHECK((m.shear >= m.weft / 300 && m.shear <= m.weft / 10));
    CHECK((m.bending >= 1e-6 && m.bending <= 1e-4));
  }
}

TEST_CASE("of a name that there is not the error lists those that there are") {
  const auto found = find_material("tweed");
  REQUIRE_FALSE(found);
  CHECK(found.error() ==
        "material: there is no 'tweed', there are cotton, denim, linen, polyester, silk, wool");
  CHECK(find_material("a\n\x1b[31m").error().starts_with("material: there is no 'a??[31m', "));
}

TEST_CASE("a material's errors name the field and the value") {
  const auto error_with = [](double Material::*field, double value) {
    Material material = plain_material();
    material.*field = value;
    const auto checked = check_material(material);
    REQUIRE_FALSE(checked);
    MeshDescription mesh = quads(2);
    mesh.material = material;
    CHECK(refusal(mesh) == checked.error());
    return checked.error();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(error_with(&Material::density, 0) ==
        "material.density: must be finite and greater than 0 (0)");
  CHECK(error_with(&Material::warp, nan) ==
        "material.warp: must be finite and greater than 0 (nan)");
  CHECK(error_with(&Material::weft, -1) == "material.weft: must be finite and greater than 0 (-1)");
  CHECK(error_with(&Material::thickness, -1) ==
        "material.thickness: must be finite and at least 0 (-1)");
  CHECK(error_with(&Material::friction, nan) ==
        "material.friction: must be finite and at least 0 (nan)");
  CHECK(error_with(&Material::shear, -1) == "material.shear: must be finite and at least 0 (-1)");
  CHECK(error_with(&Material::bending, nan) ==
        "material.bending: must be finite and at least 0 (nan)");
  CHECK(error_with(&Material::damping_stretch, -1).starts_with("material.damping_stretch: "));
  CHECK(error_with(&Material::damping_bending, -1).starts_with("material.damping_bending: "));
  CHECK(error_with(&Material::damping_motion, -1).starts_with("material.damping_motion: "));
  CHECK(error_with(&Material::drag, -1).starts_with("material.drag: "));
  CHECK(error_with(&Material::lift, -1).starts_with("material.lift: "));
  CHECK(error_with(&Material::ram, -1).starts_with("material.ram: "));
  CHECK(error_with(&Material::bending_yield, 0) ==
        "material.bending_yield: must be greater than 0, or infinite (0)");
  CHECK(error_with(&Material::bending_hardening, -1).starts_with("material.bending_hardening: "));
  CHECK(error_with(&Material::bending_friction, nan).starts_with("material.bending_friction: "));
  CHECK(error_with(&Material::bending_slip, 0).starts_with("material.bending_slip: "));
}

TEST_CASE("thickness and friction of layers are the material's") {
  MeshDescription mesh = quads(3);
  mesh.material = plain_material();
  const SelfContact plain;
  CHECK(Material{}.friction == plain.friction);
  mesh.material->thickness = 0;
  CHECK(made(mesh).scene.self_contact == plain);
  mesh.material->thickness = 0.7e-3;
  mesh.material->friction = 0.45;
  const SelfContact of_material{.thickness = 0.7e-3, .friction = 0.45};
  CHECK(made(mesh).scene.self_contact == of_material);
}

TEST_CASE("damping and air are the material's") {
  MeshDescription mesh = quads(3);
  mesh.material = plain_material();
  CHECK(made(mesh).scene.air.triangles.empty());
  mesh.material->damping_stretch = 1;
  mesh.material->damping_bending = 2;
  mesh.material->damping_motion = 3;
  mesh.material->lift = 4;
  mesh.material->ram = 5;
  const SceneDescription scene = made(mesh).scene;
  CHECK(scene.damping.stretch == 1);
  CHECK(scene.damping.bending == 2);
  CHECK(scene.damping.motion == 3);
  CHECK(scene.air.lift == 4);
  CHECK(scene.air.ram == 5);
  CHECK(scene.air.drag == 0);
  CHECK(scene.air.triangles.size() == 8);
  CHECK(build_model(scene));
}

TEST_CASE("without a material there is neither bending nor damping nor air") {
  const SceneDescription scene = made(quads(3)).scene;
  CHECK(scene.bending.empty());
  CHECK(scene.air.triangles.empty());
  CHECK(scene.damping.stretch == 0);
}

}  // namespace
}  // namespace weft::test::engine_mesh_materials
