/// What one solve of the direct solver works on: its measuring writes directions and errors here,
/// its solving makes impulses of them.
///
/// Which step writes what, in this order:
///   measure   nx, ny, nz, lambda (errors), touches, seconds, ties, active, turned
///   solve     lambda and the impulses of touches, seconds and ties; total; turned
///   apply     nothing
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <vector>

#include "engine/contacts/contacts.h"
#include "engine/model/model.h"
#include "kernels/vectors.h"

namespace weft {

/// How an attempt at a step ends.
enum class DirectOutcome : std::uint8_t { converged, failed, exhausted };

/// A constraint or contact that is no row, with its direction and error.
struct Tie {
  std::uint32_t index = 0;  // of the constraint; contacts are counted behind the constraints
  std::uint32_t a = 0, b = 0;
  kernels::Vector n{};
  double error = 0, impulse = 0;
};

struct DirectSystem {
  DirectSystem(const Model& model, const Settings& settings);

  const Model& model;
  const DirectLayout& layout;
  const Settings settings;

  std::vector<double> nx, ny, nz;       // per row; 0: does not take part
  std::vector<double> lambda;           // per row: errors, then impulses
  std::vector<double> total;            // accumulated impulses, constraints then contacts
  std::int64_t active = 0;              // constraints and contacts that take part
  bool turned = true;                   // the matrix has changed since it was factorised
  std::vector<Tie> touches;             // contacts with a particle of the matrix
  std::vector<std::uint32_t> touch_of;  // per slot, kNoIndex: none; with spheres only
  std::vector<Tie> ties;                // links between bodies, contacts included
  std::vector<Tie> seconds;             // further contacts of particles that have a touch

  kernels::Vector n(std::size_t row) const { return {nx[row], ny[row], nz[row]}; }
  std::int64_t count() const { return static_cast<std::int64_t>(total.size()); }

  /// Room for these contacts; fresh: every accumulated impulse is 0.
  void start(const ContactStore& contacts, bool fresh);
  /// Of a constraint or contact: the length that its error may have.
  double tolerance(std::uint32_t index) const;
  /// +1: a rope, whose impulses are positive; -1: a contact; 0: a bar.
  int side(std::uint32_t index) const;
  /// The part of an impulse that keeps the sum on its side of 0; it is added to the sum.
  double clamped(std::uint32_t index, double impulse);
  std::size_t bytes() const;
};

}  // namespace weft
