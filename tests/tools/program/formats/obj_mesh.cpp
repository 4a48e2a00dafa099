#include "tools/program/formats/obj_mesh.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/scenes/scenes.h"

namespace weft::tools {
namespace {

/// Two unit squares side by side in the x-y plane, as separate parts: vertices 5 and 8 (from 1: 6
/// and 9) repeat 1 and 2, vertex 4 is in no face.
constexpr auto kTwoSquares = R"(
mtllib missing.mtl
o left
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 9 9 9
vt 0 0
usemtl cotton
f 1/1 2/1 3/1 4/1
o right
v 1 0 0
v 2 0 0
v 2 1 0
v 1 1 0
f -4 -3 -2 -1
)";

ObjScene parse(const std::string& text, const ObjOptions& options = {}) {
  auto scene = parse_obj(text, options);
  REQUIRE_MESSAGE(scene, scene.error());
  return std::move(scene.value());
}

std::string obj_error(const std::string& text, const ObjOptions& options = {}) {
  const auto scene = parse_obj(text, options);
  REQUIRE_FALSE(scene);
  return scene.error();
}

std::size_t count(const SceneDescription& scene, ConstraintKind kind) {
  return static_cast<std::size_t>(std::ranges::count(scene.constraints, kind, &Constraint::kind));
}

std::vector<std::uint32_t> pinned(const std::string& rule) {
  return parse(kTwoSquares, {.pin = rule}).description.fixed;
}

TEST_CASE("parts are welded where they meet, and unused vertices are no particles") {
  const ObjScene scene = parse(kTwoSquares);
  CHECK(scene.description.positions.size() == 6);
  CHECK(scene.description.constraints.size() == 7);
  CHECK(scene.mesh.vertices.size() == 9);
  CHECK(scene.mesh.particle_of_vertex ==
        std::vector<std::uint32_t>{0, 1, 2, 3, kNoIndex, 1, 4, 5, 2});
  CHECK(build_model(scene.description));
}

TEST_CASE("coordinates are those of the file to the last bit") {
  const ObjScene scene =
      parse("v 0.3125 0.375 0.1\nv -1.7e-3 123456.789 1e22\nv .5 5. +2\nf 1 2 3");
  const Vec3 written[] = {{0.3125, 0.375, 0.1}, {-1.7e-3, 123456.789, 1e22}, {0.5, 5, 2}};
  REQUIRE(scene.mesh.vertices.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(scene.mesh.vertices[i].x == written[i].x);
    CHECK(scene.mesh.vertices[i].y == written[i].y);
    CHECK(scene.mesh.vertices[i].z == written[i].z);
  }
}

TEST_CASE("edges keep their length in the file, and the mass is shared") {
  const ObjScene scene = parse(kTwoSquares, {.mass = 3, .scale = 2});
  for (const Constraint& constraint : scene.description.constraints) {
    CHECK(constraint.rest_length == 2);
  }
  CHECK(scene.description.masses == std::vector<double>(6, 0.5));
  CHECK(scene.mesh.vertices[6].x == 4);
}

TEST_CASE("diagonals of four-sided faces become ropes when asked for") {
  const ObjScene plain = parse(kTwoSquares);
  CHECK(count(plain.description, ConstraintKind::rope) == 0);
  const ObjScene ropes = parse(kTwoSquares, {.ropes = Ropes::diagonals});
  CHECK(count(ropes.description, ConstraintKind::rope) == 4);
  CHECK(count(ropes.description, ConstraintKind::distance) == 7);
  CHECK(build_model(ropes.description));
}

TEST_CASE("a diagonal that is an edge of another face stays a distance") {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 2\nf 1 2 3 4\nf 1 3 5\n";
  const ObjScene scene = parse(text, {.ropes = Ropes::diagonals});
  CHECK(count(scene.description, ConstraintKind::rope) == 1);
  CHECK(build_model(scene.description));
}

TEST_CASE("all edges and lines become ropes when asked for") {
  const ObjScene ropes = parse(std::string(kTwoSquares) + "l 1 7\n", {.ropes = Ropes::all});
  CHECK(count(ropes.description, ConstraintKind::rope) == 8);
  CHECK(count(ropes.description, ConstraintKind::distance) == 0);
}

TEST_CASE("of a material edges are springs at the scale that is asked for") {
  const ObjScene scene =
      parse(kTwoSquares, {.pin = "y>0.9", .scale = 0.5, .material = find_material("wool").value()});
  CHECK(scene.description.constraints.size() == 7 + 4);
  for (const Constraint& constraint : scene.description.constraints) {
    CHECK(constraint.compliance > 0);
  }
  double mass = 0;
  for (const double m : scene.description.masses) mass += m;
  CHECK(mass == doctest::Approx(2 * 0.25 * find_material("wool").value().density));
  CHECK(scene.description.fixed.size() == 3);
  CHECK(scene.counts.quads == 2);
}

TEST_CASE("polygons are joined along their border only, lines along their segments") {
  const std::string pentagon = "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\n";
  CHECK(parse(pentagon + "f 1 2 3 4 5\n").description.constraints.size() == 5);
  CHECK(parse(pentagon + "l 1 2 3 4 5\n").description.constraints.size() == 4);
}

TEST_CASE("edges without a length are dropped") {
  const ObjScene scene = parse("v 0 0 0\nv 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\nf 1 1 2\n");
  CHECK(scene.description.positions.size() == 3);
  CHECK(scene.description.constraints.size() == 3);
  CHECK(obj_error("v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n") == "every edge of the mesh has length 0");
}

TEST_CASE("pin rules choose particles by their vertices") {
  CHECK(pinned("none").empty());
  CHECK(pinned("top") == std::vector<std::uint32_t>{2, 3, 5});
  CHECK(pinned("y>0.9") == std::vector<std::uint32_t>{2, 3, 5});
  CHECK(pinned("x>=2") == std::vector<std::uint32_t>{4, 5});
  CHECK(pinned("x<1") == std::vector<std::uint32_t>{0, 3});
  CHECK(pinned("x<=1") == std::vector<std::uint32_t>{0, 1, 2, 3});
  CHECK(pinned("3,6-8") == std::vector<std::uint32_t>{2, 3, 4, 5});
  CHECK(pinned("1,5") == std::vector<std::uint32_t>{1});
}

TEST_CASE("top is the highest thousandth") {
  const std::string uneven =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0.9995 0\nv 2 0.998 0\nf 1 2 3 4\nl 3 5\n";
  CHECK(parse(uneven, {.pin = "top"}).description.fixed == std::vector<std::uint32_t>{2, 3});
}

TEST_CASE("pin rules may be joined: or adds, and takes away, and binds more tightly") {
  CHECK(pinned("top and x<1") == std::vector<std::uint32_t>{3});
  CHECK(pinned("x>=2 or 0") == std::vector<std::uint32_t>{0, 4, 5});
  CHECK(pinned("x<1 and y<0.5 or top and x>1") == std::vector<std::uint32_t>{0, 5});
  CHECK(pinned("top and x<1 or  0,1 ") == std::vector<std::uint32_t>{0, 1, 3});
  CHECK(obj_error(kTwoSquares, {.pin = "top and x>5"}) == "--pin: 'top and x>5' matches no vertex");
  CHECK(obj_error(kTwoSquares, {.pin = "top or 99"}) == "--pin: '99': no face has a vertex 99");
  CHECK(
      obj_error(kTwoSquares, {.pin = "top and "}).starts_with("--pin: 'top and' is not none, top"));
  CHECK(obj_error(kTwoSquares, {.pin = "top or left"}).starts_with("--pin: 'left' is not none"));
}

TEST_CASE("what is up decides where the top is and where gravity comes from") {
  const std::string wall = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3 4\n";
  const SceneDescription scene = parse(wall, {.pin = "top", .up = &Vec3::z}).description;
  CHECK(scene.fixed == std::vector<std::uint32_t>{2, 3});
  CHECK(scene.gravity.y == 0);
  CHECK(scene.gravity.z == -10);
  CHECK(parse(wall).description.gravity.y == -10);
}

TEST_CASE("vertices are welded within a distance, after the scale") {
  const std::string noisy =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0.001 0\nv 1 1.001 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
  CHECK(parse(noisy).counts.pieces == 2);
  const ObjScene welded = parse(noisy, {.weld_distance = 0.002});
  CHECK(welded.counts.pieces == 1);
  CHECK(welded.description.positions.size() == 4);
  CHECK(parse(noisy, {.weld_distance = 0.002, .scale = 10}).counts.pieces == 2);
}

TEST_CASE("seams sew lists of vertices, one by one") {
  const std::string strips =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 -1 1\nv 0 -1 1\n"
      "f 1 2 3 4\nf 5 6 7 8\n";
  CHECK(parse(strips).counts.pieces == 2);
  const ObjScene sewn = parse(strips, {.seams = {"0-1:4,5"}});
  CHECK(sewn.counts.pieces == 1);
  CHECK(sewn.mesh.particle_of_vertex[0] == sewn.mesh.particle_of_vertex[4]);
  CHECK(sewn.mesh.particle_of_vertex[1] == sewn.mesh.particle_of_vertex[5]);
  const ObjScene crossed = parse(strips, {.seams = {"0-1:5-4", "3:7"}});
  CHECK(crossed.mesh.particle_of_vertex[0] == crossed.mesh.particle_of_vertex[5]);
  CHECK(crossed.mesh.particle_of_vertex[3] == crossed.mesh.particle_of_vertex[7]);
  CHECK(obj_error(strips, {.seams = {"0-1:4"}}) == "--seam: '0-1:4' sews 2 vertices to 1");
  CHECK(obj_error(strips, {.seams = {"0:8"}}) ==
        "--seam: '0:8': there is no vertex 8, the last one is 7");
  for (const std::string seam : {"", "0-1", ":", "0:", "0:x", "a:b"}) {
    CAPTURE(seam);
    CHECK(obj_error(strips, {.seams = {seam}})
              .starts_with("--seam: '" + seam + "' is not two lists"));
  }
}

TEST_CASE("pin rules are in the file's coordinates") {
  CHECK(parse(kTwoSquares, {.pin = "y>0.9", .scale = 0.1}).description.fixed.size() == 3);
}

TEST_CASE("a pin rule that means nothing is refused") {
  for (const std::string rule : {"", "y", "y>", "w>1", "y=1", "y>x", "1,", "3-1", "-1", "bottom"}) {
    CAPTURE(rule);
    CHECK(obj_error(kTwoSquares, {.pin = rule})
              .starts_with("--pin: '" + rule + "' is not none, top, a comparison"));
  }
  CHECK(obj_error(kTwoSquares, {.pin = "y>5"}) == "--pin: 'y>5' matches no vertex");
  CHECK(obj_error(kTwoSquares, {.pin = "0,4"}) == "--pin: '0,4': no face has a vertex 4");
  CHECK(obj_error(kTwoSquares, {.pin = "9"}) == "--pin: '9': no face has a vertex 9");
  CHECK(obj_error(kTwoSquares, {.pin = "0-99"}) == "--pin: '0-99': no face has a vertex 4");
}

TEST_CASE("broken files are refused in one line") {
  CHECK(obj_error("v 0 0 0\nv 1 x 0\nf 1 2 1\n") ==
        "line 2: 'v 1 x 0': a vertex needs three finite numbers");
  CHECK(obj_error("v 0 0 0\nv 1 0 0\nf 1 2\n") ==
        "line 3: 'f 1 2': a face has three corners at least");
  CHECK(obj_error("v 0 0 0\nf\n") == "line 2: 'f': a face has three corners at least");
  CHECK(obj_error("v 0 0 0\nl 1\n") == "line 2: 'l 1': a line has two ends at least");
  CHECK(obj_error("v 0 0\n") == "line 1: 'v 0 0': a vertex needs three finite numbers");
  CHECK(obj_error("v \x01 \x1b" + std::string(1000, '9') + "\n") ==
        "line 1: 'v ? ?" + std::string(35, '9') + "...': a vertex needs three finite numbers");
  CHECK(obj_error("v 0 0 0\nv 1 0 0\nf 1 2 3\n") ==
        "line 3: there is no vertex 3, the last one is 2");
  CHECK(obj_error("v 0 0 0\n") == "no face and no line in the file");
  CHECK(obj_error("") == "no face and no line in the file");
  const std::string zero = obj_error("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 0 1 2\n");
  CHECK(zero == "line 4: '0': not the number of a vertex");
  std::string many = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf";
  for (int i = 0; i < 256; ++i) many += " 1";
  CHECK(obj_error(many) == "line 4: a face of 256 vertices; at most 255 can be read");
}

TEST_CASE("what is not the number of a vertex is refused, with its line") {
  const std::string triangle = "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\n";
  for (const std::string word : {"0", "-0", "-4", "3.5", "3e0", "x", "", "0x3",
                                 "99999999999999999999", "-99999999999999999999"}) {
    CAPTURE(word);
    const std::string error = "line 4: '" + word + "/1': not the number of a vertex";
    CHECK(obj_error(triangle + "f 1 2 " + word + "/1\n") == error);
    CHECK(obj_error(triangle + "l 1 2 " + word + "/1\n") == error);
  }
  for (const std::string number : {"4", "4294967295", "4294967299", "9223372036854775807"}) {
    CAPTURE(number);
    CHECK(obj_error(triangle + "f 1 2 " + number + "\nf 1 2 3\n") ==
          "line 4: there is no vertex " + number + ", the last one is 3");
  }
  CHECK(parse("f 1 2 3\n" + triangle).description.positions.size() == 3);
  CHECK(parse(triangle + "f -1 -2 -3\n").description.positions.size() == 3);
  CHECK_FALSE(parse_obj(triangle + "f 1/x 2 3\n", {}));
}

TEST_CASE("lines end as they may, and comments may follow") {
  const std::string text =
      "# a sheet\nv 0 0 0#one\nv 1 0 0 # two\nv 1 1 0\no #1\nf 1 2 3 # c\nl 1 3#d\n";
  const ObjScene scene = parse(text);
  CHECK(scene.description.constraints.size() == 3);
  std::string old_mac = text;
  std::ranges::replace(old_mac, '\n', '\r');
  CHECK(parse(old_mac).description.constraints.size() == 3);
  CHECK(obj_error("v 0 0 0\rv 1 x 0\rf 1 2 1\r") ==
        "line 2: 'v 1 x 0': a vertex needs three finite numbers");
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";

TEST_CASE("lines are counted from 1, blank ones and comments too, however they end") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    CAPTURE(end);
    std::string text = "# one";
    for (const char* line : {"", "v 0 0 0", "  ", "v 1 0 0 # five", "vt 0 0", "f 1 x 2"}) {
      text += end + line;
    }
    CHECK(obj_error(text) == "line 7: 'x': not the number of a vertex");
    CHECK(obj_error(text + end + end) == "line 7: 'x': not the number of a vertex");
  }
}

