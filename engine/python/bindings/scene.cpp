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

template <class Element>
void check_kinds(const std::vector<Element>& elements, ConstraintKind Element::*kind,
                 const std::string& list) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].*kind <= ConstraintKind::rope) continue;
    refuse(list + "[" + std::to_string(i) +
           "].kind: " + std::to_string(static_cast<int>(elements[i].*kind)) +
           " is neither 0, distance, nor 1, rope");
  }
}

/// A strength of 0 means broken, and an array of zeros is full of that.
template <class Element>
void check_strengths(const std::vector<Element>& elements, const std::string& list) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].strength != 0) continue;
    refuse(list + "[" + std::to_string(i) +
           "].strength: 0 is that of a broken one; records() makes records with the defaults, and "
           "np.zeros does not");
  }
}

template <class Element>
std::vector<Element> checked_records(py::handle value, const std::string& list) {
  std::vector<Element> out = records<Element>(value, list);
  for_each_element_field<Element>([&]<class V, class N>(const ElementField<Element, V, N>& field) {
    if constexpr (std::is_same_v<V, ConstraintKind>) check_kinds(out, field.member, list);
  });
  if constexpr (requires(Element element) { element.strength; }) check_strengths(out, list);
  return out;
}

void add_scene_enumerations(py::module_& m) {
  py::enum_<Tear>(m, "Tear", "The kinds of tears; see scene.h.")
      .value("constraint", Tear::constraint)
      .value("seam", Tear::seam)
      .value("anchor", Tear::anchor)
      .value("sheet", Tear::sheet);
  py::enum_<ConstraintKind>(m, "ConstraintKind", "distance, or rope, which only pulls.")
      .value("distance", ConstraintKind::distance)
      .value("rope", ConstraintKind::rope);
}

/// list: of its arrays in messages.
template <class Part>
void add_fields(Fields<Part>& part, const std::string& list = "") {
  for_each_part_field<Part>([&]<class V, class InC>(const PartField<Part, V, InC>& field) {
    if constexpr (requires { elements<typename V::value_type>(py::object(), ""); })
      part.array(field.name, field.member, field.text, list + field.name);
    else
      part.field(field.name, field.member, field.text);
  });
}

template <class Part>
void add_part(py::module_& m, const char* type, const char* text, const std::string& list = "") {
  Fields<Part> part(m, type, text);
  add_fields(part, list);
}

void add_parts(py::module_& m) {
  add_part<Damping>(m, "Damping", "Damping times of springs, and the decay of all motion.");
  add_part<Air>(m, "Air", "Drag and lift on triangles of the cloth.", "air.");
  add_part<Pressure>(m, "Pressure", "A pressure on triangles of the surface.");
  add_part<SelfContact>(m, "SelfContact", "Layers of the cloth keep off each other.");
}

void add_particles(Fields<Scene>& scene) {
  scene.array("positions", &Scene::positions, "m, an array (particles, 3)")
      .array("velocities", &Scene::velocities, "m/s, one per particle; empty: at rest")
      .array("masses", &Scene::masses, "kg, one per particle")
      .array("fixed", &Scene::fixed, "particles of infinite inertia")
      .array("surface", &Scene::surface,
             "triangles of the cloth, which meshes touch, an array (n, 3)")
      .array("rail_particles", &Scene::rail_particles, "of all rails, each in its order")
      .array("spheres", &Scene::spheres, "particles that others collide with")
      .array("radii", &Scene::radii, "m, one per particle; empty without spheres");
}

void add_elements(Fields<Scene>& scene) {
  for_each_element_kind([&]<class Element>(const ElementKind<Element>& kind) {
    scene.property(
        kind.name, [kind](const Scene& s) { return array_of_records(s.*kind.list); },
        [kind](Scene& s, py::object v) { s.*kind.list = checked_records<Element>(v, kind.name); },
        ("records of weft." + std::string(kind.type)).c_str());
  });
}

void add_model(py::module_& m) {
  py::class_<ModelInfo> info(m, "ModelInfo", "Counts of what a model consists of.");
  for_each_part_field<ModelInfo>(
      [&](const auto& field) { info.def_readonly(field.name, field.member, field.text); });
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
      [](const py::buffer& given) {
        const py::bytes saved = whole(given);
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
  add_elements(scene);
  scene.field("damping", &Scene::damping, "a Damping")
      .field("air", &Scene::air, "an Air")
      .field("pressures", &Scene::pressures, "a list of Pressure")
      .field("self_contact", &Scene::self_contact, "a SelfContact");
  add_fields(scene);
  add_model(m);
}

}  // namespace weft::python
