#include "tools/studies/forms/forms_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/program/files/pending_file.h"
#include "tools/program/terminal/exit_code.h"
#include "tools/program/terminal/progress.h"
#include "tools/studies/forms/results.h"
#include "tools/studies/study_outputs.h"

namespace weft::tools {
namespace {

struct FormsOptions : StudyOptions {
  std::string name;
};

Result<int> run_forms(const FormsOptions& options) {
  std::vector<forms::Form> selected = forms::all_forms();
  std::erase_if(selected, [&](const forms::Form& form) {
    return form.name.find(options.name) == std::string::npos;
  });
  if (selected.empty()) return Error{fmt::format("--form: none is named '{}'", options.name)};
  auto outputs = StudyOutputs::open(options);
  if (!outputs) return Error{outputs.error()};
  std::vector<forms::FormResult> results;
  {
    TaskLine line(selected.size());
    for (const forms::Form& form : selected) {
      line.next(form.name);
      results.push_back(
          forms::measure(form, options.quick ? forms::kRefinements - 1 : forms::kRefinements));
    }
  }
  const auto done = outputs.value().write(
      forms::to_text(results), forms::to_json(results), [&](const std::filesystem::path& folder) {
        return write_file(folder / "forms.md", forms::to_markdown(results));
      });
  if (!done) return Error{done.error()};
  return forms::failed(results) > 0 ? kCaseFailed : kDone;
}

}  // namespace

void add_forms_command(CommandLine& line) {
  const auto options = std::make_shared<FormsOptions>();
  Verb verb = line.add_verb(
      "forms", "Hold cloth against closed forms: error and time at three meshes or steps each",
      [options] {
        const auto result = run_forms(*options);
        return result ? result.value() : refuse(result.error());
      });
  add_study_options(verb, *options, "write the table, forms.md, into a folder",
                    "without the finest mesh, and without judging errors: a few seconds");
  verb.option("--form", options->name, "only those with this in their name");
}

}  // namespace weft::tools
