/// The vector kernels, one function pointer per stage, one table per instruction set.
///
/// Precision. Positions and velocities are double. Inside the loop everything is float: what each
/// slot was displaced by since the directions were last renewed, u, and for each constraint
///
///     e = e0 + n . (u_a - u_b)
///
/// with n and e0 computed in double at the renewal and rounded once. Renewing folds u into the
/// positions: iterative refinement, which is what lets float lanes reach 0.001 % and far below.
///
/// Scale. Errors are in tolerances: n and e0 are divided by the constraint's tolerance tau, so that
/// |e| <= 1 is satisfied and no tolerance is loaded. A correction moves the ends by
///
///     u_a += gain_a e n,   u_b += gain_b e n
///     gain_a = -tau^2 w_a / (w_a + w_b),   gain_b = tau^2 w_b / (w_a + w_b)
///
/// Padding constraints have n = 0, e0 = 0 and gains 0: they are satisfied and move nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/impulse_energy.h"
#include "kernels/runs.h"
#include "kernels/simd/isa.h"
#include "kernels/vectors.h"

namespace weft::simd {

using kernels::Run;

/// Displacements of the slots, in one of two layouts; axis k of slot i is x[i * step + k * stride].
///
///     planar, for runs:              | x x x ... | y y y ... | z z z ... |     step 1
///     quads, where all are singles:  | x y z - | x y z - | x y z - | ...       step 4, stride 1
///
/// Quads take 1.0 ns per constraint where planar singles take 2.5; runs take 0.3 (perf/tried.md).
/// Quads are 16-byte aligned.
struct Displacements {
  float* x = nullptr;
  std::size_t stride = 0;
  std::size_t step = 1;

