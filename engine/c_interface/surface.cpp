/// Surfaces in C.
#include <weft/surface.h>

#include "engine/c_interface/arrays.h"
#include "engine/c_interface/calls.h"
#include "engine/c_interface/float_vectors.h"
#include "engine/c_interface/handles.h"
#include "engine/c_interface/mesh.h"

using namespace weft::c_interface;

weft_result weft_surface_of_mesh(const weft_mesh* mesh, const weft_mesh_cloth* cloth,
                                 weft_surface** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"out", out}}); !r) return r;
    const auto description = read_mesh("mesh", mesh);
    if (!description) return weft::Error{description.error()};
    return hand_over(weft::surface_of_mesh(description.value(), cloth->cloth), out);
  });
}

weft_result weft_map_surface(const weft_mesh* mesh, const weft_mesh_cloth* cloth,
                             const weft_mesh* other, double max_distance, weft_surface** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}, {"out", out}}); !r) return r;
    const auto description = read_mesh("mesh", mesh);
    if (!description) return weft::Error{description.error()};
    const auto follower = read_mesh("other", other);
    if (!follower) return weft::Error{follower.error()};
    return hand_over(
        weft::map_surface(description.value(), cloth->cloth, follower.value(), max_distance), out);
  });
}

void weft_free_surface(weft_surface* surface) { delete surface; }

weft_result weft_clone_surface(const weft_surface* surface, weft_surface** out) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"surface", surface}, {"out", out}}); !r) return r;
    *out = new weft_surface{surface->surface.clone()};
    return {};
  });
}

size_t weft_surface_vertex_count(const weft_surface* surface) {
  return ask("surface", surface, [&] { return surface->surface.vertex_count(); });
}

size_t weft_surface_particle_count(const weft_surface* surface) {
  return ask("surface", surface, [&] { return surface->surface.particle_count(); });
}

size_t weft_surface_triangle_count(const weft_surface* surface) {
  return ask("surface", surface, [&] { return surface->surface.triangles().size(); });
}

const uint32_t* weft_surface_triangles(const weft_surface* surface) {
  return ask("surface", surface, [&] {
    return reinterpret_cast<const std::uint32_t*>(surface->surface.triangles().data());
  });
}

weft_result weft_follow(weft_surface* surface, const weft_cloth* cloth, int* changes) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"surface", surface}, {"cloth", cloth}}); !r) return r;
    const auto followed = surface->surface.follow(cloth->cloth);
    if (!followed) return weft::Error{followed.error()};
    if (changes != nullptr) *changes = followed.value();
    return {};
  });
}

size_t weft_surface_split_count(const weft_surface* surface) {
  return ask("surface", surface, [&] { return surface->surface.split_from().size(); });
}

const uint32_t* weft_surface_split_from(const weft_surface* surface) {
  return ask("surface", surface, [&] { return surface->surface.split_from().data(); });
}

weft_result weft_read_vertices(weft_surface* surface, const weft_cloth* cloth,
                               weft_float_vectors positions, weft_float_vectors normals,
                               const double origin[3]) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"surface", surface}, {"cloth", cloth}}); !r) return r;
    const auto places = float_vectors("positions", positions);
    if (!places) return weft::Error{places.error()};
    const auto directions = float_vectors("normals", normals);
    if (!directions) return weft::Error{directions.error()};
    return surface->surface.read_vertices(cloth->cloth, places.value(), directions.value(),
                                          vector_of(origin));
  });
}

weft_result weft_copy_shape(weft_surface* surface, const weft_cloth* from, weft_cloth* to) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"surface", surface}, {"from", from}, {"to", to}}); !r) return r;
    return surface->surface.copy_shape(from->cloth, to->cloth);
  });
}

size_t weft_surface_bytes(const weft_surface* surface) {
  return ask("surface", surface, [&] { return surface->surface.bytes(); });
}
