#include "engine/step/step.h"

#include <algorithm>

#include "engine/parallel/team.h"
#include "engine/step/reporting.h"
#include "engine/step/small_step.h"
#include "engine/step/solve.h"
#include "engine/step/substeps.h"

namespace weft {
namespace {

/// Below this the loops are too short for one more thread: two gained nothing at 1,600
/// particles and 1.7 times at 10,000.
constexpr std::size_t kLeastSlotsPerThread = 1000;

int threads_worth_having(const State& s) {
  if (s.reference) return 1;
  const std::size_t most = s.model->slots() / kLeastSlotsPerThread;
  const std::size_t wanted = s.settings.threads > 0 ? static_cast<std::size_t>(s.settings.threads)
                                                    : static_cast<std::size_t>(kMaxThreads);
  return static_cast<int>(std::min(most, wanted));
}

/// The pins under way: whatever becomes of the step, they stand in the end where they were sent.
class Travel {
 public:
  Travel(State& s, double dt) : s_(s), jumped_(s.pins.depart(dt, s.position, s.velocity)) {}
  ~Travel() { s_.pins.stop(arrived_, s_.position, s_.velocity); }
  Travel(const Travel&) = delete;
  Travel& operator=(const Travel&) = delete;

  bool jumped() const { return jumped_; }
  void arrive() { arrived_ = true; }

 private:
  State& s_;
  const bool jumped_;
  bool arrived_ = false;
};

}  // namespace

StepReport step(State& s, double dt) {
  StepReport report;
  Team team(threads_worth_having(s), s.team_state);
  const bool by_small_steps = s.settings.solver == Solver::small_steps;
  bool done = false;
  {
    Travel travel(s, dt);
    const auto run = by_small_steps ? run_small_steps : run_substeps;
    done = run(s, dt, travel.jumped(), report, team);
    if (done) travel.arrive();
  }
  const bool reported = done && s.small_steps;
  if (!reported) timed(report, Stage::report, [&] { report_errors(s, s.position, report, team); });
  return report;
}

}  // namespace weft