  float* y() const { return x + stride; }
  float* z() const { return x + 2 * stride; }
  bool in_quads() const { return step == 4; }
};

/// Constraints in blocks of kLanes, so that a pass over them is one stream of memory:
///
///     | n.x | n.y | n.z | e0 | gain_a | gain_b |    each kLanes floats, one cache line
///
/// Constraint c is lane c % kLanes of block c / kLanes; runs, and ranges of singles, are whole
/// blocks.
struct alignas(64) ConstraintBlock {
  float nx[kernels::kLanes], ny[kernels::kLanes], nz[kernels::kLanes];  // in 1 / tau
  float e0[kernels::kLanes];                                            // in tau
  float gain_a[kernels::kLanes], gain_b[kernels::kLanes];               // tau^2
};

/// What relaxing a constraint reads and writes.
struct BlockRelaxation {
  Displacements u;
  ConstraintBlock* blocks = nullptr;
  float* impulse = nullptr;          // ropes, contacts: sum of corrections, >= 0 and <= 0;
                                     // springs: since directions were renewed
  const float* yield = nullptr;      // springs (relax_springs.h), per constraint
  const float* held = nullptr;       // springs: sum of corrections before that
  const std::uint32_t* a = nullptr;  // constraint -> slot, for singles
  const std::uint32_t* b = nullptr;
  std::uint64_t* mask = nullptr;  // skipping by masks: per slot, bit = colour
  float threshold = 1;            // 0: correct whatever the error
  bool from_memory = false;       // the blocks do not fit the caches: fetch them ahead
};

/// Memory of the anticipating form (anticipate.h), for Settings::anticipate_products: it is slower
/// in lanes than forming errors from displacements (perf/tried.md). Constraint slots as elsewhere;
/// pulls of block i are first_pull[i] ... first_pull[i + 1] - 1, each kLanes products.
struct Anticipation {
  float* error = nullptr;                      // per constraint
  float* change = nullptr;                     // per constraint: its last correction
  float* sum = nullptr;                        // per constraint: of its corrections
  const std::uint32_t* first_pull = nullptr;   // per block of kLanes constraints
  const std::int32_t* from_run = nullptr;      // per pull: neighbour of lane 0; lane k has + k
  const std::int32_t* from_singles = nullptr;  // per pull and lane
  const float* weight = nullptr;               // per pull and lane
  float* product = nullptr;                    // per pull and lane
  float threshold = 1;
};

/// What renewing directions and measuring strain read.
struct Geometry {
  kernels::VectorsView x;                  // per slot: positions
  const double* rest_length = nullptr;     // per constraint; padding: 1
  const double* inverse_square = nullptr;  // per constraint: 1 / rest^2; padding: 0
  const double* scale = nullptr;           // per constraint: 1 / tau; padding: 0
  const std::uint32_t* a = nullptr;        // constraint -> slot, for singles
  const std::uint32_t* b = nullptr;
};

/// The springs among the constraints of a Geometry, for their energy.
struct SpringStiffness {
  const double* compliance = nullptr;      // m/N; of what is no spring, and of padding: infinite
  const double* inverse_masses = nullptr;  // 1/kg, w_a + w_b
  double give = 0;                         // s^2: it adds give (w_a + w_b) to each compliance
};

/// The particles of a step, per slot; padding slots have inverse mass 0.
struct Motion {
  const double* inverse_mass = nullptr;
  const double* mass = nullptr;
  kernels::Vector gravity{};
  kernels::VectorsView force{};  // x == nullptr: none besides gravity
  kernels::VectorsView position{}, velocity{};
  kernels::VectorsView solved{};
  kernels::VectorsView next_velocity{};
};

/// Rows of a front come in groups of so many, as in AVX-512.
inline constexpr std::size_t kFrontRows = 8;

/// A front of a sparse factorisation (fronts.h). All arrays are 64-byte aligned, the padding of
/// panel and update is 0.
struct Front {
  std::size_t width = 0;          // columns of the panel, a multiple of 4
  std::size_t stride = 0;         // rows of the panel, a multiple of kFrontRows
  std::size_t below = 0;          // the last of them; rows and columns of update
  double* panel = nullptr;        // in: assembled; out: L without its diagonal, 0 above it
  double* update = nullptr;       // in: assembled; out: what is passed on
  const double* least = nullptr;  // per column: a pivot that is no larger is taken as infinite
  double* reciprocal = nullptr;   // per column: 1 / d, or 0
  double* scratch = nullptr;      // as large as panel
};

/// A vector in each lane.
struct alignas(64) LaneVectors {
  float x[kernels::kLanes], y[kernels::kLanes], z[kernels::kLanes];
};

/// What a row of a block of yarns (yarns.h) is like: masses of particle k of kLanes yarns, and the
/// lengths of what joins it to particle k + 1; 0: nothing does.
struct alignas(64) YarnRow {
  float rest[kernels::kLanes];
  float inverse_mass[kernels::kLanes];
  float joined[kernels::kLanes];      // the sum of both inverse masses; 0 without a constraint
  float square[kernels::kLanes];      // rest^2; without a constraint so large that no error counts
  float compliance[kernels::kLanes];  // m/N, of springs in small steps; 0: rigid
};
/// What the joints of a row give way by, where they may be springs (yarns.h).
struct alignas(64) YarnSpringRow {
  float softness[kernels::kLanes];  // compliance / h^2; 0: rigid, or nothing
  float shift[kernels::kLanes];     // target - rest
  float sum[kernels::kLanes];       // of its impulses in this substep
};
/// Sets joined and square of a block's rows from rest and inverse_mass.
void derive_joints(std::span<YarnRow> rows);

/// Room for what kernels have of a row besides (yarn_arrays.h): in the linear system, in the
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

/// Rows of a block whose lanes stand in kLanes rows of memory, a column each (yarn_places.h); what
/// else is in these is nobody's. Or a single row whose particles stand anywhere.
struct YarnPatch {
  std::uint32_t place[kernels::kLanes];  // per lane: of its row of memory; single: of its particle
  std::uint32_t row[kernels::kLanes];    // per column: of the block; nobody's: behind the last
  std::uint32_t columns = 0;             // behind these all are nobody's
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
/// a row, of which the first `count` are its own; the other lanes are nobody's.
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
  bool moved = false;                  // what rows remember is not the present base
  bool from_memory = false;            // positions do not fit the caches
  YarnSpringRow* springs = nullptr;    // per row; null: all joints are rigid
};

/// What is eliminated: how t changes lengths; errors besides; or these for the last time.
enum class YarnElimination : std::uint8_t { changes, errors, last };

/// What a watched sweep did to a block, and whether its lengths are good enough now.
struct Swept {
  std::uint32_t solves = 0;  // 0: it was left alone
  bool within = true;
};

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

/// What is left of a flight between two frames: the velocity in the end, and how it came about in
/// the last substep.
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

/// Of an edge block whose constraints may be springs (reference::ConstraintLaw).
struct alignas(64) SpringBlock {
  float rest[kernels::kLanes];
  float inverse_masses[kernels::kLanes];  // w_a + w_b
  float compliance[kernels::kLanes];      // m/N
};
/// What the laws of a substep have in common (reference::SpringStep, LawStep).
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
/// Bending elements of small steps (bending.h), in blocks of kLanes, of three particles or of four;
/// particles in quads. Padding: spare slots, with weights and shares of 0.
struct alignas(64) BendingBlock {
  std::uint32_t slot[4][kernels::kLanes];
  float weight[3][kernels::kLanes];  // of particles 0, 1 and 3: c_i. That of 2 makes their sum 0
  float share[4][kernels::kLanes];   // w_i c_i / W, W = sum of w_i c_i^2
  float rest[kernels::kLanes];       // m
  float softness[kernels::kLanes];   // compliance / W, s^2
};
struct Bending {
  float* u = nullptr;
  const float* v = nullptr;  // in the beginning of the substep
  const BendingBlock* blocks = nullptr;
  const EdgeSpans* spans = nullptr;  // d of the base
  bool curved = false;               // a rest is not 0
  float own = 1;                     // 1 / omega
  float rate = 0;                    // 1 / (n (b h)^2)
  float damping = 0;                 // tau, s
  float most = 0;                    // 1/s: tau is softness times this at most
  float resolved = 0;                // 1/s^2: what is stiffer has a softness of less than 1 / this
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
  LaneVectors normal, turn;  // when the step begins, and in it; who has none: 0
  float distance[kernels::kLanes], curvature[kernels::kLanes];
};
struct AnchorHold {
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
/// Of a hull: normal and offset, from the origin of the frame, thickness included, where the body
/// is as the substep begins and ends.
struct BodyFace {
  float from[4], to[4];
};
/// A body in a substep. Places are from `origin`, which is near to the cloth.
struct BodyFrame {
  float origin[3];
  const BodyFace* faces = nullptr;
  std::uint32_t face_count = 0;                       // 0: a capsule, as it is in the end
  float a[3], axis[3];                                // where it begins, and its direction
  float length = 0, radius = 0, taper = 0, lean = 0;  // lean: taper / sqrt(1 - taper^2)
  float short_way = 0;                                // m^2: of ways that are looked at in full
  float centre_from[3], way[3], turn[9];              // turn: what rotates, less 1, by columns
  float centre_to[3], velocity[3], spin[3];
  float friction = 0;
};
struct BodyPair {
  std::uint32_t block = 0, body = 0;
};
/// reference::Grip of each lane in the present substep, and what was given to the particles since
/// the search: momentum, its moment about the body, and twice the energy that friction took.
struct alignas(64) BodyGrips {
  float pushed[kernels::kLanes], held[kernels::kLanes];
  float stopped[kernels::kLanes], slowed[kernels::kLanes];
  float came_out[kernels::kLanes];
  LaneVectors linear, angular;
  float friction[kernels::kLanes];
};
struct BodyHold {
  Flight flight{};
  const float* base = nullptr;
  const BodyBlock* blocks = nullptr;
  const BodyPair* pairs = nullptr;
  const BodyFrame* frames = nullptr;
  BodyGrips* grips = nullptr;         // per pair
  std::uint16_t* touching = nullptr;  // per pair, a bit per lane
  std::uint16_t* moved = nullptr;     // likewise: farther than `far`
  std::uint16_t* quick = nullptr;     // likewise: its way is to be looked at in full
  bool woven = false;                 // in woven rows, else in quads
  float rate = 0;                     // of SubstepWeights
  float momentum_share = 1;           // by which a change of velocity counts as momentum
  float h = 0;
};

/// kLanes pairs of features (distances.h): a point and a triangle, or two edges, by their points.
/// Lanes that are not used repeat another one.
struct alignas(64) PairBlock {
  std::uint32_t point[4][kernels::kLanes];
};
/// What is known of pairs when an interval begins.
struct PairMeasure {
  const PairBlock* pairs = nullptr;
  const float* points = nullptr;  // in quads
  const float* ways = nullptr;    // likewise: that the points are expected to take
  float reach = 0;                // m: who may come nearer than this is near
  float beyond = 0;               // of an edge: so far past its ends it may face another one
  float (*distance)[kernels::kLanes] = nullptr;  // written, per block
  std::uint16_t* near = nullptr;                 // written, per block, a bit per lane
};
/// On which side of each other the features of a block are.
struct alignas(64) PairSide {
  LaneVectors normal;  // from the second to the first, as last seen there
  float thickness[kernels::kLanes];
  std::uint32_t used = 0;  // a bit per lane
};
struct PairTouch {
  const PairBlock* pairs = nullptr;
  const float* points = nullptr;
  PairSide* sides = nullptr;
  std::uint16_t* touching = nullptr;  // written: nearer than the thickness, or on the other side
};
/// Whether features may have met between two states.
struct PairMoves {
  const PairBlock* pairs = nullptr;
  const float* moves = nullptr;                        // of the points, in quads
  const float (*distance)[kernels::kLanes] = nullptr;  // in the first state
  float rounding = 0;                                  // m, of the distances
  std::uint16_t* moved = nullptr;                      // written: by more than their distance
};
/// kLanes boxes; of those that are not used `low` is above `high`.
struct alignas(64) BoxCluster {
  float low[3][kernels::kLanes], high[3][kernels::kLanes];
};

struct YarnRelaxation {
  float omega = 1;
  float tolerance = 0;           // as above
  std::uint32_t* out = nullptr;  // per row, a bit per lane, likewise
  float left = 0;                // as above
};

/// Of yarns whose links may be springs, in quads (small_step_springs.h).
struct YarnSpringRelaxation {
  YarnRelaxation yarns;
  float* multiplier = nullptr;  // kg m, per row and lane
  float unit_mass = 1;          // kg, by which rows divide masses
  SpringLaws laws;
};

struct YarnProducts {
  float product = 0;  // residual . z
  float worst = 0;    // largest |residual| / rest; of velocities, largest |residual|
};

/// Sums over a run, in an order that depends on nothing but the run.
struct StrainSums {
  double largest = 0;
  double squares = 0;
};

/// Of (length / rest)^2; most is infinite where one is not finite.
struct StretchRange {
  double least = 1;
  double most = 1;
};

/// Boxes around groups of kBoxed slots, from low to high; one without a particle reaches from
/// infinity to minus infinity. There are count, a multiple of kLanes.
inline constexpr std::size_t kBoxed = 256;
struct Boxes {
  kernels::VectorsView low, high;
  const double* reach = nullptr;  // largest of the group
  std::size_t count = 0;
};

/// Ranges of slots are multiples of kLanes; runs and singles likewise. Kernels for runs take planar
/// displacements.
struct Table {
  /// solved = p + h v + h^2/2 a (paper eq. 2).
  void (*predict)(const Motion&, double h, std::size_t first, std::size_t last);
  /// next_velocity = v + h a + (solved - predicted) / h, predicted formed as in predict. Returns
  /// whether solved and next_velocity are finite.
  bool (*commit)(const Motion&, double h, std::size_t first, std::size_t last);
  /// The same, and the impulses of the range while those of the velocity loop are still 0.
  bool (*commit_watched)(const Motion&, double h, std::size_t first, std::size_t last,
                         kernels::ImpulseEnergy& impulses);
  /// Once velocities are corrected. Both sum in an order that depends on nothing but the range.
  kernels::ImpulseEnergy (*measure_impulses)(const Motion&, double h, std::size_t first,
                                             std::size_t last);
  /// x += u, u = 0.
  void (*apply_displacements)(kernels::VectorsView x, Displacements u, std::size_t first,
                              std::size_t last);

