#include "tools/program/commands/replay_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "tools/program/commands/run_progress.h"
#include "tools/program/files/text_file.h"
#include "tools/program/recording/replay.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/text/parse.h"
#include "tools/program/text/wording.h"

namespace weft::tools {
namespace {

struct GivenOptions {
  std::string file;
  std::optional<std::string> isa;
  std::optional<int> threads;
};

Result<ReplayOptions> options_of(const GivenOptions& given) {
  ReplayOptions options;
  options.threads = given.threads;
  if (!given.isa) return options;
  const auto isa = parse_choice<Isa>("--isa", *given.isa);
  if (!isa) return Error{isa.error()};
  options.isa = isa.value();
  return options;
}

/// What is another one here than where the run was recorded.
void tell_of_others(const RecordedStart& start, Isa isa) {
  if (start.version != version_text()) {
    print_message(fmt::format("weft: recorded by weft {}, and this is {}: steps may differ\n",
                              shown(start.version), version_text()));
  }
  if (isa == start.settings.isa || start.settings.backend == Backend::reference) return;
  const bool rounds_otherwise = isa == Isa::sse2 || start.settings.isa == Isa::sse2;
  print_message(fmt::format(
      "weft: recorded on {}, and this runs on {}: steps {}\n", name(start.settings.isa), name(isa),
      rounds_otherwise ? "differ, since sse2 rounds otherwise" : "should not differ"));
}

std::string result_text(const RecordedResult& result) {
  return fmt::format("{:016x} ({})", result.hash, name(result.status));
}

/// The steps that were done; the file may end within one.
std::size_t done_steps(const Recording& recording) {
  return static_cast<std::size_t>(
      std::ranges::count_if(recording.steps, [](const auto& step) { return bool(step.result); }));
}

std::string text(const Recording& recording, const ReplaySummary& summary) {
  const RecordedStart& start = recording.start;
  const std::size_t steps = done_steps(recording);
  std::string text = fmt::format("recorded  {}{}weft {}, {}, {}\n", shown(start.note),
                                 start.note.empty() ? "" : ", ", shown(start.version),
                                 name(start.settings.isa), counted(steps, "step"));
  if (!recording.is_finished)
    text += "end       missing: the program was killed, or the file is cut off\n";
  text += fmt::format("replayed  {} to the same bits\n", counted(summary.last_step, "step"));
  if (summary.last_state) text += fmt::format("state     {}\n", result_text(*summary.last_state));
  return text;
}

std::string text(const Difference& difference) {
  const std::string where = difference.step == 0
                                ? "the state before the first step"
                                : fmt::format("step {} is the first that", difference.step);
  return fmt::format("{} differs: recorded {}, now {}", where, result_text(difference.recorded),
                     result_text(difference.found));
}

Result<int> replay_verb(const GivenOptions& given) {
  const auto options = options_of(given);
  if (!options) return Error{options.error()};
  const auto recording = read_recording(given.file);
  if (!recording) return Error{recording.error()};
  const RecordedStart& start = recording.value().start;
  Result<ReplaySummary> summary = Error{""};
  {
    RunPlan plan;
    plan.steps = std::max(1, static_cast<int>(recording.value().steps.size()));
    RunProgress progress(plan);
    summary = replay(recording.value(), options.value(), [&](int, const StepReport& report) {
      progress.add_frame();
      progress.show(report.max_strain);
    });
  }
  if (!summary) {
    const bool is_of_another = start.version != version_text();
    return Error{fmt::format("'{}': {}{}", given.file, summary.error(),
                             is_of_another ? fmt::format(" (recorded by weft {}, and this is {})",
                                                         shown(start.version), version_text())
                                           : "")};
  }
  tell_of_others(start, summary.value().isa);
  if (auto printed = print_text(text(recording.value(), summary.value())); !printed)
    return Error{printed.error()};
  if (summary.value().past_end) {
    print_message(fmt::format("weft: the program ended within step {}; here that comes to {}\n",
                              summary.value().last_step + 1,
                              result_text(*summary.value().past_end)));
  }
  if (!summary.value().difference) return kDone;
  print_message(fmt::format("weft: {}\n", text(*summary.value().difference)));
  return kCaseFailed;
}

}  // namespace

void add_replay_command(CommandLine& line) {
  auto given = std::make_shared<GivenOptions>();
  Verb verb =
      line.add_verb("replay", "Run a recording again; name the first step that differs", [given] {
        const auto result = replay_verb(*given);
        return result ? result.value() : refuse(result.error());
      });
  verb.required("FILE", given->file, "what `weft run --record` or Cloth::begin_recording wrote");
  verb.option("--isa", given->isa,
              "sse2, avx2, avx512 or neon (default: as recorded, or the best there is)");
  verb.within(0, kMaxThreads, "--threads", given->threads,
              "most threads of a step (default: as recorded)");
}

}  // namespace weft::tools
