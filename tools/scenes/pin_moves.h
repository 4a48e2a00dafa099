/// How fixed particles of a scene move by themselves: rigid motions that go through given poses at
/// given times. Units are m, s and rad.
///
/// A particle is at
///
///     about + R(t) (x - about) + translation(t)
///
/// where x is its place without the motion and R turns by the length of the rotation vector, about
/// its direction. Translations and rotation vectors are linear between the times, and still before
/// the first and after the last.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <span>
#include <vector>

namespace weft::tools {

struct PinMove {
  std::vector<std::uint32_t> particles = {};  ///< fixed ones
  std::vector<std::uint32_t> anchors = {};    ///< or anchors, whose normals turn with them
  std::vector<double> times = {};             ///< one at least, increasing
  std::vector<Vec3> translations = {};        ///< one per time
  std::vector<Vec3> rotations = {};           ///< empty: none; else one vector per time
  Vec3 about = {};
  std::vector<Vec3> from = {};  ///< x of each particle or anchor; empty: their places in the scene
};

/// Where a particle is at a time.
Vec3 place_at(const PinMove& move, double time, Vec3 without);

/// The rotation vector of the motion at a time.
Vec3 rotation_at(const PinMove& move, double time);
/// Where a direction points at a time.
Vec3 turned_at(const PinMove& move, double time, Vec3 direction);

/// A call of Cloth::move_fixed or Cloth::place_fixed.
struct PlacedPin {
  std::uint32_t particle = 0;
  Vec3 position{};
};

/// Moves of the pins of one cloth, which must stand where its scene has them.
class MovedPins {
 public:
  MovedPins(std::span<const PinMove> moves, const Cloth& cloth);
  /// Puts those that do not stand where they are at time 0 down there, with Cloth::place_fixed.
  Result<void> place(Cloth& cloth) const;
  /// Sends those whose place changes to where they are at `time`, with Cloth::move_fixed. Its error
  /// is that of the first that is refused.
  Result<void> send(Cloth& cloth, double time) const;
  /// Those that stand elsewhere, and where they are at `time`.
  std::vector<PlacedPin> places_at(const Cloth& cloth, double time) const;
  /// These are no pins any more: they are not moved again.
  void release(std::span<const std::uint32_t> particles);

 private:
  std::vector<PinMove> moves_;
  std::vector<std::vector<Vec3>> from_;  // of each move, of each particle
};

/// The moves of a scene that goes on from where this one is after `elapsed` seconds: all times
/// become less by that. Since the new scene's pins stand where they came to, `from` says where they
/// were.
std::vector<PinMove> present_moves(std::span<const PinMove> moves, const SceneDescription& scene,
                                   double elapsed);

}  // namespace weft::tools
