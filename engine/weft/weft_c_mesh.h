/* Materials, meshes and surfaces, in C. Part of weft_c.h, which says how data cross to C. */
#ifndef WEFT_WEFT_C_MESH_H
#define WEFT_WEFT_C_MESH_H

#include <stddef.h>
#include <stdint.h>
#include <weft/weft_c_cloth.h>
#include <weft/weft_c_scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------ materials, meshes */

typedef struct weft_material { /* Material */
  size_t size;
  double density, thickness, warp, weft, shear, bending;
  double damping_stretch, damping_bending, damping_motion, drag, lift;
  double friction;
  double ram;
  double strength;
  double bending_yield, bending_hardening, bending_friction, bending_slip;
} weft_material;

WEFT_API weft_result weft_init_material(weft_material* material, size_t size);
WEFT_API weft_result weft_check_material(const weft_material* material);
WEFT_API size_t weft_material_count(void);
/* NULL if no material has this number. */
WEFT_API const char* weft_material_name(size_t number);
WEFT_API const char* weft_material_source(size_t number);
WEFT_API weft_result weft_find_material(const char* name, weft_material* material);

enum { WEFT_NO_ROPES = 0, WEFT_DIAGONAL_ROPES = 1, WEFT_ALL_ROPES = 2 }; /* Ropes */

typedef struct weft_mesh { /* MeshDescription */
  size_t size;
  size_t vertex_count;
  const double* positions; /* 3 each */
  size_t corner_count;
  const uint32_t* corners;
  size_t face_count;          /* 0: all faces are triangles */
  const uint32_t* face_sizes; /* corners of each face */
  size_t line_count;
  const uint32_t* lines;        /* 2 each */
  const double* rest_positions; /* 3 for each vertex, or NULL */
  const double* rest_corners;   /* 2 for each corner, or NULL */
  size_t warp_count;            /* 0, 1 or one for each face */
  const double* warp;           /* 3 each */
  size_t pin_count;
  const uint32_t* pins;
  const weft_material* material; /* or NULL: rigid edges */
  double mass, thread_density, weld_distance;
  size_t seam_count;
  const uint32_t* seams; /* 2 each */
  double seam_time, seam_force;
  int ropes;
} weft_mesh;

typedef struct weft_mesh_counts { /* MeshCounts */
  size_t size;
  size_t triangles, quads, recognised_quads, welded_vertices, unused_vertices, degenerate_faces,
      double_faces, non_manifold_edges, thread_lines, pieces, loose_pieces;
  double suggested_weld;
} weft_mesh_counts;

WEFT_API weft_result weft_init_mesh(weft_mesh* mesh, size_t size);
WEFT_API weft_result weft_init_mesh_counts(weft_mesh_counts* counts, size_t size);

/* directions: 3 for each face. texture: 2 for each corner. */
WEFT_API weft_result weft_warp_from_texture(const weft_mesh* mesh, const double* texture,
                                            size_t face_count, double* directions);
WEFT_API weft_result weft_cloth_from_mesh(const weft_mesh* mesh, weft_mesh_cloth** out);
/* The scene of a mesh cloth. Its arrays belong to the mesh cloth; the caller may change the struct.
 */
WEFT_API weft_result weft_scene_of(const weft_mesh_cloth* cloth, weft_scene* scene);
/* One particle for each vertex, WEFT_NO_INDEX if it has none. */
WEFT_API const uint32_t* weft_particle_of_vertex(const weft_mesh_cloth* cloth);
WEFT_API weft_result weft_counts_of(const weft_mesh_cloth* cloth, weft_mesh_counts* counts);
WEFT_API size_t weft_cell_count(const weft_mesh_cloth* cloth);
WEFT_API const uint32_t* weft_cells(const weft_mesh_cloth* cloth); /* 4 each */

/* --------------------------------------------------------------------------------- surfaces */

WEFT_API weft_result weft_surface_of_mesh(const weft_mesh* mesh, const weft_mesh_cloth* cloth,
                                          weft_surface** out);
/* max_distance: HUGE_VAL for any distance. */
WEFT_API weft_result weft_map_surface(const weft_mesh* mesh, const weft_mesh_cloth* cloth,
                                      const weft_mesh* other, double max_distance,
                                      weft_surface** out);
WEFT_API weft_result weft_clone_surface(const weft_surface* surface, weft_surface** out);
WEFT_API size_t weft_surface_vertex_count(const weft_surface* surface);
WEFT_API size_t weft_surface_particle_count(const weft_surface* surface);
WEFT_API size_t weft_surface_triangle_count(const weft_surface* surface);
WEFT_API const uint32_t* weft_surface_triangles(const weft_surface* surface); /* 3 each */
/* changes, which may be NULL: 1 where the counts and the triangles differ from those before */
WEFT_API weft_result weft_follow(weft_surface* surface, const weft_cloth* cloth, int* changes);
WEFT_API size_t weft_surface_split_count(const weft_surface* surface);
WEFT_API const uint32_t* weft_surface_split_from(const weft_surface* surface);
/* positions or normals may have no floats: NULL and 0. origin: or NULL: 0. */
WEFT_API weft_result weft_read_vertices(weft_surface* surface, const weft_cloth* cloth,
                                        weft_float_vectors positions, weft_float_vectors normals,
                                        const double origin[3]);
WEFT_API weft_result weft_copy_shape(weft_surface* surface, const weft_cloth* from, weft_cloth* to);
WEFT_API size_t weft_surface_bytes(const weft_surface* surface);

#ifdef __cplusplus
}
#endif

#endif
