/// The data that contact kernels (contacts.h) read and write.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/runs.h"
#include "kernels/simd/isa.h"
#include "kernels/simd/lane_vectors.h"
#include "kernels/simd/star_data.h"

namespace weft::simd {

/// kLanes contacts of one kind, a point and a triangle or two edges. No point is in two of them.
/// Points are numbered as quads of places and moves are. A lane that is not used has a point of its
/// own.
struct alignas(64) ContactBlock {
  std::uint32_t point[4][kernels::kLanes];
  /// Third corners of the faces beside a feature. For edges: those of both faces of the first edge,
  /// then of the second; where there is no face a corner of the edge. For a triangle: those across
  /// its sides; at a border its own third corner, since beyond a border the triangle counts as
  /// going on.
  std::uint32_t beside[4][kernels::kLanes];
  /// For a triangle: 1, at borders -1. For edges, the first: so far off their ends they touch, as a
  /// share of their lengths.
  float towards[3][kernels::kLanes];
  float thickness[kernels::kLanes];  // m
  float friction[kernels::kLanes];   // Coulomb's coefficient
  // Frozen for a substep:
  float weight[4][kernels::kLanes];
  LaneVectors normal;            // a unit vector from the second feature to the first
  float gap[kernels::kLanes];    // m, over the target when the substep begins
  float slack[kernels::kLanes];  // 1/kg: the compliance
  float give[kernels::kLanes];   // kg: a multiplier for a way; 0: the contact is a neighbour's
  // Accumulated:
  float push[kernels::kLanes];    // kg m, along the normal
  LaneVectors hold;               // kg m, by friction
  float before[kernels::kLanes];  // kg m, along the normal in the last substep
};

struct ContactFreeze {
  ContactBlock* blocks = nullptr;
  const float* places = nullptr;  // quads: where points begin, and their inverse masses
  float rounding = 0;             // m, of places: what is nearer keeps its normal
  float warm = 0;                 // multipliers begin with so much of the last ones
  float recovery = 0;             // of what is missing of the thickness so much comes out
};

struct ContactSolve {
  ContactBlock* blocks = nullptr;
  float* moves = nullptr;  // quads: since the substep began, and inverse masses
};

struct ContactKernels {
  /// Freezes blocks first ... last - 1.
  void (*freeze)(const ContactFreeze&, bool edges, std::size_t first, std::size_t last);
  /// Adds what the multipliers move, of these blocks.
  void (*start)(const ContactSolve&, const std::uint32_t* blocks, std::size_t count);
  /// One visit of each.
  void (*visit)(const ContactSolve&, const std::uint32_t* blocks, std::size_t count);
  /// Sets a bit per lane in blocks first ... last - 1 for contacts that push, and unless `pushing`
  /// also for those that are nearer than their targets.
  void (*find_active)(const ContactSolve&, bool pushing, std::uint16_t* active, std::size_t first,
                      std::size_t last);
  /// Turns triangles first ... last - 1: threads may do others at a time.
  void (*turn_triangles)(const TriangleTurns&, std::size_t first, std::size_t last);
  /// Finds stars in blocks first ... last - 1 with a triangle that does not face their direction.
  void (*find_folded_stars)(const StarFold&, std::size_t first, std::size_t last);
};

}  // namespace weft::simd
