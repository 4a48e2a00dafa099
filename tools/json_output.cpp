#include "tools/json_output.h"

#include <cerrno>
#include <cstring>

namespace weft::tools {

Result<JsonOutput> JsonOutput::open(const std::string& destination) {
  JsonOutput output;
  if (destination == "-") return output;
  auto file = PendingFile::open(destination);
  if (!file) return Error{file.error()};
  output.file_ = std::move(file.value());
  return output;
}

Result<void> JsonOutput::write(const Json& json) {
  const std::string text = json.dump(2) + '\n';
  if (file_) {
    file_->write(text);
    return file_->commit();
  }
  const bool complete =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!complete) return Error{std::string("cannot write to stdout: ") + std::strerror(errno)};
  return {};
}

}  // namespace weft::tools
