#include "tools/studies/hard/suite.h"

#include <fmt/format.h>

#include <chrono>

namespace weft::tools::hard {

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const auto& cases :
       {mass_cases(), infeasible_cases(), start_cases(), step_cases(), place_cases(),
        motion_cases(), length_cases(), graph_cases(), material_cases(), input_cases(),
        sheet_cases(), budget_cases(), rest_cases(), bending_cases(), body_cases(), mesh_cases(),
        layer_cases(), knot_cases(), pressure_cases()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

std::vector<Selected> select(std::string_view filter) {
  std::vector<Selected> selected;
  for (const Case& hard_case : all_cases()) {
    for (const Method& method : all_methods()) {
      const std::string name = fmt::format("{}/{}", hard_case.name, label(method));
      if (!hard_case.claimed(method) || name.find(filter) == std::string::npos) continue;
      selected.push_back({name, hard_case, method});
    }
  }
  return selected;
}

CaseResult run(const Selected& selected, bool quick) {
  const Case& hard_case = selected.hard_case;
  CaseResult result{selected.name, hard_case.measures, selected.method, hard_case.bound, {}, 0};
  const auto start = std::chrono::steady_clock::now();
  result.outcome = hard_case.run({selected.method, quick});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  result.seconds = took.count();
  return result;
}

}  // namespace weft::tools::hard
