/// Models of cloth that has torn (Tear in weft/scene.h).
///
/// The description is changed at the torn place, and a model is made of it, as for changes of
/// numbers (change.h). So all properties of models hold for a torn one.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"

namespace weft {

/// A thing that is to break.
struct Break {
  Tear kind = Tear::constraint;
  std::uint32_t index = 0;  // in the description; of a sheet the particle
  double load = 0;          // N or N/m
  kernels::Vector along{};  // of a sheet: the direction of the largest tension
};

struct TornModel {
  std::shared_ptr<const Model> model;  // null: nothing changes
  std::vector<Torn> torn;              // all that broke
};

/// In each group the first that can break does. A sheet cannot be split at each particle. A
/// constraint along an edge of a sheet breaks by a split of one of its ends, if one can be split.
/// x: of the particles, by slots. without: numbers of seams, ascending, that the cloth goes on
/// without.
TornModel torn_model(const Model& model, std::span<const std::vector<Break>> groups,
                     std::span<const std::uint32_t> without, const kernels::Vectors& x);

}  // namespace weft
