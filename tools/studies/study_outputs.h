/// What verbs that measure have in common: how much they do (--quick), and where they put their
/// results: --json FILE|-, --out FOLDER, standard output.
#pragma once

#include <weft/weft.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "tools/program/files/json_output.h"
#include "tools/program/terminal/command_line.h"

namespace weft::tools {

struct StudyOptions {
  std::string json;  ///< empty: not asked for
  std::string out;   ///< likewise
  bool quick = false;
};

/// out, quick: what they do for this verb.
void add_study_options(Verb verb, StudyOptions& options, const std::string& out,
                       const std::string& quick);

class StudyOutputs {
 public:
  /// Before minutes of work, not after: what cannot be written is refused at once. Makes the folder
  /// if need be.
  static Result<StudyOutputs> open(const StudyOptions& options);

  using WriteFolder = std::function<Result<void>(const std::filesystem::path& folder)>;
  /// The folder, the JSON, and the text, last, unless the JSON goes to standard output.
  Result<void> write(const std::string& text, const Json& json, const WriteFolder& write_folder);

 private:
  std::optional<JsonOutput> json_;
  std::string folder_;
};

}  // namespace weft::tools
