/// A run as a file, to be repeated elsewhere bit for bit: the files of --record and `weft replay`.
///
/// A file is a row of parts: the start (model, state, settings, and what made them), and then of
/// each frame the calls before its step, and its status with the hash of the state that it reached.
/// Each part is written before the run goes on, so that a run that crashes leaves the calls that
/// led there. Each has a checksum.
#pragma once

#include <weft/weft.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/recording/frame_calls.h"

namespace weft::tools {

/// This library's, "0.4.0".
std::string version_text();

struct RecordedStart {
  std::string version;       ///< of the library
  std::string scene;         ///< as it was named
  Isa isa = Isa::automatic;  ///< that the kernels ran on
  Settings settings;         ///< as they were asked for
  int frames_before = 0;     ///< of a run that was resumed
  int frames = 0;            ///< that the run is to end with
  double dt = 0;             ///< s
  std::vector<std::byte> model, state;
  std::uint64_t hash = 0;  ///< of the state
};

struct RecordedResult {
  Status status = Status::converged;
  std::uint64_t hash = 0;
};

struct RecordedFrame {
  FrameCalls calls;
  std::optional<RecordedResult> result;  ///< none: the run ended within the step
};

struct Recording {
  RecordedStart start;
  std::vector<RecordedFrame> frames;
  bool is_finished = false;  ///< else the run was killed, or the file is cut off
};

/// An error says which part is damaged.
Result<Recording> parse_recording(std::span<const std::byte> bytes);
/// The error names the file.
Result<Recording> read_recording(const std::string& path);

/// The parts, as bytes.
std::vector<std::byte> bytes_of(const RecordedStart& start);
std::vector<std::byte> bytes_of(const FrameCalls& calls);
std::vector<std::byte> bytes_of(const RecordedResult& result);
std::vector<std::byte> bytes_of_end();

class RecordingFile {
 public:
  /// An error if nothing can be written there. A recording that is there stays until the first part
  /// replaces it: a run that is refused loses none.
  static Result<RecordingFile> open(const std::string& path);

  /// In the order of the parts.
  void add_part(std::span<const std::byte> part);
  /// Whether all that was to be written is.
  Result<void> finish();

 private:
  RecordingFile(std::string path, std::FILE* file);
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  bool has_part_ = false;
  Result<void> written_;
};

}  // namespace weft::tools
