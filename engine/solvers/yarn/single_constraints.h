/// The constraints that belong to no yarn: ropes, constraints at hubs, and contacts. After a sweep
/// of the yarns they are relaxed one by one. In the linear system each is a block of its own, with
/// its diagonal as preconditioner.
#pragma once

#include <weft/weft.h>

#include <vector>

#include "engine/measure/spring_laws.h"
#include "engine/model/model.h"
#include "engine/spheres/sphere_contacts.h"
#include "kernels/simd/table.h"

namespace weft {

/// Arrays of displacements, base positions and velocities have the layout of YarnPlaces.
class SingleConstraints {
 public:
  SingleConstraints(const Model& model, const Settings& settings);

  /// In the first round accumulated impulses start at 0; in later rounds contacts may have been
  /// added. Impulses act along the directions at the present positions. laws: of a model with
  /// springs, for positions.
  void start(const SphereContacts& contacts, const SpringLaws* laws, bool first_round);
  void keep_multipliers(SpringLaws& laws) const;
  std::size_t count() const { return pairs_.size(); }
  /// For scheme rattle: from here on the impulses of constraints act along the directions at base +
  /// u. Contacts come about within a step, and theirs act along present directions.
  void keep_start(const float* base, const float* u);
  /// One pass at the positions base + u. The sum of the impulses of a one-sided constraint keeps
  /// its sign: a rope that has pulled too much gives back what it had.
  void relax(const float* base, float* u);
  /// The largest error in units of the tolerance, of contacts that overlap and of one-sided
  /// constraints that have acted but are slack in the end. A rope that is too long counts as
  /// strain, which others measure.
  double violation(const float* base, const float* u) const;

  // The stages of conjugate gradients (kernels/simd/yarn_system.h). A one-sided constraint takes
  // part if it is violated or has an impulse from before; finish() clamps the sums, and the next
  // linearise() sees the errors that this leaves.
  void linearise(const float* base, const float* u);
  /// For velocities: linearise_velocities() finds the directions at the positions base + u and
  /// which one-sided constraints are taut or touch there; read() then finds the errors at the
  /// velocities base + u.
  void linearise_velocities(const float* base, const float* u);
  /// Returns the largest error, or NaN if one is NaN.
  double read(const float* base, const float* u);
  /// YarnProducts::worst is a strain, in which the tolerance of contacts counts as `goal`; for
  /// velocities it is in m/s.
  simd::YarnProducts precondition(double alpha, double goal);
  void push(double beta, float* t);
  double pull(const float* t);
  void finish(float* t);

  std::size_t bytes() const;

 private:
  struct Pair {
    std::uint32_t a = 0, b = 0;  // places
    int side = 0;                // +1: pulls only, -1: pushes only
    double distance = 0;
    double wa = 0, wb = 0;  // inverse masses, in units of 1 / YarnLayout::lightest
    double reciprocal = 0;  // 1 / (wa + wb + softness)
    double sum = 0;         // of the impulses so far
    double softness = 0;    // compliance / h^2, in the same units; 0: rigid
    double target() const { return distance + softness * sum; }
  };
  struct Row {
    kernels::Vector n{};
    bool near = true;  // taut or touching, so that it may act
    double lambda = 0, residual = 0, z = 0, p = 0, q = 0;
  };
  static bool at_rest(const Pair& pair, kernels::Vector d);
  bool from_start(std::size_t i) const { return from_start_ && i < constraints_; }
  void take_laws(const SpringLaws& laws);
  void make_rows();
  void set_error(std::size_t i, double error);
  void add(std::uint32_t a, std::uint32_t b, double distance, int side);

  const Model& model_;
  const std::size_t stride_;  // YarnPlaces
  const double tolerance_, contact_tolerance_;
  std::size_t constraints_ = 0;  // the first of pairs_; the others are contacts
  bool from_start_ = false, velocities_ = false;
  kernels::AlignedVector<Pair> pairs_;
  std::vector<kernels::Vector> starts_;  // scheme rattle: directions at the start of the substep
  std::vector<Row> rows_;                // of the linear system, one for each pair
  std::vector<std::uint32_t> active_;    // the rows that take part in it
};

}  // namespace weft
