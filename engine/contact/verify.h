/// Stage 7 of an interval finds features that went through each other in it. Points move in
/// straight lines from their old to their new places. If the cloth crosses no body at the start,
/// and no pair fails here, then it crosses none at the end.
///
/// The cheapest test comes first: points have moved less, relative to each other, than their
/// features were apart. The second: one fixed direction separates them at both ends, and so all of
/// the way. The last one takes steps that cannot go too far (additive continuous collision
/// detection: Li, Kaufman and Jiang, 2021).
#pragma once

#include <vector>

#include "engine/contact/near.h"
#include "engine/contact/scene.h"

namespace weft {

/// A pair that met on its way.
struct Failure {
  std::uint32_t list = 0, pair = 0;  // of the candidates
  double time = 0;                   // of the interval, 0 to 1: before they met
  double depth = 0;                  // m, of one that is late
};

class Verification {
 public:
  explicit Verification(const simd::Table& table) : table_(table) {}

  /// Moves are measured. Points that left their boxes have new candidates.
  void find(const ContactScene& scene, CandidateSearch& search, NearSearch& near_search,
            Candidates& candidates, Team& team);
  const std::vector<Failure>& failures() const { return failures_; }
  /// Instead, pairs that have met no other, but have come nearer than their thickness where nothing
  /// was expected: time is 1.
  void find_late(const ContactScene& scene, const NearSearch& near_search,
                 const Candidates& candidates, Team& team);

 private:
  /// The verdict on a pair. asks: one thread is to look at it, since it asks for normals.
  struct Verdict {
    bool fails = false, asks = false;
    double time = 0, depth = 0;
  };
  template <class Judge>
  void judge_moved(const ContactScene& scene, const NearSearch& near_search,
                   const Candidates& candidates, std::size_t lists, double near, Team& team,
                   Judge&& judge);
  void leave_each_once(const Candidates& candidates);
  void look_beside_strayed(const ContactScene& scene, CandidateSearch& search,
                           NearSearch& near_search, Candidates& candidates, Team& team);

  const simd::Table& table_;
  std::vector<Failure> failures_;
  std::vector<std::uint16_t> moved_;
  std::vector<std::uint32_t> looked_at_;   // pairs; scratch
  std::vector<Verdict> verdicts_;          // likewise
  std::vector<std::uint8_t> has_strayed_;  // per slot; scratch
};

}  // namespace weft
