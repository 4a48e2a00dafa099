/// The methods that studies and the hard cases compare.
#pragma once

#include <weft/weft.h>

#include <vector>

namespace weft::tools {

struct Method {
  Solver solver = Solver::gauss_seidel;
  Scheme scheme = Scheme::paper;
};

/// What weft says to it: not every solver goes with every scheme.
Result<void> offered(const Method& method);

/// Every solver with every scheme that it takes, each method once. Solver::automatic has two: the
/// plain call, and rattle; with the other schemes it is a method of another name.
std::vector<Method> all_methods();

}  // namespace weft::tools
