/// weft: a cloth simulation library. This header includes the whole public interface of
/// simulation: scene.h (describe and build), settings.h (create), body.h (what cloth touches),
/// cloth.h (step and read), batch.h (many cloths) and jobs.h (threads of a job system).
/// It does not include mesh.h, which makes a SceneDescription of a mesh and a material, and
/// surface.h, which tells a renderer what to draw. weft_c.h is all of them in C.
///
///   describe -> build -> create -> step -> read
///
///   weft::SceneDescription scene = ...;                   // plain vectors, SI units
///   auto model = weft::build_model(scene);                // validates; immutable, shareable
///   auto cloth = weft::Cloth::create(model.value(), {});  // mutable state and its workspace
///   auto report = cloth.value().step(0.01);               // one step, and the error it reached
///   cloth.value().read_positions(out);                    // in the description's numbering
///
/// Design:
///  1. The user asks for an error, not for an iteration count. Every step reports the error it
///     reached, recomputed from the positions that it committed.
///  2. Only what the scene needs runs: no spheres, no contact code; no velocity correction, no
///     velocity loop.
///  3. A Model is immutable and may be shared by any number of Cloths and threads. A Cloth is not
///     synchronised: one thread at a time, for functions that are const too.
///  4. weft owns no threads, starts none, and has no globals that affect results but WEFT_ISA in
///     the environment (Isa). Parallel work runs in the oneTBB arena that the calling thread is in,
///     or in the caller's own job system (jobs.h), rounded as the calling thread rounds. Threads go
///     back when the step ends, as they were; weft changes neither their priority nor the
///     processors that they may run on. A task that an arena had no thread for may start when its
///     step is over, and returns at once. So a plugin that holds weft must not be unloaded while
///     tasks may still start: link it with -z nodelete.
///     Floating-point exceptions are to be masked: lanes compute what nobody takes (1 / 0).
///  5. A step allocates nothing once warm (contact lists grow to their largest size and stay).
///  6. Errors are values. Bad input yields one line that names the field, the index and the value,
///     and nothing is built or changed. weft throws only what the standard allocator throws.
///
/// Numbers of sections (3.2, 4.4) are those of Bayer, Diziol and Bender, "Optimized Impulse-Based
/// Dynamic Simulation" (2009), "the paper" here. Files that are named are in weft's sources.
///
/// Versions are major.minor.patch. While major is 0 a new minor version may change this interface
/// and the bits of results; a new patch changes neither, but for mistakes.
#pragma once

#include <weft/batch.h>
#include <weft/body.h>
#include <weft/cloth.h>
#include <weft/jobs.h>
#include <weft/result.h>
#include <weft/scene.h>
#include <weft/settings.h>

#define WEFT_VERSION_MAJOR 0
#define WEFT_VERSION_MINOR 3
#define WEFT_VERSION_PATCH 0
