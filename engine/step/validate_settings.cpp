#include "engine/step/validate_settings.h"

#include <cmath>

#include "engine/hypotenuse.h"
#include "engine/model/model.h"
#include "engine/step/choose_solver.h"
#include "engine/validation.h"

namespace weft {
namespace {

Result<void> validate_count(std::string_view field, int value, int least) {
  if (value >= least) return {};
  return refuse(field, "must be at least " + std::to_string(least), std::to_string(value));
}

template <class Enum>
Result<void> validate_choice(std::string_view field, Enum value, Enum last) {
  if (value <= last) return {};
  return refuse(field, "unknown choice", std::to_string(static_cast<int>(value)));
}

/// Not every scheme goes with every solver.
Result<void> validate_scheme(const Settings& s) {
  const bool by_small_steps = is_of_small_steps(s.scheme);
  const bool small_steps = s.solver == Solver::small_steps;
  if (by_small_steps && !small_steps && s.solver != Solver::automatic) {
    return refuse("scheme", "is for solver small_steps, not " + std::string(name(s.solver)),
                  std::string(name(s.scheme)));
  }
  if (!by_small_steps && !small_steps) return {};
  if (small_steps && !by_small_steps && s.scheme != Scheme::automatic) {
    return refuse("scheme", "solver small_steps takes implicit and bdf2",
                  std::string(name(s.scheme)));
  }
  if (s.velocity_correction) {
    return refuse("velocity_correction", "small steps have no velocity loop", "on");
  }
  return {};
}

/// The reference keeps products whenever it anticipates, and other solvers have none.
Result<void> validate_products(const Settings& s) {
  if (!s.measuring.anticipate_products) return {};
  if (s.backend != Backend::simd) {
    return refuse("anticipate_products", "is for the simd backend", std::string(name(s.backend)));
  }
  if (s.solver != Solver::gauss_seidel) {
    return refuse("anticipate_products", "is for solver gauss_seidel", std::string(name(s.solver)));
  }
  if (!s.measuring.anticipate) return refuse("anticipate_products", "needs anticipate", "off");
  return {};
}

/// The number of substeps holds it, and small steps alone know their error of motion.
Result<void> validate_motion_tolerance(const Settings& s) {
  const auto refuse_it = [&](std::string_view what) {
    return refuse("motion_tolerance", what, number(s.motion_tolerance));
  };
  if (!std::isfinite(s.motion_tolerance) || s.motion_tolerance < 0)
    return refuse_it("must be finite and at least 0");
  if (s.motion_tolerance == 0) return {};
  constexpr double kLeastOfFloats = 1e-5;  // beside what rounding moves
  if (s.backend == Backend::simd && s.motion_tolerance < kLeastOfFloats)
    return refuse_it("must be 0 or at least 1e-5 m/s on the simd backend");
  if (s.solver != Solver::small_steps && s.solver != Solver::automatic)
    return refuse_it("is for solver small_steps, not " + std::string(name(s.solver)));
  if (s.scheme != Scheme::automatic && !is_of_small_steps(s.scheme))
    return refuse_it("is for schemes implicit and bdf2, not " + std::string(name(s.scheme)));
  if (s.velocity_correction) return refuse_it("does not go with velocity_correction");
  if (s.substeps != kAutomaticSubsteps) return refuse_it("needs automatic substeps");
  if (s.iterations > 0) return refuse_it("does not go with iterations");
  return {};
}

/// Heights are the inverse lengths of weights.
Result<void> validate_membrane_for_lanes(const MembraneStore& s) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    const reference::MembraneShape& shape = s.element[i].shape;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &from = s.rest[i][k], &to = s.rest[i][(k + 1) % 3];
      const double height = 1 / hypotenuse(shape.u[k], shape.v[k]);
      const double side = hypotenuse(to[0] - from[0], to[1] - from[1]);
      if (fits_float(height) && fits_float(side)) continue;
      const std::string field = element("membrane", s.described[i]) + ".rest";
      if (auto r = validate_float(field + ": its height", height); !r) return r;
      return validate_float(field + ": its side", side);
    }
  }
  return {};
}

}  // namespace

