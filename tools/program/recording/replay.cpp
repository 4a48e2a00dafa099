#include "tools/program/recording/replay.h"

#include <fmt/format.h>

#include <utility>

namespace weft::tools {
namespace {

bool is_same(const RecordedResult& a, const RecordedResult& b) {
  return a.status == b.status && a.hash == b.hash;
}

Result<Cloth> create(const RecordedStart& start, const ReplayOptions& options) {
  const auto model = load_model(start.model);
  if (!model) return Error{model.error()};
  Settings settings = start.settings;
  settings.isa = options.isa.value_or(start.isa);
  settings.threads = options.threads.value_or(settings.threads);
  auto cloth = Cloth::create(model.value(), settings);
  if (cloth || options.isa) return cloth;
  settings.isa = Isa::automatic;  // this machine lacks those
  return Cloth::create(model.value(), settings);
}

}  // namespace

Result<ReplaySummary> replay(const Recording& recording, const ReplayOptions& options,
                             const ReplayCallback& on_frame) {
  const RecordedStart& start = recording.start;
  auto created = create(start, options);
  if (!created) return Error{created.error()};
  Cloth& cloth = created.value();
  if (auto loaded = cloth.load_state(start.state); !loaded) return Error{loaded.error()};
  ReplaySummary summary{cloth.settings().isa, start.frames_before, {}, {}};
  if (cloth.state_hash() != start.hash) {
    summary.difference = {
        0, {Status::converged, start.hash}, {Status::converged, cloth.state_hash()}};
    return summary;
  }
  for (const RecordedFrame& frame : recording.frames) {
    const int number = summary.last_frame + 1;
    const auto refused = [&](const std::string& why) {
      return Error{fmt::format("frame {}: {}", number, why)};
    };
    if (auto done = apply(frame.calls, cloth); !done) return refused(done.error());
    const auto report = cloth.step(start.dt);
    if (!report) return refused(report.error());
    const RecordedResult found{report.value().status, cloth.state_hash()};
    if (!frame.result) {
      summary.past_end = found;
      return summary;
    }
    if (!is_same(found, *frame.result)) {
      summary.difference = {number, *frame.result, found};
      return summary;
    }
    summary.last_frame = number;
    if (on_frame) on_frame(number, report.value());
  }
  return summary;
}

}  // namespace weft::tools
