#include <pybind11/stl.h>
#include <weft/scene.h>

#include "arrays.h"
#include "bytes.h"
#include "fields.h"
#include "held.h"
#include "parts.h"
#include "records.h"

namespace weft::python {

namespace {

using Scene = SceneDescription;

void check_kinds(const std::vector<ConstraintKind>& kinds, const std::string& field) {
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] > ConstraintKind::rope) {
      refuse(field + "[" + std::to_string(i) + "].kind: " +
             std::to_string(static_cast<int>(kinds[i])) + " is neither 0, distance, nor 1, rope");
    }
  }
}

template <class T>
std::vector<T> checked_records(py::handle value, const std::string& field) {
  std::vector<T> out = records<T>(value, field);
  std::vector<ConstraintKind> kinds;
  for (const T& record : out) kinds.push_back(record.kind);
  check_kinds(kinds, field);
  return out;
}

void add_scene_enumerations(py::module_& m) {
  py::enum_<ConstraintKind>(m, "ConstraintKind", "distance, or rope, which only pulls.")
      .value("distance", ConstraintKind::distance)
      .value("rope", ConstraintKind::rope);
}

void add_parts(py::module_& m) {
  Fields<Damping> damping(m, "Damping", "Damping times of springs, and the decay of all motion.");
  damping.field("stretch", &Damping::stretch, "s")
      .field("bending", &Damping::bending, "s")
      .field("motion", &Damping::motion, "1/s");

  Fields<Air> air(m, "Air", "Drag and lift on triangles of the cloth.");
  air.array("triangles", &Air::triangles, "an array (n, 3) of particles", "air.triangles")
      .field("density", &Air::density, "kg/m^3")
      .field("drag", &Air::drag, "of the area that a triangle shows")
      .field("lift", &Air::lift, "across the wind")
      .field("ram", &Air::ram, "of the flow that a piece of the cloth catches")
      .field("wind", &Air::wind, "m/s");

  Fields<Pressure> pressure(m, "Pressure", "A pressure on triangles of the surface.");
  pressure.field("pressure", &Pressure::pressure, "Pa, more than the air around has")
      .array("triangles", &Pressure::triangles, "by their numbers; empty: all")
      .field("gas", &Pressure::gas, "whether it falls as the volume grows")
      .field("volume", &Pressure::volume, "m^3, where a gas has the pressure; 0: that of now")
      .field("ambient", &Pressure::ambient, "Pa, of the air around a gas");

  Fields<SelfContact> self_contact(m, "SelfContact", "Layers of the cloth keep off each other.");
  self_contact.field("on", &SelfContact::on, "whether they do")
      .field("thickness", &SelfContact::thickness, "m, from the middle of one to that of the next")
      .field("friction", &SelfContact::friction, "Coulomb's, between layers")
      .field("untangle", &SelfContact::untangle, "whether triangles that cross are drawn apart");
}

void add_particles(Fields<Scene>& scene) {
  scene.array("positions", &Scene::positions, "m, an array (particles, 3)")
      .array("velocities", &Scene::velocities, "m/s, one per particle; empty: at rest")
      .array("masses", &Scene::masses, "kg, one per particle")
      .array("fixed", &Scene::fixed, "particles of infinite inertia")
      .array("surface", &Scene::surface,
             "triangles of the cloth, which meshes touch, an array (n, 3)")
      .array("spheres", &Scene::spheres, "particles that others collide with")
      .array("radii", &Scene::radii, "m, one per particle; empty without spheres");
}

