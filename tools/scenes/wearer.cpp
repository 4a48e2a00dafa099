#include "tools/scenes/wearer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/scenes/garments.h"

namespace weft::scenes {
namespace {

using tools::PinMove;
using tools::SceneBody;

// --------------------------------------------------------------------------------- the wearer

constexpr double kShoulder = 0.14, kShoulderHeight = 1.17;  // m

/// How the wearer walks.
struct Gait {
  static constexpr double kStart = 1, kEnd = 10;        // s
  static constexpr double kSpeed = 1, kPace = 0.9;      // m/s; double steps a second
  static constexpr double kBob = 0.02;                  // m
  static constexpr double kTwist = 0.12, kSwing = 0.3;  // rad, of the body and of the arms
  static constexpr double kFrame = 1.0 / 60;            // s, between two poses

  /// 0 to 1 in a second.
  static double vigour(double time) {
    const double share = std::clamp(time - kStart, 0.0, 1.0);
    return share * share * (3 - 2 * share);
  }
  static double phase(double time) { return 2 * std::numbers::pi * kPace * (time - kStart); }
};

/// A part that turns about the vertical through `joint`, with the body and by itself; side: of an
/// arm, +1 or -1, 0 of the body.
PinMove walk(Vec3 joint, double side) {
  PinMove move;
  move.about = joint;
  double way = 0;
  const int frames = static_cast<int>(std::lround(Gait::kEnd / Gait::kFrame));
  for (int i = 0; i <= frames; ++i) {
    const double time = Gait::kFrame * i, vigour = Gait::vigour(time);
    const double twist = vigour * Gait::kTwist * std::sin(Gait::phase(time));
    const double swing = vigour * side * Gait::kSwing * std::sin(Gait::phase(time));
    way += vigour * Gait::kSpeed * Gait::kFrame;
    move.times.push_back(time);
    move.rotations.push_back({0, twist + swing, 0});
    // The joint turns with the body, about x = z = 0.
    const double x = joint.x * std::cos(twist) + joint.z * std::sin(twist);
    const double z = joint.z * std::cos(twist) - joint.x * std::sin(twist);
    const double bob = vigour * Gait::kBob * std::sin(2 * Gait::phase(time));
    move.translations.push_back({x - joint.x, bob, z - joint.z + way});
  }
  return move;
}

SceneBody part(Vec3 a, Vec3 b, double radius_a, double radius_b, double side) {
  return {.shape = Capsule{a, b, radius_a, radius_b}, .move = walk(side == 0 ? Vec3{} : a, side)};
}

/// Wider than deep: two capsules side by side are its trunk.
std::vector<SceneBody> wearer() {
  std::vector<SceneBody> parts{
      part({0, kShoulderHeight, 0}, {0, 1.36, 0}, 0.035, 0.035, 0),
      part({-kShoulder, kShoulderHeight, 0}, {kShoulder, kShoulderHeight, 0}, 0.035, 0.035, 0)};
  for (const double side : {-1.0, 1.0}) {
    const Vec3 shoulder{side * kShoulder, kShoulderHeight, 0};
    parts.push_back(part(shoulder, {side * 0.56, kShoulderHeight, 0}, 0.035, 0.03, side));
    const Vec3 chest{side * 0.06, 1.12, 0}, hip{side * 0.07, 0.66, 0}, knee{side * 0.07, 0.2, 0};
    parts.push_back(part(hip, chest, 0.05, 0.045, 0));
    parts.push_back(part(hip, knee, 0.05, 0.035, 0));
  }
  return parts;
}

}  // namespace

Result<Layout> dressed_wearer(const Options& options) {
  auto layout = worn_tunic(options);
  if (layout) layout.value().bodies = wearer();
  return layout;
}

tools::PinMove walk_of_trunk() { return walk({}, 0); }

}  // namespace weft::scenes
