/* Results, messages and handles, in C. Part of weft_c.h, which says how data cross to C. */
#ifndef WEFT_WEFT_C_HANDLES_H
#define WEFT_WEFT_C_HANDLES_H

#include <stddef.h>
#include <stdint.h>
#include <weft/api.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ----------------------------------------------------------------------------------- errors */

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

/* ---------------------------------------------------------------------------------- handles */

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

#ifdef __cplusplus
}
#endif

#endif
