/* Scenes and models, in C. Part of weft_c.h, which says how data cross to C. */
#ifndef WEFT_WEFT_C_SCENE_H
#define WEFT_WEFT_C_SCENE_H

#include <stddef.h>
#include <stdint.h>
#include <weft/weft_c_handles.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { WEFT_DISTANCE = 0, WEFT_ROPE = 1 }; /* ConstraintKind, in a byte each */

typedef struct weft_pressure { /* Pressure */
  size_t size;                 /* of an array: the same in all of it */
  double pressure;
  size_t triangle_count;
  const uint32_t* triangles; /* by their numbers; without any: all */
  int gas;                   /* yes or no */
  double volume, ambient;
} weft_pressure;

WEFT_API weft_result weft_init_pressure(weft_pressure* pressure, size_t size);

typedef struct weft_scene { /* SceneDescription */
  size_t size;
  size_t particle_count;
  const double* positions;  /* 3 each */
  const double* velocities; /* 3 each, or NULL: at rest */
  const double* masses;

  size_t fixed_count;
  const uint32_t* fixed;

  size_t constraint_count;
  const uint32_t* constraint_particles; /* 2 each */
  const double* rest_lengths;
  const uint8_t* constraint_kinds; /* or NULL: WEFT_DISTANCE */
  const double* compliances;       /* or NULL: 0 */

  size_t membrane_count;
  const uint32_t* membrane_particles; /* 3 each */
  const double* membrane_rest;        /* 6 each: u, v of each corner */
  const double* membrane_stiffnesses; /* 3 each: warp, weft, shear */
  const uint8_t* membrane_kinds;      /* or NULL: WEFT_DISTANCE */

  size_t bending_count;
  const uint32_t* bending_particles; /* 4 each, the last may be WEFT_NO_INDEX */
  const double* bending_weights;     /* 4 each */
  const double* bending_rests;       /* or NULL: 0 */
  const double* bending_compliances;

  size_t anchor_count;
  const uint32_t* anchor_particles;
  const double* anchor_points;        /* 3 each */
  const double* anchor_normals;       /* 3 each, or NULL: none */
  const double* anchor_max_distances; /* or NULL: 0 */
  const double* backstop_distances;   /* or NULL: 0 */
  const double* backstop_radii;       /* or NULL: 0, no backstop */

  size_t seam_count;
  const uint32_t* seam_particles; /* 2 each */
  const double* seam_times;       /* or NULL: 1 */
  const double* seam_max_forces;  /* or NULL: infinite */

  size_t surface_count;
  const uint32_t* surface_triangles; /* 3 each */

  double damping_stretch, damping_bending, damping_motion;

  size_t air_triangle_count;
  const uint32_t* air_triangles; /* 3 each */
  double air_density, air_drag, air_lift;
  double wind[3];

  double friction;
  double gravity[3];

  size_t sphere_count;
  const uint32_t* spheres;
  const double* radii; /* particle_count of them, or NULL: there are no spheres */

  int self_contact; /* yes or no: whether layers of the cloth collide */
  double self_contact_thickness, self_contact_friction;

  double air_ram;
  size_t pressure_count;
  const weft_pressure* pressures; /* of surface_triangles */

  const double* bending_folds; /* or NULL: 0; m, of hinges */

  int self_contact_untangle; /* yes or no: whether triangles that cross are pulled apart */

  size_t tether_count;
  const uint32_t* tether_particles; /* 2 each: particle, pin */
  const double* tether_lengths;
  double tether_slack;

  size_t slider_count;
  const uint32_t* slider_particles;
  const uint32_t* slider_rails;   /* 2 each: the first and the last in rail_particles */
  const double* slider_frictions; /* or NULL: 0 */
  size_t rail_particle_count;
  const uint32_t* rail_particles;

  /* N, of triangles N/m; or NULL: infinite, nothing breaks */
  const double* constraint_strengths;
  const double* membrane_strengths;
  const double* anchor_strengths;
  const double* seam_strengths;

  const double* bending_yields;     /* m, of hinges; or NULL: infinite, none yields */
  const double* bending_hardenings; /* or NULL: 0 */
  const double* bending_arms;       /* m; or NULL: 0 */
} weft_scene;

typedef struct weft_model_info { /* ModelInfo */
  size_t size;
  size_t particles, constraints, inert_constraints, ropes, compliant, membrane_elements,
      bending_elements, anchors, seams, surface_triangles, air_triangles, spheres, colours, tiles;
  double run_share;
  size_t bytes;
  size_t tethers;
} weft_model_info;

WEFT_API weft_result weft_init_scene(weft_scene* scene, size_t size);
WEFT_API weft_result weft_init_model_info(weft_model_info* info, size_t size);

WEFT_API weft_result weft_build_model(const weft_scene* scene, weft_model** out);
WEFT_API weft_result weft_describe(const weft_model* model, weft_model_info* info);
WEFT_API weft_result weft_save_model(const weft_model* model, weft_bytes** out);
WEFT_API weft_result weft_load_model(const void* bytes, size_t size, weft_model** out);

#ifdef __cplusplus
}
#endif

#endif
