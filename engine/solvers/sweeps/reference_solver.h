/// The scalar reference (kernels/reference) on the state of a cloth.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

#include "engine/measure/spring_laws.h"
#include "engine/model/model.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/reference/relax.h"

namespace weft {

class ReferenceSolver {
 public:
  ReferenceSolver(const Model& model, const Settings& settings);

  /// Moves x until every constraint and listed contact is within tolerance. first_round: contacts
  /// were found anew, accumulated impulses start at 0. Scheme rattle takes directions at `start`,
  /// if given, instead of x. h is the time step, for the impulse limit. laws: of a model with
  /// springs (PositionTask).
  kernels::LoopResult solve_positions(kernels::VectorsView x, kernels::VectorsView start, double h,
                                      const SphereContacts& contacts, SpringLaws* laws,
                                      bool first_round, const kernels::LoopLimits& limits);
  /// The same by the original method as the paper has it (kernels/reference/previewed.h), from
  /// motion.position; motion.velocity is room.
  kernels::LoopResult solve_previewed_positions(const reference::Motion& motion, double h,
                                                const SphereContacts& contacts, SpringLaws* laws,
                                                bool first_round,
                                                const kernels::LoopLimits& limits);
  /// The velocity loop at the positions x.
  kernels::LoopResult correct_velocities(kernels::VectorsView x, kernels::VectorsView v,
                                         const SphereContacts& contacts,
                                         const kernels::LoopLimits& limits);
  std::size_t bytes() const;

 private:
  void reserve(std::size_t contacts);
  bool owns_constraints() const;
  void place_contacts(const SphereContacts& contacts);
  void take_laws(const SpringLaws& laws);
  reference::Relaxation position_problem(kernels::VectorsView x, double h,
                                         const SphereContacts& contacts, const SpringLaws* laws,
                                         bool first_round);
  void keep_multipliers(SpringLaws* laws) const;
  void take_directions_at(kernels::VectorsView start, reference::Relaxation& r);
  void choose_velocity_tolerances(const reference::Relaxation& r, kernels::VectorsView x);
  reference::Relaxation problem(kernels::VectorsView x, std::size_t contacts);
  reference::Workspace workspace();
  reference::Method method(const kernels::LoopLimits& limits) const;

  const Model& model_;
  const ReferenceLayout& layout_;
  const Settings settings_;
  std::size_t capacity_ = 0;  // of the arrays over constraints, contacts behind them

  std::vector<std::uint32_t> a_, b_;                          // with spheres or springs only
  kernels::AlignedVector<double> target_, effective_mass_;    // with spheres or springs only
  kernels::AlignedVector<double> softness_;                   // with springs only
  kernels::AlignedVector<double> start_target_;               // scheme rattle only
  kernels::AlignedVector<double> tolerance_;                  // m
  kernels::AlignedVector<double> velocity_tolerance_, zero_;  // velocity correction only
  kernels::Vectors direction_;
  kernels::AlignedVector<double> impulse_;

  // Only those of the chosen method are allocated.
  std::vector<double> error_, pending_, row_product_;
  std::vector<reference::Flag> row_ready_, changed_, moved_;
  kernels::Vectors hub_motion_;
  std::vector<std::uint64_t> mask_;
};

}  // namespace weft
