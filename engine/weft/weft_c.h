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

#include <weft/weft_c_body.h>
#include <weft/weft_c_cloth.h>
#include <weft/weft_c_handles.h>
#include <weft/weft_c_mesh.h>
#include <weft/weft_c_scene.h>
#include <weft/weft_c_settings.h>

#endif
