#include "cloth.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <weft/cloth.h>

#include <filesystem>
#include <optional>
#include <string>

#include "arrays.h"
#include "buffers.h"
#include "bytes.h"
#include "fields.h"
#include "parts.h"

namespace weft::python {

namespace {

void add_arena(py::module_& m) {
  py::class_<Arena>(m, "Arena",
                    "Threads of oneTBB that steps may use. Without one a step runs in the thread "
                    "that calls it. Results are the same.")
      .def(py::init([](int threads) {
             if (threads < 1 || threads > kMaxThreads) {
               refuse("threads: " + std::to_string(threads) + " is not within 1 and " +
                      std::to_string(kMaxThreads));
             }
             return std::make_unique<Arena>(threads);
           }),
           py::arg("threads"), "threads: the calling one is among them.");
}

StepReport step(HeldCloth& cloth, const Given<double>& given, Arena* arena) {
  const double dt = taken(given, "dt");
  const auto used = use(cloth);
  const py::gil_scoped_release release;
  return value_of(in_arena(arena, [&] { return cloth.value.step(dt); }));
}

py::array new_vectors(std::size_t count) {
  return py::array_t<double>({static_cast<py::ssize_t>(count), py::ssize_t{3}});
}

py::array read_positions(const HeldCloth& held, std::optional<py::array> given, Vec3 origin) {
  const auto used = use(held);
  const Cloth& cloth = held.value;
  py::array out = given ? *given : new_vectors(cloth.particle_count());
  if (is_float32(out)) {
    check(cloth.read_positions(floats_in(out, cloth.particle_count(), "out"), origin));
    return out;
  }
  if (origin.x != 0 || origin.y != 0 || origin.z != 0) {
    refuse("origin: counts only where out is of float32");
  }
  check(cloth.read_positions(vectors_in(out, cloth.particle_count(), "out")));
  return out;
}

py::array read_velocities(const HeldCloth& held, std::optional<py::array> given) {
  const auto used = use(held);
  const Cloth& cloth = held.value;
  py::array out = given ? *given : new_vectors(cloth.particle_count());
  if (is_float32(out)) {
    check(cloth.read_velocities(floats_in(out, cloth.particle_count(), "out")));
  } else {
    check(cloth.read_velocities(vectors_in(out, cloth.particle_count(), "out")));
  }
  return out;
}

void check_particle(const Cloth& cloth, std::uint32_t particle) {
  if (particle >= cloth.particle_count()) {
    refuse("particle: " + std::to_string(particle) + " is not below " +
           std::to_string(cloth.particle_count()));
  }
}

void add_making(ClothClass& cloth) {
  cloth
      .def_static(
          "create",
          [](const HeldModel& held, const Settings& settings) {
            const auto model = held.model;
            const Settings copy = settings;
            const py::gil_scoped_release release;
            return std::make_unique<HeldCloth>(value_of(Cloth::create(model, copy)));
          },
          py::arg("model"), py::arg("settings") = Settings{},
          "Checks the settings. The state starts as described.")
      .def(
          "clone",
          [](const HeldCloth& c) {
            const auto used = use(c);
            const py::gil_scoped_release release;
            return std::make_unique<HeldCloth>(c.value.clone());
          },
          "A second cloth, which continues bit for bit as this one does.")
      .def(
          "copy_state",
          [](HeldCloth& c, const HeldCloth& from) {
            if (&c == &from) return;
            const auto used = use(c);
            const auto read = use(from);
            check(c.value.copy_state(from.value));
          },
          py::arg("from_cloth"), "Takes over model and state of another cloth.")
      .def(
          "save_state",
          [](const HeldCloth& c) {
            const auto used = use(c);
            return to_python(c.value.save_state());
          },
          "The state as bytes for a file.")
      .def(
          "load_state",
          [](HeldCloth& c, const py::buffer& given) {
            const auto used = use(c);
            const py::bytes saved = whole(given);
            const auto bytes = bytes_of(saved);
            const py::gil_scoped_release release;
            check(c.value.load_state(bytes));
          },
          py::arg("bytes"), "Goes on where the saved cloth was. Damaged bytes are refused.")
      .def(
          "begin_recording",
          [](HeldCloth& c, const std::filesystem::path& path, const std::string& note) {
            const auto used = use(c);
            check(c.value.begin_recording(path.string(), note));
          },
          py::arg("path"), py::arg("note") = "",
          "Writes all that this cloth does from now on to a file, which `weft replay FILE` runs "
          "again.")
      .def(
          "end_recording",
          [](HeldCloth& c) {
            const auto used = use(c);
            check(c.value.end_recording());
          },
          "Completes the file.")
      .def("step", &step, py::arg("dt"), py::arg("arena") = nullptr,
           "Advances by dt seconds, without Python's lock.");
}

void add_reading(ClothClass& cloth) {
  cloth
      .def_property_readonly(
          "model", [](const HeldCloth& c) { return use(c), HeldModel{c.value.model()}; },
          "another one after change()")
      .def_property_readonly(
          "settings", [](const HeldCloth& c) { return use(c), Settings(c.value.settings()); },
          "a copy; solver, scheme, isa and substeps are those that are used")
      .def(
          "particle_count", [](const HeldCloth& c) { return use(c), c.value.particle_count(); },
          "of the description")
      .def(
          "position",
          [](const HeldCloth& c, std::uint32_t particle) {
            const auto used = use(c);
            check_particle(c.value, particle);
            return c.value.position(particle);
          },
          py::arg("particle"), "m")
      .def(
          "velocity",
          [](const HeldCloth& c, std::uint32_t particle) {
            const auto used = use(c);
            check_particle(c.value, particle);
            return c.value.velocity(particle);
          },
          py::arg("particle"), "m/s")
      .def("read_positions", &read_positions, py::arg("out") = py::none(),
           py::arg("origin") = Vec3{},
           "Fills out, an array (particles, 3) of float64 or float32, or a new one of float64, "
           "and returns it. Rows of float32 may be apart; they are relative to the origin.")
      .def("read_velocities", &read_velocities, py::arg("out") = py::none(),
           "The same of velocities, m/s.")
      .def(
          "bounds",
          [](const HeldCloth& c) {
            const auto used = use(c);
            const Bounds bounds = c.value.bounds();
            return std::pair(bounds.least, bounds.most);
          },
          "m, the least and the most of all positions")
      .def(
          "strain", [](const HeldCloth& c) { return use(c), c.value.strain(); },
          "Recomputed from the positions.")
      .def(
          "max_penetration", [](const HeldCloth& c) { return use(c), c.value.max_penetration(); },
          "m, over pairs of spheres and particles")
      .def(
          "energy", [](const HeldCloth& c) { return use(c), c.value.energy(); },
          "of the particles that are not fixed")
      .def(
          "state_hash", [](const HeldCloth& c) { return use(c), c.value.state_hash(); },
          "FNV-1a over the bits of all positions and velocities.")
      .def(
          "bytes", [](const HeldCloth& c) { return use(c), c.value.bytes(); },
          "held by this cloth, without the model");
}

void add_writing(ClothClass& cloth) {
  using Write = Result<void> (Cloth::*)(std::span<const Vec3>);
  const auto written = [](const char* name, Write write) {
    return [name, write](HeldCloth& c, py::object in) {
      const auto values = vectors<Vec3>(in, name);
      const auto used = use(c);
      check((c.value.*write)(values));
    };
  };
  cloth
      .def("write_positions", written("positions", &Cloth::write_positions), py::arg("positions"),
           "m, one per particle")
      .def("write_velocities", written("velocities", &Cloth::write_velocities),
           py::arg("velocities"), "m/s, one per particle")
      .def("write_forces", written("forces", &Cloth::write_forces), py::arg("forces"),
           "N, one per particle; empty: none")
      .def(
          "set_gravity",
          [](HeldCloth& c, const Given<Vec3>& given) {
            const Vec3 gravity = taken(given, "gravity");
            const auto used = use(c);
            check(c.value.set_gravity(gravity));
          },
          py::arg("gravity"), "m/s^2, from the next step on")
      .def(
          "set_wind",
          [](HeldCloth& c, const Given<Vec3>& given) {
            const Vec3 wind = taken(given, "wind");
            const auto used = use(c);
            check(c.value.set_wind(wind));
          },
          py::arg("wind"), "m/s, from the next step on")
      .def(
          "set_pressure",
          [](HeldCloth& c, const py::object& pressure) {
            const bool is_list = py::isinstance<py::list>(pressure);
            const auto parts = is_list ? taken(Given<std::vector<Pressure>>{pressure}, "pressures")
                                       : std::vector<Pressure>{};
            const double everywhere = is_list ? 0 : taken(Given<double>{pressure}, "pressure");
            const auto used = use(c);
            check(is_list ? c.value.set_pressure(parts) : c.value.set_pressure(everywhere));
          },
          py::arg("pressure"),
          "Pa, on all triangles of the surface from the next step on; or a list of Pressure")
      .def(
          "pressures",
          [](const HeldCloth& c) {
            const auto used = use(c);
            return c.value.pressures();
          },
          "a list of PressureNow, in the order in which they were set");
}

}  // namespace

void add_cloth(py::module_& m) {
  add_arena(m);
  ClothClass cloth(m, "Cloth",
                   "One moving cloth. One thread at a time may use it: while it does, a call of "
                   "another one raises Error.");
  add_making(cloth);
  add_reading(cloth);
  add_writing(cloth);
  add_cloth_motion(m, cloth);
}

}  // namespace weft::python
