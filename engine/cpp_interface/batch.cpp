#include <weft/batch.h>

#include <algorithm>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "engine/model/validate.h"
#include "engine/parallel/crew.h"
#include "engine/recording/recorder.h"
#include "engine/step/state.h"
#include "engine/step/step.h"
#include "engine/step/validate_settings.h"
#include "engine/validation.h"

namespace weft {

/// Cloths of a batch as the pieces of work of a crew. Those that were refused have an error.
class ClothBatch : public Pieces {
 public:
  ClothBatch(std::span<ClothStep> steps, const JobSystem& jobs);

  std::size_t count() const override { return steps_.size(); }
  bool is_due(std::size_t i) const override { return bool(steps_[i].result); }
  int threads(std::size_t i) const override;
  Team::SharedState& shared(std::size_t i) override { return *state(i).team_state; }
  void lead(std::size_t i, Team& team) noexcept override;

  std::shared_ptr<ArenaRun> arena_run() const;

 private:
  bool has_state(std::size_t i) const {
    return steps_[i].cloth != nullptr && steps_[i].cloth->state() != nullptr;
  }
  State& state(std::size_t i) const { return *steps_[i].cloth->state(); }
  Result<void> admit(std::size_t i);

  std::span<ClothStep> steps_;
};

namespace {

/// Short enough to need no memory.
Error out_of_memory() { return Error{"out of memory"}; }

}  // namespace

ClothBatch::ClothBatch(std::span<ClothStep> steps, const JobSystem& jobs) : steps_(steps) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    try {
      auto admitted = validate(jobs);
      if (admitted) admitted = admit(i);
      if (!admitted)
        steps[i].result = Error{admitted.error()};
      else if (!steps[i].result)
        steps[i].result = StepReport{};
    } catch (const std::bad_alloc&) {
      steps[i].result = out_of_memory();
    }
  }
}

/// Whether cloth i may take part. If so it is marked until it is stepped.
Result<void> ClothBatch::admit(std::size_t i) {
  const auto refused = [i](std::string_view reason, const std::string& value) {
    return refuse(element("steps", i) + ".cloth", reason, value);
  };
  if (steps_[i].cloth == nullptr) return refused("must not be null", "null");
  if (!has_state(i)) return refused("was moved from", "empty");
  if (auto valid = validate_time_step(steps_[i].dt); !valid)
    return Error{element("steps", i) + "." + valid.error()};
  if (std::exchange(state(i).is_in_batch, true)) return refused("is in the batch already", "twice");
  return {};
}

int ClothBatch::threads(std::size_t i) const {
  return has_state(i) ? state(i).threads_worth_having() : 1;
}

void ClothBatch::lead(std::size_t i, Team& team) noexcept {
  State& s = state(i);
  s.is_in_batch = false;
  try {
    const double dt = steps_[i].dt;
    Recorder* const recorder = steps_[i].cloth->recorder_.get();
    steps_[i].result = recorded(recorder, s, dt, [&] { return step(s, dt, team); });
  } catch (const std::bad_alloc&) {
    steps_[i].result = out_of_memory();
  }
}

/// The run of the first cloth, which keeps it for later batches; null without memory.
std::shared_ptr<ArenaRun> ClothBatch::arena_run() const {
  const auto admitted =
      std::ranges::find_if(steps_, [](const ClothStep& step) { return bool(step.result); });
  if (admitted == steps_.end()) return nullptr;
  std::shared_ptr<ArenaRun>& arena_run = admitted->cloth->state()->arena_run;
  try {
    if (!arena_run) arena_run = std::make_shared<ArenaRun>();
  } catch (const std::bad_alloc&) {
  }
  return arena_run;
}

void step_all(std::span<ClothStep> steps, const JobSystem& jobs) noexcept {
  ClothBatch batch(steps, jobs);
  Crew::work(batch, jobs, jobs.run == nullptr ? batch.arena_run() : nullptr);
}

}  // namespace weft
