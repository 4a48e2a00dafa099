/// One cloth on its way through a hard case, and what was seen of it.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/studies/hard/body_oracle.h"
#include "tools/studies/hard/oracle.h"

namespace weft::tools::hard {

struct Trial {
  SceneDescription scene;
  Settings settings;
  int steps = 200;
  double dt = 0.01;                                              ///< s
  std::function<double(int step)> varying_dt = {};               ///< instead of dt
  std::function<void(Cloth& cloth, int step)> before_step = {};  ///< moves pins, sets forces
  std::function<void(const Cloth& cloth, int step)> after_step = {};
  std::vector<TrialBody> bodies = {};
};

/// Strains and penetrations are the oracle's, never the report's.
struct Observed {
  std::string refusal = {};  ///< what weft said instead of taking the scene, the settings or a dt
  int steps = 0;
  bool stopped = false;  ///< before the last of them: one left the state as it was
  Status worst = Status::converged;
  int worst_step = -1;
  int missed = 0;        ///< steps that did not converge, by their status
  int false_claims = 0;  ///< steps said to converge, or an error reported, and it is not so; or
                         ///< said to converge though triangles cross
  bool finite = true;
  double max_strain = 0, end_strain = 0;
  double max_penetration = 0, end_penetration = 0;  ///< m, into spheres and bodies
  bool went_through = false;  ///< a body, by the straight way of a step that does not turn
  std::size_t crossings = 0;  ///< of triangles with those of bodies, and of layers; most of a step
  std::size_t end_crossings = 0;
  int intersecting = 0;  ///< most in a step, as the reports say
  int contact_failures = 0, zones = 0;
  double body_work = 0;                                      ///< J, as the reports say
  double energy_start = 0, energy_gain = 0, energy_end = 0;  ///< J; gain: the largest over start
                                                             ///< and the work of bodies
  double most_kinetic = 0, end_kinetic = 0;
  double seconds = 0;  ///< of the processor, in step()
  double longest_seconds = 0;
  Snapshot end = {};

  double ms_per_step() const { return steps > 0 ? 1e3 * seconds / steps : 0; }
};

Observed observe(const Trial& trial);

/// "600 steps of 0.12 ms, max strain 0.0998 %, ..."
std::string text(const Observed& observed);

}  // namespace weft::tools::hard
