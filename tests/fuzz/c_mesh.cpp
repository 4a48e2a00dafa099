/// Meshes, materials and surfaces by the C interface: a mesh becomes a cloth, which is drawn, and
/// another mesh follows it.
#include <limits>
#include <vector>

#include "tests/fuzz/c_calls.h"
#include "tests/fuzz/c_structs.h"

namespace weft::fuzz {
namespace {

Owned<weft_cloth> cloth_of(const weft_mesh_cloth* made_of) {
  auto scene = initial(weft_init_scene);
  check(weft_scene_of(made_of, &scene) == WEFT_OK, "a mesh cloth has a scene");
  const auto model =
      made<weft_model>([&](weft_model** out) { return weft_build_model(&scene, out); });
  if (!model) return nullptr;
  auto settings = initial(weft_init_settings);
  settings.max_iterations = 100;
  return made<weft_cloth>(
      [&](weft_cloth** out) { return weft_create_cloth(model.get(), &settings, out); });
}

void draw(weft_surface* surface, const weft_cloth* cloth) {
  done(weft_follow(surface, cloth, nullptr));
  const std::size_t vertices = weft_surface_vertex_count(surface);
  std::vector<float> positions(3 * vertices), normals(3 * vertices);
  done(weft_read_vertices(surface, cloth, {positions.data(), positions.size(), 3},
                          {normals.data(), normals.size(), 3}, nullptr));
  const std::uint32_t* corners = weft_surface_triangles(surface);
  for (std::size_t i = 0; i < 3 * weft_surface_triangle_count(surface); ++i)
    check(corners[i] < vertices, "triangles are of the vertices of the mesh");
  check(weft_surface_bytes(surface) > 0, "a surface holds memory");
}

void follow(Drawing& drawing, const weft_mesh& mesh, const weft_mesh_cloth* made_of,
            const weft_cloth* cloth) {
  Arrays arrays(drawing);
  auto material = initial(weft_init_material);
  const auto other = draw_mesh(arrays, material);
  const double farthest = drawing.near(std::numeric_limits<double>::infinity());
  const auto surface = made<weft_surface>(
      [&](weft_surface** out) { return weft_map_surface(&mesh, made_of, &other, farthest, out); });
  if (!surface) return;
  draw(surface.get(), cloth);
  const auto other_made = made<weft_mesh_cloth>(
      [&](weft_mesh_cloth** out) { return weft_cloth_from_mesh(&other, out); });
  if (!other_made) return;
  const auto to = cloth_of(other_made.get());
  if (!to) return;
  changed(to.get(), [&] { return weft_copy_shape(surface.get(), cloth, to.get()); });
  step(to.get(), 0.01, nullptr);
}

void find_warp(Drawing& drawing, const weft_mesh& mesh) {
  const std::size_t faces = mesh.face_count > 0 ? mesh.face_count : mesh.corner_count / 3;
  const auto texture = drawing.numbers(2 * mesh.corner_count, 0.5);
  std::vector<double> directions(3 * faces);
  done(weft_warp_from_texture(&mesh, texture.data(), faces, directions.data()));
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int WEFT_FUZZ_TARGET(c_mesh)(const std::uint8_t* data, std::size_t size) {
  using namespace weft::fuzz;
  Drawing drawing(data, size);
  Arrays arrays(drawing);
  auto material = initial(weft_init_material);
  const auto mesh = draw_mesh(arrays, material);
  if (drawing.flag()) find_warp(drawing, mesh);
  const auto made_of = made<weft_mesh_cloth>(
      [&](weft_mesh_cloth** out) { return weft_cloth_from_mesh(&mesh, out); });
  if (!made_of) return 0;
  auto counts = initial(weft_init_mesh_counts);
  check(weft_counts_of(made_of.get(), &counts) == WEFT_OK, "a mesh cloth has counts");
  const auto cloth = cloth_of(made_of.get());
  if (!cloth) return 0;
  note_accepted();
  step(cloth.get(), 0.01, nullptr);
  const auto surface = made<weft_surface>(
      [&](weft_surface** out) { return weft_surface_of_mesh(&mesh, made_of.get(), out); });
  check(surface != nullptr, "a mesh that became cloth can be drawn");
  draw(surface.get(), cloth.get());
  follow(drawing, mesh, made_of.get(), cloth.get());
  step(cloth.get(), 0.01, nullptr);
  return 0;
}
