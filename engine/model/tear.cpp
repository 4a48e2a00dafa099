#include "engine/model/tear.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "engine/model/change.h"
#include "engine/model/pressures.h"
#include "engine/model/split.h"

namespace weft {
namespace {

using kernels::Vector;

class Tearing {
 public:
  Tearing(const Model& model, const kernels::Vectors& x)
      : model_(model), description_(description_of(model)) {
    for (const std::uint32_t slot : model.ordering.slot_of) x_.push_back(x[slot]);
  }

  /// Returns whether it broke.
  bool apply(const Break& it) {
    switch (it.kind) {
      case Tear::constraint:
        tear_constraint(it);
        return true;
      case Tear::seam:
        description_.seams[it.index].strength = 0;
        tell(it);
        return true;
      case Tear::anchor:
        description_.anchors[it.index].max_distance = std::numeric_limits<double>::infinity();
        tell(it);
        return true;
      case Tear::sheet:
        return split(it.index, it);
    }
    return false;
  }
  /// Its flanks are apart (engine/step/flanks.h).
  void forget_seam(std::uint32_t seam) {
    description_.seams.erase(description_.seams.begin() + seam);
    forgets_ = true;
  }
  TornModel result() && {
    if (torn_.empty() && !forgets_) return {};
    let_gas_out(description_.pressures, description_.surface);
    auto other = std::make_shared<Model>(description_, &model_);
    other->split_from = std::move(split_from_);
    other->tears += !torn_.empty();
    return {std::move(other), std::move(torn_)};
  }

 private:
  void tell(const Break& it) {
    torn_.push_back({.kind = it.kind, .index = it.index, .load = it.load});
  }
  bool split(std::uint32_t particle, const Break& it) {
    const std::uint32_t added = SheetSplitter(description_, x_).split(particle, it.along);
    if (added == kNoIndex) return false;
    split_from_.push_back(particle < model_.particles ? particle
                                                      : split_from_[particle - model_.particles]);
    torn_.push_back({Tear::sheet, particle, added, it.load});
    return true;
  }
  void tear_constraint(const Break& it) {
    const Constraint c = description_.constraints[it.index];
    Break split_it = it;
    split_it.along = x_[c.b] - x_[c.a];
    for (const std::uint32_t end : SheetSplitter(description_, x_).ends_of_edge(c)) {
      if (split(end, split_it)) return;
    }
    description_.constraints[it.index].strength = 0;
    tell(it);
  }

  const Model& model_;
  SceneDescription description_;
  std::vector<Vector> x_;
  std::vector<std::uint32_t> split_from_;
  std::vector<Torn> torn_;
  bool forgets_ = false;
};

}  // namespace

TornModel torn_model(const Model& model, std::span<const std::vector<Break>> groups,
                     std::span<const std::uint32_t> without, const kernels::Vectors& x) {
  Tearing tearing(model, x);
  for (const std::vector<Break>& group : groups)
    std::ignore = std::ranges::any_of(group, [&](const Break& it) { return tearing.apply(it); });
  std::for_each(without.rbegin(), without.rend(),
                [&](std::uint32_t seam) { tearing.forget_seam(seam); });
  return std::move(tearing).result();
}

}  // namespace weft
