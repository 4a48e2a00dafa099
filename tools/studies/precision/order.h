/// The order of convergence of a scheme: the error of its trajectory behaves like dt^order.
#pragma once

#include <weft/weft.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/studies/precision/task.h"

namespace weft::tools::precision {

struct OrderPoint {
  double dt = 0;     ///< s
  double error = 0;  ///< m, at 0.4 s
};

struct Order {
  std::string scene;  ///< with its size
  std::string scheme;
  std::vector<OrderPoint> points;
  std::optional<double> order;  ///< nothing if a run failed
};

/// The exponent p of y = c x^p, by least squares of the logarithms. Nothing for fewer than two
/// points, or if one is not positive.
std::optional<double> fitted_exponent(std::span<const double> x, std::span<const double> y);

/// Every scheme, so that nothing but the scheme is seen. paper, rattle: the direct solver, with
/// tight tolerances, at dt = 0.01 ... 0.00125 s. implicit, bdf2: small steps, with a tolerance so
/// loose that no local pass has anything to do, at dt = 0.0025 ... 0.0003125 s. The task has its
/// reference.
std::vector<Order> measure_orders(const Task& task);

}  // namespace weft::tools::precision
