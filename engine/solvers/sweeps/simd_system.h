/// The data of Gauss-Seidel on the vector kernels (simd_solver.h).
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/measure/simd_layout.h"
#include "engine/measure/spring_laws.h"
#include "engine/model/model.h"
#include "engine/solvers/sweeps/pull_layout.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/loop.h"
#include "kernels/simd/table.h"

namespace weft {

/// Contacts in lanes: those of each sphere together, padded to whole lanes.
struct ContactLanes {
  struct Range {
    std::uint32_t first = 0, last = 0;
    std::uint32_t real = 0;  // without padding
  };
  std::vector<Range> spheres;  // those that have contacts
  std::vector<std::uint32_t> a, b;
  std::vector<std::uint32_t> contact;  // in the SphereContacts, or kNoIndex
  kernels::AlignedVector<simd::ConstraintBlock> blocks;
  kernels::AlignedVector<float> impulse;
  kernels::AlignedVector<double> distance, scale;

  void resize(std::size_t n);
  std::size_t bytes() const;
};

/// The constraints as one of the two loops sees them, errors and directions in its tolerances tau.
struct ScaledConstraints {
  kernels::AlignedVector<simd::ConstraintBlock> blocks;
  kernels::AlignedVector<double> scale;  // 1 / tau
  kernels::AlignedVector<float> weight;  // of the pulls (PullLayout); anticipate_products only

  std::size_t bytes() const;
};

/// Springs in lanes, per constraint slot (kernels/simd/relax_springs.h); of rigid constraints the
/// softness is 0. Corrections between two renewals are floats; multipliers are doubles.
struct SpringLanes {
  kernels::AlignedVector<double> target, softness;  // of the laws
  kernels::AlignedVector<double> multiplier;        // kg m, until the last renewal
  kernels::AlignedVector<double> unit;  // kg m: of a correction by one tolerance; padding: 0
  kernels::AlignedVector<double> rest;  // m, to which a spring gives way with this multiplier
  kernels::AlignedVector<float> compliance_share, held;

  void resize(std::size_t n);
  std::size_t bytes() const;
};

/// Threads write theirs side by side.
struct alignas(64) SharedSweep : kernels::Sweep {};

/// Constraints, contacts and springs as the kernels take them. SimdLoop relaxes them.
class SimdSystem {
 public:
  SimdSystem(const Model& model, const Settings& settings, const simd::Table& table);
  std::size_t bytes() const;

 private:
  friend class SimdLoop;
  friend class SimdSolver;

  void allocate_displacements();
  template <class Tolerance>
  ScaledConstraints scaled(Tolerance&& tau) const;
  void order_contacts(const SphereContacts& contacts);
  void place_contacts(const SphereContacts& contacts, double tolerance, bool keep_impulses);
  void take_laws(const SpringLaws& laws, bool first_round);
  void renew_multipliers();
  void keep_multipliers(SpringLaws& laws) const;
  void choose_active(kernels::VectorsView x);
  simd::BlockRelaxation relaxation(ScaledConstraints& constraints);
  simd::Geometry geometry(kernels::VectorsView x, const ScaledConstraints& constraints) const;

  const Model& model_;
  const SimdLayout& layout_;
  const ChunkNeighbours& neighbours_;
  const Settings settings_;
  const simd::Table& table_;

  kernels::AlignedVector<float> u_;
  std::size_t u_stride_ = 0, u_step_ = 1;  // simd::Displacements
  kernels::AlignedVector<float> impulse_;  // with ropes or springs only
  std::optional<SpringLanes> springs_;
  ScaledConstraints positions_, velocities_;  // the latter with velocity correction
  // Skip without anticipation only; springs have no kernels that use it.
  kernels::AlignedVector<std::uint64_t> mask_;
  // Per chunk, skip only: something in it, or in a chunk that shares a particle with it, was
  // corrected since it was last visited; since its directions were last renewed.
  std::vector<std::uint8_t> changed_, stale_;
  std::vector<std::uint32_t> corrections_;      // per chunk, of the present pass
  kernels::AlignedVector<SharedSweep> sweeps_;  // per share, or piece, of parallel work
  std::vector<std::uint8_t> open_seam_;         // no share of the present pass had all its tiles
  std::optional<PullMemory> pulls_;             // anticipate_products only
  ContactLanes contacts_;
  std::vector<float> contact_impulse_;        // per contact of the SphereContacts
  std::vector<std::uint32_t> contact_order_;  // its contacts, sphere by sphere
};

}  // namespace weft
