/// Data of the kernels of yarns (yarns.h): rows, and where they find their particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/runs.h"

namespace weft::simd {

/// The kind of a row of a block of yarns (yarns.h): masses of particle k of kLanes yarns, and the
/// lengths of the links to particle k + 1; 0: there is none.
struct alignas(64) YarnRow {
  float rest[kernels::kLanes];
  float inverse_mass[kernels::kLanes];
  float joined[kernels::kLanes];      // the sum of both inverse masses; 0 without a constraint
  float square[kernels::kLanes];      // rest^2; without a constraint so large that no error counts
  float compliance[kernels::kLanes];  // m/N, of springs in small steps; 0: rigid
};
/// The give of the joints of a row, where they may be springs (yarns.h).
struct alignas(64) YarnSpringRow {
  float softness[kernels::kLanes];  // compliance / h^2; 0: rigid, or nothing
  float shift[kernels::kLanes];     // target - rest
  float sum[kernels::kLanes];       // of its impulses in this substep
};
/// Sets joined and square of a block's rows from rest and inverse_mass.
void derive_joints(std::span<YarnRow> rows);

/// Space for further values of a row (yarn_arrays.h): in the linear system, in the
/// scratch of a sweep, of scheme rattle's directions, and of the base.
struct alignas(64) YarnSystemRow {
  float floats[10 * kernels::kLanes];
};
struct alignas(64) YarnScratch {
  float floats[8 * kernels::kLanes];
};
struct alignas(64) YarnDirections {
  float floats[3 * kernels::kLanes];
};
struct alignas(64) YarnBaseSteps {
  std::int32_t words[kernels::kLanes];
};

inline constexpr std::size_t kRowFloats = 3 * kernels::kLanes;  // of the woven layout

/// Rows of a block whose lanes stand in kLanes rows of memory, a column each (yarn_places.h); other
/// places in these are unused. Or a single row whose particles stand anywhere.
struct YarnPatch {
  std::uint32_t place[kernels::kLanes];  // per lane: of its row of memory; single: of its particle
  std::uint32_t row[kernels::kLanes];    // per column: of the block; unused: behind the last
  std::uint32_t columns = 0;             // behind these all are unused
  bool single = false;                   // row[0]
};

/// How the rows of a block find their particles (yarn_places.h).
enum class YarnAccess : std::uint8_t { quads, in_place, patches };

struct YarnBlock {
  std::uint32_t first = 0, last = 0;      // rows
  std::uint32_t lanes = kernels::kLanes;  // that have yarns, the first ones
  YarnAccess access = YarnAccess::quads;
  std::uint32_t place = 0;  // in place: of the first row
  std::uint32_t first_patch = 0, last_patch = 0;
  std::uint32_t patches_ahead = 0;         // behind these: those of the block that comes next
  float compliance[kernels::kLanes] = {};  // per lane, in small steps (small_step_yarns.h)
};

/// A row of the woven layout, | x ... x | y ... y | z ... z |. Each four of its lanes are slots in
/// a row, of which the first `count` are its own; the other lanes are unused.
struct WovenRow {
  static constexpr std::uint32_t kFours = kernels::kLanes / 4;
  std::uint32_t place = 0;
  std::uint32_t four[kFours] = {};
  std::uint8_t count[kFours] = {};
  bool in_a_row = false;  // all kLanes slots are
};

struct Yarns {
  const std::uint32_t* kind = nullptr;  // per row: which of the kinds it is
  const YarnRow* kinds = nullptr;       // rows that are alike share one
  YarnSystemRow* system = nullptr;
  const std::uint32_t* slot = nullptr;  // quads: per row and lane; padding: slots of no particle
  const YarnPatch* patch = nullptr;
  YarnDirections* start = nullptr;  // per row: scheme rattle's directions; null: present ones
  bool velocities = false;          // that is what the system's errors are of
  float* base = nullptr;
  YarnBaseSteps* base_step = nullptr;  // per row: what it remembers of that (yarn_rows.h)
  float cell = 0;                      // that it was split by
  bool moved = false;                  // rows do not remember the present base
  bool from_memory = false;            // positions do not fit the caches
  YarnSpringRow* springs = nullptr;    // per row; null: all joints are rigid
};

/// The eliminated numbers: how t changes lengths; errors besides; or these for the last time.
enum class YarnElimination : std::uint8_t { changes, errors, last };

/// The effect of a watched sweep on a block, and whether its lengths are good enough now.
struct Swept {
  std::uint32_t solves = 0;  // 0: it was left alone
  bool within = true;
};

struct YarnProducts {
  float product = 0;  // residual . z
  float worst = 0;    // largest |residual| / rest; of velocities, largest |residual|
};

}  // namespace weft::simd
