#include "tools/studies/forms/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace weft::tools::forms {
namespace {

/// One value of each reading.
template <class Value>
std::string all(const FormResult& result, const char* separator, Value&& value) {
  std::string text;
  for (const Reading& reading : result.readings) {
    if (!text.empty()) text += separator;
    text += value(reading);
  }
  return text;
}

std::string error_text(const Reading& r) {
  const std::string missed = r.missed > 0 ? fmt::format(" ({} missed)", r.missed) : "";
  return fmt::format("{:+.2f}{}", 100 * r.error(), missed);
}
std::string time_text(const Reading& r) { return fmt::format("{:.2g}", r.ms_per_frame); }
std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace

int failed(const std::vector<FormResult>& results) {
  return static_cast<int>(
      std::ranges::count_if(results, [](const FormResult& r) { return !r.holds(); }));
}

std::string to_text(const std::vector<FormResult>& results) {
  std::string text = fmt::format("{:42}{:>12}{:>12}{:>24}{:>8}{:>24}\n", "", "expected", "measured",
                                 "error, %", "bound", "ms per frame");
  for (const FormResult& r : results) {
    const Reading& finest = r.readings.back();
    fmt::format_to(std::back_inserter(text), "{:42}{:>12}{:>12}{:>24}{:>8g}{:>24}{}\n", r.name,
                   with_unit(finest.expected, r.unit), with_unit(finest.measured, r.unit),
                   all(r, ", ", error_text), 100 * r.bound, all(r, ", ", time_text),
                   r.holds() ? "" : "  FAIL");
  }
  const int bad = failed(results);
  fmt::format_to(std::back_inserter(text), "{} hold, {} do not\n",
                 static_cast<int>(results.size()) - bad, bad);
  return text;
}

std::string to_markdown(const std::vector<FormResult>& results) {
  std::string text =
      "| | closed form | meshes or steps | expected | measured | error, % | ms per frame |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const FormResult& r : results) {
    const Reading& finest = r.readings.back();
    fmt::format_to(std::back_inserter(text), "| {}{} | {} | {} | {} | {} | {} | {} |\n", r.name,
                   r.holds() ? "" : " **fails**", r.formula,
                   all(r, ", ", [](const Reading& reading) { return reading.size; }),
                   with_unit(finest.expected, r.unit), with_unit(finest.measured, r.unit),
                   all(r, ", ", error_text), all(r, ", ", time_text));
  }
  return text;
}

Json to_json(const std::vector<FormResult>& results) {
  Json forms = Json::array();
  for (const FormResult& r : results) {
    Json readings = Json::array();
    for (const Reading& reading : r.readings) {
      readings.push_back({{"size", reading.size},
                          {"expected", reading.expected},
                          {"measured", reading.measured},
                          {"error", reading.error()},
                          {"ms_per_frame", reading.ms_per_frame},
                          {"substeps", reading.substeps},
                          {"missed", reading.missed}});
    }
    forms.push_back({{"name", r.name},
                     {"formula", r.formula},
                     {"unit", r.unit},
                     {"bound", r.bound},
                     {"holds", r.holds()},
                     {"readings", std::move(readings)}});
  }
  const int bad = failed(results);
  return {{"forms", forms}, {"held", static_cast<int>(results.size()) - bad}, {"failed", bad}};
}

}  // namespace weft::tools::forms