TEST_CASE("the last line needs no end") {
  for (const std::string text : {"f 1 2 3", "f 1 2 3\nl 1 3", "f -3 -2 -1", "f 1 2 3#c"}) {
    CAPTURE(text);
    CHECK(parse(kTriangle + text).description.constraints.size() == 3);
  }
  CHECK(obj_error(kTriangle + "f 1 2 34") == "line 4: there is no vertex 34, the last one is 3");
}

TEST_CASE("a vertex that is missing is reported where it is used first") {
  CHECK(obj_error(kTriangle + "f 1 2 3\nf 1 2 5\nl 1 4\nf 1 5 2\n") ==
        "line 5: there is no vertex 5, the last one is 3");
  CHECK(obj_error(kTriangle + "l 1 4\n") == "line 4: there is no vertex 4, the last one is 3");
}

TEST_CASE("negative numbers count back from the vertices above them") {
  const ObjScene scene =
      parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -1 -4 -2\nl -1 2\n");
  CHECK(scene.mesh.faces == std::vector<std::vector<std::uint32_t>>{{0, 1, 2}, {3, 0, 2}});
  CHECK(scene.mesh.lines == std::vector<std::vector<std::uint32_t>>{{3, 1}});
  CHECK(obj_error("v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 1 1 0\n") ==
        "line 3: '-3': not the number of a vertex");
}

