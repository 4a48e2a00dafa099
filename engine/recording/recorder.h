/// Writes the calls on a cloth to a file (recording.h), part by part: a program that crashes leaves
/// all calls before the crash.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/step/state.h"

namespace weft {

class Recorder {
 public:
  /// `asked`: the settings. An error if nothing can be written there.
  static Result<std::unique_ptr<Recorder>> begin(const std::string& path, std::string_view note,
                                                 const Settings& asked, const State& state);

  /// A step goes on whatever becomes of the file: end() tells.
  void before_step(const State& state, double dt) noexcept;
  void after_step(const State& state, Status status) noexcept;
  /// Whether all that was to be written is.
  Result<void> end();
  std::size_t bytes() const { return state_.capacity(); }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Recorder(std::string path, std::FILE* file, std::shared_ptr<const Model> model);

  void add_part(std::span<const std::byte> part);
  void try_to(const auto& write) noexcept;

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::shared_ptr<const Model> model_;
  std::vector<std::byte> state_;  ///< as the last part left it
  Result<void> written_;
};

/// A step, with what goes before it and behind it where there is a recorder.
StepReport recorded(Recorder* recorder, const State& state, double dt, const auto& step) {
  if (recorder != nullptr) recorder->before_step(state, dt);
  StepReport report = step();
  if (recorder != nullptr) recorder->after_step(state, report.status);
  return report;
}

/// The saved state that calls made of another one.
Result<std::vector<std::byte>> patched_state(std::span<const std::byte> before,
                                             std::span<const Patch> patches);

}  // namespace weft
