/// Bodies that the cloth collides with. The caller moves them, or they have a mass and move by
/// themselves. Part of weft.h.
///
///   auto leg = weft::build_shape(weft::Capsule{hip, knee, 0.09, 0.06});  // m, in its coordinates
///
///   auto id = cloth.add_body({.shape = leg.value(), .pose = pose, .friction = 0.4});
///   cloth.move_body(id.value(), next_pose);     // each frame: it travels there during the step
///   auto report = cloth.step(1.0 / 60);
///   weft::BodyLoad load = cloth.body_load(id.value()).value();  // the force of the cloth on it
///
/// In every substep the cloth is kept one thickness away from the surface, with Coulomb friction.
/// Bodies are solid: a particle that is inside when a step begins comes out at 2 m/s at most, and
/// gains no speed. Solver small_steps only; `automatic` becomes small_steps when the first body is
/// added.
///
/// A body with a mass (Body::mass) moves by gravity, by its contacts with the cloth, and by the
/// force that the caller gives:
///
///   auto ball = weft::build_shape(weft::Ball{{}, 0.1});
///   auto mass = weft::mass_of(*ball.value(), 1000);  // kg/m^3
///   auto id = cloth.add_body({.shape = ball.value(), .pose = pose, .mass = mass.value()});
///   auto report = cloth.step(1.0 / 60);
///   weft::Pose where = cloth.body_pose(id.value()).value();
///
/// It falls and turns as a rigid body. The cloth loses the momentum that the body gains from it.
/// Such a body collides with particles of the cloth alone, fixed ones included: not with other
/// bodies. It has no drag. A body much heavier than the cloth under it needs short substeps. A
/// program with a physics engine calls move_body instead, and applies body_load to its own bodies.
///
/// All shapes but meshes touch the particles of the cloth, by a contact in closed form.
/// Fast particles are stopped too, if the last search (every 2 ms) found them near. The search
/// predicts where particles go; tests/README.md says which bodies are too fast for that. An edge or
/// a corner of a body that passes between the particles of a coarse cloth is not detected.
///
/// A ball, capsule, hull or torus that fits between the particles of the cloth touches the whole
/// surface of the cloth, as a triangle mesh does, and costs as much. It fits where its greatest
/// width is less than 2/sqrt(3) of the longest side of a triangle of the cloth, or its width is
/// less than half of the largest height of a triangle, as those of rods and blades are. These
/// lengths are at rest; for a thread both are its length. Its thickness counts, on both sides. The
/// width of a capsule is that of its wider end, and the width of a torus is twice its minor radius.
/// Such a hull has round edges, and such a capsule pushes across its axis.
///
/// Triangle meshes touch the whole surface of the cloth (SceneDescription::surface): particles
/// against triangles both ways, and edges against edges. Every 2 ms each pair that may have met is
/// verified: more often if the mesh is fast, and less often if it is slow and the only body. So a
/// cloth that does not cross the mesh when a step begins does not cross it when the step ends.
/// Where this is not possible, as between two bodies that close on each other, the report says so
/// (StepReport::intersecting).
#pragma once

#include <weft/result.h>
#include <weft/scene.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace weft {

/// A unit quaternion. Any length other than 0 is scaled to 1.
struct Rotation {
  double x = 0, y = 0, z = 0, w = 1;
};

/// Position and rotation of the coordinates of a body: x -> position + rotation x.
struct Pose {
  Vec3 position{};  ///< m
  Rotation rotation{};
};

// Shapes, in the coordinates of the body; lengths in m.

/// The half space where normal . x < offset.
struct Plane {
  Vec3 normal{0, 1, 0};  ///< of any length but 0; the offset is measured in units of this length
  double offset = 0;
};
struct Ball {
  Vec3 centre{};
  double radius = 0;  ///< > 0
};
/// All balls whose centres lie on a segment; the radius changes linearly from a to b.
struct Capsule {
  Vec3 a{}, b{};
  double radius_a = 0, radius_b = 0;  ///< > 0
};
/// The convex hull of at least four points that are not in one plane. Each particle near a hull is
/// compared with all faces of the hull: give it tens of faces, not thousands. The thickness is
/// added to the faces, so the thick hull has sharp edges and corners, unless it is thin.
struct Hull {
  std::vector<Vec3> points;
};
/// A box around the origin of the body with these edges, as a hull.
WEFT_API Hull box(Vec3 size);

