/// A recording, once more: whether every step comes to the bits that it came to.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <optional>
#include <string>

#include "engine/recording/recording.h"

namespace weft::tools {

/// The error names the file.
Result<Recording> read_recording(const std::string& path);

/// The first step that is another one; 0: the start is.
struct Difference {
  int step = 0;
  RecordedResult recorded, found;
};

struct ReplaySummary {
  Isa isa = Isa::automatic;  ///< that the kernels ran on
  int last_step = 0;
  std::optional<RecordedResult> last_state;  ///< after that
  std::optional<Difference> difference;
  /// The last step had no result, and came to its end now.
  std::optional<RecordedResult> past_end;
};

/// Called after every step that was replayed, counted from 1.
using ReplayCallback = std::function<void(int step, const StepReport&)>;

/// With the settings of the recording, on other instructions or threads where these are given, and
/// on others where this machine lacks those of the recording. Ends with the first difference. An
/// error means that the model or a state was refused.
struct ReplayOptions {
  std::optional<Isa> isa;
  std::optional<int> threads;
};
Result<ReplaySummary> replay(const Recording& recording, const ReplayOptions& options,
                             const ReplayCallback& on_step = {});

}  // namespace weft::tools
