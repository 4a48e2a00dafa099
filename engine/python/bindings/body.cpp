#include <pybind11/stl.h>
#include <weft/body.h>

#include "arrays.h"
#include "fields.h"
#include "held.h"
#include "parts.h"

namespace weft::python {

namespace {

void add_shapes(py::module_& m) {
  Fields<Plane> plane(m, "Plane", "The half space where normal . x < offset.");
  plane.field("normal", &Plane::normal, "of any length but 0")
      .field("offset", &Plane::offset, "in units of the normal");
  Fields<Ball> ball(m, "Ball", "A ball.");
  ball.field("centre", &Ball::centre, "m").field("radius", &Ball::radius, "m");
  Fields<Capsule> capsule(m, "Capsule", "All balls whose centres lie on a segment.");
  capsule.field("a", &Capsule::a, "m")
      .field("b", &Capsule::b, "m")
      .field("radius_a", &Capsule::radius_a, "m")
      .field("radius_b", &Capsule::radius_b, "m");
  Fields<Hull> hull(m, "Hull", "The convex hull of points.");
  hull.array("points", &Hull::points, "m, an array (n, 3)");
  m.def("box", &box, py::arg("size"), "A box around the origin with these edges, as a hull.");
  Fields<TriangleMesh> mesh(m, "TriangleMesh", "A surface of triangles, rigid or deforming.");
  mesh.array("vertices", &TriangleMesh::vertices, "m, an array (n, 3)")
      .array("triangles", &TriangleMesh::triangles, "an array (n, 3) of vertices")
      .field("two_sided", &TriangleMesh::two_sided, "keeps cloth on the side where it is");
  py::class_<HeldShape>(m, "BodyShape", "A shape that is prepared. Cloths share it.");
  m.def(
      "build_shape",
      [](const ShapeDescription& shape) {
        const py::gil_scoped_release release;
        return HeldShape{value_of(build_shape(shape))};
      },
      py::arg("shape"), "Checks a Plane, Ball, Capsule, Hull or TriangleMesh and prepares it.");
}

}  // namespace

void add_body(py::module_& m) {
  add_shapes(m);
  Fields<Pose> pose(m, "Pose", "Position and rotation of the coordinates of a body.");
  pose.field("position", &Pose::position, "m")
      .field("rotation", &Pose::rotation, "a quaternion x, y, z, w");
  Fields<BodyMass> mass(m, "BodyMass", "The mass of a body that moves by itself.");
  mass.field("mass", &BodyMass::mass, "kg")
      .field("centre", &BodyMass::centre, "m, of mass, in the coordinates of the body")
      .field("inertia", &BodyMass::inertia, "kg m^2, xx yy zz yz zx xy");
  m.def(
      "mass_of",
      [](const Given<HeldShape>& shape, const Given<double>& density) {
        return value_of(mass_of(*taken(shape, "shape").shape, taken(density, "density")));
      },
      py::arg("shape"), py::arg("density"), "The mass of a full ball, capsule or hull.");
  Fields<Body> body(m, "Body", "A body for Cloth.add_body.");
  body.property(
          "shape",
          [](const Body& b) -> py::object {
            if (!b.shape) return py::none();
            return py::cast(HeldShape{b.shape});
          },
          [](Body& b, const Given<HeldShape>& v) { b.shape = taken(v, "shape").shape; },
          "a BodyShape")
      .field("pose", &Body::pose, "where it is")
      .field("thickness", &Body::thickness, "m, at which it keeps particles")
      .field("friction", &Body::friction, "Coulomb's")
      .field("mass", &Body::mass, "a BodyMass of one that moves by itself, or None");
  Fields<BodyVelocity> velocity(m, "BodyVelocity", "The velocity of a body that moves by itself.");
  velocity.field("linear", &BodyVelocity::linear, "m/s, of its centre of mass")
      .field("angular", &BodyVelocity::angular, "rad/s");
  py::class_<BodyLoad>(m, "BodyLoad", "The mean force and moment of the cloth on a body.")
      .def_readonly("force", &BodyLoad::force, "N")
      .def_readonly("moment", &BodyLoad::moment, "N m, about the position of its pose");
}

}  // namespace weft::python
