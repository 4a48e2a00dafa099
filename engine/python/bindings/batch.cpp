#include <pybind11/stl.h>
#include <weft/batch.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "arrays.h"
#include "cloth.h"
#include "parts.h"

namespace weft::python {

namespace {

struct Batch {
  std::vector<py::object> objects;  // kept alive
  std::vector<HeldCloth*> cloths;
  std::vector<ClothStep> steps;
};

using Uses = std::vector<Use<Cloth>>;

Uses use_all(const Batch& batch) {
  Uses uses;
  uses.reserve(batch.cloths.size());
  for (const HeldCloth* cloth : batch.cloths) uses.push_back(use(*cloth));
  return uses;
}

std::unique_ptr<Batch> make_batch(const py::iterable& cloths) {
  auto batch = std::make_unique<Batch>();
  std::set<HeldCloth*> seen;
  for (const py::handle object : cloths) {
    auto* cloth = object.cast<HeldCloth*>();
    const std::string field = "cloths[" + std::to_string(batch->cloths.size()) + "]";
    if (!cloth) refuse(field + ": None is no cloth");
    if (!seen.insert(cloth).second) refuse(field + ": it is in the batch already");
    batch->objects.push_back(py::reinterpret_borrow<py::object>(object));
    batch->cloths.push_back(cloth);
    batch->steps.push_back({.cloth = &cloth->value});
  }
  return batch;
}

/// Returns how many were refused.
std::size_t step_batch(Batch& batch, double dt, Arena* arena) {
  const Uses uses = use_all(batch);
  const py::gil_scoped_release release;
  for (ClothStep& step : batch.steps) step.dt = dt;
  in_arena(arena, [&] { step_all(batch.steps); });
  std::size_t refused = 0;
  for (const ClothStep& step : batch.steps) refused += step.result ? 0 : 1;
  return refused;
}

const ClothStep& step_of(const Batch& batch, std::size_t cloth) {
  if (cloth >= batch.steps.size()) {
    refuse("cloth: " + std::to_string(cloth) + " is not below " +
           std::to_string(batch.steps.size()));
  }
  return batch.steps[cloth];
}

StepReport report_of(const Batch& batch, std::size_t cloth) {
  const ClothStep& step = step_of(batch, cloth);
  const auto used = use(*batch.cloths[cloth]);
  if (!step.result) refuse(step.result.error());
  return step.result.value();
}

std::size_t particles_of(const Batch& batch) {
  const std::size_t count = batch.cloths.empty() ? 0 : batch.cloths[0]->value.particle_count();
  for (std::size_t i = 0; i < batch.cloths.size(); ++i) {
    const std::size_t own = batch.cloths[i]->value.particle_count();
    if (own != count) {
      refuse("cloths[" + std::to_string(i) + "]: " + std::to_string(own) +
             " particles, and cloths[0] has " + std::to_string(count));
    }
  }
  return count;
}

using Read = Result<void> (Cloth::*)(std::span<Vec3>) const;
using Write = Result<void> (Cloth::*)(std::span<const Vec3>);

void check_shape(const Batch& batch, const py::array& array, std::size_t particles,
                 const std::string& name) {
  const auto cloths = static_cast<py::ssize_t>(batch.cloths.size());
  if (array.ndim() != 3 || array.shape(0) != cloths ||
      array.shape(1) != static_cast<py::ssize_t>(particles) || array.shape(2) != 3) {
    refuse(name + ": shape " + shape_of(array) + " is not (" + std::to_string(cloths) + ", " +
           std::to_string(particles) + ", 3)");
  }
}

py::array_t<double> read(const Batch& batch, std::optional<py::array> given, Read one) {
  const Uses uses = use_all(batch);
  const std::size_t particles = particles_of(batch);
  if (!given) {
    given = py::array_t<double>({static_cast<py::ssize_t>(batch.cloths.size()),
                                 static_cast<py::ssize_t>(particles), py::ssize_t{3}});
  }
  check_shape(batch, *given, particles, "out");
  if (!py::isinstance<py::array_t<double>>(*given) || !(given->flags() & py::array::c_style) ||
      !given->writeable()) {
    refuse("out: not float64 in C's order that can be written");
  }
  auto* out = static_cast<Vec3*>(given->mutable_data());
  {
    const py::gil_scoped_release release;
    for (std::size_t i = 0; i < batch.cloths.size(); ++i) {
      check((batch.cloths[i]->value.*one)({out + i * particles, particles}));
    }
  }
  return *given;  // with Python's lock, which counts references
}

bool are_finite(std::span<const Vec3> values) {
  return std::ranges::all_of(values, [](const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  });
}

/// values: of one cloth after the other, as many each. A cloth refuses what is not finite, and says
/// so best itself; what is refused is found before anything is written.
void write_all(Batch& batch, std::span<const Vec3> values, Write one) {
  const std::size_t count = values.size() / std::max<std::size_t>(1, batch.cloths.size());
  const auto write = [&](std::size_t i) {
    const auto written = (batch.cloths[i]->value.*one)(values.subspan(i * count, count));
    if (!written) refuse("cloths[" + std::to_string(i) + "]: " + written.error());
  };
  for (std::size_t i = 0; i < batch.cloths.size(); ++i) {
    if (!are_finite(values.subspan(i * count, count))) write(i);
  }
  for (std::size_t i = 0; i < batch.cloths.size(); ++i) write(i);
}

enum class Empty : std::uint8_t { refused, taken };

void write(Batch& batch, py::handle given, Write one, const std::string& name,
           Empty empty = Empty::refused) {
  const Doubles in = Doubles::ensure(given);
  if (!in) PyErr_Clear(), refuse(name + ": not an array of numbers");
  const Uses uses = use_all(batch);
  const std::size_t particles = particles_of(batch);
  if (in.size() > 0 || empty == Empty::refused) check_shape(batch, in, particles, name);
  write_all(batch,
            {reinterpret_cast<const Vec3*>(in.data()), static_cast<std::size_t>(in.size()) / 3},
            one);
}

}  // namespace

void add_batch(py::module_& m) {
  py::class_<Batch>(m, "Batch", "Many cloths, which it keeps alive, as one.")
      .def(py::init(&make_batch), py::arg("cloths"), "cloths: each of them once.")
      .def("__len__", [](const Batch& b) { return b.cloths.size(); })
      .def("step_all", &step_batch, py::arg("dt"), py::arg("arena") = nullptr,
           "Steps all cloths, without Python's lock, and returns how many were refused. One that "
           "is refused does not keep the others from their step.")
      .def("report", &report_of, py::arg("cloth"),
           "The StepReport of its last step here; raises Error where that was refused.")
      .def(
          "read_positions",
          [](const Batch& b, std::optional<py::array> out) {
            return read(b, std::move(out), &Cloth::read_positions);
          },
          py::arg("out") = py::none(),
          "Fills out, an array (cloths, particles, 3) of float64, or a new one, and returns it.")
      .def(
          "read_velocities",
          [](const Batch& b, std::optional<py::array> out) {
            return read(b, std::move(out), &Cloth::read_velocities);
          },
          py::arg("out") = py::none(), "The same of velocities.")
      .def(
          "write_positions",
          [](Batch& b, py::object in) { write(b, in, &Cloth::write_positions, "positions"); },
          py::arg("positions"),
          "An array (cloths, particles, 3), one cloth after the other. All or, on an error, none.")
      .def(
          "write_velocities",
          [](Batch& b, py::object in) { write(b, in, &Cloth::write_velocities, "velocities"); },
          py::arg("velocities"), "The same of velocities.")
      .def(
          "write_forces",
          [](Batch& b, py::object in) {
            write(b, in, &Cloth::write_forces, "forces", Empty::taken);
          },
          py::arg("forces"), "The same of forces, N; empty: none.");
}

}  // namespace weft::python
