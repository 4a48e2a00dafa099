/// weft: a cloth simulation library. A program describes a scene, builds a model, creates a cloth,
/// steps it and reads it:
///
///   weft::SceneDescription scene = ...;                   // plain vectors, SI units
///   auto model = weft::build_model(scene);                // validates; immutable, shareable
///   auto cloth = weft::Cloth::create(model.value(), {});  // mutable state and its workspace
///   auto report = cloth.value().step(0.01);               // one step, and the error it reached
///   cloth.value().read_positions(out);                    // in the description's numbering
///
/// This header includes the whole interface of simulation:
///
///   scene.h     describe a scene, build a model
///   settings.h  create a cloth: solver and tolerances
///   cloth.h     step it, move it, read it
///   report.h    what a step reports
///   body.h      bodies that the cloth touches
///   batch.h     many cloths at once
///   jobs.h      threads of a job system
///   measuring.h settings that only measure methods: no other program needs it
///
/// It does not include mesh.h, which makes a SceneDescription of a mesh and a material, surface.h,
/// which gives a renderer its vertices, or report_fields.h and scene_fields.h, which list fields.
/// weft_c.h is all of them in C.
///
/// Design:
///  1. The user asks for an error, not for an iteration count. Every step reports the error it
///     reached, recomputed from the positions that it committed.
///  2. A step runs only the code that the scene needs. Without spheres no contact code runs;
///     without velocity correction no velocity loop runs.
///  3. A Model is immutable. Any number of Cloths and threads may share it. A Cloth is not
///     synchronised: one thread at a time may call it, const functions included.
///  4. weft owns no threads and starts none. Parallel work runs in the oneTBB arena that the
///     calling thread is in, or in the caller's own job system (jobs.h). All threads use the
///     rounding mode of the calling thread, and get their own back when the step ends. weft changes
///     neither their priority nor their affinity. A oneTBB task may start after its step has ended;
///     it returns at once. So a plugin that holds weft must not be unloaded while tasks may still
///     start: link it with -z nodelete. Do not enable floating-point traps: SIMD lanes may divide
///     by zero; those results are not used. The only global that affects results is WEFT_ISA in the
///     environment (Isa).
///  5. A step allocates nothing once warm (contact lists grow to their largest size and stay).
///  6. Errors are values. Bad input yields one line that names the field, the index and the value,
///     and nothing is built or changed. weft throws only what the standard allocator throws.
///
/// "The paper" is Bayer, Diziol and Bender, "Optimized Impulse-Based Dynamic Simulation" (2009);
/// numbers of sections (3.2, 4.4) are those of the paper. The files that comments name are in the
/// sources of weft.
///
/// Versions are major.minor.patch. While major is 0 a new minor version may change this interface
/// and the bits of results; a new patch changes neither, except to fix mistakes.
#pragma once

#include <weft/batch.h>
#include <weft/body.h>
#include <weft/cloth.h>
#include <weft/jobs.h>
#include <weft/report.h>
#include <weft/result.h>
#include <weft/scene.h>
#include <weft/settings.h>

#define WEFT_VERSION_MAJOR 0
#define WEFT_VERSION_MINOR 6
#define WEFT_VERSION_PATCH 0
