/// The triangles of fabric of small steps in lanes.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "engine/model/model.h"
#include "engine/parallel/team.h"
#include "engine/solvers/small_steps/laws.h"
#include "engine/solvers/small_steps/membrane_layout.h"

namespace weft {

class SimdMembrane {
 public:
  SimdMembrane(const Model& model, const simd::Table& table);

  /// Measures a new base.
  void measure_base(const float* base, Team& team);
  /// u_start: when the substep began. continues: the substep has been swept before.
  void relax(float* u, const float* u_start, const LawStep& laws, double omega, bool continues,
             Team& team);
  /// Finds which elements break a law by more than the strain.
  void judge(float* u, const float* u_start, const LawStep& laws, double strain, Team& team);

  /// Elements that were found then.
  std::int64_t count_out() const;
  template <class Work>
  void for_each_out(Work&& work) const {
    for (std::size_t i = 0; i < out_.size(); ++i) {
      for (std::uint32_t bits = out_[i]; bits != 0; bits &= bits - 1) {
        work(layout_
                 .element[i * kernels::kLanes + static_cast<std::size_t>(std::countr_zero(bits))]);
      }
    }
  }

  reference::MembraneMultipliers multipliers(std::uint32_t element) const;
  void set_multipliers(std::uint32_t element, const reference::MembraneMultipliers& to);
  std::size_t bytes() const;

 private:
  simd::Membrane arrays(float* u, const float* u_start, const LawStep& laws);
  /// work(is rope, first, last) over the blocks, batch by batch.
  template <class Work>
  void for_blocks(Team& team, Work&& work) const;
  /// The place of the first law; the next ones are kLanes apart.
  std::size_t multiplier_place(std::uint32_t element) const {
    const std::size_t place = layout_.place[element], lane = place % kernels::kLanes;
    return reference::kMembraneLaws * (place - lane) + lane;
  }
  double mobility(std::uint32_t element) const {
    return model_.membrane.element[element].mobility.most();
  }

  const Model& model_;
  const MembraneLayout& layout_;
  const simd::Table& table_;
  kernels::AlignedVector<simd::MembraneSpans> spans_;  // deformation of the base
  kernels::AlignedVector<float> multiplier_;           // as the kernel has them
  std::vector<std::uint16_t> out_;                     // per block, a bit per lane
};

}  // namespace weft
