#include <pybind11/stl.h>
#include <weft/cloth.h>

#include "arrays.h"
#include "cloth.h"
#include "fields.h"
#include "records.h"

namespace weft::python {

namespace {

/// Pairs (index, value).
std::vector<ChangedValue> changed_values(const py::iterable& value, const std::string& field) {
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

template <class Class>
void add_values(Class& changes, const char* name, Values values, const char* meaning) {
  changes.def_property(
      name,
      [values](const Changes& c) {
        py::list pairs;
        for (const ChangedValue& one : c.*values)
          pairs.append(py::make_tuple(one.index, one.value));
        return pairs;
      },
      [values, name](Changes& c, const py::iterable& v) { c.*values = changed_values(v, name); },
      meaning);
}

void add_changes(py::module_& m) {
  py::class_<ChangedMembrane> membrane(m, "ChangedMembrane", "New stiffnesses of a triangle.");
  add_keywords<ChangedMembrane>(membrane);
  membrane.def_readwrite("index", &ChangedMembrane::index, "its number in the description")
      .def_readwrite("warp", &ChangedMembrane::warp, "N/m")
      .def_readwrite("weft", &ChangedMembrane::weft, "N/m")
      .def_readwrite("shear", &ChangedMembrane::shear, "N/m per radian");
  py::class_<ChangedAir> air(m, "ChangedAir", "New numbers of the air.");
  add_keywords<ChangedAir>(air);
  air.def_readwrite("density", &ChangedAir::density, "kg/m^3")
      .def_readwrite("drag", &ChangedAir::drag, "as Air.drag")
      .def_readwrite("lift", &ChangedAir::lift, "as Air.lift");
  py::class_<Changes> changes(m, "Changes", "Changes of a cloth that moves.");
  add_keywords<Changes>(changes);
  changes
      .def_property(
          "fix", [](const Changes& c) { return rows<std::uint32_t>(c.fix); },
          [](Changes& c, py::object v) { c.fix = indices(v, "fix"); }, "particles")
      .def_property(
          "release", [](const Changes& c) { return rows<std::uint32_t>(c.release); },
          [](Changes& c, py::object v) { c.release = indices(v, "release"); }, "fixed particles")
      .def_readwrite("membrane", &Changes::membrane, "a list of ChangedMembrane")
      .def_readwrite("damping", &Changes::damping, "a Damping, or None")
      .def_readwrite("air", &Changes::air, "a ChangedAir, or None");
  add_values(changes, "masses", &Changes::masses, "pairs (particle, kg)");
  add_values(changes, "rest_lengths", &Changes::rest_lengths, "pairs (constraint, m)");
  add_values(changes, "compliances", &Changes::compliances, "pairs (constraint, m/N)");
  add_values(changes, "bending", &Changes::bending, "pairs (bending element, m/N)");
}

void add_pins(ClothClass& cloth) {
  using Fixed = Result<void> (Cloth::*)(std::span<const std::uint32_t>, std::span<const Vec3>);
  const auto fixed = [](Fixed give) {
    return [give](HeldCloth& c, py::object particles, py::object positions) {
      const auto who = indices(particles, "particles");
      const auto where = vectors<Vec3>(positions, "positions");
      const auto used = use(c);
      check((c.value.*give)(who, where));
    };
  };
  cloth
      .def("move_fixed", fixed(&Cloth::move_fixed), py::arg("particles"), py::arg("positions"),
           "Moves fixed particles: they travel there during the next step.")
      .def("place_fixed", fixed(&Cloth::place_fixed), py::arg("particles"), py::arg("positions"),
           "Puts fixed particles down somewhere else, without a way between.")
      .def(
          "change",
          [](HeldCloth& c, const Changes& changes) {
            const auto used = use(c);
            const Changes copy = changes;
            const py::gil_scoped_release release;
            check(c.value.change(copy));
          },
          py::arg("changes"), "Changes the description of a moving cloth; on an error, nothing.");
}

void add_anchors(py::module_& m, ClothClass& cloth) {
  py::class_<AnchorLimit> limit(m, "AnchorLimit", "New limits of an anchor.");
  add_keywords<AnchorLimit>(limit);
  limit.def_readwrite("max_distance", &AnchorLimit::max_distance, "m; infinite: let go")
      .def_readwrite("backstop", &AnchorLimit::backstop, "whether the backstop counts");
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
          [](HeldCloth& c, const std::vector<AnchorLimit>& limits) {
            const auto used = use(c);
            check(c.value.limit_anchors(limits));
          },
          py::arg("limits"), "New limits of all anchors, a list of AnchorLimit.")
      .def(
          "limit_anchor",
          [](HeldCloth& c, std::uint32_t anchor, const AnchorLimit& one) {
            const auto used = use(c);
            check(c.value.limit_anchor(anchor, one));
          },
          py::arg("anchor"), py::arg("limit"), "Sets the limits of one anchor.")
      .def(
          "scale_anchors",
          [](HeldCloth& c, double scale) {
            const auto used = use(c);
            check(c.value.scale_anchors(scale));
          },
          py::arg("scale"), "Multiplies all largest distances, from the next step on.");
}

void add_rigid_motion(py::module_& m, ClothClass& cloth) {
  py::class_<RigidMotion> motion(m, "RigidMotion", "x -> about + R (x - about) + translation.");
  add_keywords<RigidMotion>(motion);
  motion.def_readwrite("translation", &RigidMotion::translation, "m")
      .def_readwrite("rotation", &RigidMotion::rotation, "rad, about this axis")
      .def_readwrite("about", &RigidMotion::about, "m");
  cloth
      .def(
          "carry",
          [](HeldCloth& c, const RigidMotion& by, double share) {
            const auto used = use(c);
            check(c.value.carry(by, share));
          },
          py::arg("motion"), py::arg("share"), "Takes the whole cloth along, by a share.")
      .def(
          "teleport",
          [](HeldCloth& c, const RigidMotion& by) {
            const auto used = use(c);
            check(c.value.teleport(by));
          },
          py::arg("motion"), "carry with share 1, without drag of the air.");
}

void add_bodies(ClothClass& cloth) {
  using Move = Result<void> (Cloth::*)(std::uint32_t, const Pose&);
  using MoveVertices = Result<void> (Cloth::*)(std::uint32_t, std::span<const Vec3>);
  const auto posed = [](Move move) {
    return [move](HeldCloth& c, std::uint32_t id, const Pose& pose) {
      const auto used = use(c);
      check((c.value.*move)(id, pose));
    };
  };
  const auto deformed = [](MoveVertices move) {
    return [move](HeldCloth& c, std::uint32_t id, py::object vertices) {
      const auto where = vectors<Vec3>(vertices, "vertices");
      const auto used = use(c);
      check((c.value.*move)(id, where));
    };
  };
  cloth
      .def(
          "add_body",
          [](HeldCloth& c, const Body& body) {
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
          "body_contacts",
          [](const HeldCloth& c) {
            const auto used = use(c);
            return array_of_records(c.value.body_contacts());
          },
          "Contacts of the last step, records of weft.BodyContact.");
}

}  // namespace

void add_cloth_motion(py::module_& m, ClothClass& cloth) {
  add_changes(m);
  add_pins(cloth);
  add_anchors(m, cloth);
  add_rigid_motion(m, cloth);
  add_bodies(cloth);
}

}  // namespace weft::python