TEST_CASE("a byte order mark and a plus are read over") {
  const ObjScene scene = parse("\xef\xbb\xbfv +0 0 0\nv 1 +0.5 0\nv 0 1 0\nf 1 2 3\n");
  CHECK(scene.description.positions.size() == 3);
  CHECK(scene.description.positions[1].y == 0.5);
}

TEST_CASE("words are apart by blanks or tabs, and a vertex may carry a weight or a colour") {
  const ObjScene scene = parse("v 1 2 3 9\n\tv\t4 5\t6 0.1 0.2 0.3\nv 7 8 9\nf\t1 2\t3\n");
  const auto& positions = scene.description.positions;
  REQUIRE(positions.size() == 3);
  CHECK((positions[0].x == 1 && positions[0].y == 2 && positions[0].z == 3));
  CHECK((positions[1].x == 4 && positions[1].y == 5 && positions[1].z == 6));
  CHECK(obj_error(kTriangle + "\tf\t1\tx\t2\n") == "line 4: 'x': not the number of a vertex");
}

TEST_CASE("lines that a mesh does not need are not looked at") {
  const std::string huge(99, '8');  // beyond the range of the loader's numbers
  const ObjScene scene =
      parse(kTriangle + "vw 0 " + huge + "\nvw 0 -1\nt x 9/9/9\ncurv\nf 1 2 3\n");
  CHECK(scene.description.constraints.size() == 3);
}

