/// A recorded run, once more: whether every frame comes to the bits that it came to.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <optional>

#include "tools/program/recording/recording.h"

namespace weft::tools {

/// The first frame that is another one; 0: the start is.
struct Difference {
  int frame = 0;
  RecordedResult recorded, found;
};

struct ReplaySummary {
  Isa isa = Isa::automatic;  ///< that the kernels ran on
  int last_frame = 0;
  std::optional<Difference> difference;
  /// The calls of a frame without a result were made, and its step came to its end.
  std::optional<RecordedResult> past_end;
};

/// Called after every frame that was replayed.
using ReplayCallback = std::function<void(int frame, const StepReport&)>;

/// With the settings of the recording, on other instructions or threads where these are given, and
/// on others where this machine lacks those of the recording. Ends with the first difference. An
/// error means that the model, the state or a call was refused.
struct ReplayOptions {
  std::optional<Isa> isa;
  std::optional<int> threads;
};
Result<ReplaySummary> replay(const Recording& recording, const ReplayOptions& options,
                             const ReplayCallback& on_frame = {});

}  // namespace weft::tools
