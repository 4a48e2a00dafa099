#include "tools/program/viewer/shown_bodies.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

#include "tools/scenes/body_meshes.h"
#include "tools/scenes/body_moves.h"

namespace weft::tools {
namespace {

Json numbers(Vec3 v) { return {v.x, v.y, v.z}; }

std::vector<float> floats_of(std::span<const Vec3> points) {
  std::vector<float> floats;
  for (const Vec3& point : points) {
    for (const double coordinate : {point.x, point.y, point.z})
      floats.push_back(static_cast<float>(coordinate));
  }
  return floats;
}

void append_pose(std::vector<float>& poses, const Pose& pose) {
  const auto& [p, r] = pose;
  for (const double number : {p.x, p.y, p.z, r.x, r.y, r.z, r.w})
    poses.push_back(static_cast<float>(number));
}

Json described(const Plane& plane) {
  return {{"shape", "plane"}, {"normal", numbers(plane.normal)}, {"offset", plane.offset}};
}
Json described(const Ball& ball) {
  return {{"shape", "ball"}, {"centre", numbers(ball.centre)}, {"radius", ball.radius}};
}
Json described(const Capsule& capsule) {
  return {{"shape", "capsule"},
          {"a", numbers(capsule.a)},
          {"b", numbers(capsule.b)},
          {"radius_a", capsule.radius_a},
          {"radius_b", capsule.radius_b}};
}
Json described(const Hull& hull) {
  Json points = Json::array();
  for (const Vec3& point : hull.points) points.push_back(numbers(point));
  return {{"shape", "hull"}, {"points", std::move(points)}};
}
Json described(const TriangleMesh& mesh) {
  return {{"shape", "mesh"}, {"two_sided", mesh.two_sided}};
}

/// A shape that the page draws as triangles.
std::optional<TriangleMesh> mesh_of(const TriangleMesh& mesh) { return mesh; }
std::optional<TriangleMesh> mesh_of(const HeightField& field) {
  return scenes::terrain_mesh(field);
}
std::optional<TriangleMesh> mesh_of(const Torus& torus) {
  return scenes::torus_mesh(torus, 96, 32);
}
std::optional<TriangleMesh> mesh_of(const auto&) { return std::nullopt; }

}  // namespace

ShownBodies::ShownBodies(const SceneDescription& scene, std::span<const SceneBody> bodies,
                         double quantum)
    : scene_(scene), bodies_(bodies), moving_(bodies.size() + scene.spheres.size()) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].vertex_move) moving_[i].points.emplace_back(Vec3{}, quantum);
  }
}

void ShownBodies::add_sample(std::span<const Vec3> particles, double time, const Cloth* cloth) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    append_pose(moving_[i].poses, cloth != nullptr ? pose_in(*cloth, id, bodies_[i], time)
                                                   : pose_at(bodies_[i], time));
    if (bodies_[i].vertex_move) moving_[i].points.front().add_sample(vertices_at(bodies_[i], time));
  }
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)
    append_pose(moving_[bodies_.size() + i].poses, {.position = particles[scene_.spheres[i]]});
}

Json ShownBodies::shape_of(std::size_t body, const std::string& name, Sections& sections) const {
  if (body >= bodies_.size()) {
    const std::uint32_t particle = scene_.spheres[body - bodies_.size()];
    return described(Ball{.radius = scene_.radii[particle]});
  }
  const ShapeDescription& shape = bodies_[body].shape;
  if (auto mesh = std::visit([](const auto& one) { return mesh_of(one); }, shape)) {
    const bool deforms = bodies_[body].vertex_move.has_value();
    if (deforms) mesh->vertices = vertices_at(bodies_[body], 0);
    sections.add_triangles(name + " triangles", mesh->triangles);
    sections.add_floats(name + " vertices", floats_of(mesh->vertices));
    if (deforms) sections.add(name + " motion", moving_[body].points.front().bytes());
    return described(*mesh);
  }
  return std::visit(
      [](const auto& one) {
        Json json;
        if constexpr (requires { described(one); }) json = described(one);
        return json;
      },
      shape);
}

Json ShownBodies::write(Sections& sections) const {
  Json all = Json::array();
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const std::string name = fmt::format("body {}", i);
    Json body = shape_of(i, name, sections);
    sections.add_floats(name + " poses", moving_[i].poses);
    all.push_back(std::move(body));
  }
  return all;
}

}  // namespace weft::tools