TEST_CASE("each of the three coordinates is a finite number") {
  for (const std::string line : {"v x 0 0", "v 0 x 0", "v 0 0 x", "v 0 0 nan", "v inf 0 0",
                                 "v 0 1e999 0", "v 0 0 1,5", "v 0 0"}) {
    CAPTURE(line);
    CHECK(obj_error(kTriangle + line + " # c\n").starts_with("line 4: '" + line));
  }
}

TEST_CASE("faces of up to 255 corners are read, lines of any number") {
  std::string vertices, numbers;
  for (int i = 1; i <= 255; ++i) {
    const std::string number = std::to_string(i);
    vertices += "v " + number + " 0 " + std::to_string(i * i) + '\n';
    numbers += ' ' + number;
  }
  const ObjScene face = parse(vertices + "f" + numbers);
  CHECK(face.description.constraints.size() == 255);
  CHECK(parse(vertices + "v 0 0 0\nl" + numbers + " 256").description.constraints.size() == 255);
}

TEST_CASE("only four-sided faces have diagonals") {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\n";
  for (const std::string face : {"f 1 2 3\n", "f 1 2 3 4 5\n"}) {
    CAPTURE(face);
    const ObjScene scene = parse(vertices + face, {.ropes = Ropes::diagonals});
    CHECK(count(scene.description, ConstraintKind::rope) == 0);
  }
}

