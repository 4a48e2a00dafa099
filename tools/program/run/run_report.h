/// The report of one run, as JSON and as a table. Every time is printed with the strain that was
/// reached.
#pragma once

#include <weft/weft.h>

#include <optional>
#include <string>

#include "tools/program/files/json_output.h"
#include "tools/program/options/scene_source.h"
#include "tools/program/run/runner.h"

namespace weft::tools {

struct RunReport {
  std::string scene;
  Settings settings;
  RunPlan plan;
  RunSummary summary;
  std::optional<MeshCounts> mesh = {};
};

Json to_json(const RunReport& report);
std::string to_table(const RunReport& report);

}  // namespace weft::tools