  /// n = (x_a - x_b) / l / tau, e0 = (l - rest) / tau (paper 4.2).
  void (*renew_run)(const Geometry&, const BlockRelaxation&, const Run&);
  void (*renew_singles)(const Geometry&, const BlockRelaxation&, std::uint32_t first,
                        std::uint32_t last);
  /// The same with n at other positions: those at the start of the step (scheme rattle).
  void (*renew_from_start_run)(const Geometry&, kernels::VectorsView start, const BlockRelaxation&,
                               const Run&);
  void (*renew_from_start_singles)(const Geometry&, kernels::VectorsView start,
                                   const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  /// n as above with tau in m/s, e0 = n . (v_a - v_b) (paper 3.3).
  void (*renew_velocity_run)(const Geometry&, kernels::VectorsView v, const BlockRelaxation&,
                             const Run&);
  void (*renew_velocity_singles)(const Geometry&, kernels::VectorsView v, const BlockRelaxation&,
                                 std::uint32_t first, std::uint32_t last);

  /// One pass over constraints of one colour; returns how many were corrected.
  std::uint32_t (*relax_run)(const BlockRelaxation&, const Run&);
  /// The same for many runs, those with wanted[i] == 0 left out (null: none), so that a short run
  /// costs no call. corrections[i] is set for every run.
  void (*relax_runs)(const BlockRelaxation&, const Run* runs, std::size_t count,
                     const std::uint8_t* wanted, std::uint32_t* corrections);
  std::uint32_t (*relax_singles)(const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  std::uint32_t (*relax_rope_run)(const BlockRelaxation&, const Run&);
  std::uint32_t (*relax_rope_singles)(const BlockRelaxation&, std::uint32_t first,
                                      std::uint32_t last);
  /// Constraints that share slots (hubs), one after the other.
  std::uint32_t (*relax_serial)(const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  std::uint32_t (*relax_rope_serial)(const BlockRelaxation&, std::uint32_t first,
                                     std::uint32_t last);
  /// All of these where constraints may be springs.
  std::uint32_t (*relax_spring_run)(const BlockRelaxation&, const Run&, bool rope);
  std::uint32_t (*relax_spring_singles)(const BlockRelaxation&, std::uint32_t first,
                                        std::uint32_t last, bool rope);
  std::uint32_t (*relax_spring_serial)(const BlockRelaxation&, std::uint32_t first,
                                       std::uint32_t last, bool rope);
  /// Contacts of one sphere, the slot a[first]; see contacts.h for their gains.
  std::uint32_t (*relax_contacts)(const BlockRelaxation&, std::uint32_t first, std::uint32_t last);
  /// The same with the paper's masks (4.3): lanes whose bit is clear at both ends are passed over,
  /// whole vectors at once. `visits` counts the lanes looked at.
  std::uint32_t (*relax_masked_run)(const BlockRelaxation&, const Run&, std::uint64_t bit,
                                    std::uint64_t& visits);

  /// The anticipating form. renew_products starts afresh: error = e0, no changes.
  void (*renew_products_run)(const Anticipation&, const BlockRelaxation&, const Run&);
  void (*renew_products_singles)(const Anticipation&, const BlockRelaxation&, std::uint32_t first,
                                 std::uint32_t last);
  std::uint32_t (*relax_anticipated_run)(const Anticipation&, const Run&);
  std::uint32_t (*relax_anticipated_singles)(const Anticipation&, std::uint32_t first,
                                             std::uint32_t last);
  /// u_a += gain_a sum n, u_b += gain_b sum n, sum = 0.
  void (*apply_sums_run)(const Anticipation&, const BlockRelaxation&, const Run&);
  void (*apply_sums_singles)(const Anticipation&, const BlockRelaxation&, std::uint32_t first,
                             std::uint32_t last);
  /// error = e0 + n . (u_a - u_b), change = 0.
  void (*refresh_errors_run)(const Anticipation&, const BlockRelaxation&, const Run&);
  void (*refresh_errors_singles)(const Anticipation&, const BlockRelaxation&, std::uint32_t first,
                                 std::uint32_t last);

  /// base = x in whole cells, a power of two (0: none), rounded to float, u = x - base; and x moved
  /// to base + u. Of slots first ... last - 1, in quads.
  void (*split_quads)(kernels::VectorsView x, std::size_t first, std::size_t last, double cell,
                      float* base, float* u);
  void (*join_quads)(kernels::VectorsView x, std::size_t first, std::size_t last, const float* base,
                     const float* u);
  /// The same of woven rows.
  void (*split_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count, double cell,
                     float* base, float* u);
  void (*join_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count,
                    const float* base, const float* u);
  /// u = x - base.
  void (*offset_quads)(kernels::VectorsView x, std::size_t first, std::size_t last,
                       const float* base, float* u);
  void (*offset_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count,
                      const float* base, float* u);
  /// to = x, rounded to float; and x = from.
  void (*narrow_quads)(kernels::VectorsView x, std::size_t first, std::size_t last, float* to);
  void (*narrow_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count, float* to);
  void (*widen_quads)(kernels::VectorsView x, std::size_t first, std::size_t last,
                      const float* from);
  void (*widen_rows)(kernels::VectorsView x, const WovenRow* rows, std::size_t count,
                     const float* from);
  // Of yarns. scratch: one row more than the block has; for patches twice that (scratch_rows()).
  /// start = the directions at base + u.
  void (*yarn_keep_start)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  /// Solves the yarns of a block.
  void (*yarn_sweep)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  /// The same along present directions, unless all lengths are far within the share `enough`; and
  /// again until they are within it, at most `most` times.
  Swept (*yarn_sweep_watched)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                              float enough, std::uint32_t most);
  /// Conjugate gradients (yarn_system.h) over all yarns, or all but those of the first family,
  /// which is eliminated; what writes t goes family by family.
  void (*yarn_linearise)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  /// The velocities base + u become the right side; returns the largest.
  float (*yarn_read)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch);
  YarnProducts (*yarn_precondition)(const Yarns&, const YarnBlock&, float alpha);
  void (*yarn_push_first)(const Yarns&, const YarnBlock&, float beta, float* t,
                          YarnScratch* scratch);
  void (*yarn_push)(const Yarns&, const YarnBlock&, float beta, float* t, YarnScratch* scratch);
  /// The block's impulses take what t changes its lengths by out of t again; with errors, those
  /// too.
  void (*yarn_eliminate)(const Yarns&, const YarnBlock&, float* t, YarnElimination,
                         YarnScratch* scratch);
  float (*yarn_pull)(const Yarns&, const YarnBlock&, float* t, YarnScratch* scratch);
  void (*yarn_finish)(const Yarns&, const YarnBlock&, float* t, YarnScratch* scratch);
  /// u += t, of the floats first ... last - 1, multiples of kLanes.
  void (*yarn_add)(float* u, const float* t, std::size_t first, std::size_t last);

  // Small steps (small_steps.h), of the floats first ... last - 1, multiples of kLanes.
  void (*advance)(const Flight&, const SubstepWeights&, std::size_t first, std::size_t last);
  /// Returns the largest component of the departure of the last substep (reference::departure()).
  float (*advance_measured)(const Flight&, const SubstepWeights&, std::size_t first,
                            std::size_t last);
  /// v becomes the velocity, predicted u; returns the same.
  float (*settle)(const Flight&, const LastSubstep&, std::size_t first, std::size_t last);
  /// The largest |u - u_before|.
  float (*largest_move)(const Flight&, std::size_t first, std::size_t last);
  /// Begins a frame at u with the velocities v, which need not be the past's; h: of its last
  /// substep.
  void (*resume)(const Flight&, const Past&, float h, std::size_t first, std::size_t last);
  void (*keep_past)(const Flight&, const Past&, std::size_t first, std::size_t last);
  /// Gain and energy alone of the impulses, of a frame from position and velocity to solved and
  /// next_velocity; of slots first ... last - 1.
  kernels::ImpulseEnergy (*measure_energy_change)(const Motion&, std::size_t first,
                                                  std::size_t last);
  void (*renew_base)(const Flight&, float* base, float cell, std::size_t first, std::size_t last);
  // Of blocks first ... last - 1.
  void (*measure_edges)(const EdgeBlock*, EdgeSpans*, const float* base, std::size_t first,
                        std::size_t last);
  void (*relax_distances)(const EdgeRelaxation&, std::size_t first, std::size_t last);
  void (*relax_ropes)(const EdgeRelaxation&, std::size_t first, std::size_t last);
  void (*relax_springs)(const SpringRelaxation&, bool rope, std::size_t first, std::size_t last);
  /// Sets `out` to the constraints that break their laws by more than the tolerance.
  void (*judge_springs)(const SpringRelaxation&, bool rope, std::size_t first, std::size_t last);
  void (*measure_bending)(const BendingBlock*, EdgeSpans*, const float* base, bool four,
                          std::size_t first, std::size_t last);
  void (*bend)(const Bending&, bool four, std::size_t first, std::size_t last);
  /// J, of each block; stiffness: 1 / compliance per block and lane.
  void (*bending_energy)(const Bending&, const float* stiffness, double* energy, bool four,
                         std::size_t first, std::size_t last);
  void (*measure_membrane)(const MembraneBlock*, MembraneSpans*, const float* base,
                           std::size_t first, std::size_t last);
  /// continues: from the multipliers, else from none.
  void (*relax_membrane)(const Membrane&, float omega, bool continues, bool rope, std::size_t first,
                         std::size_t last);
  /// out: per block, a bit per lane: whether a law is broken by more than `strain`.
  void (*judge_membrane)(const Membrane&, float strain, std::uint16_t* out, bool rope,
                         std::size_t first, std::size_t last);
  void (*hold_anchors)(const AnchorHold&, std::size_t first, std::size_t last);
  /// Of pairs first ... last - 1.
  void (*grip_bodies)(const BodyHold&, std::size_t first, std::size_t last);
  /// m, by which the deepest is under a surface; at least 0.
  float (*deepest_in_bodies)(const BodyHold&, std::size_t first, std::size_t last);
  /// Of blocks first ... last - 1. edges: pairs of edges, else of a point and a triangle.
  void (*measure_pairs)(const PairMeasure&, bool edges, std::size_t first, std::size_t last);
  void (*touch_pairs)(const PairTouch&, bool edges, std::size_t first, std::size_t last);
  void (*find_moved_pairs)(const PairMoves&, bool edges, std::size_t first, std::size_t last);
  /// Which of the boxes the one from low to high meets, a bit each.
  std::uint32_t (*find_met)(const BoxCluster&, const float* low, const float* high);
  /// Scratch as above.
  void (*relax_yarns)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                      const YarnRelaxation&);
  void (*relax_spring_yarns)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                             const YarnSpringRelaxation&);
  /// As judge_springs.
  void (*judge_spring_yarns)(const Yarns&, const YarnBlock&, float* u, YarnScratch* scratch,
                             const YarnSpringRelaxation&);

