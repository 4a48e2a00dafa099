/// Settings that only measure methods: the optimisations of the paper, each of which can be left
/// out. All other programs leave them as they are. Part of weft.h; in C and in Python they are
/// fields of the settings like all others.
#pragma once

#include <weft/api.h>

#include <cstdint>
#include <string_view>

namespace weft {

/// each: directions are renewed before every iteration (sections 3.2, 4.1).
/// frozen: directions are renewed once all errors along them are within tolerance (section 4.4), or
///   after renew_after iterations.
enum class Directions : std::uint8_t { each, frozen };

struct Measuring {
  Directions directions = Directions::frozen;
  /// The largest number of iterations along the same frozen directions. 0: until all errors along
  /// them are within tolerance, as in the paper (section 4.4); on the simd backend at most 1024,
  /// since between renewals errors in floats fall by seven digits at most. An exact solution along
  /// directions that will change is wasted work: 32 saves a fifth of the iterations and more.
  int renew_after = 32;
  /// Section 4.2: errors are updated instead of recomputed. The simd backend forms them from
  /// displacements either way, which is faster in lanes (perf/tried.md). There this setting selects
  /// how `skip` tracks satisfied constraints: true, by flags of chunks; false, by the 64-bit masks
  /// of the paper.
  bool anticipate = true;
  /// With gauss_seidel on the simd backend and with `anticipate`: errors of distance constraints,
  /// in both loops, are kept, and updated through the stored products of neighbouring directions,
  /// as in section 4.2. Ropes, constraints at hubs and contacts still form theirs from
  /// displacements. An iteration takes 1.3 to 2 times as long as by displacements, on irregular
  /// meshes 3 times (perf/tried.md). The reference backend anticipates by products anyway, and
  /// refuses this setting. Models with springs refuse it, too.
  bool anticipate_products = false;
  bool skip = true;  ///< Section 4.3: satisfied constraints are passed over.
  /// N s, the largest impulse of one correction; 0: no limit. gauss_seidel on the reference backend
  /// only.
  double impulse_limit = 0;
};

struct Settings;
/// The method of the paper, with all its optimisations: Gauss-Seidel, one substep.
WEFT_API Settings paper_settings();

WEFT_API std::string_view name(Directions);

}  // namespace weft
