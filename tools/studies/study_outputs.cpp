#include "tools/studies/study_outputs.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "tools/program/files/pending_file.h"
#include "tools/program/files/text_file.h"

namespace weft::tools {
namespace {

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem) return Error{fmt::format("--out {}: {}", folder.string(), problem.message())};
  const auto probe = PendingFile::open(folder / "probe");  // dropped
  if (!probe) return Error{fmt::format("--out {}: no file can be written there", folder.string())};
  return {};
}

}  // namespace

void add_study_options(Verb verb, StudyOptions& options, const std::string& out,
                       const std::string& quick) {
  verb.option("--json", options.json, "write the results as JSON; - for standard output");
  verb.option("--out", options.out, out);
  verb.flag("--quick", options.quick, quick);
}

Result<StudyOutputs> StudyOutputs::open(const StudyOptions& options) {
  StudyOutputs outputs;
  outputs.folder_ = options.out;
  if (!options.out.empty()) {
    if (const auto made = make_folder(options.out); !made) return Error{made.error()};
  }
  if (options.json.empty()) return outputs;
  auto opened = JsonOutput::open(options.json);  // in the folder that was just made, perhaps
  if (!opened) return Error{fmt::format("--json: {}", opened.error())};
  outputs.json_ = std::move(opened.value());
  return outputs;
}

Result<void> StudyOutputs::write(const std::string& text, const Json& json,
                                 const WriteFolder& write_folder) {
  if (!folder_.empty()) {
    auto done = write_folder(folder_);
    if (!done) return Error{fmt::format("--out: {}", done.error())};
  }
  if (json_) {
    auto done = json_->write(json);
    if (!done) return Error{fmt::format("--json: {}", done.error())};
  }
  return json_ && json_->is_stdout() ? Result<void>{} : print_text(text);
}

}  // namespace weft::tools
