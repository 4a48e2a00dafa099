/// Models that differ from others in numbers (Cloth::change).
///
/// Data prepared from constraints are shared where none of them changes. A changed model is the one
/// that build_model makes of the changed description, so all properties of models hold for it.
/// Descriptions are not kept: a model can give its description at any time.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"

namespace weft {

/// The description that the model was built from, but for the order of lists of particles.
SceneDescription description_of(const Model& model);

/// The changes must be valid for the model.
std::shared_ptr<const Model> changed(const Model& model, const Changes& changes);

/// The description of the model, with the shape at rest of `scene` times `scale`
/// (Cloth::set_rest_shape). An error if their elements are not the same, or a value is none.
Result<SceneDescription> with_rest_shape(const Model& model, const SceneDescription& scene,
                                         double scale);

/// The changed description must be valid for the model.
std::shared_ptr<const Model> rebuilt(const Model& model, const SceneDescription& description);

/// With other largest distances, one for each anchor.
std::shared_ptr<const Model> with_anchor_distances(const Model& model,
                                                   std::span<const AnchorLimit> limits);

/// Whether both come from one model by changes.
inline bool are_related(const Model& a, const Model& b) { return a.origin == b.origin; }

/// work(slot in a, slot in b) for each particle of two related models: they have the same ones, or
/// a is b, torn.
template <class Work>
void for_each_particle(const Model& a, const Model& b, Work&& work) {
  for (std::size_t i = 0; i < a.particles; ++i) {
    const std::size_t its = i < b.particles ? i : a.split_from[i - b.particles];
    work(a.ordering.slot_of[i], b.ordering.slot_of[its]);
  }
}

/// work(number in a, number in b) for each that is active in both. described: the numbers in the
/// description of those that are active, of `count` with the inert ones.
template <class Work>
void for_each_described(const std::vector<std::uint32_t>& described_a,
                        const std::vector<std::uint32_t>& described_b, std::size_t count,
                        Work&& work) {
  std::vector<std::uint32_t> in_b(count, kNoIndex);
  for (std::uint32_t i = 0; i < described_b.size(); ++i) in_b[described_b[i]] = i;
  for (std::uint32_t i = 0; i < described_a.size(); ++i) {
    if (described_a[i] >= count) continue;  // of a torn one
    const std::uint32_t there = in_b[described_a[i]];
    if (there != kNoIndex) work(i, there);
  }
}

/// Calls work(i, j) for the constraints that both have.
template <class Work>
void for_each_constraint(const Model& a, const Model& b, Work&& work) {
  for_each_described(a.constraints.described, b.constraints.described,
                     b.constraints.size() + b.inert.constraints.size(), work);
}

/// Calls work(i, j) for the triangles of fabric that both have.
template <class Work>
void for_each_triangle(const Model& a, const Model& b, Work&& work) {
  for_each_described(a.membrane.described, b.membrane.described,
                     b.membrane.size() + b.inert.membrane.size(), work);
}

}  // namespace weft
