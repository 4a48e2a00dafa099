/* weft in C: all of weft.h, mesh.h and surface.h, for C99 and for languages that call C.
 *
 *   weft_scene scene;
 *   weft_init_scene(&scene, sizeof scene);               // the defaults
 *   scene.particle_count = 2, scene.positions = xyz, scene.masses = kg;
 *   scene.constraint_count = 1, scene.constraint_particles = pair, scene.rest_lengths = metres;
 *   weft_model* model = NULL;
 *   weft_cloth* cloth = NULL;
 *   if (weft_build_model(&scene, &model) || weft_create_cloth(model, NULL, &cloth) ||
 *       weft_step(cloth, 1.0 / 60, NULL, NULL) || weft_position(cloth, 1, place))
 *     puts(weft_last_message());
 *   weft_free_cloth(cloth), weft_free_model(model);
 *
 * The C++ headers document every function and field. A name here means the same as there, with the
 * same default and the same unit (m, kg, s, N, J, rad). This header says how data cross to C.
 *
 * Shapes. Points and vectors are doubles x, y, z, one after the other: an array of n points has
 * 3 n doubles. Edges, triangles and the like are the numbers of their particles or vertices, 2, 3
 * or 4 each. A list of things is several arrays of one count, one array for each property. "or
 * NULL" says that an array may be left out; then its property has its default everywhere. If a
 * count is 0 its arrays are not read. An int that means yes or no is 0 or not 0. A count is at most
 * 4294967295.
 *
 * Structs. The first field is the size of the struct as the caller's compiler knows it. The init
 * function of a struct sets the size and all defaults. Call it first, also if a function fills in
 * the struct. Later versions add fields at the end. A program that was compiled before gets the
 * defaults of new fields, and new fields are not written to its structs. Fields that this version
 * does not know must be 0. NULL in place of an optional struct means the defaults.
 *
 * Ownership. Functions that return a handle have a parameter `out`. The caller frees the handle
 * with the weft_free_ function of its kind, which ignores NULL. Handles do not depend on each
 * other: a cloth keeps its model. Functions read the caller's arrays and keep none. Pointers that
 * they return point into a handle; they are valid until it is freed, or until the next call that
 * changes it.
 *
 * Errors. Functions return WEFT_OK (0) or another weft_result. Then nothing was changed, and
 * weft_last_message() is one line that names the field, the index and the value. A null handle or
 * array is such an error. Functions that return another type fail only for a null handle: they
 * return 0 (NULL) and set the message. No exception leaves a function. Freed handles, and counts
 * larger than their arrays, are not noticed.
 *
 * Threads. One thread at a time may use a handle. Any number of threads may use a model, a shape or
 * a mesh cloth. weft starts no threads (weft_jobs). Each thread has its own message.
 */
#ifndef WEFT_WEFT_C_H
#define WEFT_WEFT_C_H

#include <stddef.h>
#include <stdint.h>
#include <weft/api.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------- errors */

typedef enum weft_result {
  WEFT_OK = 0,
  WEFT_REFUSED = 1,       /* bad input; the message names it */
  WEFT_OUT_OF_MEMORY = 2, /* nothing was changed */
  WEFT_FAILED = 3         /* anything else: a mistake in weft, or a host whose threads failed */
} weft_result;

/* The message of the last call of this thread that did not succeed; "" if there was none. Never
 * NULL. It is valid until the next such call of this thread. Cut off after 1,023 characters. */
WEFT_API const char* weft_last_message(void);

/* The version of the library that runs. Each pointer may be NULL. */
WEFT_API void weft_version(int* major, int* minor, int* patch);

/* -------------------------------------------------------------------------------------- handles */

typedef struct weft_model weft_model;           /* Model */
typedef struct weft_cloth weft_cloth;           /* Cloth */
typedef struct weft_shape weft_shape;           /* BodyShape */
typedef struct weft_mesh_cloth weft_mesh_cloth; /* MeshCloth */
typedef struct weft_surface weft_surface;       /* Surface */
typedef struct weft_bytes weft_bytes;           /* bytes of a saved model or state */

WEFT_API void weft_free_model(weft_model* model);
WEFT_API void weft_free_cloth(weft_cloth* cloth);
WEFT_API void weft_free_shape(weft_shape* shape);
WEFT_API void weft_free_mesh_cloth(weft_mesh_cloth* cloth);
WEFT_API void weft_free_surface(weft_surface* surface);
WEFT_API void weft_free_bytes(weft_bytes* bytes);

