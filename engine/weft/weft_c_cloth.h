/* Steps, batches and cloths, in C. Part of weft_c.h, which says how data cross to C. */
#ifndef WEFT_WEFT_C_CLOTH_H
#define WEFT_WEFT_C_CLOTH_H

#include <stddef.h>
#include <stdint.h>
#include <weft/weft_c_scene.h>
#include <weft/weft_c_settings.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --------------------------------------------------------------------------- steps, batches */

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
  double law_error;
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

/* ----------------------------------------------------------------------------------- cloths */

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

#ifdef __cplusplus
}
#endif

#endif
