/// Shapes of strips that bend and do not stretch, in double: what no formula tells.
#pragma once

namespace weft::tools::forms {

struct Tip {
  double x = 0;  ///< of the length, from the clamp
  double y = 0;  ///< likewise; below the clamp it is negative
};

/// The tip of a strip that is clamped level and bends under its own weight, by the boundary problem
///
///     theta'' = - load (1 - s) cos theta,   theta(0) = 0,   theta'(1) = 0
///
/// for the slope downwards, theta, along the length, s, by shooting from the tip. load: rho g L^3 /
/// k_b, 1000 at most: heavier strips hang down but for less than rounding.
Tip heavy_elastica(double load);

/// The tip of a strip that is clamped level and pulled down by a force at its end that keeps its
/// direction: theta'' = - load cos theta, theta(0) = 0, theta'(1) = 0. load: P L^2 / k_b, 20 at
/// most.
Tip end_loaded_elastica(double load);

/// Height over its ends, of the length, of a strip that was straight between hinges and these have
/// come nearer by this share of its length: Euler's elastica, p / K(p) with 2 E(p) / K(p) - 1 = 1 -
/// nearer.
double buckled_height(double nearer);

}  // namespace weft::tools::forms
