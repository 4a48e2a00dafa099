#include "records.h"

#include "parts.h"

namespace weft::python {

namespace {

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

/// Rows of a list, each with all fields.
py::object whole_rows(py::handle value, const py::dtype& type, const RecordDefaults& defaults) {
  if (!py::isinstance<py::list>(value)) return py::reinterpret_borrow<py::object>(value);
  const py::object one = py::module_::import("numpy").attr("frombuffer")(defaults.bytes, type);
  const py::tuple fields = one[py::int_(0)].attr("item")();
  const std::size_t least = fields.size() - defaults.optional;
  py::list rows;
  for (const py::handle row : value) {
    const py::object its = py::reinterpret_borrow<py::object>(row);
    const std::size_t given = py::isinstance<py::tuple>(row) ? py::len(row) : fields.size();
    const bool is_short = given >= least && given < fields.size();
    const py::object others = fields.attr("__getitem__")(
        py::slice(static_cast<py::ssize_t>(given), static_cast<py::ssize_t>(fields.size()), 1));
    rows.append(is_short ? its + others : its);
  }
  return rows;
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

py::array record_array(py::handle value, const py::dtype& type, const std::string& field,
                       const RecordDefaults& defaults) {
  py::array array;
  try {
    array = py::module_::import("numpy").attr("ascontiguousarray")(
        whole_rows(value, type, defaults), type);
  } catch (const py::error_already_set& error) {
    refuse(field + ": not records of " + py::str(type.attr("names")).cast<std::string>());
  }
  if (array.size() > 0 && array.ndim() != 1) {
    refuse(field + ": shape " + shape_of(array) + " is not (n,)");
  }
  return array;
}

void RecordFields::add(const char* name, const std::string& format, std::ptrdiff_t offset) {
  names_.append(name);
  formats_.append(py::dtype::from_args(py::str(format)));
  offsets_.append(offset);
}

py::dtype RecordFields::type(std::size_t size) const {
  return py::dtype(names_, formats_, offsets_, static_cast<py::ssize_t>(size));
}

template <>
py::dtype record_type<BodyContact>() {
  RecordFields fields;
  fields.add("particle", &BodyContact::particle);
  fields.add("body", &BodyContact::body);
  fields.add("point", &BodyContact::point);
  fields.add("normal", &BodyContact::normal);
  fields.add("push", &BodyContact::push);
  return fields.type(sizeof(BodyContact));
}

template <>
py::dtype record_type<Torn>() {
  RecordFields fields;
  fields.add("kind", &Torn::kind);
  fields.add("index", &Torn::index);
  fields.add("particle", &Torn::particle);
  fields.add("load", &Torn::load);
  return fields.type(sizeof(Torn));
}

namespace {

/// count records of the type, with the defaults of its struct.
py::array default_records(const py::dtype& type, py::ssize_t count) {
  if (count < 0) refuse("count: " + std::to_string(count) + " is below 0");
  py::object made;
  std::string names;
  for_each_element_kind([&]<class Element>(const ElementKind<Element>& kind) {
    names += (names.empty() ? "" : ", ") + std::string(kind.type);
    if (made || !record_type<Element>().equal(type)) return;
    py::array array(type, std::vector<py::ssize_t>{count});
    auto* const out = static_cast<std::byte*>(array.mutable_data());
    const Element one{};
    for (py::ssize_t i = 0; i < count; ++i)
      std::memcpy(out + i * py::ssize_t{sizeof(Element)}, &one, sizeof(Element));
    made = std::move(array);
  });
  if (!made) refuse("type: is none of " + names);
  return made;
}

}  // namespace

void add_records(py::module_& m) {
  for_each_element_kind([&]<class Element>(const ElementKind<Element>& kind) {
    m.attr(kind.type) = record_type<Element>();
  });
  m.def(
      "records", &default_records, py::arg("type"), py::arg("count"),
      "An array of so many records of a type, such as weft.Constraint, with the defaults of their "
      "fields.");
  m.attr("BodyContact") = record_type<BodyContact>();
  m.attr("Torn") = record_type<Torn>();
}

}  // namespace weft::python
