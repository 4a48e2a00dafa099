/// Runs that go on where another one was: the files of --save and --resume.
///
/// A file holds the state of the cloth and how many frames came before. While a run lasts it is
/// written anew every now and then, and each time it is complete before it takes the place of the
/// last one: whenever the run is killed there is one to go on from.
#pragma once

#include <weft/weft.h>

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace weft::tools {

struct RunState {
  int frame = 0;  ///< frames that were done
  double dt = 0;  ///< s, of each
  std::vector<std::byte> cloth = {};
};

/// The content of a file. An error says why it is none.
Result<RunState> parse_run_state(std::span<const std::byte> bytes);
std::vector<std::byte> bytes_of(const RunState& state);

/// An error names the file and says why.
Result<RunState> read_run_state(const std::string& path);

class StateFile {
 public:
  /// An error if nothing can be written there.
  static Result<StateFile> open(const std::string& path, double dt);
  /// After a frame that was committed: writes the file if that is some time ago.
  void add_frame(const Cloth& cloth, int frame);
  /// After the last one that was.
  void add_last(const Cloth& cloth, int frame);
  /// Whether all that was to be written is.
  Result<void> finish() const { return written_; }

 private:
  StateFile(std::string path, double dt);
  std::string path_;
  double dt_ = 0;
  std::chrono::steady_clock::time_point last_;
  Result<void> written_;
};

}  // namespace weft::tools
