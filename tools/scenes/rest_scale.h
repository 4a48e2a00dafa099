/// How the shape at rest of a scene's cloth grows and shrinks by itself (Cloth::set_rest_shape).
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

namespace weft::tools {

/// A factor of all lengths of the scene: linear between the times, still before the first and after
/// the last.
struct RestScale {
  std::vector<double> times = {};   ///< s, increasing; empty: it stays 1
  std::vector<double> scales = {};  ///< one per time
};

double scale_at(const RestScale& scale, double time);

/// The shape of one cloth, which must be as its scene has it, but for what has torn since.
class GrowingRest {
 public:
  GrowingRest(const RestScale& scale, const Cloth& cloth);
  /// Gives the cloth its shape of `time`, unless it has that already.
  Result<void> grow(Cloth& cloth, double time);
  /// The cloth has torn, and has its shape of `time`.
  void go_on_torn(const Cloth& cloth, double time);
  bool has_grown() const { return last_ != 1; }

 private:
  void take_scene(const Cloth& cloth, double scale);

  RestScale scale_;
  SceneDescription scene_;
  double scale_of_scene_ = 1;  // that its shape at rest has
  std::uint32_t tears_ = 0;    // of the cloth, that the scene has
  double last_ = 1;
};

/// That of a scene which goes on after `elapsed` seconds: all times become less by that.
RestScale present_scale(const RestScale& scale, double elapsed);
/// That of a scene whose shape at rest has the scale `now` already.
RestScale scale_over(RestScale scale, double now);

}  // namespace weft::tools
