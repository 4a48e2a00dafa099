/// Whether a cloth rests, and may sleep.
///
/// It rests if for kRestTime no particle, fixed ones included, has been farther than the share
/// kRestShare of the mean length of its constraints from where it was when that time began. The
/// test is about positions over a time, and not about velocities: a particle of the acceleration a
/// moves by a t^2 / 2 from a turning point. So motions faster than kRestShare of a length in
/// kRestTime are no rest: larger swings, creep, and cloth that tips over. Cloth that tips over more
/// slowly than that falls asleep.
///
/// Positions are compared every kRestTime / 4. A cloth whose steps are longer than that does not
/// sleep, since the motion between is not known.
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