WEFT_API const void* weft_bytes_data(const weft_bytes* bytes);
WEFT_API size_t weft_bytes_size(const weft_bytes* bytes);

#define WEFT_NO_INDEX 0xffffffffu /* kNoIndex */

/* ---------------------------------------------------------------------------- scenes, models */

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

  int self_contact; /* yes or no: whether layers of the cloth keep off each other */
  double self_contact_thickness, self_contact_friction;

  double air_ram;
  size_t pressure_count;
  const weft_pressure* pressures; /* of surface_triangles */

  const double* bending_folds; /* or NULL: 0; m, of hinges */

  int self_contact_untangle; /* yes or no: whether triangles that cross are drawn apart */

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

/* ----------------------------------------------------------------------------------- settings */

enum {
  WEFT_GAUSS_SEIDEL = 0,
  WEFT_DIRECT = 1,
  WEFT_YARN = 2,
  WEFT_SMALL_STEPS = 3,
  WEFT_SOLVER_AUTOMATIC = 4
};
enum {
  WEFT_PAPER = 0,
  WEFT_RATTLE = 1,
  WEFT_IMPLICIT = 2,
  WEFT_BDF2 = 3,
  WEFT_SCHEME_AUTOMATIC = 4
};
enum { WEFT_EACH = 0, WEFT_FROZEN = 1 };
enum { WEFT_REFERENCE = 0, WEFT_SIMD = 1 };
enum { WEFT_ISA_AUTOMATIC = 0, WEFT_SSE2 = 1, WEFT_AVX2 = 2, WEFT_AVX512 = 3, WEFT_NEON = 4 };

typedef struct weft_settings { /* Settings */
  size_t size;
  double tolerance;
  int substeps, iterations, renew_after, max_iterations;
  double contact_tolerance, velocity_tolerance, motion_tolerance, impulse_limit;
  int solver, scheme, backend, isa; /* the enumerations above */
  int threads;
  int directions;                                                        /* likewise */
  int anticipate, anticipate_products, sleep, skip, velocity_correction; /* yes or no */
} weft_settings;

WEFT_API weft_result weft_init_settings(weft_settings* settings, size_t size);
/* paper_settings() */
WEFT_API weft_result weft_init_paper_settings(weft_settings* settings, size_t size);

/* The names of these numbers; "unknown" for other numbers. */
WEFT_API const char* weft_solver_name(int solver);
WEFT_API const char* weft_scheme_name(int scheme);
WEFT_API const char* weft_directions_name(int directions);
WEFT_API const char* weft_backend_name(int backend);
WEFT_API const char* weft_isa_name(int isa);

/* ------------------------------------------------------------------------------ steps, batches */

enum {
  WEFT_CONVERGED = 0,
  WEFT_FIXED_ITERATIONS = 1,
  WEFT_ITERATION_LIMIT = 2,
  WEFT_INFEASIBLE = 3,
  WEFT_PASSED_THROUGH = 4,
  WEFT_NON_FINITE_INPUT = 5,
  WEFT_NON_FINITE = 6
}; /* Status */

WEFT_API const char* weft_status_name(int status);
WEFT_API const char* weft_stage_name(int stage);
/* Whether a step with this status changed the state. */
WEFT_API int weft_committed(int status);

typedef struct weft_contact_ms { /* ContactMs */
  double find, sweep, verify;
} weft_contact_ms;

typedef struct weft_report { /* StepReport */
  size_t size;
  int status, asleep, substeps, halvings;
  int64_t iterations, direction_updates, velocity_iterations, visits, corrections;
  int scheme_fallbacks, contacts;
  double max_strain, rms_strain, max_shear, max_error, max_bending_error;
  uint32_t worst_constraint, worst_element;
  double max_penetration;
  int body_contacts, contact_failures, zones, intersecting, self_contacts, tangled;
  double max_anchor_error;
  int open_seams;
  double max_seam_gap, seam_work, motion_error, energy_lost, pin_work, body_work, friction_work;
  uint32_t failed_particle, passed_particle;
  double stage_seconds[6]; /* predict, find_contacts, solve_positions, commit,
                              correct_velocities, report */
  weft_contact_ms contact_ms;
  int late_seams;
  uint32_t worst_seam;
  int held_apart;
  uint32_t worst_held;
  double untangling_work, max_rail_gap;
  int torn;
} weft_report;

