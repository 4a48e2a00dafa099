#include <pybind11/stl.h>
#include <weft/body.h>
#include <weft/shape_fields.h>

#include "arrays.h"
#include "fields.h"
#include "held.h"
#include "parts.h"

namespace weft::python {

namespace {

template <class Shape>
void add_shape(py::module_& m) {
  Fields<Shape> shape(m, kShapeKind<Shape>.type, kShapeKind<Shape>.about);
  for_each_part_field<Shape>([&](const auto& field) {
    if constexpr (requires { shape.array(field.name, field.member, field.text); })
      shape.array(field.name, field.member, field.text);
    else
      shape.field(field.name, field.member, field.text);
  });
}

void add_shapes(py::module_& m) {
  for_each_shape([&]<class Shape> { add_shape<Shape>(m); });
  m.def("box", &box, py::arg("size"), "A box around the origin with these edges, as a hull.");
  py::class_<HeldShape>(m, "BodyShape", "A shape that is prepared. Cloths share it.");
  m.def(
      "build_shape",
      [](const ShapeDescription& shape) {
        const py::gil_scoped_release release;
        return HeldShape{value_of(build_shape(shape))};
      },
      py::arg("shape"), "Checks a Plane, a Ball or another shape and prepares it.");
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
      py::arg("shape"), py::arg("density"), "The mass of a shape that is full.");
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
