/// Stall detection: whether a loop that does not converge still makes progress.
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
///
/// Some never settle: a skirt whose hem is pulled too far wanders about for ever, its error rising
/// and falling by a hundredth. They stand still too: errors that rise at every fourth look or more,
/// of which the least in kWindow looks is not a hundredth below that in as many before. (The best
/// of all times is no measure: a heavy sphere on a sheet begins with a good one by chance, and
/// comes back to it after thirty looks.)
///
/// A loop that stood still in the last step is in doubt from the beginning, and taken to stand
/// still after two looks at which its error is as large and does not fall.
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
  /// stood_at: error() when the last step stood still; 0: it did not.
  Standstill(const Settings& settings, double stood_at)
      : tolerance_(settings.tolerance),
        contact_tolerance_(settings.contact_tolerance),
        stood_at_(stood_at),
        in_doubt_(stood_at > 0) {}

  /// The errors after another kPassesBetweenLooks passes.
  void look(const Strain& strain, double penetration) {
    constexpr double kSame = 1e-6, kFallen = 0.9;
    constexpr int kPatience = 4;
    const auto same = [](double now, double before) {
      return std::abs(now - before) <= kSame * std::max(now, before);
    };
    const bool reproduced = in_doubt_ && same(strain.max, strain_.max) &&
                            same(strain.rms, strain_.rms) && same(penetration, penetration_);
    strain_ = strain;
    penetration_ = penetration;
    const double error = std::max(strain.max / tolerance_, penetration / contact_tolerance_) - 1;
    stale_ = error < kFallen * least_ ? 0 : stale_ + 1;
    least_ = std::min(least_, error);
    reached_ = reproduced || stands_as_before(error) || (in_doubt_ && wanders(error));
    error_ = error;
    in_doubt_ = in_doubt_ || stale_ >= kPatience;
  }
  bool in_doubt() const { return in_doubt_; }
  bool reached() const { return reached_; }
  /// Beyond the tolerances, in tolerances.
  double error() const { return error_; }

 private:
  bool stands_as_before(double error) {
    constexpr double kLess = 0.98;
    constexpr int kLooks = 2;
    const bool falls = error < kLess * error_;
    as_before_ = stood_at_ > 0 && error >= kLess * stood_at_ && !falls ? as_before_ + 1 : 0;
    return as_before_ >= kLooks;
  }
  bool wanders(double error) {
    constexpr int kWindow = 32;
    constexpr double kLess = 0.99;
    ++looks_;
    rises_ += error > error_ ? 1 : 0;
    lowest_ = std::min(lowest_, error);
    if (looks_ < kWindow) return false;
    const bool no_lower = lowest_ > kLess * lowest_before_ && 4 * rises_ >= kWindow;
    lowest_before_ = lowest_;
    lowest_ = kNone;
    looks_ = rises_ = 0;
    return no_lower;
  }

  static constexpr double kNone = std::numeric_limits<double>::infinity();

  const double tolerance_, contact_tolerance_;
  const double stood_at_;
  Strain strain_;
  double penetration_ = 0;
  double error_ = 0;
  double least_ = kNone;
  int stale_ = 0;      // looks since it fell by a tenth
  int as_before_ = 0;  // looks as far out as where the last step stood still
  // In doubt, of a window of looks:
  double lowest_ = kNone, lowest_before_ = kNone;
  int looks_ = 0, rises_ = 0;
  bool in_doubt_, reached_ = false;
};

}  // namespace weft
