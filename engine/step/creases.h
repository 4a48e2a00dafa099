/// The angles at rest of hinges that have yielded (BendingElement).
#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/saving/archive.h"
#include "engine/solvers/small_steps/creases.h"

namespace weft {

void visit_fields(Is<Crease> auto& crease, auto& archive) {
  auto& [angle, worked] = crease;
  archive(angle, worked);
}

/// One for each bending element of the description; none where no element yields.
class Creases {
 public:
  Creases() = default;
  /// As the model has them: nothing has yielded.
  explicit Creases(const Model& model);
  /// Those of another model that is related: elements that a tear has made begin as those did that
  /// they were copied from.
  Creases(const Creases& from, const Model& its_model, const Model& model);

  /// A step was done.
  void take(std::span<const Crease> creases) { all_.assign(creases.begin(), creases.end()); }

  std::span<const Crease> all() const { return all_; }
  std::size_t bytes() const { return bytes_of(all_); }
  friend void visit_fields(Is<Creases> auto& creases, auto& archive) {
    auto& [all] = creases;
    archive(all);
  }
  /// Whether those that were read are the model's.
  bool fit(const Model& model) const;

 private:
  std::vector<Crease> all_;
};

}  // namespace weft