/* JobSystem. Set both functions or neither; they must not throw. NULL in place of the struct is the
 * oneTBB arena that the calling thread is in (jobs.h). */
typedef struct weft_jobs {
  size_t size;
  void* host; /* the first argument of the functions */
  /* Returns how many threads may run jobs at the same time, the calling one included. */
  int (*threads)(void* host);
  /* Calls job(context) `times` times, in any threads, and returns when all calls have returned. */
  void (*run)(void* host, void (*job)(void* context), void* context, int times);
} weft_jobs;

/* A cloth of a batch (ClothStep). */
typedef struct weft_batch_step {
  size_t size; /* in an array all entries have the size of the first */
  weft_cloth* cloth;
  double dt;
  weft_result result; /* the result of this step */
  char message[256];  /* if the result is not WEFT_OK; cut off at its end */
  weft_report report; /* if the result is WEFT_OK */
} weft_batch_step;

WEFT_API weft_result weft_init_report(weft_report* report, size_t size);
WEFT_API weft_result weft_init_jobs(weft_jobs* jobs, size_t size);
WEFT_API weft_result weft_init_batch_step(weft_batch_step* step, size_t size);

/* jobs, report: or NULL. */
WEFT_API weft_result weft_step(weft_cloth* cloth, double dt, const weft_jobs* jobs,
                               weft_report* report);
/* WEFT_OK does not mean that each cloth was stepped: see the result of each entry. Allocates
 * nothing once warm: the first cloth keeps the list of the batch. */
WEFT_API weft_result weft_step_all(size_t count, weft_batch_step* steps, const weft_jobs* jobs);

/* --------------------------------------------------------------------------------------- cloths */

/* settings: or NULL. */
WEFT_API weft_result weft_create_cloth(const weft_model* model, const weft_settings* settings,
                                       weft_cloth** out);
WEFT_API weft_result weft_clone_cloth(const weft_cloth* cloth, weft_cloth** out);
WEFT_API weft_result weft_copy_state(weft_cloth* to, const weft_cloth* from);
WEFT_API weft_result weft_save_state(const weft_cloth* cloth, weft_bytes** out);
WEFT_API weft_result weft_load_state(weft_cloth* cloth, const void* bytes, size_t size);
/* note: or NULL. */
WEFT_API weft_result weft_begin_recording(weft_cloth* cloth, const char* path, const char* note);
WEFT_API weft_result weft_end_recording(weft_cloth* cloth);

WEFT_API size_t weft_particle_count(const weft_cloth* cloth);
/* A new handle of the model that the cloth has now. */
WEFT_API weft_result weft_model_of(const weft_cloth* cloth, weft_model** out);
WEFT_API weft_result weft_settings_of(const weft_cloth* cloth, weft_settings* settings);

WEFT_API weft_result weft_position(const weft_cloth* cloth, uint32_t particle, double out[3]);
WEFT_API weft_result weft_velocity(const weft_cloth* cloth, uint32_t particle, double out[3]);
/* count: number of particles of the cloth. */
WEFT_API weft_result weft_read_positions(const weft_cloth* cloth, size_t count, double* out);
WEFT_API weft_result weft_read_velocities(const weft_cloth* cloth, size_t count, double* out);

/* FloatVectors. count: number of floats in the buffer. */
typedef struct weft_float_vectors {
  float* floats;
  size_t count;
  size_t stride; /* floats from one vector to the next, at least 3 */
} weft_float_vectors;

/* origin: or NULL: 0. */
WEFT_API weft_result weft_read_float_positions(const weft_cloth* cloth, weft_float_vectors out,
                                               const double origin[3]);
WEFT_API weft_result weft_read_float_velocities(const weft_cloth* cloth, weft_float_vectors out);
WEFT_API weft_result weft_bounds(const weft_cloth* cloth, double least[3], double most[3]);