/// A surface of triangles, rigid, or deforming (Cloth::move_body_vertices).
///
/// The front of a triangle is the side from which its corners run counterclockwise. A one-sided
/// mesh, as the body of a character is, keeps cloth in front of it. Two triangles that share an
/// edge must run along it in opposite directions. A particle that starts inside a closed mesh comes
/// out at the vertex, edge or triangle that is nearest to it. So does one that starts behind an
/// open mesh within the box around its vertices. Cloth behind the mesh and outside that box stays
/// on its side, where it collides as it does in front.
///
/// A two-sided mesh keeps cloth on whichever side the cloth is.
///
/// A particle that starts exactly on a mesh counts as in front of it.
///
/// A mesh costs many times as much as another shape (perf/README.md), and more the finer it is.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  /// Triangles with two equal corners are left out; others may have no area.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool two_sided = false;
};

/// Terrain: the solid under a surface over a rectangle of x and z. It has upright sides under its
/// border, and no bottom.
///
/// The surface goes through heights over the points of a grid. The first point is over the origin
/// of the body. Two triangles make up a cell of the grid. They share the side from its corner of
/// the least x and z to that of the largest. Cloth is kept away from the nearest point of the
/// surface, so slopes count in full. Where cells are finer than the cloth, a ridge or a tip between
/// its particles is not seen.
struct HeightField {
  std::uint32_t columns = 0, rows = 0;  ///< points along x and along z, at least 2
  double spacing_x = 0, spacing_z = 0;  ///< m, between them, > 0
  std::vector<double> heights;          ///< m, along y: that of a point is [row * columns + column]
};

/// A ring: all balls of the minor radius whose centres lie on a circle of the major one.
struct Torus {
  Vec3 centre{};
  Vec3 axis{0, 1, 0};  ///< of any length but 0
  double major = 0;    ///< > 0
  double minor = 0;    ///< from major / 10000 to less than major
};

using ShapeDescription = std::variant<Plane, Ball, Capsule, Hull, TriangleMesh, HeightField, Torus>;

/// A shape that is checked and prepared. It is immutable: cloths and threads may share it.
class BodyShape;
/// Checks the shape and prepares it. An error names the field, the index and the value.
WEFT_API Result<std::shared_ptr<const BodyShape>> build_shape(const ShapeDescription& shape);

/// The mass of a body that moves by itself, and how it is spread.
struct BodyMass {
  double mass = 0;  ///< kg, > 0
  Vec3 centre{};    ///< m, the centre of mass, in the coordinates of the body
  /// kg m^2, the tensor of inertia about the centre, along the axes of the body: its elements xx,
  /// yy, zz, yz, zx and xy. The element xy is minus the sum of m x y.
  std::array<double, 6> inertia{};
};
/// The mass of a ball, a capsule, a hull or a torus that is full, at a density (kg/m^3, > 0).
WEFT_API Result<BodyMass> mass_of(const BodyShape& shape, double density);

/// The velocity of a body that moves by itself.
struct BodyVelocity {
  Vec3 linear{};   ///< m/s, of its centre of mass
  Vec3 angular{};  ///< rad/s
};

/// A body for Cloth::add_body.
struct Body {
  std::shared_ptr<const BodyShape> shape;
  Pose pose{};  ///< where it is
  /// m, at least 0: particles are kept at this distance. Two bodies share a gap that is smaller
  /// than the sum of their thicknesses in proportion to these, and StepReport::max_penetration
  /// reports only the depth beyond that.
  double thickness = 1e-3;
  /// Coulomb's coefficient, at least 0. The coefficient of a contact is the geometric mean of this
  /// one and the cloth's (SceneDescription::friction).
  double friction = 0.3;
  /// With a mass it moves by itself, and move_body is refused. It must be a ball, a capsule, a hull
  /// or a torus, and too large to fit between the particles of the cloth.
  std::optional<BodyMass> mass{};
};

/// The mean force and moment of the cloth on a body during the last step. The body acted on the
/// cloth with the opposite ones.
struct BodyLoad {
  Vec3 force{};   ///< N
  Vec3 moment{};  ///< N m, about the position of its pose
};

/// A particle that touched a body in the last substep of a step.
struct BodyContact {
  std::uint32_t particle = 0;  ///< of a touching edge or triangle: its particle nearest to point
  std::uint32_t body = 0;      ///< id of the body
  Vec3 point{};                ///< m, on the surface
  Vec3 normal{};               ///< out of the body
  double push = 0;             ///< m, by which the substep moved the particle along the normal
};

}  // namespace weft
