#include <pybind11/stl.h>
#include <weft/mesh.h>

#include "arrays.h"
#include "fields.h"
#include "parts.h"

namespace weft::python {

namespace {

using Mesh = MeshDescription;

void add_materials(py::module_& m) {
  Fields<Material> material(m, "Material", "A cloth's own properties, whatever its mesh.");
  material.field("density", &Material::density, "kg/m^2")
      .field("thickness", &Material::thickness, "m")
      .field("friction", &Material::friction, "Coulomb's, between layers")
      .field("warp", &Material::warp, "N/m")
      .field("weft", &Material::weft, "N/m")
      .field("shear", &Material::shear, "N/m per radian")
      .field("bending", &Material::bending, "N m")
      .field("damping_stretch", &Material::damping_stretch, "s")
      .field("damping_bending", &Material::damping_bending, "s")
      .field("damping_motion", &Material::damping_motion, "1/s")
      .field("drag", &Material::drag, "as Air.drag")
      .field("lift", &Material::lift, "as Air.lift")
      .field("ram", &Material::ram, "as Air.ram")
      .field("strength", &Material::strength, "N/m, at which it tears; infinite: it does not")
      .field("bending_yield", &Material::bending_yield,
             "1/m, beyond which it keeps a crease; infinite: it does not")
      .field("bending_hardening", &Material::bending_hardening,
             "of the moment beyond the yield, over that of bending")
      .field("bending_friction", &Material::bending_friction,
             "N, half of the width of the loop of moment against curvature")
      .field("bending_slip", &Material::bending_slip, "1/m, that brings friction to all of it");
  m.def(
      "check_material", [](const Material& given) { check(check_material(given)); },
      py::arg("material"), "Raises Error with the field and the value that are refused.");
  m.def(
      "find_material", [](const std::string& name) { return value_of(find_material(name)); },
      py::arg("name"), "A common fabric; the error lists the names that there are.");
  m.def(
      "materials",
      [] {
        py::dict named;
        for (const NamedMaterial& one : materials())
          named[py::str(one.name.data(), one.name.size())] = one.material;
        return named;
      },
      "Common fabrics by their names.");
}

void set_faces(Mesh& mesh, py::object value) {
  const py::array array = py::array::ensure(value);
  if (!array || array.ndim() != 2 || array.shape(1) < 3) {
    PyErr_Clear();
    refuse("faces: not an array (faces, corners) with three corners or more");
  }
  const auto sides = static_cast<std::uint32_t>(array.shape(1));
  mesh.corners = index_rows(value, "faces", array.shape(1));
  mesh.face_sizes.assign(mesh.corners.size() / sides, sides);
}

void add_shape(Fields<Mesh>& mesh) {
  mesh.array("positions", &Mesh::positions, "m, an array (vertices, 3)")
      .array("corners", &Mesh::corners, "vertices, face after face")
      .array("face_sizes", &Mesh::face_sizes, "corners of each face; empty: triangles")
      .array("lines", &Mesh::lines, "threads, an array (n, 2)")
      .array("rest_positions", &Mesh::rest_positions, "m, the shape at rest in space")
      .array("rest_corners", &Mesh::rest_corners,
             "m, the shape at rest when flat, one (u, v) per corner")
      .array("warp", &Mesh::warp, "where the warp runs, one direction or one per face")
      .array("seams", &Mesh::seams, "pairs of vertices that are sewn together, an array (n, 2)")
      .array("pins", &Mesh::pins, "vertices whose particles are fixed");
  mesh.def("set_faces", &set_faces, py::arg("faces"),
           "Sets corners and face_sizes to those of an array (faces, corners).");
}

void add_description(py::module_& m) {
  py::enum_<Ropes>(m, "Ropes", "The constraints that only pull.")
      .value("none", Ropes::none)
      .value("diagonals", Ropes::diagonals)
      .value("all", Ropes::all);
  Fields<Mesh> mesh(m, "MeshDescription",
                    "A surface, where it begins and in its shape at rest. Arrays that it "
                    "returns are copies and cannot be written: assign whole ones.");
  add_shape(mesh);
  mesh.field("material", &Mesh::material, "a Material; None: rigid edges")
      .field("mass", &Mesh::mass, "kg of the whole, without a material")
      .field("thread_density", &Mesh::thread_density, "kg/m")
      .field("weld_distance", &Mesh::weld_distance, "m")
      .field("seam_time", &Mesh::seam_time, "s")
      .field("seam_force", &Mesh::seam_force, "N")
      .field("ropes", &Mesh::ropes, "Ropes");
}

void add_made(py::module_& m) {
  py::class_<MeshCounts>(m, "MeshCounts", "Counts of a mesh.")
      .def_readonly("triangles", &MeshCounts::triangles, "that are left of the faces")
      .def_readonly("quads", &MeshCounts::quads, "four-sided faces")
      .def_readonly("recognised_quads", &MeshCounts::recognised_quads, "pairs of triangles")
      .def_readonly("welded_vertices", &MeshCounts::welded_vertices,
                    "that share the particle of an earlier one")
      .def_readonly("unused_vertices", &MeshCounts::unused_vertices, "in no face and no line")
      .def_readonly("degenerate_faces", &MeshCounts::degenerate_faces, "without area, left out")
      .def_readonly("double_faces", &MeshCounts::double_faces, "left out")
      .def_readonly("non_manifold_edges", &MeshCounts::non_manifold_edges, "of three faces or more")
      .def_readonly("thread_lines", &MeshCounts::thread_lines, "that became threads")
      .def_readonly("pieces", &MeshCounts::pieces, "that nothing joins")
      .def_readonly("loose_pieces", &MeshCounts::loose_pieces, "of these, without a pin")
      .def_readonly("suggested_weld", &MeshCounts::suggested_weld, "m; 0: none");
  py::class_<MeshCloth> made(m, "MeshCloth", "The result of cloth_from_mesh.");
  add_field(made, "scene", &MeshCloth::scene, "a SceneDescription, which may be changed");
  made.def_property_readonly(
          "particle_of_vertex",
          [](const MeshCloth& made) { return rows<std::uint32_t>(made.particle_of_vertex); },
          "one per vertex; kNoIndex: none")
      .def_readonly("counts", &MeshCloth::counts, "MeshCounts")
      .def_property_readonly(
          "cells", [](const MeshCloth& made) { return rows<std::uint32_t>(made.cells); },
          "particles of faces that became springs, an array (n, 4)");
}

}  // namespace

void add_mesh(py::module_& m) {
  add_materials(m);
  add_description(m);
  add_made(m);
  m.def(
      "warp_from_texture",
      [](const Mesh& mesh, py::object texture) {
        const auto places = vectors<std::array<double, 2>>(texture, "texture");
        return rows<double>(value_of(warp_from_texture(mesh, places)));
      },
      py::arg("mesh"), py::arg("texture"), "Directions of v on each face; one (u, v) per corner.");
  m.def(
      "cloth_from_mesh",
      [](const Mesh& mesh) {
        const Mesh copy = mesh;  // others may change theirs meanwhile
        const py::gil_scoped_release release;
        return value_of(cloth_from_mesh(copy));
      },
      py::arg("mesh"), "Welds, sews, and derives springs and masses.");
}

}  // namespace weft::python
