/// Bodies as triangle meshes, made by code: closed, one-sided, from outside counterclockwise.
#pragma once

#include <weft/body.h>

namespace weft::scenes {

/// So many triangles around and, of each half ball, `around / 4` rows of them.
TriangleMesh capsule_mesh(const Capsule& capsule, int around);
TriangleMesh ball_mesh(const weft::Ball& ball, int around);
/// Around the y axis, with so many quads along the ring and around its tube, each cut in two.
TriangleMesh ring_mesh(double radius, double tube_radius, int along, int around);
/// The same of a torus.
TriangleMesh torus_mesh(const Torus& torus, int along, int around);
/// The surface of terrain, which is open and looks up.
TriangleMesh terrain_mesh(const HeightField& field);
/// Around the origin, with so many squares along each edge, each cut in two.
TriangleMesh box_mesh(Vec3 size, int along);
/// A level rectangle around the origin that looks up, of so many squares each way, cut in two.
TriangleMesh plate_mesh(double length, double width, int along, int across);
/// All of the second mesh is added to the first.
void add_mesh(const TriangleMesh& mesh, TriangleMesh& sum);

}  // namespace weft::scenes
