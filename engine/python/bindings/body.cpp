#include <pybind11/stl.h>
#include <weft/body.h>

#include "arrays.h"
#include "fields.h"
#include "held.h"
#include "parts.h"

namespace weft::python {

namespace {

void add_shapes(py::module_& m) {
  py::class_<Plane> plane(m, "Plane", "The half space where normal . x < offset.");
  add_keywords<Plane>(plane);
  plane.def_readwrite("normal", &Plane::normal, "of any length but 0")
      .def_readwrite("offset", &Plane::offset, "in units of the normal");
  py::class_<Ball> ball(m, "Ball", "A ball.");
  add_keywords<Ball>(ball);
  ball.def_readwrite("centre", &Ball::centre, "m").def_readwrite("radius", &Ball::radius, "m");
  py::class_<Capsule> capsule(m, "Capsule", "All balls whose centres lie on a segment.");
  add_keywords<Capsule>(capsule);
  capsule.def_readwrite("a", &Capsule::a, "m")
      .def_readwrite("b", &Capsule::b, "m")
      .def_readwrite("radius_a", &Capsule::radius_a, "m")
      .def_readwrite("radius_b", &Capsule::radius_b, "m");
  py::class_<Hull> hull(m, "Hull", "The convex hull of points.");
  add_keywords<Hull>(hull);
  hull.def_property(
      "points", [](const Hull& h) { return rows<double>(h.points); },
      [](Hull& h, py::object v) { h.points = vectors<Vec3>(v, "points"); }, "m, an array (n, 3)");
  m.def("box", &box, py::arg("size"), "A box around the origin with these edges, as a hull.");
  py::class_<TriangleMesh> mesh(m, "TriangleMesh", "A surface of triangles, rigid or deforming.");
  add_keywords<TriangleMesh>(mesh);
  mesh.def_property(
          "vertices", [](const TriangleMesh& t) { return rows<double>(t.vertices); },
          [](TriangleMesh& t, py::object v) { t.vertices = vectors<Vec3>(v, "vertices"); },
          "m, an array (n, 3)")
      .def_property(
          "triangles", [](const TriangleMesh& t) { return rows<std::uint32_t>(t.triangles); },
          [](TriangleMesh& t, py::object v) { t.triangles = index_tuples<3>(v, "triangles"); },
          "an array (n, 3) of vertices")
      .def_readwrite("two_sided", &TriangleMesh::two_sided, "keeps cloth on the side where it is");
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
  py::class_<Pose> pose(m, "Pose", "Position and rotation of the coordinates of a body.");
  add_keywords<Pose>(pose);
  pose.def_readwrite("position", &Pose::position, "m")
      .def_readwrite("rotation", &Pose::rotation, "a quaternion x, y, z, w");
  py::class_<Body> body(m, "Body", "A body for Cloth.add_body.");
  add_keywords<Body>(body);
  body.def_property(
          "shape",
          [](const Body& b) -> py::object {
            if (!b.shape) return py::none();
            return py::cast(HeldShape{b.shape});
          },
          [](Body& b, const HeldShape& held) { b.shape = held.shape; }, "a BodyShape")
      .def_readwrite("pose", &Body::pose, "where it is")
      .def_readwrite("thickness", &Body::thickness, "m, at which it keeps particles")
      .def_readwrite("friction", &Body::friction, "Coulomb's");
  py::class_<BodyLoad>(m, "BodyLoad", "The mean force and moment of the cloth on a body.")
      .def_readonly("force", &BodyLoad::force, "N")
      .def_readonly("moment", &BodyLoad::moment, "N m, about the position of its pose");
}

}  // namespace weft::python