TEST_CASE("lines that a backslash continues are refused") {
  CHECK(obj_error(kTriangle + "f 1 2 \\\n3\n") == "line 4: '\\': not the number of a vertex");
  CHECK(obj_error(kTriangle + "l 1 2\\\n3\n") == "line 4: '2\\': not the number of a vertex");
  CHECK(obj_error("v 0 0 \\\n0\n") == "line 1: 'v 0 0 \\': a vertex needs three finite numbers");
}

TEST_CASE("what the loader refuses is one line too, with the number of the file's") {
  const std::string error = obj_error("\r\n# two\r\n" + kTriangle + "f 1/x 2 3\n");
  CHECK(error.find('\n') == std::string::npos);
  CHECK(error.find("line 6") != std::string::npos);
}

TEST_CASE("masses and scales must be above 0") {
  CHECK(obj_error(kTwoSquares, {.mass = 0}) == "--mass: 0 is not a number above 0");
  CHECK(obj_error(kTwoSquares, {.scale = -1}) == "--scale: -1 is not a number above 0");
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(obj_error(kTwoSquares, {.mass = infinity}) == "--mass: inf is not a number above 0");
  CHECK(obj_error(kTwoSquares, {.scale = 0 * infinity}).starts_with("--scale: "));
}

TEST_CASE("a mesh is written with the numbering and the faces of its file") {
  const ObjScene scene = parse(kTwoSquares);
  auto model = build_model(scene.description);
  REQUIRE(model);
  const auto cloth = Cloth::create(model.value(), {});
  REQUIRE(cloth);
  const std::string text =
      obj_text(scene.mesh, scene.description, particle_positions(cloth.value()));
  CHECK(text ==
        "o cloth\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\nv 1 0 0\nv 2 0 0\nv 2 1 0\n"
        "v 1 1 0\nf 1 2 3 4\nf 6 7 8 9\n");
  CHECK(parse(text).mesh.particle_of_vertex == scene.mesh.particle_of_vertex);
}

