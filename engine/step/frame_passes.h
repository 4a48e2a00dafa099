/// The passes of a frame of small steps beyond one sweep per substep: their bound, in times of
/// sweeps, and their number.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/model/model.h"
#include "engine/solvers/small_steps/local_passes.h"
#include "engine/spheres/sphere_contacts.h"
#include "engine/tuning.h"

namespace weft {

class FramePasses {
 public:
  FramePasses(const Model& model, const SphereContacts& contacts, StepReport& report)
      : contacts_(contacts),
        report_(report),
        constraints_(static_cast<std::int64_t>(model.constraints.size() + model.membrane.size() +
                                               model.seams.size() + model.sliders.size())),
        local_visit_(time_of_local_visit(model)) {}

  void begin(double most) { left_ = most; }
  double left() const { return left_; }
  double most_of_substep() const { return local_visit_ * tuning::kMostVisits; }
  /// The share left for each of the substeps to come, and for the end of the last one.
  double share_of_substep(int substeps_left) const {
    return std::clamp(left_ / (substeps_left + 1), 0.0, most_of_substep());
  }
  /// Local passes visit contacts too, which may be many more than the constraints, and hold what
  /// they move by meshes: this takes so much of the time of each visit as it did the last time.
  std::int64_t most_visits(double passes) const {
    const double most = passes * visits_of_a_pass() / (local_visit_ + held_);
    return static_cast<std::int64_t>(std::max(0.0, most));
  }
  bool are_many(std::int64_t out) const {
    return static_cast<double>(out) > tuning::kManyOut * static_cast<double>(constraints_);
  }
  /// Any local visit counts as kLocalVisit.
  double taken() const { return taken_; }

  void count_sweep() {
    ++report_.iterations;
    ++report_.direction_updates;
    report_.visits += constraints_;
    report_.corrections += constraints_;
  }
  void count_sweep_beyond() {
    count_sweep();
    left_ -= 1;
    taken_ += 1;
  }
  void count(const LocalWork& work) {
    report_.visits += work.visits;
    report_.corrections += work.corrections;
    const double beyond = static_cast<double>(work.visits - contacts_.count());
    const double passes = std::max(0.0, beyond) / visits_of_a_pass();
    local_passes_ += passes;
    left_ -= local_visit_ * passes;
    taken_ += tuning::kLocalVisit * passes;
  }
  /// Counts the visits of contacts with meshes beside a sweep.
  void count_contacts(double visits) {
    left_ -= tuning::kContactShare * visits / visits_of_a_pass();
  }
  /// And beside local passes.
  void count_contacts(const LocalWork& work, double visits) {
    count_contacts(visits);
    held_ = tuning::kContactShare * visits / std::max(1.0, static_cast<double>(work.visits));
  }
  void end() { report_.iterations += static_cast<std::int64_t>(std::ceil(local_passes_)); }

 private:
  /// The time of local passes over everything, in visits of a sweep that take as long.
  static double time_of_local_visit(const Model& model) {
    const auto triangles = static_cast<double>(model.membrane.size());
    const auto others =
        static_cast<double>(model.constraints.size() + model.seams.size() + model.sliders.size());
    if (triangles == 0) return tuning::kLocalVisit;
    const double time = tuning::kLocalVisitOfTriangle * triangles + tuning::kLocalVisit * others;
    return time / (triangles + others);
  }
  double visits_of_a_pass() const {
    return std::max(1.0, static_cast<double>(constraints_ + contacts_.count()));
  }

  const SphereContacts& contacts_;
  StepReport& report_;
  const std::int64_t constraints_;  // triangles of fabric, seams and sliders are among them
  const double local_visit_;        // in visits of a sweep
  double held_ = 0;                 // likewise, of what is held by meshes beside a local visit
  double left_ = 0;
  double local_passes_ = 0;  // done
  double taken_ = 0;
};

}  // namespace weft
