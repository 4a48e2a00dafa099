#include "engine/model/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "engine/model/model.h"
#include "engine/step/choose_solver.h"

namespace weft {
namespace {

/// What has a square, as its inverse has, of all digits; with a margin, for sums.
constexpr double kLeastSquared = 1e-150, kMostSquared = 1e150;
/// So that places of particles, padding and all, have 32 bits, and so have places in lists of who
/// is whose neighbour.
constexpr std::size_t kMostParticles = std::size_t{1} << 28;
constexpr std::size_t kMostConstraints = std::size_t{1} << 26;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string element(std::string_view field, std::size_t index) {
  return std::string(field) + "[" + std::to_string(index) + "]";
}

Error refuse(std::string_view what, std::string_view reason, const std::string& value) {
  return Error{std::string(what) + ": " + std::string(reason) + " (" + value + ")"};
}

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string text(Vec3 v) { return number(v.x) + ", " + number(v.y) + ", " + number(v.z); }

Result<void> validate_positive(std::string_view field, double value) {
  if (!std::isfinite(value) || value <= 0) {
    return refuse(field, "must be finite and greater than 0", number(value));
  }
  return {};
}

/// Of a length or a mass: so that squares of it, and their inverses, are numbers with all digits,
/// and sums of inverses are numbers.
Result<void> validate_square(std::string_view field, double value) {
  if (value >= kLeastSquared && value <= kMostSquared) return {};
  return refuse(field, "must be from 1e-150 to 1e150, to be squared", number(value));
}

/// The same of floats, with a margin: the simd backend measures errors in tolerances.
bool fits_float(double value) { return value >= 1e-18 && value <= 1e18; }

Result<void> validate_float(std::string_view field, double value) {
  if (fits_float(value)) return {};
  return refuse(field, "must be from 1e-18 to 1e18 on the simd backend", number(value));
}

Result<void> validate_particle(const std::string& field, std::uint32_t particle,
                               std::size_t particles) {
  if (particle < particles) return {};
  return refuse(field, "no such particle, the scene has " + std::to_string(particles),
                std::to_string(particle));
}

Result<void> validate_index_list(std::string_view field, std::span<const std::uint32_t> list,
                                 std::size_t particles) {
  std::vector<bool> seen(particles);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (auto r = validate_particle(element(field, i), list[i], particles); !r) return r;
    if (seen[list[i]]) {
      return refuse(element(field, i), "particle is listed twice", std::to_string(list[i]));
    }
    seen[list[i]] = true;
  }
  return {};
}

Result<void> validate_constraint(std::size_t index, const Constraint& c, std::size_t particles) {
  const std::string field = element("constraints", index);
  if (auto r = validate_particle(field + ".a", c.a, particles); !r) return r;
  if (auto r = validate_particle(field + ".b", c.b, particles); !r) return r;
  if (c.a == c.b) return refuse(field, "joins a particle to itself", std::to_string(c.a));
  if (c.kind != ConstraintKind::distance && c.kind != ConstraintKind::rope) {
    return refuse(field + ".kind", "unknown", std::to_string(static_cast<int>(c.kind)));
  }
  if (auto r = validate_positive(field + ".rest_length", c.rest_length); !r) return r;
  return validate_square(field + ".rest_length", c.rest_length);
}

std::uint64_t key(const Constraint& c) {
  const auto [low, high] = std::minmax(c.a, c.b);
  return (std::uint64_t{low} << 32) | high;
}

Result<void> validate_no_duplicates(std::span<const Constraint> constraints) {
  std::vector<std::uint32_t> order(constraints.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::pair(key(constraints[i]), i) < std::pair(key(constraints[j]), j);
  });
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Constraint& c = constraints[order[k]];
    if (key(c) != key(constraints[order[k - 1]])) continue;
    return refuse(element("constraints", order[k]),
                  "joins the same particles as " + element("constraints", order[k - 1]),
                  std::to_string(c.a) + ", " + std::to_string(c.b));
  }
  return {};
}

Result<void> validate_constraints(std::span<const Constraint> constraints, std::size_t particles) {
  if (constraints.size() > kMostConstraints) {
    return refuse("constraints", "at most " + std::to_string(kMostConstraints),
                  std::to_string(constraints.size()));
  }
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (auto r = validate_constraint(i, constraints[i], particles); !r) return r;
  }
  return validate_no_duplicates(constraints);
}

Result<void> validate_contacts(const SceneDescription& d) {
  if (d.spheres.empty() && d.radii.empty()) return {};
  if (d.spheres.empty()) {
    return refuse("radii", "given without spheres, nothing would collide",
                  std::to_string(d.radii.size()));
  }
  if (auto r = validate_size("radii", d.radii.size(), d.positions.size()); !r) return r;
  for (std::size_t i = 0; i < d.radii.size(); ++i) {
    if (!std::isfinite(d.radii[i]) || d.radii[i] < 0) {
      return refuse(element("radii", i), "must be finite and at least 0", number(d.radii[i]));
    }
    if (d.radii[i] > kMostSquared) {
      return refuse(element("radii", i), "must be at most " + number(kMostSquared),
                    number(d.radii[i]));
    }
  }
  if (auto r = validate_index_list("spheres", d.spheres, d.positions.size()); !r) return r;
  for (std::size_t i = 0; i < d.spheres.size(); ++i) {
    if (d.radii[d.spheres[i]] <= 0) {
      return refuse(element("radii", d.spheres[i]), "a sphere needs a radius greater than 0",
                    number(d.radii[d.spheres[i]]));
    }
  }
  return {};
}

