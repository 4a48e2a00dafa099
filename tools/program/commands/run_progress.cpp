#include "tools/program/commands/run_progress.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/program/text/wording.h"

namespace weft::tools {
namespace {

std::size_t runs_of(const RunPlan& plan) {
  return plan.repeat > 1 ? static_cast<std::size_t>(plan.repeat) + 1 : 1;  // one to warm up
}
std::size_t before_of(const RunPlan& plan) {
  return plan.resume ? static_cast<std::size_t>(plan.resume->frame) : 0;
}
std::size_t frames_of(const RunPlan& plan) {
  return static_cast<std::size_t>(plan.steps) - before_of(plan);
}

}  // namespace

RunProgress::RunProgress(const RunPlan& plan)
    : frames_(frames_of(plan)),
      before_(before_of(plan)),
      runs_(runs_of(plan)),
      left_(frames_ * runs_) {}

void RunProgress::add_frame() {
  const auto now = Clock::now();
  left_.add(std::chrono::duration<double>(now - last_).count());
  last_ = now;
  const bool repeats = left_.done() > frames_;
  if (repeats && line_.redraws()) {
    const std::size_t repeat = (left_.done() - 1) / frames_;
    line_.show(text(fmt::format("repeat {}/{}", repeat, runs_ - 1)));
  }
}

void RunProgress::show(double max_strain) {
  if (line_.redraws()) line_.show(text("strain " + measured_percent(max_strain)));
}

std::string RunProgress::text(const std::string& detail) const {
  const std::size_t frame = (left_.done() - 1) % frames_ + 1 + before_;
  return fmt::format("{} frame {}/{}, {}, {} left", bar(left_.done(), frames_ * runs_, 20), frame,
                     frames_ + before_, detail, duration_text(left_.seconds()));
}

}  // namespace weft::tools
