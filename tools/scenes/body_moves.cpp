#include "tools/scenes/body_moves.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace weft::tools {
namespace {

Rotation quaternion(Vec3 r) {
  const double angle = std::hypot(r.x, r.y, r.z);
  const double part = angle > 0 ? std::sin(angle / 2) / angle : 0.5;
  return {part * r.x, part * r.y, part * r.z, std::cos(angle / 2)};
}

/// By the shorter way around.
Vec3 rotation_vector(const Rotation& q) {
  const double sine = std::hypot(q.x, q.y, q.z);
  const double part = sine > 0 ? 2 * std::atan2(sine, std::abs(q.w)) / sine : 2;
  const double turn = std::copysign(part, q.w);
  return {turn * q.x, turn * q.y, turn * q.z};
}

/// First b, then a.
Rotation product(const Rotation& a, const Rotation& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
      a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// x -> position + rotation x
Vec3 placed(const Pose& pose, Vec3 x) {
  const Rotation& q = pose.rotation;
  const Vec3 t{2 * (q.y * x.z - q.z * x.y), 2 * (q.z * x.x - q.x * x.z),
               2 * (q.x * x.y - q.y * x.x)};
  return {pose.position.x + x.x + q.w * t.x + q.y * t.z - q.z * t.y,
          pose.position.y + x.y + q.w * t.y + q.z * t.x - q.x * t.z,
          pose.position.z + x.z + q.w * t.z + q.x * t.y - q.y * t.x};
}

Vec3 point_between(Vec3 a, Vec3 b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

/// Times that have come to be one to the last bit: only the later frame is kept.
void drop_merged_times(VertexMove& move) {
  for (std::size_t key = move.times.size(); key-- > 1;) {
    if (move.times[key - 1] < move.times[key]) continue;
    const auto merged = static_cast<std::ptrdiff_t>(key - 1);
    move.times.erase(move.times.begin() + merged);
    move.vertices.erase(move.vertices.begin() + merged);
  }
}

/// As it is at time 0.
ShapeDescription first_shape(const SceneBody& body) {
  ShapeDescription shape = body.shape;
  if (body.vertex_move) std::get<TriangleMesh>(shape).vertices = vertices_at(body, 0);
  return shape;
}

}  // namespace

Pose pose_at(const SceneBody& body, double time) {
  const Rotation rotation = quaternion(body.rotation);
  if (!body.move) return {body.position, rotation};
  return {place_at(*body.move, time, body.position),
          product(quaternion(rotation_at(*body.move, time)), rotation)};
}

Pose pose_in(const Cloth& cloth, std::uint32_t id, const SceneBody& body, double time) {
  return body.mass ? cloth.body_pose(id).value() : pose_at(body, time);
}

Vec3 centre_of_mass(const SceneBody& body, const Pose& pose) {
  return placed(pose, body.mass->centre);
}

std::vector<Vec3> vertices_at(const SceneBody& body, double time) {
  if (!body.vertex_move) return std::get<TriangleMesh>(body.shape).vertices;
  const auto& [times, vertices] = *body.vertex_move;
  const auto next = std::ranges::upper_bound(times, time);
  if (next == times.begin()) return vertices.front();
  if (next == times.end()) return vertices.back();
  const auto after = static_cast<std::size_t>(next - times.begin()), before = after - 1;
  const double share = (time - times[before]) / (times[after] - times[before]);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < vertices[after].size(); ++i)
    places.push_back(point_between(vertices[before][i], vertices[after][i], share));
  return places;
}

std::vector<Vec3> places_at(const SceneBody& body, double time) {
  const Pose pose = pose_at(body, time);
  std::vector<Vec3> places = vertices_at(body, time);
  for (Vec3& place : places) place = placed(pose, place);
  return places;
}

std::size_t count_triangles(std::span<const SceneBody> bodies) {
  std::size_t count = 0;
  for (const SceneBody& body : bodies) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&body.shape)) count += mesh->triangles.size();
  }
  return count;
}

std::vector<SceneBody> present_bodies(std::span<const SceneBody> bodies, double elapsed) {
  std::vector<SceneBody> present(bodies.begin(), bodies.end());
  for (SceneBody& body : present) {
    if (body.move) body.move = present_moves({&*body.move, 1}, {}, elapsed).front();
    if (!body.vertex_move) continue;
    for (double& time : body.vertex_move->times) time -= elapsed;
    drop_merged_times(*body.vertex_move);
  }
  return present;
}

void take_free_bodies(const Cloth& cloth, std::vector<SceneBody>& bodies) {
  for (std::uint32_t id = 0; id < bodies.size(); ++id) {
    SceneBody& body = bodies[id];
    if (!body.mass) continue;
    const Pose pose = cloth.body_pose(id).value();
    body.position = pose.position;
    body.rotation = rotation_vector(pose.rotation);
    body.velocity = cloth.body_velocity(id).value();
  }
}

Result<MovedBodies> MovedBodies::add(std::span<const SceneBody> bodies, Cloth& cloth) {
  MovedBodies added;
  added.bodies_ = bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto refused = [&](const std::string& why) {
      return Error{"bodies[" + std::to_string(i) + "]." + why};
    };
    const auto shape = build_shape(first_shape(bodies[i]));
    if (!shape) return refused(shape.error());
    const auto id = cloth.add_body({.shape = shape.value(),
                                    .pose = pose_at(bodies[i], 0),
                                    .thickness = bodies[i].thickness,
                                    .friction = bodies[i].friction,
                                    .mass = bodies[i].mass});
    if (!id) return refused(id.error());
    if (bodies[i].mass) {
      if (auto set = cloth.set_body_velocity(id.value(), bodies[i].velocity); !set)
        return refused(set.error());
    }
    added.ids_.push_back(id.value());
  }
  return added;
}

Result<void> MovedBodies::send(Cloth& cloth, double time) const {
  for (const auto& [id, pose] : poses_at(time)) {
    if (auto sent = cloth.move_body(id, pose); !sent) return sent;
  }
  for (const auto& [id, vertices] : deformed_at(time)) {
    if (auto sent = cloth.move_body_vertices(id, vertices); !sent) return sent;
  }
  return {};
}

std::vector<PosedBody> MovedBodies::poses_at(double time) const {
  std::vector<PosedBody> poses;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (bodies_[i].move) poses.push_back({ids_[i], pose_at(bodies_[i], time)});
  }
  return poses;
}

std::vector<DeformedBody> MovedBodies::deformed_at(double time) const {
  std::vector<DeformedBody> deformed;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (bodies_[i].vertex_move) deformed.push_back({ids_[i], vertices_at(bodies_[i], time)});
  }
  return deformed;
}

}  // namespace weft::tools
