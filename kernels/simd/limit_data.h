/// Data of the kernels of anchors and bodies in small steps.
#pragma once

#include <cstdint>

#include "kernels/runs.h"
#include "kernels/simd/lane_vectors.h"
#include "kernels/simd/small_step_data.h"

namespace weft::reference {
struct BodyMotion;
}

namespace weft::simd {

/// Anchors (anchors.h) of kLanes particles that stand in a row of memory; those without one have an
/// infinite `most`.
struct alignas(64) AnchorBlock {
  LaneVectors point;            // when the step begins, from the base of the particle
  LaneVectors way;              // in the step
  float most[kernels::kLanes];  // m
  float far[kernels::kLanes];   // m^2: of a motion, beyond which its constraints are looked at
  std::uint32_t place = 0;      // of the first
  std::int32_t backstop = -1;   // its block of these, or none
};
struct alignas(64) BackstopBlock {
  LaneVectors normal, turn;  // when the step begins, and in it; 0 without one
  float distance[kernels::kLanes], curvature[kernels::kLanes];
};
struct AnchorSolve {
  Flight flight{};
  const AnchorBlock* blocks = nullptr;
  const BackstopBlock* backstops = nullptr;
  std::uint16_t* at_limit = nullptr;  // per block, a bit per lane
  std::uint16_t* moved = nullptr;     // likewise: farther than `far`
  bool woven = false;                 // in woven rows, else in quads
  float rate = 0;                     // of SubstepWeights
  float share = 0;                    // of the step that is over
  float per_second = 0;               // 1 / its length
};

/// Particles that may touch bodies (bodies.h): kLanes that stand in a row of memory.
struct alignas(64) BodyBlock {
  float mass[kernels::kLanes];    // kg; 0: not free
  float radius[kernels::kLanes];  // m
  float far[kernels::kLanes];     // m^2: of a motion, beyond which its constraints are looked at
  std::uint32_t place = 0;        // of the first
};
/// A face of a hull: normal and offset, from the origin of the frame, thickness included, where the
/// body is as the substep begins and ends.
struct BodyFace {
  float from[4], to[4];
};
/// How lanes find the gap of a body; not of a field (fields.h).
enum class BodyKind : std::uint8_t { plane, hull, round, field };

/// A body in a substep. Places are from `origin`, which is near to the cloth.
struct BodyFrame {
  float origin[3];
  BodyKind kind = BodyKind::field;
  const reference::BodyMotion* motion = nullptr;  // of a field
  const BodyFace* faces = nullptr;
  std::uint32_t face_count = 0;
  // A round form, as it is in the end: where it begins, and its direction.
  float a[3], axis[3];
  float length = 0, radius = 0, taper = 0, lean = 0;  // lean: taper / sqrt(1 - taper^2)
  float short_way = 0;  // m^2: of ways that are looked at in full, beside a round form
  float centre_from[3], way[3], turn[9];  // turn: a rotation, less 1, by columns
  float centre_to[3], velocity[3], spin[3];
  float friction = 0;
};
struct BodyPair {
  std::uint32_t block = 0, body = 0;
};
/// reference::ContactSums of each lane in the present substep, and the sums for particles since the
/// search: momentum, its moment about the body, and twice the energy that friction took.
struct alignas(64) BodyContactSums {
  float pushed[kernels::kLanes], held[kernels::kLanes];
  float stopped[kernels::kLanes], slowed[kernels::kLanes];
  float came_out[kernels::kLanes];
  float thinned_by[kernels::kLanes], retreat[kernels::kLanes];
  LaneVectors linear, angular;
  float friction[kernels::kLanes];
};
struct BodySolve {
  Flight flight{};
  const float* base = nullptr;
  const BodyBlock* blocks = nullptr;
  const BodyPair* pairs = nullptr;
  const BodyFrame* frames = nullptr;
  BodyContactSums* sums = nullptr;    // per pair
  std::uint16_t* touching = nullptr;  // per pair, a bit per lane
  std::uint16_t* moved = nullptr;     // likewise: farther than `far`
  std::uint16_t* quick = nullptr;     // likewise: its way is to be looked at in full
  bool woven = false;                 // in woven rows, else in quads
  float rate = 0;                     // of SubstepWeights
  float momentum_share = 1;           // by which a change of velocity counts as momentum
  float h = 0;
  const float* spared = nullptr;  // m, per pair and lane: of the depth that is measured
};

}  // namespace weft::simd