/* count: number of particles of the cloth; for forces also 0: none. */
WEFT_API weft_result weft_write_positions(weft_cloth* cloth, size_t count, const double* in);
WEFT_API weft_result weft_write_velocities(weft_cloth* cloth, size_t count, const double* in);
WEFT_API weft_result weft_write_forces(weft_cloth* cloth, size_t count, const double* in);
WEFT_API weft_result weft_set_gravity(weft_cloth* cloth, const double gravity[3]);
WEFT_API weft_result weft_set_wind(weft_cloth* cloth, const double wind[3]);
/* On the whole surface; 0: none. */
WEFT_API weft_result weft_set_pressure(weft_cloth* cloth, double pressure);
WEFT_API weft_result weft_set_pressures(weft_cloth* cloth, size_t count,
                                        const weft_pressure* pressures);
/* PressureNow. count: number of pressures of the cloth. volumes: or NULL. */
WEFT_API weft_result weft_read_pressures(const weft_cloth* cloth, size_t count, double* pressures,
                                         double* volumes);
WEFT_API weft_result weft_move_fixed(weft_cloth* cloth, size_t count, const uint32_t* particles,
                                     const double* positions);
WEFT_API weft_result weft_place_fixed(weft_cloth* cloth, size_t count, const uint32_t* particles,
                                      const double* positions);

/* count: number of all anchors. normals: or NULL: as they are. */
WEFT_API weft_result weft_move_anchors(weft_cloth* cloth, size_t count, const double* points,
                                       const double* normals);
/* backstops: a byte each, yes or no; or NULL: yes. */
WEFT_API weft_result weft_limit_anchors(weft_cloth* cloth, size_t count,
                                        const double* max_distances, const uint8_t* backstops);
WEFT_API weft_result weft_limit_anchor(weft_cloth* cloth, uint32_t anchor, double max_distance,
                                       int backstop);
WEFT_API weft_result weft_scale_anchors(weft_cloth* cloth, double scale);
/* seams: count numbers of seams. */
WEFT_API weft_result weft_release_seams(weft_cloth* cloth, size_t count, const uint32_t* seams);
WEFT_API weft_result weft_close_seams(weft_cloth* cloth, size_t count, const uint32_t* seams);

/* RigidMotion; each or NULL: 0. */
WEFT_API weft_result weft_carry(weft_cloth* cloth, const double translation[3],
                                const double rotation[3], const double about[3], double share);
WEFT_API weft_result weft_teleport(weft_cloth* cloth, const double translation[3],
                                   const double rotation[3], const double about[3]);

/* The constraints, membrane, bending and tethers of the scene count, times scale. */
WEFT_API weft_result weft_set_rest_shape(weft_cloth* cloth, const weft_scene* scene, double scale);

/* Changes. Particles, constraints and elements by their numbers in the description. */
typedef struct weft_changes {
  size_t size;
  size_t fix_count;
  const uint32_t* fix;
  size_t release_count;
  const uint32_t* release;
  size_t mass_count;
  const uint32_t* mass_particles;
  const double* masses;
  size_t rest_length_count;
  const uint32_t* rest_length_constraints;
  const double* rest_lengths;
  size_t compliance_count;
  const uint32_t* compliance_constraints;
  const double* compliances;
  size_t membrane_count;
  const uint32_t* membrane_elements;
  const double* membrane_stiffnesses; /* 3 each: warp, weft, shear */
  size_t bending_count;
  const uint32_t* bending_elements;
  const double* bending_compliances;
  int change_damping; /* yes or no: whether the next three fields count */
  double damping_stretch, damping_bending, damping_motion;
  int change_air; /* likewise */
  double air_density, air_drag, air_lift;
  double air_ram;
} weft_changes;

WEFT_API weft_result weft_init_changes(weft_changes* changes, size_t size);
WEFT_API weft_result weft_change(weft_cloth* cloth, const weft_changes* changes);

typedef struct weft_strain { /* Strain */
  size_t size;
  double max, rms;
  uint32_t worst_constraint;
  double max_shear;
  uint32_t worst_element;
} weft_strain;

typedef struct weft_energy { /* Energy */
  size_t size;
  double kinetic, potential, elastic;
} weft_energy;

WEFT_API weft_result weft_init_strain(weft_strain* strain, size_t size);
WEFT_API weft_result weft_init_energy(weft_energy* energy, size_t size);
WEFT_API weft_result weft_strain_of(const weft_cloth* cloth, weft_strain* strain);
WEFT_API weft_result weft_energy_of(const weft_cloth* cloth, weft_energy* energy);
WEFT_API double weft_max_penetration(const weft_cloth* cloth);
WEFT_API uint64_t weft_state_hash(const weft_cloth* cloth);
WEFT_API size_t weft_cloth_bytes(const weft_cloth* cloth);

