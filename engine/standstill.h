/// Whether a loop that does not end still gets anywhere.
///
/// Where constraints contradict each other no impulses solve them. Along frozen directions the loop
/// then wanders about for ever: a taut chain at the least kink is thrown far to its side, for there
/// its linear errors have a solution. With directions renewed before every pass each correction is
/// a projection onto its own constraint, and projections onto sets that do not meet settle,
/// geometrically, on errors that the next pass reproduces.
///
/// So: if what is beyond the tolerances has not fallen by a tenth in kPatience looks, that raises
/// doubt, and directions are renewed in every pass, which costs three times as much. Errors that
/// are then the same in two looks are there to stay, and so are those that have not fallen by
/// kLeastFall in kLongPatience looks: a tube pulled longer than its yarns wanders about for ever,
/// errors rising and falling by a hundredth. (What is within the tolerances need not fall: judged
/// by the rms, sphere_drop, 40 x 40, at 1 % was in doubt in nearly every pass.) Where the loop is
/// merely slow (masses that differ by 10^6, a fine mesh at a tight tolerance) they go on falling,
/// by 10^-4 and more between looks; less than 10^-6 cannot be told from the rounding of float
/// lanes.
///
/// What stood still a step ago is in doubt from the beginning, and believed to stand still after
/// two looks unless it is out by less than it was then.
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
      : tolerance_(settings.tolerance), contact_tolerance_(settings.contact_tolerance) {
    constexpr double kLess = 0.98;
    if (stood_at == 0) return;
    in_doubt_ = true;
    mark_ = kLess * stood_at;
    standing_ = kLongPatience - 2;
  }

  /// The errors after another kPassesBetweenLooks passes.
  void look(const Strain& strain, double penetration) {
    constexpr double kSame = 1e-6, kFallen = 0.9, kLeastFall = 5e-4;
    constexpr int kPatience = 4;
    const auto same = [](double now, double before) {
      return std::abs(now - before) <= kSame * std::max(now, before);
    };
    const bool reproduced = in_doubt_ && same(strain.max, strain_.max) &&
                            same(strain.rms, strain_.rms) && same(penetration, penetration_);
    strain_ = strain;
    penetration_ = penetration;
    error_ = std::max(strain.max / tolerance_, penetration / contact_tolerance_) - 1;
    stale_ = error_ < kFallen * least_ ? 0 : stale_ + 1;
    least_ = std::min(least_, error_);
    standing_ = error_ < mark_ ? 0 : standing_ + 1;
    if (standing_ == 0) mark_ = (1 - kLeastFall) * error_;
    in_doubt_ = in_doubt_ || stale_ >= kPatience;
    reached_ = reproduced || (in_doubt_ && standing_ >= kLongPatience);
  }
  bool in_doubt() const { return in_doubt_; }
  bool reached() const { return reached_; }
  /// Beyond the tolerances, in tolerances.
  double error() const { return error_; }

 private:
  static constexpr int kLongPatience = 32;

  const double tolerance_, contact_tolerance_;
  Strain strain_;
  double penetration_ = 0;
  double error_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
  int stale_ = 0;  // looks since it fell by a tenth
  double mark_ = std::numeric_limits<double>::infinity();
  int standing_ = 0;  // looks since it was below the mark
  bool in_doubt_ = false, reached_ = false;
};

}  // namespace weft