TEST_CASE("spheres are written as objects of their own") {
  const auto [scene, mesh, bodies, moves] = scenes::make_scene("hang_sphere", {.size = 3}).value();
  auto model = build_model(scene);
  REQUIRE(model);
  const auto cloth = Cloth::create(model.value(), {});
  REQUIRE(cloth);
  const std::string text = obj_text(mesh, scene, particle_positions(cloth.value()));
  CHECK(text.find("o sphere_9\n") != std::string::npos);
  const ObjScene again = parse(text);
  CHECK(again.mesh.faces.size() > 4);
  for (std::size_t vertex = 9; vertex < again.mesh.vertices.size(); ++vertex) {
    const Vec3 v = again.mesh.vertices[vertex];
    CHECK(std::hypot(v.x - 0.5, v.y + 0.6, v.z - 0.5) == doctest::Approx(0.25));
  }
}

TEST_CASE("faces of a second sphere are its own") {
  auto [scene, mesh, bodies, moves] = scenes::make_scene("hang_sphere", {.size = 3}).value();
  scene.spheres.push_back(4);
  scene.radii[4] = 0.01;
  const auto model = build_model(scene);
  REQUIRE(model);
  const auto cloth = Cloth::create(model.value(), {});
  REQUIRE(cloth);
  const ObjScene again = parse(obj_text(mesh, scene, particle_positions(cloth.value())));
  const Vec3 centre = cloth.value().position(4);
  const auto& faces = again.mesh.faces;  // four of the cloth, then as many of each sphere
  for (std::size_t i = 4 + (faces.size() - 4) / 2; i < faces.size(); ++i) {
    for (const std::uint32_t corner : faces[i]) {
      const Vec3 v = again.mesh.vertices[corner];
      CHECK(std::hypot(v.x - centre.x, v.y - centre.y, v.z - centre.z) == doctest::Approx(0.01));
    }
  }
}

}  // namespace
}  // namespace weft::tools
