/// The immutable part of a cloth: particles, and the elements that join them. Any number of Cloths
/// share it; one that is changed goes on with another model (engine/model/change.h).
///
/// Inside the engine particles are numbered by slot (engine/ordering/ordering.h); the description's
/// numbers appear only at the interface.
#pragma once

#include <weft/weft.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "engine/hypotenuse.h"
#include "engine/lists.h"
#include "engine/model/on_demand.h"
#include "engine/model/unevenness.h"
#include "engine/ordering/ordering.h"
#include "engine/triangles/triangle_surface.h"
#include "kernels/reference/anchors.h"
#include "kernels/reference/membrane.h"
#include "kernels/vectors.h"

namespace weft {

struct ChunkNeighbours;
struct BendingFronts;
struct DirectLayout;
struct PullLayout;
struct ReferenceLayout;
struct SimdLayout;
struct SmallStepsLayout;
struct YarnLayout;

/// The active constraints in solver order; within each range in the order of the batches:
///
///   [0, plain)          distance, no hub at either end
///   [plain, bilateral)  distance, at a hub
///   [bilateral, size)   ropes
///
/// A hub is a particle of more than kHubDegree constraints, or a sphere. A held particle does
/// not move, so that its distances need no turns among its ropes: it counts as a hub by its
/// distances alone. Cloth whose particles all have a rope to their pin hangs on it by its yarns
/// as before.
struct ConstraintStore {
  std::size_t plain = 0, bilateral = 0;
  std::vector<std::uint32_t> a, b;  // slots
  kernels::AlignedVector<double> rest_length;
  kernels::AlignedVector<double> effective_mass;  // 1 / (w_a + w_b), kg
  /// m/N, 0: rigid; empty where all are, but see Model::leave_out_compliances().
  kernels::AlignedVector<double> compliance;
  std::vector<double> strength;          // N; empty where none breaks
  std::vector<std::uint32_t> colour;     // unique at a particle, hubs left out
  std::vector<std::uint32_t> described;  // index in the description
  std::vector<std::uint32_t> slot;       // constraint slot; kNoIndex: at a hub
  std::vector<std::uint32_t> hub_distances, hub_ropes;
  std::vector<bool> turned;  // a is the description's b
  std::size_t size() const { return a.size(); }
  bool has_springs() const { return !compliance.empty(); }
  /// m/N. Softer than this a spring of cloth does not exist, and floats hold its softness.
  float compliance_in_lanes(std::size_t c) const {
    constexpr double kSoftest = 1e6;
    return static_cast<float>(has_springs() ? std::min(compliance[c], kSoftest) : 0);
  }
  std::size_t bytes() const;
};

/// Bending elements (weft.h) in the order of the description, those between fixed particles alone
/// left out. Where there are three particles the fourth is the third again, with weight 0.
struct BendingStore {
  /// As a BendingElement has them.
  struct Yielding {
    double yield, hardening, arm;
  };
  std::vector<std::array<std::uint32_t, 4>> slots;
  std::vector<std::array<double, 4>> weights;
  std::vector<double> rest, compliance, fold;
  std::vector<Yielding> yielding;        // empty where all have the defaults
  std::vector<std::uint32_t> described;  // index in the description; empty likewise
  std::size_t size() const { return slots.size(); }
  bool is_folded() const;
  bool may_yield() const { return !yielding.empty(); }
  bool yields(std::size_t i) const {
    return may_yield() && yielding[i].yield < std::numeric_limits<double>::infinity();
  }
  std::size_t bytes() const;
};

/// Triangles of fabric (weft.h) in the order of the description, those between fixed particles
/// alone left out.
struct MembraneStore {
  std::vector<std::array<std::uint32_t, 3>> slots;
  std::vector<std::array<std::array<double, 2>, 3>> rest;
  std::vector<reference::MembraneElement> element;
  std::vector<std::uint32_t> described;  // index in the description
  std::vector<double> strength;          // N/m; empty where none tears
  std::size_t size() const { return slots.size(); }
  std::size_t bytes() const;
  /// work(slot, slot, length at rest) for each side of each triangle.
  template <class Work>
  void for_each_side(Work&& work) const {
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto &from = rest[i][k], &to = rest[i][(k + 1) % 3];
        work(slots[i][k], slots[i][(k + 1) % 3], hypotenuse(to[0] - from[0], to[1] - from[1]));
      }
    }
  }
};

/// Triangles subject to drag and lift, between slots, and coefficients of the air (weft.h).
struct AirStore {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Lists at;                          // per slot: its triangles
  std::vector<std::uint32_t> piece;  // of each triangle; with ram only
  std::vector<bool> is_open;         // of each piece: it has a border
  double density = 0, drag = 0, lift = 0, ram = 0;
  kernels::Vector wind{};
};

