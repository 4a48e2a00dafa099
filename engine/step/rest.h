/// Whether a cloth rests, and may sleep.
///
/// It rests if for kRestTime no particle, fixed ones included, has been farther than the share
/// kRestShare of the mean length of its constraints from where it was when that time began. Its
/// positions are looked at and not its velocities, and for a time: a particle of the acceleration a
/// comes a t^2 / 2 away from a turning point. So whatever moves faster than kRestShare of a length
/// in kRestTime does not rest: a swing of any larger width, creep, and a balance that is being
/// lost. A balance that is lost more slowly than that is kept.
///
/// Where a step is longer than a look apart, kRestTime / 4, nothing is known of the time between:
/// such a cloth does not sleep.
#pragma once

#include <cstddef>

#include "engine/model/model.h"
#include "engine/saving/archive.h"
#include "engine/tuning.h"
#include "kernels/vectors.h"

namespace weft {

class Rest {
 public:
  explicit Rest(const Model& model);

  bool is_asleep() const { return is_asleep_; }
  /// Something was changed from outside.
  void wake();
  /// m/s: a body that is faster does not rest.
  double slowest() const { return reach_ / tuning::kRestTime; }
  /// After a step of dt. Returns whether the cloth falls asleep.
  bool watch(const kernels::Vectors& position, double dt);
  std::size_t bytes() const { return from_.bytes(); }
  friend void visit_fields(Is<Rest> auto& rest, auto& archive) {
    auto& [reach, from, time, is_watching, is_asleep, restless] = rest;  // reach: the model's
    archive(from, time, is_watching, is_asleep, restless);
  }
  /// Whether what was read is about particles of the model.
  bool fits(const Model& model) const {
    return from_.size() == model.slots() && restless_ < model.slots();
  }

 private:
  bool has_moved(const kernels::Vectors& position, std::size_t slot) const;
  bool has_moved(const kernels::Vectors& position);
  void begin(const kernels::Vectors& position);

  double reach_ = 0;       // m
  kernels::Vectors from_;  // where the particles were when the time began
  double time_ = 0;        // s, since then, or since one was seen to have moved
  bool is_watching_ = false;
  bool is_asleep_ = false;
  std::size_t restless_ = 0;  // slot of the last one that had moved: it is looked at first
};

}  // namespace weft
