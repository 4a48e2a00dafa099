/// Small steps in double, one block after the other: the text to read beside
/// engine/solvers/small_steps/simd_small_steps.h, with whose functions its own go by name and
/// order.
#pragma once

#include <weft/weft.h>

#include <iterator>
#include <vector>

#include "engine/contacts/contacts.h"
#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/bending_pace.h"
#include "engine/solvers/small_steps/local_passes.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "kernels/reference/small_steps.h"

namespace weft {

class ReferenceSmallSteps final : public SmallSteps {
 public:
  struct Past {
    double h = 0;  // of the last substep; 0: there was none
    kernels::Vectors v, v_before, moved;
  };

  ReferenceSmallSteps(const Model& model, const Settings& settings);

  double substep_length(kernels::VectorsView x, double acceleration) const override;
  void begin(kernels::VectorsView x, kernels::VectorsView v, kernels::Vector gravity,
             kernels::VectorsView force, const FramePlan& plan, Team& team) override;
  void advance(Team& team) override;
  void sweep(Team& team) override;
  std::int64_t count_out() const override { return std::ssize(out_); }
  LocalWork repair(const ContactStore& contacts, std::int64_t most_visits) override;
  LocalWork repair_everywhere(const ContactStore& contacts, std::int64_t most_visits) override;
  double law_error() override;
  void read_positions(kernels::VectorsView x, Team& team) const override;
  double bending_energy(Team& team) override;
  void settle(Team& team) override;
  void read_velocities(kernels::VectorsView v, Team& team) const override;

  void keep(Team& team) override;
  void take_past(const SmallSteps& from) override {
    past_ = static_cast<const ReferenceSmallSteps&>(from).past_;
    multiplier_ = static_cast<const ReferenceSmallSteps&>(from).multiplier_;
  }
  void forget_past() override { past_.h = 0; }
  std::size_t bytes() const override;

 private:
  struct Points;
  Points points();
  LawStep law_step() const;
  reference::Flight flight();
  bool is_free(std::size_t slot) const { return model_.inverse_mass[slot] > 0; }
  /// Of a substep of h_ after one of h_before.
  SubstepFormula formula_after(double h_before) const;
  double decaying_share() const;
  void decay();
  void settle_velocities();
  void bend();
  reference::BendingElement element(std::uint32_t i) const {
    const BendingStore& s = model_.bending;
    return {s.slots[i], s.weights[i], s.rest[i], s.compliance[i]};
  }
  void relax_chain(std::span<const std::uint32_t> slots, std::span<const std::uint32_t> links);
  void relax_edge(std::uint32_t constraint);
  void relax_spring(std::uint32_t constraint);
  LocalWork run_passes(const ContactStore& contacts, std::int64_t most_visits);
  void stop_at_contacts();

  const Model& model_;
  const SmallStepsLayout& layout_;
  const Settings settings_;
  LocalPasses passes_;
  std::vector<BendingPace> paces_;
  Past past_;
  reference::ChainSystem system_;

  double h_ = 0, omega_ = 1;
  double last_ = 0;  // b h of the last substep
  SubstepFormula formula_, next_formula_;
  kernels::Vectors x_, before_, predicted_, v_, v_before_, acceleration_;
  std::vector<std::uint32_t> out_;  // constraints that a sweep found out of tolerance
  std::vector<std::uint32_t> touched_;
  std::vector<double> multiplier_;  // per constraint; with springs only
  bool is_begun_ = false;           // the substep has been swept
  bool projects_ = false;
};

}  // namespace weft
