/// A file that appears under its name only when it is complete: it is written beside its place
/// under a temporary name, and renamed by commit(). One that replaces another has its permissions.
#pragma once

#include <weft/weft.h>

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace weft::tools {

class PendingFile {
 public:
  /// An error if nothing can be written at this place.
  static Result<PendingFile> open(const std::string& path);
  PendingFile(PendingFile&&) noexcept;
  PendingFile& operator=(PendingFile&&) noexcept;
  ~PendingFile();

  /// For seeking; write with write(), which remembers a failure.
  std::FILE* stream() const;
  void write(std::string_view bytes) const;

  /// Flushes, closes and renames. An error if any write before it failed. Without a commit the
  /// temporary file is removed when this object goes, or when the program is interrupted.
  Result<void> commit();

 private:
  struct State;
  explicit PendingFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Opens, writes and commits.
Result<void> write_file(const std::string& path, std::string_view content);

/// The temporary ones of all that live. For a signal handler that ends the program.
void remove_pending_files();

}  // namespace weft::tools
