/// Data of the kernels of small steps: particles in flight, edges, springs, bending elements and
/// triangles of fabric.
#pragma once

#include <cstdint>

#include "kernels/runs.h"
#include "kernels/simd/lane_vectors.h"

namespace weft::simd {

/// Particles in flight (small_steps.h): arrays of floats, all laid out as displacements u are.
struct Flight {
  float* u = nullptr;
  float* u_before = nullptr;            // a substep ago
  float* predicted = nullptr;           // u, before constraints were relaxed
  float* v = nullptr;                   // predicted; after settle() it is the velocity
  float* v_before = nullptr;            // a substep ago
  const float* acceleration = nullptr;  // of what is fixed: 0
  /// Where motion has led, from which velocities follow: u, or u before it was mended. Mending
  /// moves particles and is no motion.
  float* led_to = nullptr;

  bool is_mended() const { return led_to != u; }
};

/// The past of a flight between two frames: the velocity in the end, and how it came about in the
/// last substep.
struct Past {
  float* v = nullptr;
  float* v_before = nullptr;
  float* moved = nullptr;  // u - u_before
};

/// The substep that has been solved: what its velocity follows from, and its departure.
struct LastSubstep {
  float step = 0;   // b h, of which accelerations acted for a share where motion decays
  float rate = 0;   // 1 / (b h); 0: there was none in this frame, and v is the velocity
  float slope = 0;  // r / c; 0 where c is
};

struct SubstepWeights {
  float past = 0;  // c, of what the last substep changed
  float step = 0;  // b h
  float push = 0;  // b h, of which accelerations act for a share where motion decays
  LastSubstep last;
};

/// Edges that small steps relax one by one, in blocks of kLanes; particles in quads. Padding has
/// shares of 0.
struct alignas(64) EdgeBlock {
  std::uint32_t a[kernels::kLanes], b[kernels::kLanes];      // slots
  float share_a[kernels::kLanes], share_b[kernels::kLanes];  // w_a / (w_a + w_b), w_b / ...
  float square[kernels::kLanes];                             // rest^2; padding: 1
};
/// From b to a, of the base.
struct alignas(64) EdgeSpans {
  float x[kernels::kLanes], y[kernels::kLanes], z[kernels::kLanes];
};
struct EdgeRelaxation {
  float* u = nullptr;
  const EdgeBlock* blocks = nullptr;
  const EdgeSpans* spans = nullptr;
  std::uint16_t* out = nullptr;  // per block, a bit per lane: was out of tolerance
  float omega = 1;
  float tolerance = 0;  // of l^2 / rest^2 - 1
  float left = 0;       // of the same: errors up to here are left, and larger ones taken to it
};

/// The laws of an edge block whose constraints may be springs (reference::ConstraintLaw).
struct alignas(64) SpringBlock {
  float rest[kernels::kLanes];
  float inverse_masses[kernels::kLanes];  // w_a + w_b
  float compliance[kernels::kLanes];      // m/N
};
/// The common numbers of the laws of a substep (reference::SpringStep, LawStep).
struct SpringLaws {
  const float* u_start = nullptr;  // when the substep began
  float scale = 0;                 // 1 / (b h)^2, 1/s^2
  float damping = 0;               // (time constant) / h
  float most_compliance = 0;       // m/N, of a constraint that takes part
  float strain = 0;                // tolerance of a law, over rest
  bool continues = false;          // from the multipliers; else from none
};
struct SpringRelaxation {
  EdgeRelaxation edges;
  const SpringBlock* springs = nullptr;
  float* multiplier = nullptr;  // per block and lane
  SpringLaws laws;
};
/// Bending elements of small steps (bending.h), in blocks of kLanes, of three particles or of four,
/// which stand as their arms have them; particles in quads. The fourth of three is the particle
/// beside, or the middle and a third weight of 1. Padding: spare slots, with weights and a
/// stiffness of 0.
struct alignas(64) BendingBlock {
  std::uint32_t slot[4][kernels::kLanes];
  float weight[3][kernels::kLanes];  // of particles 0, 1 and 3: c_i. That of 2 makes their sum 0
  float rest[kernels::kLanes];       // m
  float stiffness[kernels::kLanes];  // k = 1 / compliance, N/m
  float softness[kernels::kLanes];   // compliance / W, W = sum of w_i c_i^2, s^2
};
/// By how much hinges of four particles are folded at rest, m, and which of them may yield: 1, or
/// 0.
struct alignas(64) BendingFolds {
  float fold[kernels::kLanes];
  float yields[kernels::kLanes];
};
/// Per block, what is measured of the base. Arms serve damping, the first of them and `sides`
/// hinges that are folded at rest: without these they are null.
struct BendingSpans {
  EdgeSpans* d = nullptr;
  EdgeSpans* along = nullptr;
  EdgeSpans* across = nullptr;
  EdgeSpans* sides = nullptr;
};
struct Bending {
  const float* u = nullptr;
  const float* start = nullptr;  // u when the substep began, of the same base
  const BendingBlock* blocks = nullptr;
  BendingSpans spans;
  const BendingFolds* folds = nullptr;  // per block; null: there are none
  bool curved = false;                  // a rest is not 0
  bool yields = false;                  // a hinge may yield
  float damping = 0;                    // tau / h
  float resolved = 0;  // 1/s^2: what is stiffer has a softness of less than 1 / this
};

/// Triangles of fabric (membrane.h), in blocks of kLanes, of one kind each; particles in quads.
/// Padding: spare slots, and zeros.
struct alignas(64) MembraneBlock {
  std::uint32_t place[3][kernels::kLanes];  // of the corners' quads: 4 slot
  float u[2][kernels::kLanes];              // 1/m, weights of corners 1 and 2 along the warp
  float v[2][kernels::kLanes];        // likewise along the weft; those of corner 0 make sums 0
  float share_u[3][kernels::kLanes];  // m, w_k u_k / W
  float share_v[3][kernels::kLanes];
  float mobility[3][kernels::kLanes];   // W_uu, W_uv and W_vv, over W
  float stiffness[3][kernels::kLanes];  // of warp, weft and shear: k A W, 1/s^2
};
/// The deformation of the base.
struct alignas(64) MembraneSpans {
  LaneVectors u, v;
};
struct Membrane {
  float* u = nullptr;
  const float* u_start = nullptr;  // when the substep began
  const MembraneBlock* blocks = nullptr;
  const MembraneSpans* spans = nullptr;
  float* multiplier = nullptr;  // per block: of warp, weft and shear, kLanes each; times W
  float give = 0;               // (b h)^2
  float damping = 0;            // (time constant) / h
};

struct YarnRelaxation {
  float omega = 1;
  float tolerance = 0;           // as of EdgeRelaxation
  std::uint32_t* out = nullptr;  // per row, a bit per lane, likewise
  float left = 0;                // as above
};

/// The relaxation of yarns whose links may be springs, in quads (small_step_springs.h).
struct YarnSpringRelaxation {
  YarnRelaxation yarns;
  float* multiplier = nullptr;  // kg m, per row and lane
  float unit_mass = 1;          // kg, by which rows divide masses
  SpringLaws laws;
};

}  // namespace weft::simd
