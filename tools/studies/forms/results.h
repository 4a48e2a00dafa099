/// The table of closed forms, as text, Markdown and JSON.
#pragma once

#include <string>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/studies/forms/form.h"

namespace weft::tools::forms {

int failed(const std::vector<FormResult>& results);
std::string to_text(const std::vector<FormResult>& results);
std::string to_markdown(const std::vector<FormResult>& results);
Json to_json(const std::vector<FormResult>& results);

}  // namespace weft::tools::forms
