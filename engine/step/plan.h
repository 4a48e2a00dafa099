/// The plan of a step: the estimate of its substeps, and the ordered list of attempts for each of
/// them.
///
///   1  scheme rattle, if the settings ask for it
///   2  the solver, in 1, 2, 4, 8 and 16 parts; State::refinement says where to begin
///   3  the direct solver, where it stands by for unequal masses
///   4  small steps
///   5  the paper's loop, whose result is accepted with its error: it comes to rest where
///      constraints contradict each other
///
/// A rejected part is retried by the next attempt; the parts before it are kept. After success, the
/// list begins again at the first attempt whose parts begin at this point. So a substep that is
/// rejected, and then in its second half, is done as a half and two quarters. Small steps, sweeps
/// and the direct solver behind yarns do all that is left of the substep.
///
/// Where pins are farther apart than the constraints between them reach, small steps are left out.
///
/// The paper's loop (gauss_seidel) and a fixed number of iterations have one attempt, by the scheme
/// of the settings, and after rattle a second one by the paper's. So has a step by small
/// steps, whose work is bounded where pins are too far apart: no frame takes long in vain.
/// Automatic substeps of fabric have more: as many substeps as the last frames needed, and 2, 4, 8
/// and 16 times as many, since a load that arrives within a frame is not known beforehand.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/step/attempt.h"
#include "engine/step/state.h"

namespace weft {

struct Plan {
  int substeps = 1;
  bool is_predicted = false;  // solved is the prediction of the first substep
  std::array<Attempt, 9> attempts{};
  std::size_t count = 0;

  std::span<const Attempt> list() const { return {attempts.data(), count}; }
  /// The first whose parts begin there; begin in finest parts.
  std::size_t first_at(int begin) const {
    std::size_t i = 0;
    while (i + 1 < count && begin % (kFinest / attempts[i].parts) != 0) ++i;
    return i;
  }
};

/// The estimate predicts all of dt: it writes over solved and, with heavy spheres, contacts.
Plan plan_for(State& s, double dt, StepReport& report, Team& team);

}  // namespace weft
