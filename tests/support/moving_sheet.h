/// Sheets whose particles go straight on, and the pairs of their features that are candidates.
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "engine/contact/near.h"
#include "engine/model/model.h"
#include "tests/support/clothes.h"
#include "tests/support/contact_particles.h"
#include "tests/support/random.h"
#include "tests/support/sheets.h"
#include "tests/support/vectors.h"

namespace weft::test::moving_sheet {

using kernels::Vector;

inline constexpr double kH = 1e-3, kThickness = 2e-3;
inline constexpr int kSubsteps = 16;

/// A sheet whose particles go straight on, each with its own velocity.
struct Moving {
  Random random;
  std::shared_ptr<const Model> model;
  BodyClock clock;
  StandingParticles particles;
  std::vector<Vector> v;

  explicit Moving(std::uint32_t seed) : random(seed) {}
  void start(double speed) {
    for (std::uint32_t slot = 0; slot < model->slots(); ++slot) {
      particles.to.push_back(model->initial_position[slot]);
      v.push_back(draw(speed));
    }
    particles.from = particles.to;
  }
  Vector draw(double size) {
    return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
  }
  /// The first substep of an interval is predicted.
  void predict() {
    clock.begin_interval(4 * kH);
    for (std::size_t i = 0; i < v.size(); ++i) {
      particles.from[i] = particles.to[i];
      particles.to[i] = particles.from[i] + kH * v[i];
    }
  }
};

using Name = std::tuple<PairKind, bool, std::uint32_t, std::uint32_t>;
inline Name name_of(const Pair& pair) {
  return {pair.kind, pair.is_turned(), pair.first, pair.second};
}

inline std::set<Name> names_of(const Candidates& candidates) {
  std::set<Name> names;
  for (const PairList& list : candidates) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list.is_used(i)) CHECK(names.insert(name_of(list.pairs[i])).second);  // each once
    }
  }
  return names;
}

/// Of an interval of so many substeps.
inline std::size_t candidates_of(const Moving& now, int substeps) {
  CHECK(now.model->slots() > now.model->particles);  // with padding, which has no place
  ContactPoints points(*now.model);
  points.begin(now.clock);
  points.look_ahead(now.particles, now.clock);
  points.begin_interval(now.particles, now.clock, substeps);
  CandidateSearch search(simd::table(simd::best_isa()));
  Candidates candidates;
  Team team;
  search.find(points, candidates, team);
  return names_of(candidates).size();
}

}  // namespace weft::test::moving_sheet