void add_joints(Fields<Scene>& scene) {
  scene
      .property(
          "constraints", [](const Scene& s) { return array_of_records(s.constraints); },
          [](Scene& s, py::object v) {
            s.constraints = checked_records<Constraint>(v, "constraints");
          },
          "records of weft.Constraint")
      .property(
          "membrane", [](const Scene& s) { return array_of_records(s.membrane); },
          [](Scene& s, py::object v) {
            s.membrane = checked_records<MembraneElement>(v, "membrane");
          },
          "records of weft.MembraneElement")
      .property(
          "bending", [](const Scene& s) { return array_of_records(s.bending); },
          [](Scene& s, py::object v) { s.bending = records<BendingElement>(v, "bending"); },
          "records of weft.BendingElement")
      .property(
          "anchors", [](const Scene& s) { return array_of_records(s.anchors); },
          [](Scene& s, py::object v) { s.anchors = records<Anchor>(v, "anchors"); },
          "records of weft.Anchor")
      .property(
          "seams", [](const Scene& s) { return array_of_records(s.seams); },
          [](Scene& s, py::object v) { s.seams = records<Seam>(v, "seams"); },
          "records of weft.Seam");
}

void add_model(py::module_& m) {
  py::class_<ModelInfo>(m, "ModelInfo", "Counts of what a model consists of.")
      .def_readonly("particles", &ModelInfo::particles, "fixed ones too")
      .def_readonly("constraints", &ModelInfo::constraints, "active ones, without contacts")
      .def_readonly("inert_constraints", &ModelInfo::inert_constraints, "between fixed particles")
      .def_readonly("ropes", &ModelInfo::ropes, "constraints that only pull")
      .def_readonly("compliant", &ModelInfo::compliant, "constraints that are springs")
      .def_readonly("membrane_elements", &ModelInfo::membrane_elements, "active ones")
      .def_readonly("bending_elements", &ModelInfo::bending_elements, "active ones")
      .def_readonly("anchors", &ModelInfo::anchors, "points that hold particles")
      .def_readonly("seams", &ModelInfo::seams, "pairs that come together")
      .def_readonly("surface_triangles", &ModelInfo::surface_triangles, "that meshes touch")
      .def_readonly("air_triangles", &ModelInfo::air_triangles, "subject to drag and lift")
      .def_readonly("spheres", &ModelInfo::spheres, "particles that others collide with")
      .def_readonly("colours", &ModelInfo::colours, "groups of constraints that share no particle")
      .def_readonly("tiles", &ModelInfo::tiles, "groups that threads may work on in parallel")
      .def_readonly("run_share", &ModelInfo::run_share, "of the constraints in contiguous runs")
      .def_readonly("bytes", &ModelInfo::bytes, "held by the model");
  py::class_<HeldModel>(m, "Model", "A scene that is checked and prepared. Cloths share it.");
  m.def(
      "build_model",
      [](const Scene& description) {
        const Scene copy = description;  // others may change theirs meanwhile
        const py::gil_scoped_release release;
        return HeldModel{value_of(build_model(copy))};
      },
      py::arg("description"), "Checks the description and prepares it.");
  m.def(
      "save_model",
      [](const HeldModel& held) {
        std::vector<std::byte> saved;
        {
          const py::gil_scoped_release release;
          saved = save_model(*held.model);
        }
        return to_python(saved);
      },
      py::arg("model"), "The model as bytes for a file.");
  m.def(
      "load_model",
      [](const py::bytes& saved) {
        const std::span<const std::byte> bytes = bytes_of(saved);
        const py::gil_scoped_release release;
        return HeldModel{value_of(load_model(bytes))};
      },
      py::arg("bytes"), "Builds a saved model again. Damaged bytes are refused.");
  m.def(
      "describe", [](const HeldModel& held) { return describe(*held.model); }, py::arg("model"),
      "Counts of what a model consists of.");
}

}  // namespace

void add_scene(py::module_& m) {
  add_scene_enumerations(m);
  add_parts(m);
  Fields<Scene> scene(m, "SceneDescription",
                      "Particles and what joins them. Arrays that it returns are copies and "
                      "cannot be written: assign whole ones.");
  add_particles(scene);
  add_joints(scene);
  scene.field("damping", &Scene::damping, "a Damping")
      .field("air", &Scene::air, "an Air")
      .field("friction", &Scene::friction, "Coulomb's, of the cloth beside bodies")
      .field("pressures", &Scene::pressures, "a list of Pressure")
      .field("self_contact", &Scene::self_contact, "a SelfContact")
      .field("gravity", &Scene::gravity, "m/s^2");
  add_model(m);
}

}  // namespace weft::python
