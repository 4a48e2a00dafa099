#include "engine/c_interface/settings.h"

#include <weft/cloth.h>

#include "engine/c_interface/choices.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

Result<void> read_choices(const weft_settings& s, Settings& out) {
  if (auto r = read_choice("solver", s.solver, Solver::automatic, out.solver); !r) return r;
  if (auto r = read_choice("scheme", s.scheme, Scheme::automatic, out.scheme); !r) return r;
  if (auto r = read_choice("backend", s.backend, Backend::simd, out.backend); !r) return r;
  if (auto r = read_choice("isa", s.isa, Isa::neon, out.isa); !r) return r;
  return read_choice("directions", s.directions, Directions::frozen, out.measuring.directions);
}

/// "unknown" for numbers that are no choice.
template <class Choice>
const char* word(int number) {
  return name(number < 0 || number > 255 ? Choice{255} : static_cast<Choice>(number)).data();
}

}  // namespace

weft_settings settings_of(const Settings& s) {
  return {.size = sizeof(weft_settings),
          .tolerance = s.tolerance,
          .substeps = s.substeps,
          .iterations = s.iterations,
          .renew_after = s.measuring.renew_after,
          .max_iterations = s.max_iterations,
          .contact_tolerance = s.contact_tolerance,
          .velocity_tolerance = s.velocity_tolerance,
          .motion_tolerance = s.motion_tolerance,
          .impulse_limit = s.measuring.impulse_limit,
          .solver = static_cast<int>(s.solver),
          .scheme = static_cast<int>(s.scheme),
          .backend = static_cast<int>(s.backend),
          .isa = static_cast<int>(s.isa),
          .threads = s.threads,
          .directions = static_cast<int>(s.measuring.directions),
          .anticipate = s.measuring.anticipate,
          .anticipate_products = s.measuring.anticipate_products,
          .sleep = s.sleep,
          .skip = s.measuring.skip,
          .velocity_correction = s.velocity_correction};
}

Result<Settings> read_settings(const weft_settings* settings) {
  Settings out;
  if (settings == nullptr) return out;
  const auto read = read_struct("settings", settings, settings_of({}));
  if (!read) return Error{read.error()};
  const weft_settings& s = read.value();
  out.tolerance = s.tolerance;
  out.substeps = s.substeps;
  out.iterations = s.iterations;
  out.measuring.renew_after = s.renew_after;
  out.max_iterations = s.max_iterations;
  out.contact_tolerance = s.contact_tolerance;
  out.velocity_tolerance = s.velocity_tolerance;
  out.motion_tolerance = s.motion_tolerance;
  out.measuring.impulse_limit = s.impulse_limit;
  out.threads = s.threads;
  out.measuring.anticipate = s.anticipate != 0;
  out.measuring.anticipate_products = s.anticipate_products != 0;
  out.sleep = s.sleep != 0;
  out.measuring.skip = s.skip != 0;
  out.velocity_correction = s.velocity_correction != 0;
  if (auto r = read_choices(s, out); !r) return Error{r.error()};
  return out;
}

}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_settings(weft_settings* settings, size_t size) {
  return init_struct("settings", settings_of({}), settings, size);
}

weft_result weft_init_paper_settings(weft_settings* settings, size_t size) {
  return init_struct("settings", settings_of(weft::paper_settings()), settings, size);
}

const char* weft_solver_name(int solver) { return word<weft::Solver>(solver); }
const char* weft_scheme_name(int scheme) { return word<weft::Scheme>(scheme); }
const char* weft_directions_name(int directions) { return word<weft::Directions>(directions); }
const char* weft_backend_name(int backend) { return word<weft::Backend>(backend); }
const char* weft_isa_name(int isa) { return word<weft::Isa>(isa); }
const char* weft_status_name(int status) { return word<weft::Status>(status); }
const char* weft_stage_name(int stage) { return word<weft::Stage>(stage); }

int weft_committed(int status) {
  return status >= 0 && status <= 255 && weft::committed(static_cast<weft::Status>(status));
}
