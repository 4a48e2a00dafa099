/// The rate at which substeps of fabric become longer again.
///
/// A sweep leaves an error that grows with the square of the length of a substep. So the error of
/// the last frame predicts that of longer substeps. Cloth at rest may bear less than the tolerance:
/// each change of length shakes it. A lengthening that had to be revoked shows how much
/// was too much, and the next ones are predicted to leave at most half of that. After each one that
/// holds the next one may leave more again.
///
/// Without this memory substeps of cloth that lies under load become longer until a frame fails,
/// and shorter at once, for ever.
#pragma once

#include <cmath>

#include "engine/saving/archive.h"
#include "engine/tuning.h"

namespace weft {

class Lengthening {
 public:
  /// By 2^doublings; left: the error that the last frame left to put right, in tolerances. Returns
  /// whether substeps become longer.
  bool begin(double doublings, double left) {
    const double predicted = left * std::exp2(2 * doublings);
    if (predicted * caution_ > 1) return false;
    if (predicted_ > 0) caution_ *= std::exp2(-doublings);
    predicted_ = predicted;
    return true;
  }
  /// Substeps have to become shorter. Where very little was predicted something else is the cause.
  void revoke() {
    if (predicted_ > tuning::kLeastBlamed) caution_ = kCaution / predicted_;
    predicted_ = 0;
  }
  /// Whether some frames can have led to it.
  bool is_valid() const {
    return predicted_ >= 0 && std::isfinite(predicted_) && caution_ >= 0 &&
           caution_ <= kCaution / tuning::kLeastBlamed;
  }
  friend void visit_fields(Is<Lengthening> auto& lengthening, auto& archive) {
    auto& [caution, predicted] = lengthening;
    archive(caution, predicted);
  }

 private:
  static constexpr double kCaution = 2;
  double caution_ = 0;    // 1 over the most that may be predicted; 0: nothing was too much
  double predicted_ = 0;  // in tolerances, by the last lengthening; 0: it was revoked
};

}  // namespace weft