/* --------------------------------------------------------------------------------------- bodies */

WEFT_API weft_result weft_plane(const double normal[3], double offset, weft_shape** out);
WEFT_API weft_result weft_ball(const double centre[3], double radius, weft_shape** out);
WEFT_API weft_result weft_capsule(const double a[3], const double b[3], double radius_a,
                                  double radius_b, weft_shape** out);
WEFT_API weft_result weft_hull(size_t count, const double* points, weft_shape** out);
WEFT_API weft_result weft_box(const double edges[3], weft_shape** out);
WEFT_API weft_result weft_triangle_mesh(size_t vertex_count, const double* vertices,
                                        size_t triangle_count, const uint32_t* triangles,
                                        int two_sided, weft_shape** out);

typedef struct weft_body { /* Body */
  size_t size;
  const weft_shape* shape; /* the body keeps it alive; the handle may be freed */
  double position[3];
  double rotation[4]; /* x, y, z, w */
  double thickness, friction;
} weft_body;

typedef struct weft_body_load { /* BodyLoad */
  size_t size;
  double force[3], moment[3];
} weft_body_load;

typedef struct weft_body_contact { /* BodyContact */
  size_t size;                     /* in an array all entries have the size of the first */
  uint32_t particle, body;
  double point[3], normal[3];
  double push;
} weft_body_contact;

WEFT_API weft_result weft_init_body(weft_body* body, size_t size);
WEFT_API weft_result weft_init_body_load(weft_body_load* load, size_t size);
WEFT_API weft_result weft_init_body_contact(weft_body_contact* contact, size_t size);

WEFT_API weft_result weft_add_body(weft_cloth* cloth, const weft_body* body, uint32_t* id);
/* rotation: x, y, z, w; or NULL: none. */
WEFT_API weft_result weft_move_body(weft_cloth* cloth, uint32_t id, const double position[3],
                                    const double rotation[4]);
WEFT_API weft_result weft_place_body(weft_cloth* cloth, uint32_t id, const double position[3],
                                     const double rotation[4]);
WEFT_API weft_result weft_move_body_vertices(weft_cloth* cloth, uint32_t id, size_t count,
                                             const double* vertices);
WEFT_API weft_result weft_place_body_vertices(weft_cloth* cloth, uint32_t id, size_t count,
                                              const double* vertices);
WEFT_API weft_result weft_switch_body(weft_cloth* cloth, uint32_t id, int on);
WEFT_API weft_result weft_remove_body(weft_cloth* cloth, uint32_t id);
WEFT_API weft_result weft_body_load_of(const weft_cloth* cloth, uint32_t id, weft_body_load* load);
enum {
  WEFT_TORN_CONSTRAINT = 0,
  WEFT_TORN_SEAM = 1,
  WEFT_TORN_ANCHOR = 2,
  WEFT_TORN_SHEET = 3
}; /* Tear */

typedef struct weft_torn { /* Torn */
  size_t size;             /* in an array all entries have the size of the first */
  int kind;                /* the enumeration above */
  uint32_t index;
  uint32_t particle; /* or WEFT_NO_INDEX */
  double load;
} weft_torn;

WEFT_API weft_result weft_init_torn(weft_torn* torn, size_t size);
/* Writes three corners of each of the first `capacity` triangles, and the number of all triangles
 * to *count. */
WEFT_API weft_result weft_surface_of(const weft_cloth* cloth, size_t capacity, uint32_t* out,
                                     size_t* count);
/* The breaks at the end of the last step. Writes the first `capacity` of them, and the number of
 * all to *count. */
WEFT_API weft_result weft_torn_of(const weft_cloth* cloth, size_t capacity, weft_torn* out,
                                  size_t* count);
/* Writes the first `capacity` contacts, and the number of all contacts to *count. */
WEFT_API weft_result weft_body_contacts(const weft_cloth* cloth, size_t capacity,
                                        weft_body_contact* out, size_t* count);

/* ---------------------------------------------------------------------------- materials, meshes */

typedef struct weft_material { /* Material */
  size_t size;
  double density, thickness, warp, weft, shear, bending;
  double damping_stretch, damping_bending, damping_motion, drag, lift;
  double friction;
  double ram;
  double strength;
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

/* ------------------------------------------------------------------------------------- surfaces */

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
