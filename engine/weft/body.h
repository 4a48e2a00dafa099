/// Bodies that cloth lies on, slides over and is pushed by: the caller moves them. Part of weft.h.
///
///   auto leg = weft::build_shape(weft::Capsule{hip, knee, 0.09, 0.06});  // m, in its coordinates
///
///   auto id = cloth.add_body({.shape = leg.value(), .pose = pose, .friction = 0.4});
///
///   cloth.move_body(id.value(), next_pose);  // it travels there during the next step
///
///   auto report = cloth.step(1.0 / 60);
///
///   weft::BodyLoad load = cloth.body_load(id.value()).value();  // what the cloth did to it
///
/// Cloth is kept at the thickness from the surface, in every substep, with Coulomb friction of the
/// same substep. Bodies are solid: a particle that is inside when a step begins comes out by 2 m/s
/// at most and gains no speed. Solver small_steps only; `automatic` chooses it when the first body
/// is added.
///
/// Planes, balls, capsules and hulls touch the particles of the cloth, by a contact in closed form.
/// What would pass through a body within a substep is stopped, if it was near enough when particles
/// were last looked for: every 2 ms, by the ways that are predicted (tests/README.md has what
/// outruns that). Edges and corners of a body between the particles of a coarse cloth are not seen.
///
/// Triangle meshes touch all of the cloth's surface (SceneDescription::surface): particles against
/// triangles both ways, and edges against edges. Every 2 ms each pair that may have met is
/// verified: a cloth that does not cross the mesh when a step begins does not cross it when the
/// step ends. If that cannot be had, as between two bodies that close on each other, the report
/// says so.
#pragma once

#include <weft/result.h>
#include <weft/scene.h>

#include <array>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace weft {

/// A unit quaternion; other lengths than 1, but for 0, are put right.
struct Rotation {
  double x = 0, y = 0, z = 0, w = 1;
};

/// Where the coordinates of a body are: x -> position + rotation x.
struct Pose {
  Vec3 position{};  ///< m
  Rotation rotation{};
};

// Shapes, in the coordinates of the body; lengths in m.

/// All of space where normal . x < offset.
struct Plane {
  Vec3 normal{0, 1, 0};  ///< of any length but 0; the offset counts in units of it
  double offset = 0;
};
struct Ball {
  Vec3 centre{};
  double radius = 0;  ///< > 0
};
/// What the balls around all points of a segment fill whose radii change evenly.
struct Capsule {
  Vec3 a{}, b{};
  double radius_a = 0, radius_b = 0;  ///< > 0
};
/// The convex hull of at least four points that are not in a plane. Each particle near it is held
/// against all of its faces: give it tens of them and not thousands. At edges and corners the
/// thickness is that of the faces, which meet in a sharp edge.
struct Hull {
  std::vector<Vec3> points;
};
/// A box around the origin of the body with these edges, as a hull.
WEFT_API Hull box(Vec3 size);

/// A surface of triangles, rigid, or deforming (Cloth::move_body_vertices).
///
/// One-sided ones, as bodies of characters are, keep cloth on the side from which their corners run
/// counterclockwise. What begins inside a closed one comes out where a vertex of the mesh, an edge
/// or a triangle is nearest to it. An open one has no inside: cloth that begins behind it, farther
/// away than the thickness, stays there. Two triangles that share an edge must run along it in
/// opposite directions. Two-sided ones keep cloth on the side where it is. What begins exactly on
/// a mesh is on the side from which its corners run counterclockwise.
///
/// Meshes cost many times what other shapes do (perf/README.md), and the more the finer they are.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< those with two equal corners are left
                                                        ///< out; others may have no area
  bool two_sided = false;
};

using ShapeDescription = std::variant<Plane, Ball, Capsule, Hull, TriangleMesh>;

/// A shape that is prepared. Immutable: cloths and threads may share it.
class BodyShape;
/// Checks the shape and prepares it.
WEFT_API Result<std::shared_ptr<const BodyShape>> build_shape(const ShapeDescription& shape);

/// What Cloth::add_body takes.
struct Body {
  std::shared_ptr<const BodyShape> shape;
  Pose pose{};              ///< where it is
  double thickness = 1e-3;  ///< m, at least 0: the distance at which it keeps particles
  double friction = 0.3;    ///< at least 0; with cloth the geometric mean with its own counts
};

/// What the cloth did to a body in its last step, divided by the length of that step: equal and
/// opposite to what the body did to the cloth.
struct BodyLoad {
  Vec3 force{};   ///< N
  Vec3 moment{};  ///< N m, about the position of its pose
};

/// A particle that touched a body in the last substep of a step.
struct BodyContact {
  std::uint32_t particle = 0;  ///< of an edge or a triangle of the cloth: the one nearest to point
  std::uint32_t body = 0;      ///< its id
  Vec3 point{};                ///< m, on the surface
  Vec3 normal{};               ///< out of the body
  double push = 0;             ///< m, by which the substep moved the particle along the normal
};

}  // namespace weft
