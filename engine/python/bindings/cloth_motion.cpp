#include <pybind11/stl.h>
#include <weft/cloth.h>

#include "arrays.h"
#include "cloth.h"
#include "fields.h"
#include "records.h"

namespace weft::python {

namespace {

/// Pairs (index, value).
std::vector<ChangedValue> changed_values(const py::object& value, const std::string& field) {
  if (!py::isinstance<py::iterable>(value))
    refuse(field + ": " + py::repr(value).cast<std::string>() + " is not a list of pairs");
  std::vector<ChangedValue> out;
  for (const py::handle pair : value) {
    try {
      const auto [index, number] = pair.cast<std::pair<std::uint32_t, double>>();
      out.push_back({index, number});
    } catch (const py::cast_error&) {
      refuse(field + "[" + std::to_string(out.size()) + "]: " + py::repr(pair).cast<std::string>() +
             " is not a pair of a number and a value");
    }
  }
  return out;
}

using Values = std::vector<ChangedValue> Changes::*;

void add_values(Fields<Changes>& changes, const char* name, Values values, const char* meaning) {
  changes.property(
      name,
      [values](const Changes& c) {
        py::list pairs;
        for (const ChangedValue& one : c.*values)
          pairs.append(py::make_tuple(one.index, one.value));
        return pairs;
      },
      [values, name](Changes& c, const py::object& v) { c.*values = changed_values(v, name); },
      meaning);
}

void add_changes(py::module_& m) {
  Fields<ChangedMembrane> membrane(m, "ChangedMembrane", "New stiffnesses of a triangle.");
  membrane.field("index", &ChangedMembrane::index, "its number in the description")
      .field("warp", &ChangedMembrane::warp, "N/m")
      .field("weft", &ChangedMembrane::weft, "N/m")
      .field("shear", &ChangedMembrane::shear, "N/m per radian");
  Fields<ChangedAir> air(m, "ChangedAir", "New numbers of the air.");
  air.field("density", &ChangedAir::density, "kg/m^3")
      .field("drag", &ChangedAir::drag, "as Air.drag")
      .field("lift", &ChangedAir::lift, "as Air.lift")
      .field("ram", &ChangedAir::ram, "as Air.ram");
  Fields<Changes> changes(m, "Changes", "Changes of a cloth that moves.");
  changes.array("fix", &Changes::fix, "particles")
      .array("release", &Changes::release, "fixed particles")
      .field("membrane", &Changes::membrane, "a list of ChangedMembrane")
      .field("damping", &Changes::damping, "a Damping, or None")
      .field("air", &Changes::air, "a ChangedAir, or None");
  add_values(changes, "masses", &Changes::masses, "pairs (particle, kg)");
  add_values(changes, "rest_lengths", &Changes::rest_lengths, "pairs (constraint, m)");
  add_values(changes, "compliances", &Changes::compliances, "pairs (constraint, m/N)");
  add_values(changes, "bending", &Changes::bending, "pairs (bending element, m/N)");
}

void add_pins(ClothClass& cloth) {
  using Fixed = Result<void> (Cloth::*)(std::span<const std::uint32_t>, std::span<const Vec3>);
  const auto fixed = [](Fixed give) {
    return [give](HeldCloth& c, py::object particles, py::object positions) {
      const bool is_one = PyIndex_Check(particles.ptr()) && !py::isinstance<py::array>(particles);
      const auto who = is_one ? std::vector{taken(Given<std::uint32_t>{particles}, "particles")}
                              : indices(particles, "particles");
      const auto where = is_one ? std::vector{taken(Given<Vec3>{positions}, "positions")}
                                : vectors<Vec3>(positions, "positions");
      const auto used = use(c);
      check((c.value.*give)(who, where));
    };
  };
  cloth
      .def("move_fixed", fixed(&Cloth::move_fixed), py::arg("particles"), py::arg("positions"),
           "Moves fixed particles, or one: they travel there during the next step.")
      .def("place_fixed", fixed(&Cloth::place_fixed), py::arg("particles"), py::arg("positions"),
           "Teleports fixed particles, or one.")
      .def(
          "change",
          [](HeldCloth& c, const Changes& changes) {
            const auto used = use(c);
            const Changes copy = changes;
            const py::gil_scoped_release release;
            check(c.value.change(copy));
          },
          py::arg("changes"), "Changes the description of a moving cloth; on an error, nothing.")
      .def(
          "set_rest_shape",
          [](HeldCloth& c, const SceneDescription& scene, const Given<double>& given) {
            const double scale = taken(given, "scale");
            const auto used = use(c);
            const SceneDescription copy = scene;
            const py::gil_scoped_release release;
            check(c.value.set_rest_shape(copy, scale));
          },
          py::arg("scene"), py::arg("scale") = 1.0,
          "Gives the cloth the shape at rest of the scene's elements, times scale.");
}

void add_anchors(py::module_& m, ClothClass& cloth) {
  Fields<AnchorLimit> limit(m, "AnchorLimit", "New limits of an anchor.");
  limit.field("max_distance", &AnchorLimit::max_distance, "m; infinite: let go")
      .field("backstop", &AnchorLimit::backstop, "whether the backstop counts");
  cloth
      .def(
          "move_anchors",
          [](HeldCloth& c, py::object points, py::object normals) {
            const auto where = vectors<Vec3>(points, "points");
            const auto out = vectors<Vec3>(normals, "normals");
            const auto used = use(c);
            check(c.value.move_anchors(where, out));
          },
          py::arg("points"), py::arg("normals") = py::tuple(),
          "Moves the points of all anchors; they travel there during the next step.")
      .def(
          "limit_anchors",
          [](HeldCloth& c, const Given<std::vector<AnchorLimit>>& given) {
            const auto limits = taken(given, "limits");
            const auto used = use(c);
            check(c.value.limit_anchors(limits));
          },
          py::arg("limits"), "New limits of all anchors, a list of AnchorLimit.")
      .def(
          "limit_anchor",
          [](HeldCloth& c, const Given<std::uint32_t>& given, const Given<AnchorLimit>& limit) {
            const auto anchor = taken(given, "anchor");
            const auto one = taken(limit, "limit");
            const auto used = use(c);
            check(c.value.limit_anchor(anchor, one));
          },
          py::arg("anchor"), py::arg("limit"), "Sets the limits of one anchor.")
      .def(
          "scale_anchors",
          [](HeldCloth& c, const Given<double>& given) {
            const double scale = taken(given, "scale");
            const auto used = use(c);
            check(c.value.scale_anchors(scale));
          },
          py::arg("scale"), "Multiplies all largest distances, from the next step on.");
}

void add_seams(ClothClass& cloth) {
  using Seams = Result<void> (Cloth::*)(std::span<const std::uint32_t>);
  const auto with = [](Seams give) {
    return [give](HeldCloth& c, py::object seams) {
      const auto which = indices(seams, "seams");
      const auto used = use(c);
      check((c.value.*give)(which));
    };
  };
  cloth
      .def("release_seams", with(&Cloth::release_seams), py::arg("seams"),
           "Releases seams: they hold nothing from the next step on.")
      .def("close_seams", with(&Cloth::close_seams), py::arg("seams"),
           "Closes seams that were released: they draw their particles together again.");
}

void add_rigid_motion(py::module_& m, ClothClass& cloth) {
  Fields<RigidMotion> motion(m, "RigidMotion", "x -> about + R (x - about) + translation.");
  motion.field("translation", &RigidMotion::translation, "m")
      .field("rotation", &RigidMotion::rotation, "rad, about this axis")
      .field("about", &RigidMotion::about, "m");
  cloth
      .def(
          "carry",
          [](HeldCloth& c, const Given<RigidMotion>& motion, const Given<double>& share) {
            const auto by = taken(motion, "motion");
            const double so_far = taken(share, "share");
            const auto used = use(c);
            check(c.value.carry(by, so_far));
          },
          py::arg("motion"), py::arg("share"), "Takes the whole cloth along, by a share.")
      .def(
          "teleport",
          [](HeldCloth& c, const Given<RigidMotion>& motion) {
            const auto by = taken(motion, "motion");
            const auto used = use(c);
            check(c.value.teleport(by));
          },
          py::arg("motion"), "carry with share 1, without drag of the air.");
}

void add_bodies(ClothClass& cloth) {
  using Move = Result<void> (Cloth::*)(std::uint32_t, const Pose&);
  using MoveVertices = Result<void> (Cloth::*)(std::uint32_t, std::span<const Vec3>);
  const auto posed = [](Move move) {
    return [move](HeldCloth& c, const Given<std::uint32_t>& id, const Given<Pose>& pose) {
      const auto which = taken(id, "id");
      const auto where = taken(pose, "pose");
      const auto used = use(c);
      check((c.value.*move)(which, where));
    };
  };
  const auto deformed = [](MoveVertices move) {
    return [move](HeldCloth& c, const Given<std::uint32_t>& id, py::object vertices) {
      const auto which = taken(id, "id");
      const auto where = vectors<Vec3>(vertices, "vertices");
      const auto used = use(c);
      check((c.value.*move)(which, where));
    };
  };
  cloth
      .def(
          "add_body",
          [](HeldCloth& c, const Given<Body>& given) {
            const Body body = taken(given, "body");
            const auto used = use(c);
            return value_of(c.value.add_body(body));
          },
          py::arg("body"), "Adds a body and returns its id.")
      .def("move_body", posed(&Cloth::move_body), py::arg("id"), py::arg("pose"),
           "Gives a body another pose: it travels there during the next step.")
      .def("place_body", posed(&Cloth::place_body), py::arg("id"), py::arg("pose"),
           "The same without a way between.")
      .def("move_body_vertices", deformed(&Cloth::move_body_vertices), py::arg("id"),
           py::arg("vertices"), "Gives a mesh other vertices: they travel there.")
      .def("place_body_vertices", deformed(&Cloth::place_body_vertices), py::arg("id"),
           py::arg("vertices"), "The same without a way between.")
      .def(
          "switch_body",
          [](HeldCloth& c, std::uint32_t id, bool on) {
            const auto used = use(c);
            check(c.value.switch_body(id, on));
          },
          py::arg("id"), py::arg("on"), "A body that is off touches nothing.")
      .def(
          "remove_body",
          [](HeldCloth& c, std::uint32_t id) {
            const auto used = use(c);
            check(c.value.remove_body(id));
          },
          py::arg("id"), "Ids are not used again.")
      .def(
          "body_load",
          [](const HeldCloth& c, std::uint32_t id) {
            const auto used = use(c);
            return value_of(c.value.body_load(id));
          },
          py::arg("id"), "The force and moment of the cloth on it in the last step.")
      .def(
          "body_pose",
          [](const HeldCloth& c, std::uint32_t id) {
            const auto used = use(c);
            return value_of(c.value.body_pose(id));
          },
          py::arg("id"), "Where it is.")
      .def(
          "body_velocity",
          [](const HeldCloth& c, std::uint32_t id) {
            const auto used = use(c);
            return value_of(c.value.body_velocity(id));
          },
          py::arg("id"), "The velocity of one with a mass.")
      .def(
          "set_body_velocity",
          [](HeldCloth& c, const Given<std::uint32_t>& id, const Given<BodyVelocity>& velocity) {
            const auto which = taken(id, "id");
            const auto to = taken(velocity, "velocity");
            const auto used = use(c);
            check(c.value.set_body_velocity(which, to));
          },
          py::arg("id"), py::arg("velocity"), "The velocity of one with a mass.")
      .def(
          "set_body_force",
          [](HeldCloth& c, const Given<std::uint32_t>& id, const Given<Vec3>& force,
             const Given<Vec3>& moment) {
            const auto which = taken(id, "id");
            const auto push = taken(force, "force");
            const auto turn = taken(moment, "moment");
            const auto used = use(c);
            check(c.value.set_body_force(which, push, turn));
          },
          py::arg("id"), py::arg("force"), py::arg("moment"),
          "N and N m; they act until others are set.")
      .def(
          "body_contacts",
          [](const HeldCloth& c) {
            const auto used = use(c);
            return array_of_records(c.value.body_contacts());
          },
          "Contacts of the last step, records of weft.BodyContact.")
      .def(
          "torn",
          [](const HeldCloth& c) {
            const auto used = use(c);
            return array_of_records(c.value.torn());
          },
          "All that broke when the last step ended, records of weft.Torn; kinds are those of Tear.")
      .def(
          "surface",
          [](const HeldCloth& c) {
            const auto used = use(c);
            return rows<std::uint32_t>(c.value.surface());
          },
          "The triangles as tears have left them, an array (n, 3) of particles.");
}

}  // namespace

void add_cloth_motion(py::module_& m, ClothClass& cloth) {
  add_changes(m);
  add_pins(cloth);
  add_anchors(m, cloth);
  add_seams(cloth);
  add_rigid_motion(m, cloth);
  add_bodies(cloth);
}

}  // namespace weft::python
