/// Runs that go on where another one was: the files of --save and --resume.
///
/// A file holds the state of the cloth and how many frames came before; of cloth that has torn its
/// model, too. While a run lasts it is
/// written anew every now and then, and each time it is complete before it takes the place of the
/// last one: whenever the run is killed there is one to go on from.
#pragma once

#include <weft/weft.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace weft::tools {

struct RunState {
  int frame = 0;  ///< frames that were done
  double dt = 0;  ///< s, of each
  std::vector<std::byte> cloth = {};
  std::uint64_t scene = 0;           ///< the fingerprint of the model that the run began with
  std::uint32_t tears = 0;           ///< as Model::tears
  std::vector<std::byte> torn = {};  ///< the model of cloth that has torn; empty: it has not
};

/// The content of a file. An error says why it is none.
Result<RunState> parse_run_state(std::span<const std::byte> bytes);
std::vector<std::byte> bytes_of(const RunState& state);

/// An error names the file and says why.
Result<RunState> read_run_state(const std::string& path);

class StateFile {
 public:
  /// An error if nothing can be written there. scene: the model that the run begins with.
  static Result<StateFile> open(const std::string& path, double dt, const Model& scene);
  /// After a frame that was committed: writes the file if that is some time ago.
  void add_frame(const Cloth& cloth, int frame);
  /// After the last one that was.
  void add_last(const Cloth& cloth, int frame);
  /// Whether all that was to be written is.
  Result<void> finish() const { return written_; }

 private:
  StateFile(std::string path, double dt, const Model& scene);
  std::string path_;
  double dt_ = 0;
  std::uint64_t scene_ = 0;
  std::chrono::steady_clock::time_point last_;
  Result<void> written_;
};

}  // namespace weft::tools
