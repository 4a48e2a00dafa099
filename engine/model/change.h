/// Models that differ from others in numbers (Cloth::change).
///
/// What changes of a model make is the model that build_model makes of the changed description, so
/// that whatever is known of models holds for it. Descriptions are not kept: a model holds
/// all that it was made of, and tells it when it is asked.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/model.h"

namespace weft {

/// What the model was built from, but for the order of lists of particles.
SceneDescription description_of(const Model& model);

/// The changes must be valid for the model.
std::shared_ptr<const Model> changed(const Model& model, const Changes& changes);

/// Whether both come from one model by changes.
inline bool are_related(const Model& a, const Model& b) { return a.origin == b.origin; }

/// work(slot in a, slot in b) for each particle of two related models.
template <class Work>
void for_each_particle(const Model& a, const Model& b, Work&& work) {
  for (std::size_t i = 0; i < a.particles; ++i) {
    work(a.ordering.slot_of[i], b.ordering.slot_of[i]);
  }
}

/// work(constraint of a, constraint of b) for each that is active in both.
template <class Work>
void for_each_constraint(const Model& a, const Model& b, Work&& work) {
  const auto& described = b.constraints.described;
  std::vector<std::uint32_t> in_b(described.size() + b.inert.constraints.size(), kNoIndex);
  for (std::uint32_t c = 0; c < described.size(); ++c) in_b[described[c]] = c;
  for (std::uint32_t c = 0; c < a.constraints.size(); ++c) {
    const std::uint32_t there = in_b[a.constraints.described[c]];
    if (there != kNoIndex) work(c, there);
  }
}

}  // namespace weft
