#include "tools/studies/precision/order.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/studies/precision/sweep.h"

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

namespace {

Settings settings_of(Scheme scheme) {
  Settings settings;
  settings.scheme = scheme;
  if (scheme == Scheme::paper || scheme == Scheme::rattle) {
    settings.solver = Solver::direct;
    settings.tolerance = 1e-7;
    settings.velocity_tolerance = 1e-7;
  } else {
    settings.solver = Solver::small_steps;
    settings.tolerance = 0.1;
  }
  return settings;
}

Order measure_order(const Task& task, Scheme scheme) {
  Order order;
  order.scene = fmt::format("{0} {1} x {1}", task.scene, task.size);
  order.scheme = name(scheme);
  Settings settings = settings_of(scheme);
  settings.threads = task.threads;
  const int first = settings.solver == Solver::small_steps ? 4 : 1;
  std::vector<double> steps, errors;
  for (const int factor : {1, 2, 4, 8}) {
    settings.substeps = first * factor;
    const auto point = measure(task, settings, {.repeat = 1});
    const bool ran =
        point && point.value().outcome.is_complete() && point.value().outcome.trajectory_error;
    if (!ran) return order;
    steps.push_back(kFrame / settings.substeps);
    errors.push_back(*point.value().outcome.trajectory_error);
    order.points.push_back({steps.back(), errors.back()});
  }
  order.order = fitted_exponent(steps, errors);
  return order;
}

}  // namespace

std::vector<Order> measure_orders(const Task& task) {
  std::vector<Order> orders;
  for (const Scheme scheme : {Scheme::paper, Scheme::rattle, Scheme::implicit, Scheme::bdf2}) {
    orders.push_back(measure_order(task, scheme));
  }
  return orders;
}

}  // namespace weft::tools::precision
