#include "engine/c_interface/mesh.h"

#include "engine/c_interface/arrays.h"
#include "engine/c_interface/choices.h"
#include "engine/c_interface/handles.h"
#include "engine/c_interface/materials.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

using Pair = std::array<std::uint32_t, 2>;
using Place = std::array<double, 2>;

weft_mesh default_mesh() {
  const MeshDescription usual;
  weft_mesh mesh{};
  mesh.size = sizeof mesh;
  mesh.mass = usual.mass;
  mesh.thread_density = usual.thread_density;
  mesh.weld_distance = usual.weld_distance;
  mesh.seam_time = usual.seam_time;
  mesh.seam_force = usual.seam_force;
  mesh.ropes = static_cast<int>(usual.ropes);
  return mesh;
}

weft_mesh_counts counts_of(const MeshCounts& c) {
  return {.size = sizeof(weft_mesh_counts),
          .triangles = c.triangles,
          .quads = c.quads,
          .recognised_quads = c.recognised_quads,
          .welded_vertices = c.welded_vertices,
          .unused_vertices = c.unused_vertices,
          .degenerate_faces = c.degenerate_faces,
          .double_faces = c.double_faces,
          .non_manifold_edges = c.non_manifold_edges,
          .thread_lines = c.thread_lines,
          .pieces = c.pieces,
          .loose_pieces = c.loose_pieces,
          .suggested_weld = c.suggested_weld};
}

void read_surface(const weft_mesh& m, Arrays& in, MeshDescription& out) {
  out.positions = list_of(in.needed<Vec3>("positions", m.positions, m.vertex_count));
  out.corners = list_of(in.needed<std::uint32_t>("corners", m.corners, m.corner_count));
  out.face_sizes = list_of(in.needed<std::uint32_t>("face_sizes", m.face_sizes, m.face_count));
  out.lines = list_of(in.needed<Pair>("lines", m.lines, m.line_count));
  out.rest_positions =
      list_of(in.optional<Vec3>("rest_positions", m.rest_positions, m.vertex_count));
  out.rest_corners = list_of(in.optional<Place>("rest_corners", m.rest_corners, m.corner_count));
  out.warp = list_of(in.needed<Vec3>("warp", m.warp, m.warp_count));
  out.pins = list_of(in.needed<std::uint32_t>("pins", m.pins, m.pin_count));
  out.seams = list_of(in.needed<Pair>("seams", m.seams, m.seam_count));
}

std::size_t face_count(const MeshDescription& mesh) {
  return mesh.face_sizes.empty() ? mesh.corners.size() / 3 : mesh.face_sizes.size();
}

}  // namespace

Result<MeshDescription> read_mesh(std::string_view name, const weft_mesh* mesh) {
  const auto read = read_struct(name, mesh, default_mesh());
  if (!read) return Error{read.error()};
  const weft_mesh& m = read.value();
  Arrays in;
  MeshDescription out;
  read_surface(m, in, out);
  if (!in.are_good()) return in.error();
  if (m.material != nullptr) {
    const auto material = read_material(m.material);
    if (!material) return Error{material.error()};
    out.material = material.value();
  }
  out.mass = m.mass;
  out.thread_density = m.thread_density;
  out.weld_distance = m.weld_distance;
  out.seam_time = m.seam_time;
  out.seam_force = m.seam_force;
  if (auto r = read_choice("ropes", m.ropes, Ropes::all, out.ropes); !r) return Error{r.error()};
  return out;
}

}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_mesh(weft_mesh* mesh, size_t size) {
  return init_struct("mesh", default_mesh(), mesh, size);
}

weft_result weft_init_mesh_counts(weft_mesh_counts* counts, size_t size) {
  return init_struct("counts", counts_of({}), counts, size);
}

weft_result weft_warp_from_texture(const weft_mesh* mesh, const double* texture, size_t faces,
                                   double* directions) {
  return call([&]() -> weft::Result<void> {
    const auto description = read_mesh("mesh", mesh);
    if (!description) return weft::Error{description.error()};
    Arrays in;
    const auto places = in.needed<Place>("texture", texture, description.value().corners.size());
    in.needed<weft::Vec3>("directions", directions, faces);
    if (!in.are_good()) return in.error();
    if (faces != face_count(description.value())) {
      return weft::Error{"face_count: the mesh has " +
                         std::to_string(face_count(description.value())) + " faces (" +
                         std::to_string(faces) + ")"};
    }
    const auto warp = weft::warp_from_texture(description.value(), places);
    if (!warp) return weft::Error{warp.error()};
    for (std::size_t i = 0; i < warp.value().size(); ++i) {
      write_vector(warp.value()[i], directions + 3 * i);
    }
    return {};
  });
}

weft_result weft_cloth_from_mesh(const weft_mesh* mesh, weft_mesh_cloth** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"out", out}}); !r) return r;
    const auto description = read_mesh("mesh", mesh);
    if (!description) return weft::Error{description.error()};
    return hand_over(weft::cloth_from_mesh(description.value()), out);
  });
}

void weft_free_mesh_cloth(weft_mesh_cloth* cloth) { delete cloth; }

weft_result weft_scene_of(const weft_mesh_cloth* cloth, weft_scene* scene) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    if (auto r = check_struct("scene", scene); !r) return r;
    write_struct(scene_of(cloth->cloth.scene, cloth->arrays), scene);
    return {};
  });
}

weft_result weft_counts_of(const weft_mesh_cloth* cloth, weft_mesh_counts* counts) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    if (auto r = check_struct("counts", counts); !r) return r;
    write_struct(counts_of(cloth->cloth.counts), counts);
    return {};
  });
}

const uint32_t* weft_particle_of_vertex(const weft_mesh_cloth* cloth) {
  return ask("cloth", cloth, [&] { return cloth->cloth.particle_of_vertex.data(); });
}

size_t weft_cell_count(const weft_mesh_cloth* cloth) {
  return ask("cloth", cloth, [&] { return cloth->cloth.cells.size(); });
}

const uint32_t* weft_cells(const weft_mesh_cloth* cloth) {
  return ask("cloth", cloth, [&] { return as_numbers<std::uint32_t>(cloth->cloth.cells); });
}
