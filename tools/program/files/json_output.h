/// JSON results, to a file or to standard output.
#pragma once

#include <weft/weft.h>

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "tools/program/files/pending_file.h"

namespace weft::tools {

/// Keeps its keys in the order in which they were added. (Whoever makes one or reads it includes
/// nlohmann/json.hpp, two seconds of compiling.)
using Json = nlohmann::ordered_json;

/// Where a result goes. Open it before the work starts, so that a destination that cannot be
/// written is refused at once and not after minutes.
class JsonOutput {
 public:
  /// destination: a file name, or "-" for standard output.
  static Result<JsonOutput> open(const std::string& destination);
  /// Once. A file appears under its name only when it is complete.
  Result<void> write(const Json& json);
  bool is_stdout() const { return !file_.has_value(); }

 private:
  std::optional<PendingFile> file_;
};

/// Opens and writes.
Result<void> write_json(const std::string& destination, const Json& json);

}  // namespace weft::tools
