/// What the benchmarks run on. Deterministic, SI units, without fixed particles unless said.
#pragma once

#include <weft/weft.h>

#include <cstdint>

namespace weft::perf {

/// The same numbers as perf/irregular_mesh draws (splitmix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double unit();  // [0, 1)
  std::uint64_t below(std::uint64_t bound) { return bits() % bound; }

 private:
  std::uint64_t state_;
};

/// N x N particles in the plane, structural edges, every particle moved by up to 2 % of an edge.
SceneDescription grid(int size);

/// An irregular triangle mesh of N x N particles, the mesh that perf/irregular_mesh writes:
/// jittered points, one diagonal per cell chosen by chance, every tenth cell without one, every
/// fiftieth cell a hole, particles and faces in an order of chance. The first row of particles is
/// fixed; rest lengths are the distances.
SceneDescription irregular(int size);

}  // namespace weft::perf
