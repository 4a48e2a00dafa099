#include "tools/program/files/json_output.h"

#include <nlohmann/json.hpp>

#include "tools/program/files/text_file.h"

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
  constexpr int kIndent = 2;
  // A file's name may be any bytes; JSON is UTF-8.
  const auto rest = Json::error_handler_t::replace;
  const std::string text = json.dump(kIndent, ' ', false, rest) + '\n';
  if (!file_) return print_text(text);
  file_->write(text);
  return file_->commit();
}

Result<void> write_json(const std::string& destination, const Json& json) {
  auto output = JsonOutput::open(destination);
  if (!output) return Error{output.error()};
  return output.value().write(json);
}

}  // namespace weft::tools
