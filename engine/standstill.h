/// Whether a loop that does not end still gets anywhere.
///
/// Where constraints contradict each other no impulses solve them. Along frozen directions the loop
/// then wanders about for ever: a taut chain at the least kink is thrown far to its side, for there
/// its linear errors have a solution. With directions renewed before every pass each correction is
/// a projection onto its own constraint, and projections onto sets that do not meet settle,
/// geometrically, on errors that the next pass reproduces.
///
/// So: if what is beyond the tolerances has not fallen by a tenth in kPatience looks, that raises
/// doubt, and directions are renewed in every pass, which costs three times as much; errors that
/// are then the same in two looks are there to stay. (What is within the tolerances need not fall:
/// judged by the rms, sphere_drop, 40 x 40, at 1 % was in doubt in nearly every pass.) Where the
/// loop is merely slow (masses that differ by 10^6, a fine mesh at a tight tolerance) they go on
/// falling, by 10^-4 and more between looks; less than 10^-6 cannot be told from the rounding of
/// float lanes.
#pragma once

#include <weft/weft.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {

/// Passes between two looks: more than steps that go well ever need, so that those are not looked
/// at.
inline constexpr int kPassesBetweenLooks = 4096;

class Standstill {
 public:
  explicit Standstill(const Settings& settings)
      : tolerance_(settings.tolerance), contact_tolerance_(settings.contact_tolerance) {}

  /// The errors after another kPassesBetweenLooks passes.
  void look(const Strain& strain, double penetration) {
    constexpr double kSame = 1e-6, kFallen = 0.9;
    constexpr int kPatience = 4;
    const auto same = [](double now, double before) {
      return std::abs(now - before) <= kSame * std::max(now, before);
    };
    reached_ = in_doubt_ && same(strain.max, strain_.max) && same(strain.rms, strain_.rms) &&
               same(penetration, penetration_);
    strain_ = strain;
    penetration_ = penetration;
    const double error = std::max(strain.max / tolerance_, penetration / contact_tolerance_) - 1;
    stale_ = error < kFallen * least_ ? 0 : stale_ + 1;
    least_ = std::min(least_, error);
    in_doubt_ = in_doubt_ || stale_ >= kPatience;
  }
  bool in_doubt() const { return in_doubt_; }
  bool reached() const { return reached_; }

 private:
  const double tolerance_, contact_tolerance_;
  Strain strain_;
  double penetration_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
  int stale_ = 0;
  bool in_doubt_ = false, reached_ = false;
};

}  // namespace weft
