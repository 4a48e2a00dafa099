/// What the measurements of section 5 amount to: Table 1, the averages of figures 2 and 3, and the
/// forms in which all of it is written.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/files/json_output.h"
#include "tools/studies/paper/study.h"

namespace weft::tools::paper {

/// A line of Table 1 in times faster than an original. `average` is 1 / mean(runtime / original's
/// runtime), which is how the paper's column follows from its percentages: for 4.3 it reports
/// average runtimes of 103 % and 95 %, and 1 / 0.99 = 1.01; in the same way 1 / 0.625 = 1.60 for
/// 4.2+4.3, 1 / 0.605 = 1.65 (printed 1.66), 1 / 0.40 = 2.50 (2.51), 1 / 0.29 = 3.45 (3.44) with
/// 4.4, and 1 / 0.69 = 1.45 (1.46) for 4.2: the percentages are rounded. It is not the mean of the
/// factors, which would be larger.
struct Gain {
  std::string_view label;
  double best = 0;
  double worst = 0;
  double average = 0;
  /// Mean runtime as a fraction of the original's, without and with velocity correction.
  std::array<double, 2> runtime{};
};

/// As printed in the paper, in the order of its Table 1.
std::vector<Gain> published_gains();
/// As measured, in the same order.
std::vector<Gain> measured_gains(const std::vector<Row>& rows);
/// Against the previewed original, and the original itself before all others.
std::vector<Gain> gains_on_previewed(const std::vector<Row>& rows);

/// The first run that missed its tolerance in some frame; none: nullptr.
const Row* first_missed(const Study& study);

Json to_json(const Study& study);
std::string rows_csv(const std::vector<Row>& rows);
std::string summary_csv(const Study& study);

/// For a reader: Table 1 beside the paper's, figure 4, and every row, each time beside its strain.
std::string to_text(const Study& study);

}  // namespace weft::tools::paper
