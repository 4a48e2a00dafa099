/// The report of one run: as JSON with the keys of the command line contract, and as a table. No
/// time is told without the strain that it bought.
#pragma once

#include <weft/weft.h>

#include <string>

#include "tools/json_output.h"
#include "tools/runner.h"

namespace weft::tools {

struct RunReport {
  std::string scene;
  Settings settings;
  RunPlan plan;
  RunSummary summary;
};

Json to_json(const RunReport& report);
std::string to_table(const RunReport& report);

}  // namespace weft::tools
