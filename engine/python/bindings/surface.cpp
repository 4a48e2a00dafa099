#include <pybind11/stl.h>
#include <weft/surface.h>

#include "arrays.h"
#include "buffers.h"
#include "held.h"
#include "parts.h"

namespace weft::python {

namespace {

py::array triangles_of(const HeldSurface& held) {
  const auto triangles = held.value.triangles();
  return read_only(
      py::array_t<std::uint32_t>({static_cast<py::ssize_t>(triangles.size()), py::ssize_t{3}},
                                 reinterpret_cast<const std::uint32_t*>(triangles.data())));
}

py::array split_from(const HeldSurface& held) {
  const auto vertices = held.value.split_from();
  return read_only(
      py::array_t<std::uint32_t>(static_cast<py::ssize_t>(vertices.size()), vertices.data()));
}

py::array new_floats(std::size_t count) {
  py::array_t<float> out({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  if (count > 0) std::memset(out.mutable_data(), 0, count * 3 * sizeof(float));
  return out;
}

using Pair = std::pair<py::array, py::array>;

Pair read_vertices(HeldSurface& held, const HeldCloth& from, std::optional<py::array> positions,
                   std::optional<py::array> normals, Vec3 origin) {
  const auto used = use(held);
  const auto read = use(from);
  const std::size_t count = held.value.vertex_count();
  Pair out{positions ? *positions : new_floats(count), normals ? *normals : new_floats(count)};
  check(held.value.read_vertices(from.value, floats_in(out.first, count, "positions"),
                                 floats_in(out.second, count, "normals"), origin));
  return out;
}

}  // namespace

void add_surface(py::module_& m) {
  py::class_<HeldSurface>(m, "Surface",
                          "Vertices and normals for a renderer. One thread at a time may use it.")
      .def(
          "clone",
          [](const HeldSurface& s) {
            const auto used = use(s);
            return std::make_unique<HeldSurface>(s.value.clone());
          },
          "A second one, which shares data that do not change.")
      .def(
          "vertex_count", [](const HeldSurface& s) { return s.value.vertex_count(); },
          "of the mesh")
      .def(
          "particle_count", [](const HeldSurface& s) { return s.value.particle_count(); },
          "of the cloths that it reads")
      .def("triangles", &triangles_of, "An array (n, 3) of vertices.")
      .def(
          "follow",
          [](HeldSurface& s, const HeldCloth& from) {
            const auto used = use(s);
            const auto read = use(from);
            return value_of(s.value.follow(from.value));
          },
          py::arg("cloth"),
          "Takes on the tears of a cloth: vertices and triangles grow. Returns whether they "
          "differ.")
      .def("split_from", &split_from,
           "For each vertex behind those of the mesh: the one that it was split from.")
      .def("read_vertices", &read_vertices, py::arg("cloth"), py::arg("positions") = py::none(),
           py::arg("normals") = py::none(), py::arg("origin") = Vec3{},
           "Fills positions and normals, arrays (vertices, 3) of float32 whose rows may be apart, "
           "or new ones, and returns both.")
      .def(
          "copy_shape",
          [](HeldSurface& s, const HeldCloth& from, HeldCloth& to) {
            if (&from == &to) refuse("to: it is the cloth that is read");
            const auto used = use(s);
            const auto read = use(from);
            const auto written = use(to);
            check(s.value.copy_shape(from.value, to.value));
          },
          py::arg("from_cloth"), py::arg("to"), "A level of detail takes shape and velocities.")
      .def(
          "bytes", [](const HeldSurface& s) { return s.value.bytes(); }, "held by this surface");
  m.def(
      "surface_of_mesh",
      [](const MeshDescription& mesh, const MeshCloth& cloth) {
        return std::make_unique<HeldSurface>(value_of(surface_of_mesh(mesh, cloth)));
      },
      py::arg("mesh"), py::arg("cloth"), "The surface of the mesh itself.");
  m.def(
      "map_surface",
      [](const MeshDescription& mesh, const MeshCloth& cloth, const MeshDescription& other,
         double max_distance) {
        return std::make_unique<HeldSurface>(
            value_of(map_surface(mesh, cloth, other, max_distance)));
      },
      py::arg("mesh"), py::arg("cloth"), py::arg("other"),
      py::arg("max_distance") = std::numeric_limits<double>::infinity(),
      "Another mesh that follows the faces of the mesh.");
}

}  // namespace weft::python
