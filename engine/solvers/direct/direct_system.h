/// The data of one solve of the direct solver. Measuring writes directions and errors, and solving
/// turns the errors into impulses.
///
/// The stages, in this order, and what each writes:
///   measure   nx, ny, nz, lambda (errors), touches, seconds, ties, active, turned
///   solve     lambda and the impulses of touches, seconds and ties; total; turned
///   apply     nothing
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

#include "engine/measure/spring_laws.h"
#include "engine/model/model.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/vectors.h"

namespace weft {

/// How an attempt at a step ends.
enum class DirectOutcome : std::uint8_t { converged, failed, exhausted };

/// A constraint or contact that has no row in the matrix, with its direction and error.
struct Tie {
  std::uint32_t index = 0;  // of the constraint; contacts are numbered behind the constraints
  std::uint32_t a = 0, b = 0;
  kernels::Vector n{};
  double error = 0, impulse = 0;
};

struct DirectSystem {
  DirectSystem(const Model& model, const Settings& settings);

  const Model& model;
  const DirectLayout& layout;
  const Settings settings;
  const SpringLaws* laws = nullptr;  // of a model with springs; not of velocities

  std::vector<double> nx, ny, nz;       // per row; 0 if it does not take part
  std::vector<double> lambda;           // per row: first the error, then the impulse
  std::vector<double> total;            // accumulated impulses, constraints then contacts
  std::int64_t active = 0;              // constraints and contacts that take part
  bool turned = true;                   // the matrix has changed since it was factorised
  std::vector<Tie> touches;             // contacts with a particle of the matrix
  std::vector<std::uint32_t> touch_of;  // per slot: index in touches, or kNoIndex; with spheres
  std::vector<Tie> ties;                // links between bodies, contacts included
  std::vector<Tie> seconds;             // further contacts of particles that have a touch

  kernels::Vector n(std::size_t row) const { return {nx[row], ny[row], nz[row]}; }
  std::int64_t count() const { return static_cast<std::int64_t>(total.size()); }

  /// Makes room for the contacts. If `fresh`, every accumulated impulse becomes 0.
  void start(const SphereContacts& contacts, bool fresh, const SpringLaws* laws = nullptr);
  /// The length of a constraint at which it has no error: a spring gives way to what its impulse
  /// has come to.
  double target(std::uint32_t index) const;
  /// The part that a constraint adds to its diagonal of A: compliance / h^2 of a spring, else 0.
  double softness(std::uint32_t index) const;
  /// The largest permitted error of a constraint or contact, in m.
  double tolerance(std::uint32_t index) const;
  /// The sign of the impulses: +1 for a rope, -1 for a contact, and 0 for a distance constraint,
  /// whose impulses have either sign.
  int side(std::uint32_t index) const;
  /// The part of an impulse that keeps the sign of the sum. It is added to the sum.
  double clamped(std::uint32_t index, double impulse);
  std::size_t bytes() const;
};

}  // namespace weft