Result<void> validate(const Settings& s) {
  if (auto r = validate_positive("tolerance", s.tolerance); !r) return r;
  if (auto r = validate_count("substeps", s.substeps, kAutomaticSubsteps); !r) return r;
  if (auto r = validate_count("iterations", s.iterations, 0); !r) return r;
  if (auto r = validate_count("renew_after", s.measuring.renew_after, 0); !r) return r;
  if (auto r = validate_count("max_iterations", s.max_iterations, 0); !r) return r;
  if (auto r = validate_positive("contact_tolerance", s.contact_tolerance); !r) return r;
  if (auto r = validate_positive("velocity_tolerance", s.velocity_tolerance); !r) return r;
  if (!std::isfinite(s.measuring.impulse_limit) || s.measuring.impulse_limit < 0) {
    return refuse("impulse_limit", "must be finite and at least 0",
                  number(s.measuring.impulse_limit));
  }
  if (auto r = validate_choice("solver", s.solver, Solver::automatic); !r) return r;
  if (auto r = validate_choice("scheme", s.scheme, Scheme::automatic); !r) return r;
  if (auto r = validate_choice("backend", s.backend, Backend::simd); !r) return r;
  if (s.measuring.impulse_limit > 0 && s.backend != Backend::reference) {
    return refuse("impulse_limit", "only the reference backend limits impulses",
                  number(s.measuring.impulse_limit));
  }
  if (s.measuring.impulse_limit > 0 &&
      (s.solver != Solver::gauss_seidel && s.solver != Solver::automatic)) {
    return refuse("impulse_limit", "only Gauss-Seidel limits impulses",
                  number(s.measuring.impulse_limit));
  }
  if (auto r = validate_products(s); !r) return r;
  if (s.solver == Solver::yarn && s.backend != Backend::simd) {
    return refuse("solver", "yarn is for the simd backend", std::string(name(s.backend)));
  }
  if (auto r = validate_scheme(s); !r) return r;
  if (auto r = validate_motion_tolerance(s); !r) return r;
  if (s.threads < 0 || s.threads > kMaxThreads) {
    return refuse("threads", "must be from 0 to " + std::to_string(kMaxThreads),
                  std::to_string(s.threads));
  }
  return validate_choice("directions", s.measuring.directions, Directions::frozen);
}

Result<void> validate_for_solver(const Settings& s, const Model& model) {
  const bool springs = model.constraints.has_springs();
  if (springs && s.scheme == Scheme::rattle) {
    return refuse("scheme", "takes no constraints with a compliance", "rattle");
  }
  if (springs && s.velocity_correction) {
    return refuse("velocity_correction", "takes no constraints with a compliance", "on");
  }
  if (springs && s.measuring.anticipate_products) {
    return refuse("anticipate_products", "takes no constraints with a compliance", "on");
  }
  const bool is_bounded_alone = s.solver == Solver::small_steps && s.substeps != kAutomaticSubsteps;
  if (s.max_iterations == 0 && !is_bounded_alone) {
    return refuse("max_iterations", "must be at least 1 but for small_steps with given substeps",
                  "0");
  }
  if (s.solver == Solver::small_steps) return validate_scheme(s);
  for (const auto& [what, count] :
       {std::pair{"membrane", model.membrane.size()}, std::pair{"bending", model.bending.size()},
        std::pair{"anchors", model.anchors.described.size()},
        std::pair{"tethers", model.anchors.pins.size()}, std::pair{"seams", model.seams.size()},
        std::pair{"sliders", model.sliders.size()},
        std::pair{"pressures", model.pressures.size()}}) {
    if (count > 0)
      return refuse(what, "is solved by small_steps only", std::string(name(s.solver)));
  }
  for (const auto& [what, is_there] :
       {std::pair{"self_contact", model.self_contact.on}, std::pair{"strength", model.may_tear}}) {
    if (is_there) return refuse(what, "is for small_steps only", std::string(name(s.solver)));
  }
  return {};
}

Result<void> validate_for_lanes(const Settings& s, const Model& model) {
  const bool corrects_velocities = s.velocity_correction || s.scheme == Scheme::rattle;
  if (s.iterations == 0 && model.has_spheres()) {
    if (auto r = validate_float("contact_tolerance", s.contact_tolerance); !r) return r;
  }
  if (s.iterations == 0 && corrects_velocities) {
    if (auto r = validate_float("velocity_tolerance", s.velocity_tolerance); !r) return r;
  }
  const double tolerance = s.iterations == 0 ? s.tolerance : 1;
  const ConstraintStore& constraints = model.constraints;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const double rest = constraints.rest_length[c];
    if (fits_float(rest) && fits_float(tolerance * rest)) continue;
    const std::string field = element("constraints", constraints.described[c]) + ".rest_length";
    if (auto r = validate_float(field, rest); !r) return r;
    return validate_float("tolerance * " + field, tolerance * rest);
  }
  return validate_membrane_for_lanes(model.membrane);
}

Result<void> validate(const JobSystem& jobs) {
  const bool has_threads = jobs.threads != nullptr, has_run = jobs.run != nullptr;
  if (has_threads == has_run) return {};
  return refuse("jobs", "must have both functions or neither", has_run ? "run" : "threads");
}

}  // namespace weft