  StrainSums (*strain_run)(const Geometry&, const Run&, bool rope);
  StrainSums (*strain_singles)(const Geometry&, std::uint32_t first, std::uint32_t last, bool rope);
  /// J, of the springs of a run or of singles.
  double (*spring_energy_run)(const Geometry&, const SpringStiffness&, const Run&, bool rope);
  double (*spring_energy_singles)(const Geometry&, const SpringStiffness&, std::uint32_t first,
                                  std::uint32_t last, bool rope);
  StretchRange (*stretch_runs)(const Geometry&, const Run*, std::size_t count, bool rope);
  StretchRange (*stretch_singles)(const Geometry&, std::uint32_t first, std::uint32_t last,
                                  bool rope);

  /// Eliminates a front's columns; reciprocal, scratch and update are written too.
  void (*eliminate_front)(const Front&);
  /// Substitutions with one front, z having its rows; panel and reciprocal are read.
  void (*solve_front_forward)(const Front&, double* z);
  void (*solve_front_backward)(const Front&, double* z);

  /// Boxes grow to hold what has mass.
  void (*bound)(kernels::VectorsView x, const double* mass, std::size_t slots, const Boxes&);
  /// Which boxes may hold something nearer to the box from low to high than reach[box] + extra;
  /// writes their indices, returns how many.
  std::size_t (*find_boxes)(const Boxes&, kernels::Vector low, kernels::Vector high, double extra,
                            std::uint32_t* out);
  /// Likewise those of the slots first ... last - 1 that are nearer to the centre than reach[slot]
  /// + extra.
  std::size_t (*find_near)(kernels::VectorsView x, const double* reach, kernels::Vector centre,
                           double extra, std::size_t first, std::size_t last, std::uint32_t* out);
  /// Likewise those that have moved, beside `along`, by more than part (reach[slot] + extra).
  std::size_t (*find_moved)(kernels::VectorsView before, kernels::VectorsView after,
                            kernels::Vector along, const double* reach, double extra, double part,
                            std::size_t first, std::size_t last, std::uint32_t* out);
};

/// The isa must be supported.
const Table& table(Isa isa);

// Of these a library has those of its processor (on_x86_64.cpp, on_aarch64.cpp).
extern const Table kSse2Table, kAvx2Table, kAvx512Table, kNeonTable;

}  // namespace weft::simd