/// Elements that lie between fixed particles alone and wait for one of them to be released, and
/// those that are broken: numbers and text of the description, in its order.
struct InertStore {
  template <class T>
  struct Entry {
    std::uint32_t described = 0;
    T entry;
  };
  std::vector<Entry<Constraint>> constraints;
  std::vector<Entry<MembraneElement>> membrane;
  std::vector<Entry<BendingElement>> bending;
  std::size_t bytes() const;
};

/// Anchors (weft.h) in the order of the description, and behind them tethers that act: anchors
/// whose point is a pin.
struct AnchorStore {
  std::vector<std::uint32_t> slot;
  std::vector<reference::AnchorLimits> limits;
  std::vector<Anchor> described;
  std::vector<std::uint32_t> pins;  // slots, of the tethers
  std::vector<std::uint32_t> at;    // per slot: its anchor, or kNoIndex; empty without anchors
  std::size_t size() const { return slot.size(); }
  std::size_t bytes() const;
};

/// Seams (weft.h) in the order of the description.
struct SeamStore {
  std::vector<std::uint32_t> a, b;            // slots
  std::vector<double> time, force, strength;  // s, N, N
  std::size_t size() const { return a.size(); }
  bool is_broken(std::size_t i) const { return strength[i] == 0; }
  bool may_break(std::size_t i) const {
    return strength[i] > 0 && strength[i] < std::numeric_limits<double>::infinity();
  }
  std::size_t bytes() const;
};

/// Sliders (weft.h) in the order of the description, and their rails.
struct SliderStore {
  std::vector<std::uint32_t> slot, first, last;
  std::vector<double> friction;
  std::vector<std::uint32_t> rail;  // slots of rail_particles
  std::size_t size() const { return slot.size(); }
  std::uint32_t pieces(std::size_t i) const { return last[i] - first[i]; }
  bool is_closed(std::size_t i) const { return rail[first[i]] == rail[last[i]]; }
  /// The ends of a piece, and the particles before and behind; of a rail that ends there the end.
  std::array<std::uint32_t, 4> around(std::size_t i, std::uint32_t piece) const {
    const std::uint32_t a = first[i] + piece, b = a + 1;
    const std::uint32_t before = a > first[i] ? a - 1 : is_closed(i) ? last[i] - 1 : a;
    const std::uint32_t behind = b < last[i] ? b + 1 : is_closed(i) ? first[i] + 1 : b;
    return {rail[before], rail[a], rail[b], rail[behind]};
  }
  std::size_t bytes() const;
};

/// Links of the first `count` constraints, between slots.
std::vector<Link> links_of(const ConstraintStore& store, std::size_t count);

/// With the normal's length 1.
reference::AnchorPose pose_of(Vec3 point, Vec3 normal);

class Model {
 public:
  /// The description must be valid. like: a model of the same particles and constraints, which
  /// differ in numbers at most; it saves work.
  /// One of more particles: a torn one.
  explicit Model(const SceneDescription& description, const Model* like = nullptr);
  /// Another one that shares what backends and solvers need, until it is changed by the two below.
  Model(const Model&) = default;
  Model& operator=(const Model&) = delete;
  void set_bending_compliances(std::span<const ChangedValue> compliances);
  void set_air(const ChangedAir& air);

  std::size_t particles = 0;  // described
  Ordering ordering;
  std::uint32_t spare_slots = 0;  // first of kLanes padding slots that no batch uses
  std::size_t slots() const { return ordering.slots(); }

  // Per slot; padding: at the origin, without mass and fixed.
  kernels::Vectors initial_position, initial_velocity;
  kernels::AlignedVector<double> mass, inverse_mass;  // inverse_mass 0: fixed, or attached
  kernels::AlignedVector<double> radius;              // empty without spheres
  std::vector<std::uint8_t> hub;
  std::vector<std::uint32_t> hubs;
  std::vector<std::uint32_t> pins;      // the fixed particles
  std::vector<std::uint32_t> holds;     // fixed ends of each constraint and each triangle of fabric
  std::vector<std::uint32_t> spheres;   // in ascending order
  std::vector<std::uint8_t> is_sphere;  // empty without spheres

