/// Gaps of a cloth between its particles, and the bodies that fit through them.
#pragma once

namespace weft {

/// The widest gaps of a cloth. No place in a triangle is farther from its nearest corner than
/// 1/sqrt(3) of its longest side. Rows of particles are no farther apart than its largest height,
/// of which a strip is half. On a thread both are its length.
struct Gaps {
  double hole = 0;   // m: a ball as wide touches a particle wherever it meets the cloth
  double strip = 0;  // m: a body that lies across, and is as wide, meets every second row
};

/// The widths of a body, m.
struct Widths {
  double least = 0, most = 0;

  /// Whether it may pass between particles without touching one: as a whole through a hole, or
  /// sideways through a strip. around: m, its thickness.
  bool fit_through(const Gaps& gaps, double around) const {
    return most + 2 * around < gaps.hole || least + 2 * around < gaps.strip;
  }
};

}  // namespace weft
