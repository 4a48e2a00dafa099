#include "tools/study_outputs.h"

#include <fmt/format.h>

#include <utility>

#include "tools/output_folder.h"
#include "tools/text_file.h"

namespace weft::tools {

Result<StudyOutputs> StudyOutputs::open(const std::string& json, const std::string& folder) {
  StudyOutputs outputs;
  outputs.folder_ = folder;
  if (!json.empty()) {
    auto opened = JsonOutput::open(json);
    if (!opened) return Error{fmt::format("--json: {}", opened.error())};
    outputs.json_ = std::move(opened.value());
  }
  if (folder.empty()) return outputs;
  if (const auto made = make_output_folder(folder); !made) return Error{made.error()};
  return outputs;
}

Result<void> StudyOutputs::write(const std::string& text, const Json& json,
                                 const WriteFolder& write_folder) {
  if (!folder_.empty()) {
    if (auto done = write_folder(folder_); !done) return done;
  }
  if (json_) {
    if (auto done = json_->write(json); !done) return done;
  }
  return json_ && json_->is_stdout() ? Result<void>{} : print_text(text);
}

}  // namespace weft::tools
