#include "tools/scenes/pin_moves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/geometry.h"

namespace weft::tools {
namespace {

using mesh::cross, mesh::operator+, mesh::operator-, mesh::operator*;

bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// sin(x) / x.
double sinc(double x) { return x == 0 ? 1 : std::sin(x) / x; }

/// By how much a rotation takes r elsewhere (Rodrigues): no rotation, by nothing at all.
Vec3 turned_by(Vec3 rotation, Vec3 r) {
  const double angle = std::hypot(rotation.x, rotation.y, rotation.z);
  const double half = sinc(angle / 2);
  const Vec3 across = cross(rotation, r);
  return sinc(angle) * across + (0.5 * half * half) * cross(rotation, across);
}

struct MovePose {
  Vec3 translation, rotation;
};

MovePose pose(const PinMove& move, std::size_t key) {
  return {move.translations[key], move.rotations.empty() ? Vec3{} : move.rotations[key]};
}

Vec3 between(Vec3 a, Vec3 b, double share) { return a + share * (b - a); }

MovePose pose_at(const PinMove& move, double time) {
  const auto next = std::ranges::upper_bound(move.times, time);
  const auto key = static_cast<std::size_t>(next - move.times.begin());
  if (key == 0) return pose(move, 0);
  if (key == move.times.size()) return pose(move, key - 1);
  const double last_time = move.times[key - 1];
  const double share = (time - last_time) / (move.times[key] - last_time);
  const MovePose a = pose(move, key - 1), b = pose(move, key);
  return {between(a.translation, b.translation, share), between(a.rotation, b.rotation, share)};
}

Vec3 place(const PinMove& move, const MovePose& pose, Vec3 without) {
  return without + turned_by(pose.rotation, without - move.about) + pose.translation;
}

/// Times that have come to be one to the last bit: only the later pose is kept.
void drop_merged_times(PinMove& move) {
  for (std::size_t key = move.times.size(); key-- > 1;) {
    if (move.times[key - 1] < move.times[key]) continue;
    const auto merged = static_cast<std::ptrdiff_t>(key - 1);
    move.times.erase(move.times.begin() + merged);
    move.translations.erase(move.translations.begin() + merged);
    if (!move.rotations.empty()) move.rotations.erase(move.rotations.begin() + merged);
  }
}

}  // namespace

Vec3 place_at(const PinMove& move, double time, Vec3 without) {
  return place(move, pose_at(move, time), without);
}

Vec3 rotation_at(const PinMove& move, double time) { return pose_at(move, time).rotation; }

Vec3 turned_at(const PinMove& move, double time, Vec3 direction) {
  return direction + turned_by(pose_at(move, time).rotation, direction);
}

MovedPins::MovedPins(std::span<const PinMove> moves, const Cloth& cloth)
    : moves_(moves.begin(), moves.end()) {
  for (const PinMove& move : moves) {
    std::vector<Vec3> from = move.from;
    if (from.empty()) {
      for (const std::uint32_t particle : move.particles) from.push_back(cloth.position(particle));
    }
    from_.push_back(std::move(from));
  }
}

Result<void> MovedPins::place(Cloth& cloth) const {
  for (const auto& [particle, position] : places_at(cloth, 0)) {
    if (auto done = cloth.place_fixed(particle, position); !done) return done;
  }
  return {};
}

Result<void> MovedPins::send(Cloth& cloth, double time) const {
  for (const auto& [particle, position] : places_at(cloth, time)) {
    if (auto done = cloth.move_fixed(particle, position); !done) return done;
  }
  return {};
}

std::vector<PlacedPin> MovedPins::places_at(const Cloth& cloth, double time) const {
  std::vector<PlacedPin> placed;
  for (std::size_t m = 0; m < moves_.size(); ++m) {
    const PinMove& move = moves_[m];
    const MovePose now = pose_at(move, time);
    for (std::size_t k = 0; k < move.particles.size(); ++k) {
      const Vec3 to = tools::place(move, now, from_[m][k]);
      if (!(to == cloth.position(move.particles[k]))) placed.push_back({move.particles[k], to});
    }
  }
  return placed;
}

void MovedPins::release(std::span<const std::uint32_t> particles) {
  for (const std::uint32_t particle : particles) {
    for (std::size_t m = 0; m < moves_.size(); ++m) {
      auto& moved = moves_[m].particles;
      const auto at = std::ranges::find(moved, particle);
      if (at == moved.end()) continue;
      from_[m].erase(from_[m].begin() + (at - moved.begin()));
      moved.erase(at);
    }
  }
}

std::vector<PinMove> present_moves(std::span<const PinMove> moves, const SceneDescription& scene,
                                   double elapsed) {
  std::vector<PinMove> present(moves.begin(), moves.end());
  for (PinMove& move : present) {
    for (double& time : move.times) time -= elapsed;
    drop_merged_times(move);
    if (!move.from.empty()) continue;
    for (const std::uint32_t pin : move.particles) move.from.push_back(scene.positions[pin]);
    for (const std::uint32_t i : move.anchors) move.from.push_back(scene.anchors[i].point);
  }
  return present;
}

}  // namespace weft::tools
