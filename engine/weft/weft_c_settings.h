/* Settings of a cloth, in C. Part of weft_c.h, which says how data cross to C. */
#ifndef WEFT_WEFT_C_SETTINGS_H
#define WEFT_WEFT_C_SETTINGS_H

#include <stddef.h>
#include <stdint.h>
#include <weft/weft_c_handles.h>

#ifdef __cplusplus
extern "C" {
#endif

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

#ifdef __cplusplus
}
#endif

#endif
