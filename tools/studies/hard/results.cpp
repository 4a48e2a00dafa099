#include "tools/studies/hard/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace weft::tools::hard {
namespace {

std::string_view verdict(const CaseResult& result) { return result.passed() ? "pass" : "fail"; }

std::string detail(const CaseResult& result) {
  const Outcome& outcome = result.outcome;
  if (outcome.failure.empty()) return outcome.detail;
  return fmt::format("{}: {}", outcome.failure, outcome.detail);
}

/// The name without the method.
std::string case_of(const CaseResult& result) {
  return result.name.substr(0, result.name.rfind('/'));
}

/// Figure / ms per step.
std::string cell(const CaseResult& result) {
  const std::string text =
      fmt::format("{:.2g} / {:.2g}", result.outcome.figure, result.outcome.ms_per_step);
  return result.passed() ? text : fmt::format("**fail** {}", text);
}

void add_new(std::vector<std::string>& list, const std::string& item) {
  if (std::ranges::find(list, item) == list.end()) list.push_back(item);
}

std::string quoted(std::string text) {
  std::ranges::replace(text, '"', '\'');
  return '"' + text + '"';
}

}  // namespace

int failed(const std::vector<CaseResult>& results) {
  return static_cast<int>(
      std::ranges::count_if(results, [](const CaseResult& result) { return !result.passed(); }));
}

Json to_json(const std::vector<CaseResult>& results) {
  Json cases = Json::array();
  for (const CaseResult& result : results) {
    cases.push_back({{"name", result.name},
                     {"result", verdict(result)},
                     {"figure", result.outcome.figure},
                     {"bound", result.bound},
                     {"detail", detail(result)},
                     {"measures", result.measures},
                     {"solver", name(result.method.solver)},
                     {"scheme", name(result.method.scheme)},
                     {"ms_per_step", result.outcome.ms_per_step},
                     {"seconds", result.seconds}});
  }
  const int bad = failed(results);
  return {{"cases", cases}, {"passed", static_cast<int>(results.size()) - bad}, {"failed", bad}};
}

std::string to_csv(const std::vector<CaseResult>& results) {
  std::string csv = "name,solver,scheme,result,measures,figure,bound,ms_per_step,seconds,detail\n";
  for (const CaseResult& r : results) {
    fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.3g},{}\n",
                   r.name, name(r.method.solver), name(r.method.scheme), verdict(r),
                   quoted(r.measures), r.outcome.figure, r.bound, r.outcome.ms_per_step, r.seconds,
                   quoted(detail(r)));
  }
  return csv;
}

std::string to_markdown(const std::vector<CaseResult>& results) {
  std::vector<std::string> methods, cases;
  std::map<std::pair<std::string, std::string>, std::string> cells;
  for (const CaseResult& r : results) {
    const std::string method = label(r.method);
    const std::string row = fmt::format("| {}: {} | {:.3g} |", case_of(r), r.measures, r.bound);
    add_new(methods, method);
    add_new(cases, row);
    cells[{row, method}] = cell(r);
  }
  std::string text = "| case: figure | bound |";
  std::string rule = "|---|---|";
  for (const std::string& method : methods) {
    text += fmt::format(" {} |", method);
    rule += "---|";
  }
  text += '\n' + rule + '\n';
  for (const std::string& row : cases) {
    text += row;
    for (const std::string& method : methods) text += fmt::format(" {} |", cells[{row, method}]);
    text += '\n';
  }
  return text;
}

std::string to_text(const std::vector<CaseResult>& results) {
  std::size_t width = 0;
  for (const CaseResult& result : results) width = std::max(width, result.name.size());
  std::string text;
  for (const CaseResult& r : results) {
    fmt::format_to(std::back_inserter(text), "{:{}}  {}  {:>9.3g} <= {:<9.3g} {}; {}\n", r.name,
                   width, r.passed() ? "pass" : "FAIL", r.outcome.figure, r.bound, r.measures,
                   detail(r));
  }
  const int bad = failed(results);
  fmt::format_to(std::back_inserter(text), "{} passed, {} failed\n",
                 static_cast<int>(results.size()) - bad, bad);
  return text;
}

}  // namespace weft::tools::hard
