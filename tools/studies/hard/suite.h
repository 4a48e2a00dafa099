/// The hard cases, and the running of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/studies/hard/hard_case.h"

namespace weft::tools::hard {

// One file each.
std::vector<Case> mass_cases();
std::vector<Case> infeasible_cases();
std::vector<Case> start_cases();
std::vector<Case> step_cases();
std::vector<Case> place_cases();
std::vector<Case> motion_cases();
std::vector<Case> length_cases();
std::vector<Case> graph_cases();
std::vector<Case> material_cases();
std::vector<Case> input_cases();
std::vector<Case> sheet_cases();
std::vector<Case> budget_cases();
std::vector<Case> rest_cases();
std::vector<Case> bending_cases();
std::vector<Case> body_cases();
std::vector<Case> mesh_cases();
std::vector<Case> layer_cases();
std::vector<Case> knot_cases();
std::vector<Case> pressure_cases();

std::vector<Case> all_cases();

/// A case with one method that claims it.
struct CaseResult {
  std::string name;  ///< "chain_end_1e6/direct"
  std::string measures;
  Method method;
  double bound = 0;
  Outcome outcome;
  double seconds = 0;
  /// Lanes know an error to the last bit of a float: converged is a tolerance to 1.2e-7 of itself.
  bool passed() const { return outcome.failure.empty() && outcome.figure <= bound * (1 + 2e-7); }
};

/// What is still to be run.
struct Selected {
  std::string name;
  Case hard_case;
  Method method;
};

/// Cases with the methods that claim them, whose name contains the filter; empty: all.
std::vector<Selected> select(std::string_view filter);

CaseResult run(const Selected& selected, bool quick);

}  // namespace weft::tools::hard
