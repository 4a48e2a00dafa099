#include "records.h"

#include <cstddef>

#include "parts.h"

namespace weft::python {

namespace {

struct Field {
  const char* name;
  const char* format;
  std::size_t offset;
};

py::dtype type_of(std::initializer_list<Field> fields, std::size_t size) {
  py::list names, formats, offsets;
  for (const Field& field : fields) {
    names.append(field.name);
    formats.append(py::dtype::from_args(py::str(field.format)));
    offsets.append(field.offset);
  }
  return py::dtype(names, formats, offsets, static_cast<py::ssize_t>(size));
}

std::vector<std::uint32_t> checked(const py::array& array, const std::string& field) {
  using Wide = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
  const char kind = array.dtype().kind();
  if (array.size() > 0 && kind != 'i' && kind != 'u') refuse(field + ": not whole numbers");
  const Wide wide = Wide::ensure(array);
  std::vector<std::uint32_t> out(static_cast<std::size_t>(wide.size()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::int64_t index = wide.data()[i];
    if (index < 0 || index > kNoIndex) {
      refuse(field + "[" + std::to_string(i) + "]: " + std::to_string(index) +
             " is not within 0 and 2^32 - 1");
    }
    out[i] = static_cast<std::uint32_t>(index);
  }
  return out;
}

py::array array_from(py::handle value, const std::string& field) {
  const py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    refuse(field + ": not an array");
  }
  return array;
}

}  // namespace

std::vector<std::uint32_t> indices(py::handle value, const std::string& field) {
  const py::array array = array_from(value, field);
  if (array.size() > 0 && array.ndim() != 1) {
    refuse(field + ": shape " + shape_of(array) + " is not (n,)");
  }
  return checked(array, field);
}

std::vector<std::uint32_t> index_rows(py::handle value, const std::string& field,
                                      py::ssize_t width) {
  const py::array array = array_from(value, field);
  if (array.size() > 0 && (array.ndim() != 2 || array.shape(1) != width)) {
    refuse(field + ": shape " + shape_of(array) + " is not (n, " + std::to_string(width) + ")");
  }
  return checked(array, field);
}

py::array record_array(py::handle value, const py::dtype& type, const std::string& field) {
  py::array array;
  try {
    array = py::module_::import("numpy").attr("ascontiguousarray")(value, type);
  } catch (const py::error_already_set& error) {
    refuse(field + ": not records of " + py::str(type.attr("names")).cast<std::string>());
  }
  if (array.size() > 0 && array.ndim() != 1) {
    refuse(field + ": shape " + shape_of(array) + " is not (n,)");
  }
  return array;
}

template <>
py::dtype record_type<Constraint>() {
  return type_of({{"a", "u4", offsetof(Constraint, a)},
                  {"b", "u4", offsetof(Constraint, b)},
                  {"rest_length", "f8", offsetof(Constraint, rest_length)},
                  {"kind", "u1", offsetof(Constraint, kind)},
                  {"compliance", "f8", offsetof(Constraint, compliance)}},
                 sizeof(Constraint));
}
template <>
py::dtype record_type<BendingElement>() {
  return type_of({{"particles", "4u4", offsetof(BendingElement, particles)},
                  {"weights", "4f8", offsetof(BendingElement, weights)},
                  {"rest", "f8", offsetof(BendingElement, rest)},
                  {"compliance", "f8", offsetof(BendingElement, compliance)},
                  {"fold", "f8", offsetof(BendingElement, fold)}},
                 sizeof(BendingElement));
}
template <>
py::dtype record_type<MembraneElement>() {
  return type_of({{"particles", "3u4", offsetof(MembraneElement, particles)},
                  {"rest", "(3,2)f8", offsetof(MembraneElement, rest)},
                  {"warp", "f8", offsetof(MembraneElement, warp)},
                  {"weft", "f8", offsetof(MembraneElement, weft)},
                  {"shear", "f8", offsetof(MembraneElement, shear)},
                  {"kind", "u1", offsetof(MembraneElement, kind)}},
                 sizeof(MembraneElement));
}
template <>
py::dtype record_type<Anchor>() {
  return type_of({{"particle", "u4", offsetof(Anchor, particle)},
                  {"point", "3f8", offsetof(Anchor, point)},
                  {"normal", "3f8", offsetof(Anchor, normal)},
                  {"max_distance", "f8", offsetof(Anchor, max_distance)},
                  {"backstop_distance", "f8", offsetof(Anchor, backstop_distance)},
                  {"backstop_radius", "f8", offsetof(Anchor, backstop_radius)}},
                 sizeof(Anchor));
}
template <>
py::dtype record_type<Seam>() {
  return type_of({{"a", "u4", offsetof(Seam, a)},
                  {"b", "u4", offsetof(Seam, b)},
                  {"time", "f8", offsetof(Seam, time)},
                  {"max_force", "f8", offsetof(Seam, max_force)}},
                 sizeof(Seam));
}
template <>
py::dtype record_type<BodyContact>() {
  return type_of({{"particle", "u4", offsetof(BodyContact, particle)},
                  {"body", "u4", offsetof(BodyContact, body)},
                  {"point", "3f8", offsetof(BodyContact, point)},
                  {"normal", "3f8", offsetof(BodyContact, normal)},
                  {"push", "f8", offsetof(BodyContact, push)}},
                 sizeof(BodyContact));
}

void add_records(py::module_& m) {
  m.attr("Constraint") = record_type<Constraint>();
  m.attr("BendingElement") = record_type<BendingElement>();
  m.attr("MembraneElement") = record_type<MembraneElement>();
  m.attr("Anchor") = record_type<Anchor>();
  m.attr("Seam") = record_type<Seam>();
  m.attr("BodyContact") = record_type<BodyContact>();
}

}  // namespace weft::python
