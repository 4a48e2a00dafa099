/// The hard cases, and the running of them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/hard/hard_case.h"

namespace weft::tools::hard {

// One file each.
std::vector<Case> mass_cases();
std::vector<Case> infeasible_cases();
std::vector<Case> start_cases();
std::vector<Case> step_cases();
std::vector<Case> place_cases();

std::vector<Case> all_cases();

/// A case with one method that claims it.
struct CaseResult {
  std::string name;  ///< "chain_end_1e6/direct"
  std::string measures;
  Method method;
  double bound = 0;
  Outcome outcome;
  double seconds = 0;
  bool passed() const { return outcome.failure.empty() && outcome.figure <= bound; }
};

/// Called before each run with its name.
using Progress = std::function<void(const std::string& name)>;

/// filter: runs whose name contains it; empty: all.
std::vector<CaseResult> run_suite(std::string_view filter, bool quick, const Progress& progress);

}  // namespace weft::tools::hard
