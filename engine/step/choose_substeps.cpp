#include "engine/step/choose_substeps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/contacts/contacts.h"
#include "engine/step/motion.h"
#include "engine/step/solve.h"

namespace weft {
namespace {

/// The strain after a step without constraints that one substep is good for. It grows with the
/// square of the step, so that there are
///
///     sqrt( strain / min(most, longest / n) )     n: particles of the constraint's yarn
///
/// the largest of all constraints, rounded up. What an edge turns by, all those behind it on its
/// yarn are swung by: a yarn of many edges wants less.
struct Bend {
  double most;
  double longest;
};
/// (0.04 and 1.5: hang, 300 x 300, 1 %, wants 5.8 substeps a frame instead of 4.4, and 1.1 times
/// the time; hang_sphere, 40 x 40, 1.2 times. 0.08: corners, 35 to 47, in more halves.)
constexpr Bend kYarnBend{0.06, 3};
constexpr Bend kUsualBend{0.04, std::numeric_limits<double>::infinity()};
/// Scheme rattle must resolve the motion: with half as many substeps half of them fall back (hang,
/// 40 x 40: 45 % instead of 3 %), and are done twice.
constexpr Bend kRattleBend{0.01, 1.5};
constexpr int kMostSubsteps = 256;

/// The largest strain at solved, as a share of what its yarn may have.
double bend_after_motion(State& s, Team& team) {
  const Bend& may = s.settings.scheme == Scheme::rattle ? kRattleBend
                    : s.yarn                            ? kYarnBend
                                                        : kUsualBend;
  const auto share = [&](double strain, std::size_t particles_of_yarn) {
    return std::max(strain / may.most,
                    strain * static_cast<double>(particles_of_yarn) / may.longest);
  };
  const std::size_t longest = s.yarn ? s.yarn->longest() : 0;
  const double most = share(max_strain_at(s, s.solved, team), longest);
  if (!s.yarn || s.yarn->longest_at().empty() || most <= s.trouble.allowance()) return most;
  const auto x = s.solved.view();
  const auto strains = s.measure->strains_of_chunks(x, team);
  double finer = share(s.measure->max_hub_strain(x), 0);
  for (std::size_t i = 0; i < strains.size(); ++i) {
    finer = std::max(finer, share(strains[i].largest, s.yarn->longest_at()[i]));
  }
  return finer;
}

/// A load that is `ratio` times as heavy as the lightest particles of what holds it pulls at these
/// with `ratio` times their weight. Across the pull they swing with the frequency w,
///
///     w^2 = ratio g / l,    l: the length of their constraints
///
/// and what turns a constraint in a substep moves them (w h)^2 times as far: beyond a few neither
/// Newton's method nor yarns find their way. So w h is to be 1 / kLoad at most.
///
/// (10 ms, 1 %, 100 frames, ms a frame: a sheet of 30 x 30 with 10^4 at a corner 0.45, 0.25 at
/// 0.5, 78 without any of this, up to 3.4 s in one; with 10^5 2.3 and 1.7; a chain of 100 under
/// 10^5 0.62 and, with 0.5, 29. At 1 all take 1.3 times as long as at 0.7.)
constexpr double kLoad = 0.7;
constexpr double kLeastLoad = 1000;

/// Of free spheres that touch something where the step would lead; kg.
double heaviest_sphere(State& s) {
  const Model& model = *s.model;
  find_contacts(model, *s.kernels, s.solved.view(), s.contacts);
  double least = std::numeric_limits<double>::infinity();  // inverse mass
  const auto weigh = [&](std::uint32_t slot) {
    const double w = model.inverse_mass[slot];
    if (w > 0 && model.is_sphere[slot]) least = std::min(least, w);
  };
  for (std::uint32_t k = 0; k < s.contacts.count(); ++k) {
    weigh(s.contacts.sphere[k]);
    weigh(s.contacts.particle[k]);
  }
  return 1 / least;
}

/// The load over the length of what holds it, 1/m. With scheme rattle a sphere is none: its
/// substeps are as short already, and more of them fall back (a taut sheet of 20 x 20 under 10 kg:
/// 20 ms a frame instead of 8). With the paper's a slack one under 10 kg takes 0.42 ms a frame
/// instead of 48, under 100 kg 1.7; before, that did not converge.
double load_per_metre(State& s) {
  const Unevenness& uneven = s.model->uneven;
  double most = uneven.ratio < kLeastLoad ? 0 : uneven.per_metre;
  const bool spheres_count = s.settings.scheme == Scheme::paper;
  if (spheres_count && s.model->heaviest_sphere * uneven.lightness >= kLeastLoad) {
    const double mass = heaviest_sphere(s);
    if (mass * uneven.lightness >= kLeastLoad)
      most = std::max(most, mass * uneven.lightness_per_metre);
  }
  return most;
}

/// What a substep by yarns costs besides its iterations is as much as some of these: with fewer of
/// them to each, max_iterations would not bound the time of a step. (corners, 101 x 101, 1/60 s, 20
/// a step: 25 substeps, 20 ms, of which one in ten is iterations; bounded, 3.0 ms.)
int most_substeps(const State& s) {
  constexpr int kLeastIterations = 8;
  if (!s.yarn) return kMostSubsteps;
  return std::clamp(s.settings.max_iterations / kLeastIterations, 1, kMostSubsteps);
}

/// For yarns: the direct solver keeps to the motion's, whose errors come back as less speed.
double substeps_for_load(State& s, double dt) {
  if (!s.yarn) return 1;
  return kLoad * dt * std::sqrt(length(s.gravity) * load_per_metre(s));
}

}  // namespace

int substeps_wanted(State& s, double dt, Team& team) {
  predict(s, dt, team);
  const double bend = bend_after_motion(s, team);
  const double wanted =
      std::ceil(std::max(std::sqrt(bend / s.trouble.allowance()), substeps_for_load(s, dt)));
  const int most = most_substeps(s);
  return wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
}

}  // namespace weft
