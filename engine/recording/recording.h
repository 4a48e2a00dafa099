/// The steps of a cloth as bytes, to be done again elsewhere bit for bit (Cloth::begin_recording).
///
/// A recording is a row of parts: the start (settings, model, state), and then for each step the
/// changes by calls before it, its status, and the hash of the state that it reached. Changes are
/// found by comparing saved states and models, so no call can be missed. Each part has a checksum.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/recording/patches.h"

namespace weft {

struct RecordedStart {
  std::string version;  ///< of the library
  std::string note;     ///< of the caller
  Settings settings;    ///< as they were asked for; isa as it was chosen
  std::vector<std::byte> model, state;
  std::uint64_t hash = 0;  ///< of the state
};

/// Between the steps.
struct RecordedCalls {
  double dt = 0;                 ///< s, of the step that follows
  std::vector<std::byte> model;  ///< that replaced the one before; empty: none
  std::vector<Patch> state;      ///< changes of the state (patched_state)
};

struct RecordedResult {
  Status status = Status::converged;
  std::uint64_t hash = 0;
};

struct RecordedStep {
  RecordedCalls calls;
  /// None: the program ended within the step, if it is the last one; else memory ran out, and the
  /// step was not done.
  std::optional<RecordedResult> result;
};

struct Recording {
  RecordedStart start;
  std::vector<RecordedStep> steps;
  bool is_finished = false;  ///< else the program was killed, or the file is cut off
};

/// This library's, "0.6.0".
std::string version_text();

/// The parts, as bytes.
std::vector<std::byte> bytes_of(const RecordedStart& start);
std::vector<std::byte> bytes_of(const RecordedCalls& calls);
std::vector<std::byte> bytes_of(const RecordedResult& result);
std::vector<std::byte> bytes_of_end();

/// An error says which part is damaged.
Result<Recording> parse_recording(std::span<const std::byte> bytes);

}  // namespace weft
