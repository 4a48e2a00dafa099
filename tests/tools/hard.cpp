#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "temporary_folder.h"
#include "tools/hard/results.h"
#include "tools/hard/suite.h"

namespace weft::tools::hard {
namespace {

CaseResult made_up(double figure, const std::string& failure) {
  CaseResult result{"a/direct", "max strain", {Solver::direct, Scheme::paper}, 1, {}, 0};
  result.outcome.figure = figure;
  result.outcome.failure = failure;
  result.outcome.detail = "detail";
  return result;
}

TEST_CASE("a figure above its bound fails, and so do a reason and what is no number") {
  CHECK(made_up(1, "").passed());
  CHECK_FALSE(made_up(1.01, "").passed());
  CHECK_FALSE(made_up(0, "reason").passed());
  CHECK_FALSE(made_up(std::numeric_limits<double>::quiet_NaN(), "").passed());
}

TEST_CASE("the JSON has the contract's keys, and counts what failed") {
  const Json json = to_json({made_up(1, ""), made_up(2, ""), made_up(0, "reason")});
  CHECK(json["passed"] == 1);
  CHECK(json["failed"] == 2);
  REQUIRE(json["cases"].size() == 3);
  CHECK(json["cases"][0]["name"] == "a/direct");
  CHECK(json["cases"][0]["result"] == "pass");
  CHECK(json["cases"][1]["result"] == "fail");
  CHECK(json["cases"][1]["figure"] == 2);
  CHECK(json["cases"][1]["bound"] == 1);
  CHECK(json["cases"][2]["detail"] == "reason: detail");
}

TEST_CASE("there are at least 40 cases, no two of a name, and each is claimed by a method") {
  std::set<std::string> names;
  for (const Case& hard_case : all_cases()) {
    CAPTURE(hard_case.name);
    CHECK(names.insert(hard_case.name).second);
    CHECK_FALSE(hard_case.measures.empty());
  }
  CHECK(names.size() >= 40);
}

int exit_code(const std::string& arguments) {
  const int status = std::system((std::string(WEFT_PROGRAM) + " hard " + arguments).c_str());
  REQUIRE(WIFEXITED(status));
  return WEXITSTATUS(status);
}

TEST_CASE("the verb runs the cases that are named, and writes the table") {
  const TemporaryFolder folder;
  CHECK(exit_code("--quick --case one_particle --json " + folder.file("hard.json") + " --out " +
                  folder.file("tables") + " >" + folder.file("stdout") + " 2>/dev/null") == 0);
  const Json json = Json::parse(folder.read("hard.json"));
  CHECK(json["failed"] == 0);
  CHECK(json["cases"].size() >= 2);
  CHECK(folder.read("tables/hard.csv").find("one_particle/direct,direct,paper,pass,") !=
        std::string::npos);
  CHECK(folder.read("tables/hard.md").find("\n| one_particle: max strain | 0.01 | 0 / ") !=
        std::string::npos);
  CHECK(folder.read("stdout").find("one_particle/gauss_seidel ") != std::string::npos);
  CHECK(exit_code("--case no_such_case 2>" + folder.file("stderr")) == 2);
  CHECK(folder.read("stderr") == "weft: --case: no case is named 'no_such_case'\n");
}

TEST_CASE("no quick case fails" * doctest::test_suite("slow")) {
  const TemporaryFolder folder;
  CHECK(exit_code("--quick --json - 2>/dev/null >" + folder.file("hard.json")) == 0);
  for (const Json& result : Json::parse(folder.read("hard.json"))["cases"]) {
    CAPTURE(result.dump());
    CHECK(result["result"] == "pass");
  }
}

}  // namespace
}  // namespace weft::tools::hard
