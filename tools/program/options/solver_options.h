/// How a scene is solved, as given on the command line.
#pragma once

#include <weft/weft.h>

#include <optional>
#include <string>

#include "tools/program/terminal/command_line.h"

namespace weft::tools {

struct SolverOptions {
  Settings settings;  ///< numbers are read into it directly
  std::optional<std::string> tolerance;
  std::optional<std::string> solver;
  std::optional<std::string> scheme;
  std::optional<std::string> anticipate;
  std::optional<std::string> skip;
  std::optional<std::string> sleep;
  std::optional<std::string> directions;
  std::optional<std::string> velocity_correction;
  std::optional<std::string> backend;
  std::optional<std::string> isa;
  std::optional<std::string> substeps;
};

void add_solver_options(Verb verb, SolverOptions& options);

/// Settings with everything that was given. Ranges of numbers are Cloth::create()'s to check.
Result<Settings> settings_of(const SolverOptions& options);

}  // namespace weft::tools
