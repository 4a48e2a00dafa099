#include "tools/hard/suite.h"

#include <fmt/format.h>

#include <chrono>

namespace weft::tools::hard {

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const auto& cases :
       {mass_cases(), infeasible_cases(), start_cases(), step_cases(), place_cases()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

std::vector<CaseResult> run_suite(std::string_view filter, bool quick, const Progress& progress) {
  std::vector<CaseResult> results;
  for (const Case& hard_case : all_cases()) {
    for (const Method& method : all_methods()) {
      const std::string name = fmt::format("{}/{}", hard_case.name, label(method));
      if (!hard_case.claimed(method) || name.find(filter) == std::string::npos) continue;
      progress(name);
      const auto start = std::chrono::steady_clock::now();
      CaseResult result{
          name, hard_case.measures, method, hard_case.bound, hard_case.run({method, quick}), 0};
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
      result.seconds = took.count();
      results.push_back(std::move(result));
    }
  }
  return results;
}

}  // namespace weft::tools::hard