Result<void> validate_count(std::string_view field, int value, int least) {
  if (value >= least) return {};
  return refuse(field, "must be at least " + std::to_string(least), std::to_string(value));
}

template <class Enum>
Result<void> validate_choice(std::string_view field, Enum value, Enum last) {
  if (value <= last) return {};
  return refuse(field, "unknown choice", std::to_string(static_cast<int>(value)));
}

}  // namespace

Result<void> validate_size(std::string_view field, std::size_t size, std::size_t expected) {
  if (size == expected) return {};
  return refuse(field, "needs " + std::to_string(expected) + " elements", std::to_string(size));
}

Result<void> validate_vector(std::string_view field, std::size_t index, Vec3 vector) {
  if (finite(vector)) return {};
  return refuse(element(field, index), "must be finite", text(vector));
}

Result<void> validate_vectors(std::string_view field, std::span<const Vec3> vectors,
                              std::size_t particles) {
  if (auto r = validate_size(field, vectors.size(), particles); !r) return r;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (auto r = validate_vector(field, i, vectors[i]); !r) return r;
  }
  return {};
}

Result<void> validate_gravity(Vec3 gravity) {
  if (finite(gravity)) return {};
  return refuse("gravity", "must be finite", text(gravity));
}

Result<void> validate_time_step(double dt) {
  if (auto r = validate_positive("dt", dt); !r) return r;
  if (!std::isfinite(1 / dt)) return refuse("dt", "is too small to be inverted", number(dt));
  return {};
}

Result<void> validate(const SceneDescription& d) {
  const std::size_t particles = d.positions.size();
  if (particles == 0) return refuse("positions", "a scene needs at least one particle", "0");
  if (particles > kMostParticles) {
    return refuse("positions", "at most " + std::to_string(kMostParticles),
                  std::to_string(particles));
  }
  if (auto r = validate_vectors("positions", d.positions, particles); !r) return r;
  if (!d.velocities.empty()) {
    if (auto r = validate_vectors("velocities", d.velocities, particles); !r) return r;
  }
  if (auto r = validate_size("masses", d.masses.size(), particles); !r) return r;
  for (std::size_t i = 0; i < particles; ++i) {
    if (auto r = validate_positive(element("masses", i), d.masses[i]); !r) return r;
    if (auto r = validate_square(element("masses", i), d.masses[i]); !r) return r;
  }
  if (auto r = validate_gravity(d.gravity); !r) return r;
  if (auto r = validate_index_list("fixed", d.fixed, particles); !r) return r;
  if (auto r = validate_constraints(d.constraints, particles); !r) return r;
  return validate_contacts(d);
}

namespace {

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
  if (!s.anticipate_products) return {};
  if (s.backend != Backend::simd) {
    return refuse("anticipate_products", "is for the simd backend", std::string(name(s.backend)));
  }
  if (s.solver != Solver::gauss_seidel) {
    return refuse("anticipate_products", "is for solver gauss_seidel", std::string(name(s.solver)));
  }
  if (!s.anticipate) return refuse("anticipate_products", "needs anticipate", "off");
  return {};
}

}  // namespace

Result<void> validate(const Settings& s) {
  if (auto r = validate_positive("tolerance", s.tolerance); !r) return r;
  if (auto r = validate_count("substeps", s.substeps, kAutomaticSubsteps); !r) return r;
  if (auto r = validate_count("iterations", s.iterations, 0); !r) return r;
  if (auto r = validate_count("renew_after", s.renew_after, 0); !r) return r;
  if (auto r = validate_count("max_iterations", s.max_iterations, 1); !r) return r;
  if (auto r = validate_positive("contact_tolerance", s.contact_tolerance); !r) return r;
  if (auto r = validate_positive("velocity_tolerance", s.velocity_tolerance); !r) return r;
  if (!std::isfinite(s.impulse_limit) || s.impulse_limit < 0) {
    return refuse("impulse_limit", "must be finite and at least 0", number(s.impulse_limit));
  }
  if (auto r = validate_choice("solver", s.solver, Solver::automatic); !r) return r;
  if (auto r = validate_choice("scheme", s.scheme, Scheme::automatic); !r) return r;
  if (auto r = validate_choice("backend", s.backend, Backend::simd); !r) return r;
  if (s.impulse_limit > 0 && s.backend != Backend::reference) {
    return refuse("impulse_limit", "only the reference backend limits impulses",
                  number(s.impulse_limit));
  }
  if (s.impulse_limit > 0 && (s.solver != Solver::gauss_seidel && s.solver != Solver::automatic)) {
    return refuse("impulse_limit", "only Gauss-Seidel limits impulses", number(s.impulse_limit));
  }
  if (auto r = validate_products(s); !r) return r;
  if (s.solver == Solver::yarn && s.backend != Backend::simd) {
    return refuse("solver", "yarn is for the simd backend", std::string(name(s.backend)));
  }
  if (auto r = validate_scheme(s); !r) return r;
  if (s.threads < 0 || s.threads > kMaxThreads) {
    return refuse("threads", "must be from 0 to " + std::to_string(kMaxThreads),
                  std::to_string(s.threads));
  }
  return validate_choice("directions", s.directions, Directions::frozen);
}

Result<void> validate_for_lanes(const Settings& s, const Model& model) {
  const bool corrects_velocities = s.velocity_correction || s.scheme == Scheme::rattle;
  if (s.iterations == 0 && model.has_contacts()) {
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
  return {};
}

}  // namespace weft
