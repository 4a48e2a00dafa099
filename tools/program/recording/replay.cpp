#include "tools/program/recording/replay.h"

#include <fmt/format.h>

#include <utility>

#include "engine/recording/recorder.h"
#include "tools/program/files/text_file.h"

namespace weft::tools {
namespace {

bool is_same(const RecordedResult& a, const RecordedResult& b) {
  return a.status == b.status && a.hash == b.hash;
}

Settings settings_of(const RecordedStart& start, const ReplayOptions& options) {
  Settings settings = start.settings;
  settings.isa = options.isa.value_or(settings.isa);
  settings.threads = options.threads.value_or(settings.threads);
  return settings;
}

Result<Cloth> create(std::span<const std::byte> bytes, Settings settings,
                     const ReplayOptions& options) {
  const auto model = load_model(bytes);
  if (!model) return Error{model.error()};
  auto cloth = Cloth::create(model.value(), settings);
  if (cloth || options.isa) return cloth;
  settings.isa = Isa::automatic;  // this machine lacks those
  return Cloth::create(model.value(), settings);
}

/// The model and the state become those that calls made of them.
Result<void> apply(const RecordedCalls& calls, const Settings& settings,
                   const ReplayOptions& options, Cloth& cloth) {
  if (calls.model.empty() && calls.state.empty()) return {};
  const auto state = patched_state(cloth.save_state(), calls.state);
  if (!state) return Error{state.error()};
  if (!calls.model.empty()) {
    auto other = create(calls.model, settings, options);
    if (!other) return Error{other.error()};
    cloth = std::move(other).value();
  }
  return cloth.load_state(state.value());
}

}  // namespace

Result<Recording> read_recording(const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return Error{text.error()};
  auto recording = parse_recording(std::as_bytes(std::span(text.value())));
  if (!recording) return Error{fmt::format("'{}': {}", path, recording.error())};
  return recording;
}

Result<ReplaySummary> replay(const Recording& recording, const ReplayOptions& options,
                             const ReplayCallback& on_step) {
  const RecordedStart& start = recording.start;
  const Settings settings = settings_of(start, options);
  auto created = create(start.model, settings, options);
  if (!created) return Error{created.error()};
  Cloth& cloth = created.value();
  if (auto loaded = cloth.load_state(start.state); !loaded) return Error{loaded.error()};
  ReplaySummary summary;
  summary.isa = cloth.settings().isa;
  const RecordedResult recorded_start{Status::converged, start.hash};
  const RecordedResult found_start{Status::converged, cloth.state_hash()};
  if (!is_same(found_start, recorded_start)) {
    summary.difference = {0, recorded_start, found_start};
    return summary;
  }
  for (const RecordedStep& step : recording.steps) {
    const int number = summary.last_step + 1;
    const auto refused = [&](const std::string& why) {
      return Error{fmt::format("step {}: {}", number, why)};
    };
    if (auto done = apply(step.calls, settings, options, cloth); !done)
      return refused(done.error());
    const bool is_last = &step == &recording.steps.back();
    if (!step.result && !is_last) continue;  // it was not done
    const auto report = cloth.step(step.calls.dt);
    if (!report) return refused(report.error());
    const RecordedResult found{report.value().status, cloth.state_hash()};
    if (!step.result) {
      summary.past_end = found;
      return summary;
    }
    if (!is_same(found, *step.result)) {
      summary.difference = {number, *step.result, found};
      return summary;
    }
    summary.last_step = number;
    summary.last_state = found;
    if (on_step) on_step(number, report.value());
  }
  return summary;
}

}  // namespace weft::tools
