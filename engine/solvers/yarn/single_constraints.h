/// What no yarn holds: ropes, constraints at hubs, contacts. After a sweep they are relaxed one by
/// one; in the linear system each is a family of its own, with its diagonal as preconditioner.
#pragma once

#include <weft/weft.h>

#include <vector>

#include "engine/contacts/contacts.h"
#include "engine/model/model.h"
#include "kernels/simd/table.h"

namespace weft {

/// Arrays of displacements, base and velocities are laid out as YarnPlaces has it.
class SingleConstraints {
 public:
  SingleConstraints(const Model& model, const Settings& settings);

  /// first_round: accumulated impulses start at 0; else contacts may have been added. Impulses act
  /// along the present directions.
  void start(const ContactStore& contacts, bool first_round);
  std::size_t count() const { return pairs_.size(); }
  /// With scheme rattle: from here on impulses of constraints act along the directions at base + u.
  /// Contacts come about within a step: theirs are present ones.
  void keep_start(const float* base, const float* u);
  /// One pass, at the positions base + u. One-sided ones keep the sum of their impulses on their
  /// side: a rope that has pulled too much gives back what it had.
  void relax(const float* base, float* u);
  /// Largest error in tolerances: of contacts, and of what has pulled or pushed and holds nothing
  /// any more: a rope that ends slack has given what was not its to give. (Ropes that are too long
  /// are the strain's.)
  double violation(const float* base, const float* u) const;

  // The stages of conjugate gradients (kernels/simd/yarn_system.h). Of the one-sided those take
  // part that are violated or have pushed or pulled before; finish() clamps the sums, and the next
  // linearise() sees what that leaves.
  void linearise(const float* base, const float* u);
  /// Of velocities: the directions at the positions base + u, and who is taut or touches there;
  /// then the errors, at the velocities base + u.
  void linearise_velocities(const float* base, const float* u);
  double read(const float* base, const float* u);  // returns the largest, or what is not a number
  /// worst: in strains, where a contact's tolerance counts as much as `goal`; of velocities as they
  /// are.
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
    double wa = 0, wb = 0;  // 1 / mass, in YarnLayout::lightest
    double reciprocal = 0;  // of their sum
    double sum = 0;         // of its impulses
  };
  struct Row {
    kernels::Vector n{};
    bool near = true;  // may act at all
    double lambda = 0, residual = 0, z = 0, p = 0, q = 0;
  };
  static bool at_rest(const Pair& pair, kernels::Vector d);
  bool from_start(std::size_t i) const { return from_start_ && i < constraints_; }
  void make_rows();
  void set_error(std::size_t i, double error);
  void add(std::uint32_t a, std::uint32_t b, double distance, int side);

  const Model& model_;
  const std::size_t stride_;  // YarnPlaces
  const double tolerance_, contact_tolerance_;
  std::size_t constraints_ = 0;  // the first of pairs_; contacts come behind
  bool from_start_ = false, velocities_ = false;
  kernels::AlignedVector<Pair> pairs_;
  std::vector<kernels::Vector> starts_;  // of constraints, for scheme rattle: directions there
  std::vector<Row> rows_;                // of the linear system,
  std::vector<std::uint32_t> active_;    // and those that take part in it
};

}  // namespace weft
