#include "tools/precision/order.h"

#include <cmath>

#include "tools/enumerators.h"
#include "tools/precision/sweep.h"

namespace weft::tools::precision {

std::optional<double> fitted_exponent(std::span<const double> x, std::span<const double> y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0)) return {};
    const double u = std::log(x[i]), v = std::log(y[i]);
    sx += u, sy += v, sxx += u * u, sxy += u * v;
  }
  const double spread = n * sxx - sx * sx;
  if (x.size() < 2 || !(spread > 0)) return {};
  return (n * sxy - sx * sy) / spread;
}

std::vector<Order> measure_orders(const Task& task) {
  std::vector<Order> orders;
  for (const Scheme scheme : enumerators<Scheme>()) {
    Order& order = orders.emplace_back(Order{std::string(name(scheme)), {}, {}});
    std::vector<double> steps, errors;
    bool all_ran = true;
    for (const int substeps : {1, 2, 4, 8}) {
      Settings settings;
      settings.solver = Solver::direct;
      settings.scheme = scheme;
      settings.substeps = substeps;
      settings.tolerance = 1e-7;
      settings.velocity_tolerance = 1e-7;
      settings.threads = task.threads;
      const auto point = measure(task, settings, {.repeat = 1});
      all_ran =
          point && point.value().outcome.is_complete() && point.value().outcome.trajectory_error;
      if (!all_ran) break;
      steps.push_back(kFrame / substeps);
      errors.push_back(*point.value().outcome.trajectory_error);
      order.points.push_back({steps.back(), errors.back()});
    }
    if (all_ran) order.order = fitted_exponent(steps, errors);
  }
  return orders;
}

}  // namespace weft::tools::precision
