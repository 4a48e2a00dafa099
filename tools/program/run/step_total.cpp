#include "tools/program/run/step_total.h"

#include <weft/report_fields.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>

namespace weft::tools {
namespace {

int sum_of(int a, int b) {
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(kMost, std::int64_t{a} + b));
}
std::int64_t sum_of(std::int64_t a, std::int64_t b) { return a + b; }
double sum_of(double a, double b) { return a + b; }
template <std::size_t n>
std::array<double, n> sum_of(std::array<double, n> a, const std::array<double, n>& b) {
  for (std::size_t i = 0; i < n; ++i) a[i] += b[i];
  return a;
}
ContactMs sum_of(const ContactMs& a, const ContactMs& b) {
  return {a.find + b.find, a.sweep + b.sweep, a.verify + b.verify};
}

}  // namespace

void add_step(StepReport& total, const StepReport& step) {
  for_each_report_field([&]<class T>(const ReportField<T>& field) {
    T& sum = total.*field.member;
    const T& value = step.*field.member;
    if (field.over_steps == OverSteps::last) sum = value;
    if constexpr (std::totally_ordered<T>) {
      if (field.over_steps == OverSteps::largest) sum = std::max(sum, value);
    }
    if constexpr (requires { sum_of(sum, value); } && !std::same_as<T, bool>) {
      if (field.over_steps == OverSteps::sum) sum = sum_of(sum, value);
    }
  });
}

}  // namespace weft::tools
