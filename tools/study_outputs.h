/// Where a verb that measures puts its results: --json FILE|-, --out FOLDER, standard output.
#pragma once

#include <weft/weft.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "tools/json_output.h"

namespace weft::tools {

class StudyOutputs {
 public:
  /// Before minutes of work, not after: what cannot be written is refused at once. Empty: not asked
  /// for.
  static Result<StudyOutputs> open(const std::string& json, const std::string& folder);

  using WriteFolder = std::function<Result<void>(const std::filesystem::path& folder)>;
  /// The folder, the JSON, and the text, last, unless the JSON goes to standard output.
  Result<void> write(const std::string& text, const Json& json, const WriteFolder& write_folder);

 private:
  std::optional<JsonOutput> json_;
  std::string folder_;
};

}  // namespace weft::tools
