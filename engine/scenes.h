/// The built-in scenes: the paper's three and two hard ones. Exact definitions, SI units.
///
/// Cloth scenes are N x N particles over 1 m x 1 m, particle (i, j) has the number i * N + j,
/// spacing L = 1/(N-1), total mass 1 kg, gravity (0, -10, 0); constraints join grid neighbours
/// ("structural" edges), those between two fixed particles are left out.
#pragma once

#include <weft/weft.h>

#include <span>
#include <string_view>

namespace weft::scenes {

struct Options {
  int size = 20;           ///< N; particles in a line for "chain"
  double slack = 0.05;     ///< sphere_drop: how much longer the sheet is than the gap it spans
  double sphere_mass = 1;  ///< sphere_drop, kg
  double end_mass = 1;     ///< chain, kg of the last particle
};

struct BuiltIn {
  std::string_view name;
  std::string_view summary;
};

/// hang, hang_sphere, sphere_drop, corners, chain.
std::span<const BuiltIn> list();

/// An unknown name or an option out of range is an error.
Result<SceneDescription> make(std::string_view name, const Options& options);

}  // namespace weft::scenes
