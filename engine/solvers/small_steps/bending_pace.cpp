#include "engine/solvers/small_steps/bending_pace.h"

#include <algorithm>

#include "engine/tuning.h"

namespace weft {

void BendingPace::begin(const FramePlan& plan) {
  h_ = plan.h;
  omega_ = plan.omega;
  substeps_ = plan.substeps;
  done_ = 0;
  const auto resolved = [&](int n) {
    const double time = n * h_;
    return time * time * stiffest_ <= tuning::kBendingPace &&
           time * damping_ * stiffest_ <= tuning::kMostBendingDamping;
  };
  for (group_ = 1; group_ < tuning::kLongestGroup && resolved(group_ + 1);) ++group_;
}

int BendingPace::next() {
  const int first = done_ - done_ % group_;
  const int size = std::min(group_, substeps_ - first);
  return done_++ == first + size / 2 ? size : 0;
}

reference::BendingVisit BendingPace::visit(int n, double give) const {
  return {.own = 1 / omega_,
          .rate = 1 / (n * give),
          .damping = damping_,
          .most = tuning::kMostBendingDamping / (n * h_)};
}

std::vector<BendingPace> paces_of(const BendingLayout& layout, double damping) {
  std::vector<BendingPace> paces;
  for (const BendingClass& c : layout.classes) paces.emplace_back(c.stiffest, damping);
  return paces;
}

}  // namespace weft
