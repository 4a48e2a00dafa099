/// The program, run as its users run it.
#pragma once

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/temporary_folder.h"

namespace weft::tools {

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

/// `where`: the folder that it runs in.
inline Outcome run_program(const TemporaryFolder& folder, const std::string& arguments,
                           const std::string& where = ".") {
  const std::string command = "cd " + where + " && " + WEFT_PROGRAM + " " + arguments + " >" +
                              folder.file("stdout") + " 2>" + folder.file("stderr");
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  const Outcome outcome{WEXITSTATUS(status), folder.read("stdout"), folder.read("stderr")};
  std::filesystem::remove(folder.file("stdout"));
  std::filesystem::remove(folder.file("stderr"));
  return outcome;
}

/// The report of a run that succeeds.
inline nlohmann::json report_of(const TemporaryFolder& folder, const std::string& arguments) {
  const Outcome outcome = run_program(folder, "run " + arguments + " --json -");
  REQUIRE(outcome.exit_code == 0);
  return nlohmann::json::parse(outcome.out);
}

}  // namespace weft::tools