  kernels::Vector gravity{};
  double friction = 0;  // of the cloth beside bodies
  SelfContact self_contact;
  ConstraintStore constraints;
  MembraneStore membrane;
  BendingStore bending;
  AnchorStore anchors;
  SeamStore seams;
  SliderStore sliders;
  std::vector<Tether> tethers;  // as described
  double tether_slack = 0;
  std::vector<std::array<std::uint32_t, 3>> surface;  // triangles, between slots
  AirStore air;
  std::vector<Pressure> pressures;  // of triangles of `surface`; volumes of gas are known
  Damping damping;
  Unevenness uneven;
  double heaviest_sphere = 0;  // kg, of the free ones
  InertStore inert;
  /// One object for a model and all that changes (engine/model/change.h) and tears make of it.
  std::shared_ptr<const int> origin;
  /// Only where the model was torn (engine/model/tear.h): for each particle that the one before did
  /// not have, the particle that it was split from.
  std::vector<std::uint32_t> split_from;
  std::uint32_t tears = 0;  // since `origin`
  bool may_tear = false;    // anything has a strength and is not broken

  /// Whether an anchor holds the particle as if it were fixed: it has no limit to move within.
  bool is_attached(std::uint32_t slot) const {
    const std::uint32_t anchor = anchors.at.empty() ? kNoIndex : anchors.at[slot];
    return anchor != kNoIndex && anchors.limits[anchor].most == 0;
  }
  bool has_attached() const {
    for (const reference::AnchorLimits& limits : anchors.limits) {
      if (limits.most == 0) return true;
    }
    return false;
  }
  /// Whether anything obeys a law with a compliance: springs or triangles of fabric.
  bool has_laws() const { return constraints.has_springs() || membrane.size() > 0; }
  bool has_spheres() const { return !spheres.empty(); }
  /// Whether the particle has one; a tether is none.
  bool has_anchor(std::uint32_t particle) const {
    return !anchors.at.empty() && anchors.at[ordering.slot_of[particle]] < anchors.described.size();
  }
  bool has_air() const {
    return !air.triangles.empty() && air.density > 0 &&
           (air.drag > 0 || air.lift > 0 || air.ram > 0);
  }
  /// Whether the air presses on pieces of the cloth.
  bool has_ram() const { return has_air() && air.ram > 0; }
  /// Whether a constraint or a triangle of fabric joins the two; slots.
  bool joined_to_sphere(std::uint32_t sphere, std::uint32_t slot) const;
  /// To anything.
  bool is_sphere_joined(std::uint32_t sphere) const;
  bool is_particle(std::size_t slot) const { return ordering.particle_at[slot] != kNoIndex; }
  std::size_t bytes() const;

  /// Each backend and solver needs a layout besides. It is made when it is first asked for, by
  /// whichever thread. The source of each layout defines its function, so that a change of a layout
  /// compiles its solver alone.
  const ReferenceLayout& reference() const;
  const SimdLayout& simd() const;
  const ChunkNeighbours& chunk_neighbours() const;
  const PullLayout& pulls() const;
  const DirectLayout& direct() const;
  const YarnLayout& yarns() const;
  const SmallStepsLayout& small_steps() const;
  const BendingFronts& bending_fronts() const;
  /// The triangles of `surface`, threads (threads.h), and free particles that are in neither.
  const TriangleSurface& touched_surface() const;

 private:
  struct Draft;
  void order_particles(Draft& draft, const Model* like);
  void store_particles(const Draft& draft);
  void store_constraints(const Draft& draft);
  void leave_out_compliances();
  void store_strengths(const SceneDescription& description);
  void store_batches(const Draft& draft, ConstraintKind kind);
  void store_hubs(const Draft& draft, ConstraintKind kind);
  void store_membrane(const SceneDescription& description);
  void store_bending(const SceneDescription& description);
  void store_anchors(const SceneDescription& description);
  void store_seams(const SceneDescription& description);
  void store_sliders(const SceneDescription& description);
  void store_surface(const SceneDescription& description);
  void store_air(const SceneDescription& description);
  void list_air_triangles();
  void find_holds();
  void find_joined();
  bool find_strength() const;
  /// Where the layout of small steps is made already.
  void renew_bending_layout();
  void append(const Constraint& constraint, std::uint32_t described, std::uint32_t a,
              std::uint32_t b);

  std::vector<std::uint64_t> joined_;  // a sphere, and the particles joined to it, in order
  OnDemand<ReferenceLayout> reference_;
  OnDemand<SimdLayout> simd_;
  OnDemand<ChunkNeighbours> chunk_neighbours_;
  OnDemand<PullLayout> pulls_;
  OnDemand<DirectLayout> direct_;
  OnDemand<YarnLayout> yarns_;
  OnDemand<SmallStepsLayout> small_steps_;
  OnDemand<BendingFronts> bending_fronts_;
  OnDemand<TriangleSurface> touched_surface_;
};

}  // namespace weft
