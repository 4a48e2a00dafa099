/// As simd_small_steps_past.cpp, in double.
#include <cmath>
#include <utility>

#include "engine/model/change.h"
#include "engine/solvers/small_steps/reference_small_steps.h"

namespace weft {

void ReferenceSmallSteps::go_on_from(const SmallSteps& from, kernels::VectorsView v,
                                     kernels::Vector gravity) {
  const auto& other = static_cast<const ReferenceSmallSteps&>(from);
  past_.h = other.past_.h;
  past_.at_limit = other.past_.at_limit;
  past_.misplaced.clear();
  for_each_particle(model_, other.model_, [&](std::uint32_t slot, std::uint32_t its_slot) {
    const Past& its = other.past_;
    ParticlePast past{its.v[its_slot], its.v_before[its_slot], its.moved[its_slot]};
    if (is_free(slot) != other.is_free(its_slot))
      past = is_free(slot) ? ParticlePast::flight(v[slot], gravity, past_.h) : ParticlePast{};
    past_.v.set(slot, past.v);
    past_.v_before.set(slot, past.v_before);
    past_.moved.set(slot, past.moved);
    past_.misplaced.take_over(its.misplaced, its_slot, slot);
  });
  past_.misplaced.sort();
}

bool ReferenceSmallSteps::load_past(ArchiveReader& archive) {
  Past past;
  archive(past);
  const auto has_slots = [&](const kernels::Vectors& v) { return v.size() == model_.slots(); };
  const bool is_past =
      has_slots(past.v) && has_slots(past.v_before) && has_slots(past.moved) &&
      past.at_limit.size() == at_limit_.size() && are_slots(model_, past.misplaced.inside) &&
      are_slots(model_, past.misplaced.crossing) && past.h >= 0 && std::isfinite(past.h);
  if (!archive.is_done() || !is_past) return false;
  past_ = std::move(past);
  return true;
}

void ReferenceSmallSteps::turn(const Turn& by) {
  for (kernels::Vectors* v : {&past_.v, &past_.v_before, &past_.moved}) {
    for (std::size_t i = 0; i < model_.slots(); ++i) v->set(i, by((*v)[i]));
  }
}

}  // namespace weft
