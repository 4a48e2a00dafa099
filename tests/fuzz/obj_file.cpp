/// An OBJ file, as cloth and as a body. The first line says by letters what is asked of it.
#include "tools/program/formats/obj_file.h"

#include <weft/mesh.h>

#include <string>

#include "tests/fuzz/checks.h"
#include "tests/fuzz/stepping.h"
#include "tools/program/formats/obj_mesh.h"

namespace weft::fuzz {
namespace {

tools::ObjOptions options_of(std::string_view letters) {
  tools::ObjOptions options;
  for (const char letter : letters) {
    if (letter == 't') options.pin = "top";
    if (letter == 'p') options.pin = "x<0.5 and y>=0 or 1-2";
    if (letter == 'm') options.material = find_material("cotton").value();
    if (letter == 'd') options.weld_distance = 0.01;
    if (letter == 'u') options.rest = "uv:0.5";
    if (letter == 'w') options.warp = "uv";
    if (letter == 'x') options.warp = "1,0,0";
    if (letter == 'r') options.ropes = Ropes::all;
    if (letter == 'g') options.ropes = Ropes::diagonals;
    if (letter == 's') options.seams = {"0-1:3-2"};
    if (letter == 'l') options.seam_time = 0.5;
    if (letter == 'z') options.up = &Vec3::z;
    if (letter == 'c') options.scale = 0.01;
  }
  return options;
}

void check_survives_writing(const tools::ObjScene& scene) {
  std::vector<Vec3> particles;
  for (const Vec3 v : scene.description.positions) particles.push_back(v);
  tools::Mesh mesh = scene.mesh;
  mesh.particle_of_vertex.assign(mesh.vertices.size(), kNoIndex);  // as the file has them
  const auto again = tools::parse_obj_file(tools::obj_text(mesh, {}, {}));
  check(static_cast<bool>(again), again ? "" : again.error());
  check(again.value().mesh.faces == mesh.faces, "faces survive writing and reading again");
  check(again.value().mesh.lines == mesh.lines, "lines survive writing and reading again");
  check(tools::obj_text({again.value().mesh.vertices, std::vector(mesh.vertices.size(), kNoIndex),
                         mesh.faces, mesh.lines},
                        {}, {}) == tools::obj_text(mesh, {}, {}),
        "vertices survive writing and reading again");
  check(tools::parse_obj_file(tools::obj_text(scene.mesh, scene.description, particles))
                .value()
                .mesh.faces == mesh.faces,
        "a frame has the faces of the file");
}

void use_as_cloth(std::string_view text, const tools::ObjOptions& options) {
  const auto scene = tools::parse_obj(std::string(text), options);
  if (!scene) return check_message(scene.error());
  check_survives_writing(scene.value());
  const auto model = build_model(scene.value().description);
  if (!model) return check_message(model.error());
  auto cloth = Cloth::create(model.value(), brief_settings());
  if (!cloth) return check_message(cloth.error());
  note_accepted();
  step_twice(cloth.value());
}

void use_as_body(const tools::ObjFile& file) {
  TriangleMesh mesh{.vertices = file.mesh.vertices,
                    .triangles = tools::triangles_of(file.mesh.faces)};
  for (const bool two_sided : {false, true}) {
    mesh.two_sided = two_sided;
    const auto shape = build_shape(mesh);
    if (!shape) check_message(shape.error());
  }
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(obj_file)(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  using namespace weft::fuzz;
  std::string_view text = fuzz::text_of(data, size);
  const std::string_view letters = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(letters.size() + 1, text.size()));
  const auto file = tools::parse_obj_file(text);
  if (!file) return check_message(file.error()), 0;
  use_as_body(file.value());
  use_as_cloth(text, options_of(letters));
  return 0;
}
