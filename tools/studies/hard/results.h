/// The results of the hard cases in the forms in which they are written.
#pragma once

#include <string>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/studies/hard/suite.h"

namespace weft::tools::hard {

int failed(const std::vector<CaseResult>& results);

Json to_json(const std::vector<CaseResult>& results);
std::string to_csv(const std::vector<CaseResult>& results);
/// A row for each case, a column for each method: figure / ms per step.
std::string to_markdown(const std::vector<CaseResult>& results);
std::string to_text(const std::vector<CaseResult>& results);

}  // namespace weft::tools::hard
