/// The constraints of small steps in lanes: yarns that are solved exactly, and edges one by one
/// (kernels/simd/small_step_yarns.h, small_step_springs.h, small_steps.h).
#pragma once

#include <weft/settings.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/laws.h"
#include "engine/solvers/small_steps/small_steps_layout.h"
#include "kernels/reference/small_steps.h"
#include "kernels/simd/table.h"

namespace weft {

/// Where the particles are in a sweep over constraints, and how far it goes.
struct LinkSweep {
  float* base = nullptr;
  float* u = nullptr;
  const float* u_start = nullptr;  // when the substep began
  LawStep laws;
  double omega = 1;
  double left = 0;         // strain that rigid constraints may keep
  bool continues = false;  // the substep has been swept before
};

class SimdLinks {
 public:
  SimdLinks(const Model& model, const Settings& settings, const simd::Table& table);

  /// Measures a new base.
  void measure_base(const float* base, Team& team);
  /// Solves yarns, family by family, and calls after() for each family.
  template <class After>
  void sweep_yarns(const LinkSweep& sweep, Team& team, After&& after) {
    for (std::size_t family = 0; family < layout_.yarns.families(); ++family) {
      sweep_family(family, sweep, team);
      after();
    }
    is_base_new_ = false;
  }
  void sweep_edges(const LinkSweep& sweep, Team& team);
  /// Finds which springs, and rigid constraints beside them, are out of tolerance.
  void judge_springs(const LinkSweep& sweep, Team& team);

  /// Constraints that the last sweep, or judge_springs(), found out of tolerance.
  std::int64_t count_out() const;
  template <class Work>
  void for_each_out(Work&& work) const {
    for_each_lane(edges_out_, layout_.constraint, work);
    for_each_lane(yarns_out_, layout_.yarns.constraint, work);
  }

  /// The largest length^2 / rest^2 - 1 within tolerance, for the lanes.
  float squared_tolerance() const;
  static float squared(double strain) {
    return static_cast<float>(reference::squared_strain(strain));
  }
  /// In places of the layout.
  float* multipliers() { return multiplier_.data(); }
  std::size_t bytes() const;

 private:
  /// work(constraint) for each bit that is set.
  template <class Words, class Work>
  static void for_each_lane(const Words& words, const std::vector<std::uint32_t>& constraint,
                            Work&& work) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      for (std::uint32_t bits = words[i]; bits != 0; bits &= bits - 1) {
        const std::uint32_t c =
            constraint[i * kernels::kLanes + static_cast<std::size_t>(std::countr_zero(bits))];
        if (c != kNoIndex) work(c);
      }
    }
  }
  template <class Work>
  void for_each_block(Team& team, std::size_t first, std::size_t last, Work&& work);
  template <class Work>
  void for_each_batch(Team& team, Work&& work) const;
  void sweep_family(std::size_t family, const LinkSweep& sweep, Team& team);
  simd::Yarns yarns(float* base);
  simd::YarnRelaxation of_yarns(const LinkSweep& sweep);
  simd::EdgeRelaxation of_edges(const LinkSweep& sweep);
  simd::SpringLaws laws(const LinkSweep& sweep) const;
  simd::SpringRelaxation of_springs(const LinkSweep& sweep);
  simd::YarnSpringRelaxation of_spring_yarns(const LinkSweep& sweep);

  const bool has_springs_;
  const SmallStepsLayout& layout_;
  const double tolerance_;  // of strain, in passes
  const simd::Table& table_;
  kernels::AlignedVector<simd::EdgeSpans> spans_;
  kernels::AlignedVector<simd::YarnBaseSteps> base_step_;  // per row
  bool is_base_new_ = true;                                // base_step_ is of another one
  kernels::AlignedVector<simd::YarnScratch> scratch_;      // for each thread
  std::vector<std::uint16_t> edges_out_;                   // per edge block, a bit per lane
  std::vector<std::uint32_t> yarns_out_;                   // per row of yarns, likewise
  kernels::AlignedVector<float> multiplier_;
};

}  // namespace weft
