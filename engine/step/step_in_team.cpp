#include "engine/step/step_in_team.h"

#include <exception>

#include "engine/parallel/crew.h"
#include "engine/step/step.h"

namespace weft {

StepReport step_in_team(State& state, double dt, const JobSystem& jobs) {
  const int threads = state.threads_worth_having();
  if (threads == 1) return step(state, dt);
  StepReport report;
  std::exception_ptr failure;  // of the thread that led
  in_team(threads, *state.team_state, jobs, state.arena_run, [&](Team& team) {
    try {
      report = step(state, dt, team);
    } catch (...) {
      failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
  return report;
}

}  // namespace weft
