/* Bodies that a cloth touches, in C. Part of weft_c.h, which says how data cross to C. */
#ifndef WEFT_WEFT_C_BODY_H
#define WEFT_WEFT_C_BODY_H

#include <stddef.h>
#include <stdint.h>
#include <weft/weft_c_handles.h>

#ifdef __cplusplus
extern "C" {
#endif

WEFT_API weft_result weft_plane(const double normal[3], double offset, weft_shape** out);
WEFT_API weft_result weft_ball(const double centre[3], double radius, weft_shape** out);
WEFT_API weft_result weft_capsule(const double a[3], const double b[3], double radius_a,
                                  double radius_b, weft_shape** out);
WEFT_API weft_result weft_hull(size_t count, const double* points, weft_shape** out);
WEFT_API weft_result weft_box(const double edges[3], weft_shape** out);
WEFT_API weft_result weft_triangle_mesh(size_t vertex_count, const double* vertices,
                                        size_t triangle_count, const uint32_t* triangles,
                                        int two_sided, weft_shape** out);
/* heights: columns * rows. */
WEFT_API weft_result weft_height_field(uint32_t columns, uint32_t rows, double spacing_x,
                                       double spacing_z, const double* heights, weft_shape** out);
WEFT_API weft_result weft_torus(const double centre[3], const double axis[3], double major,
                                double minor, weft_shape** out);

typedef struct weft_body { /* Body */
  size_t size;
  const weft_shape* shape; /* the body keeps it alive; the handle may be freed */
  double position[3];
  double rotation[4]; /* x, y, z, w */
  double thickness, friction;
  double mass; /* Body::mass; 0: none, and the next two do not count */
  double centre_of_mass[3];
  double inertia[6];
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
/* Gives the body the mass of its shape at a density. */
WEFT_API weft_result weft_give_mass(weft_body* body, double density);
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
WEFT_API weft_result weft_body_pose_of(const weft_cloth* cloth, uint32_t id, double position[3],
                                       double rotation[4]);
WEFT_API weft_result weft_body_velocity_of(const weft_cloth* cloth, uint32_t id, double linear[3],
                                           double angular[3]);
WEFT_API weft_result weft_set_body_velocity(weft_cloth* cloth, uint32_t id, const double linear[3],
                                            const double angular[3]);
WEFT_API weft_result weft_set_body_force(weft_cloth* cloth, uint32_t id, const double force[3],
                                         const double moment[3]);

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

#ifdef __cplusplus
}
#endif

#endif
