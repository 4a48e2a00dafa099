/// The loop around every method of relaxation. A method is a class of three verbs:
///
///   renew()   take new directions and errors from the present state
///   sweep()   one iteration: one pass over the constraints
///             (sweeps(n): n of them, of a method that can do better than one after the other)
///   finish()  leave the result where the caller expects it
///
/// However often directions are renewed, the loop ends when an iteration along fresh directions
/// corrects nothing: then every true error is within tolerance, because n points along the
/// connecting line.
#pragma once

#include <cstdint>

namespace weft::kernels {

/// When directions are renewed: before each iteration (paper 3.2, 4.1); when an iteration found
/// nothing left to correct along them (4.4); or never, they are given (velocity loop).
enum class Directions : std::uint8_t { each, frozen, constant };

/// The work of one pass over the constraints.
struct Sweep {
  std::int64_t visits = 0;
  std::int64_t corrections = 0;

  Sweep& operator+=(const Sweep& other) {
    visits += other.visits;
    corrections += other.corrections;
    return *this;
  }
};

struct LoopResult {
  int iterations = 0;
  int direction_updates = 0;
  std::int64_t visits = 0;
  std::int64_t corrections = 0;
  bool converged = false;
  /// The chosen solver gave up, whatever answered for it: what converged then is not its own
  /// solution. Not with a fixed number of iterations.
  bool failed = false;
};

inline void count(LoopResult& result, const Sweep& sweep, int passes = 1) {
  result.iterations += passes;
  result.visits += sweep.visits;
  result.corrections += sweep.corrections;
}

/// The part goes on where the sum has ended: whether it converged is what counts. failed stays.
inline void count(LoopResult& sum, const LoopResult& part) {
  sum.iterations += part.iterations;
  sum.direction_updates += part.direction_updates;
  sum.visits += part.visits;
  sum.corrections += part.corrections;
  sum.converged = part.converged;
}

struct LoopLimits {
  int fixed_iterations = 0;  // > 0: exactly so many, to whatever error
  int max_iterations = 1;
  int renew_after = 0;  // > 0: frozen directions live for at most so many iterations
};

template <class Loop>
LoopResult iterate_to_tolerance(Loop& loop, Directions directions, const LoopLimits& limits) {
  LoopResult result;
  loop.renew();
  ++result.direction_updates;
  bool fresh = true;
  int age = 0;
  while (result.iterations < limits.max_iterations) {
    const Sweep sweep = loop.sweep();
    count(result, sweep);
    const bool satisfied = sweep.corrections == 0;
    if (satisfied && (fresh || directions == Directions::constant)) {
      result.converged = true;
      break;
    }
    const bool old = directions == Directions::frozen && ++age == limits.renew_after;
    fresh = satisfied || old || directions == Directions::each;
    if (!fresh) continue;
    loop.renew();
    ++result.direction_updates;
    age = 0;
  }
  loop.finish();
  return result;
}

template <class Loop>
LoopResult iterate_fixed(Loop& loop, Directions directions, int iterations) {
  LoopResult result;
  while (result.iterations < iterations) {
    if (result.iterations == 0 || directions == Directions::each) {
      loop.renew();
      ++result.direction_updates;
    }
    if constexpr (requires { loop.sweeps(1); }) {
      const int passes = directions == Directions::each ? 1 : iterations;
      count(result, loop.sweeps(passes), passes);
    } else {
      count(result, loop.sweep());
    }
  }
  loop.finish();
  return result;
}

template <class Loop>
LoopResult iterate(Loop&& loop, Directions directions, const LoopLimits& limits) {
  if (limits.fixed_iterations > 0) return iterate_fixed(loop, directions, limits.fixed_iterations);
  return iterate_to_tolerance(loop, directions, limits);
}

}  // namespace weft::kernels
