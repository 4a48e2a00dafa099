#include "engine/step/tearing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "engine/measure/state_measure.h"
#include "engine/model/pressures.h"
#include "engine/model/tear.h"
#include "engine/partition.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/step/flanks.h"
#include "engine/tuning.h"

namespace weft {
namespace tearing {
namespace {

using kernels::Vector;

/// N/m, around a particle: a symmetric matrix in space, xx yy zz xy yz zx.
struct Tension {
  std::array<double, 6> t{};

  void add(double by, Vector a, Vector b) {
    const std::array<double, 6> product{a.x * b.x,
                                        a.y * b.y,
                                        a.z * b.z,
                                        0.5 * (a.x * b.y + a.y * b.x),
                                        0.5 * (a.y * b.z + a.z * b.y),
                                        0.5 * (a.z * b.x + a.x * b.z)};
    for (std::size_t i = 0; i < 6; ++i) t[i] += by * product[i];
  }
  Vector times(Vector v) const {
    return {t[0] * v.x + t[3] * v.y + t[5] * v.z, t[3] * v.x + t[1] * v.y + t[4] * v.z,
            t[5] * v.x + t[4] * v.y + t[2] * v.z};
  }
  /// No eigenvalue is larger.
  double bound() const {
    return std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] +
                     2 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]));
  }
  /// The largest eigenvalue (Smith 1961).
  double largest() const {
    const double mean = (t[0] + t[1] + t[2]) / 3;
    const double a = t[0] - mean, b = t[1] - mean, c = t[2] - mean;
    const double p =
        std::sqrt((a * a + b * b + c * c + 2 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5])) / 6);
    if (p == 0) return mean;
    const double det = a * (b * c - t[4] * t[4]) - t[3] * (t[3] * c - t[4] * t[5]) +
                       t[5] * (t[3] * t[4] - b * t[5]);
    return mean + 2 * p * std::cos(std::acos(std::clamp(det / (2 * p * p * p), -1.0, 1.0)) / 3);
  }
  /// The direction of the eigenvalue: the rows of the matrix less that are across it.
  Vector direction_of(double value) const {
    const Vector x{t[0] - value, t[3], t[5]}, y{t[3], t[1] - value, t[4]},
        z{t[5], t[4], t[2] - value};
    Vector best{};
    for (const Vector v : {cross(x, y), cross(y, z), cross(z, x)})
      if (dot(v, v) > dot(best, best)) best = v;
    return best;
  }
};

/// An element that carries more than its strength.
struct Overload {
  Break what;
  double ratio = 0;                                        // load over strength
  std::array<std::uint32_t, 2> slots{kNoIndex, kNoIndex};  // where it is
};

class Overloads {
 public:
  explicit Overloads(const State& s) : s_(s), model_(*s.model), carried_(s.small_steps->carried()) {
    find_constraints();
    find_triangles();
    find_seams();
    find_anchors();
  }
  bool any() const { return !found_.empty(); }

  /// Those that are side by side, the worst first.
  std::vector<std::vector<Break>> groups() {
    Partition joined = join_all();
    std::ranges::stable_sort(found_, std::ranges::greater(), &Overload::ratio);
    std::map<std::uint32_t, std::vector<Break>> group;
    for (const Overload& each : found_) group[joined.first(each.slots[0])].push_back(each.what);
    std::vector<std::vector<Break>> groups;
    for (auto& [first, breaks] : group) groups.push_back(std::move(breaks));
    return groups;
  }

 private:
  void take(const Overload& each, double strength) {
    if (!(each.what.load > strength)) return;
    found_.push_back(each);
    found_.back().ratio = each.what.load / strength;
  }

  void find_constraints() {
    const ConstraintStore& s = model_.constraints;
    for (std::uint32_t c = 0; c < s.strength.size(); ++c) {
      take({.what = {Tear::constraint, s.described[c], carried_.constraints[c]},
            .slots = {s.a[c], s.b[c]}},
           s.strength[c]);
    }
  }

  void find_seams() {
    const SeamStore& seams = model_.seams;
    for (std::uint32_t i = 0; i < seams.size(); ++i) {
      const SeamState& state = s_.seams.states()[i];
      if (seams.may_break(i) && state.is_closed && !state.is_released)
        take({.what = {Tear::seam, i, carried_.seams[i]}, .slots = {seams.a[i], seams.b[i]}},
             seams.strength[i]);
    }
  }

  /// By the mean tension around each particle.
  void find_triangles() {
    const MembraneStore& s = model_.membrane;
    if (s.strength.empty()) return;
    std::vector<Tension> tension(model_.slots());
    std::vector<double> area(model_.slots()), weakest(model_.slots());
    for (std::size_t i = 0; i < s.size(); ++i) {
      const Tension its = tension_of(i);
      const double a = s.element[i].shape.area;
      for (const std::uint32_t slot : s.slots[i]) {
        for (std::size_t k = 0; k < 6; ++k) tension[slot].t[k] += a * its.t[k];
        area[slot] += a;
        weakest[slot] += a * s.strength[i];
      }
    }
    for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
      if (area[slot] == 0 || !std::isfinite(weakest[slot])) continue;
      const double strength = weakest[slot] / area[slot];
      for (double& t : tension[slot].t) t /= area[slot];
      if (!(tension[slot].bound() > strength)) continue;
      const double load = tension[slot].largest();
      take({.what = {Tear::sheet, model_.ordering.particle_at[slot], load,
                     tension[slot].direction_of(load)},
            .slots = {slot, slot}},
           strength);
    }
  }
  Tension tension_of(std::size_t i) const {
    const MembraneStore& s = model_.membrane;
    const auto& [a, b, c] = s.slots[i];
    const auto& x = s_.position;
    const reference::Deformation f = deformation(s.element[i].shape, x[b] - x[a], x[c] - x[a]);
    const Vector u = direction(f.u, length(f.u)), v = direction(f.v, length(f.v));
    const auto& [along_u, along_v, shear] = carried_.triangles[i];
    Tension tension;
    tension.add(along_u, u, u);
    tension.add(along_v, v, v);
    tension.add(2 * shear, u, v);
    return tension;
  }

  void find_anchors() {
    const AnchorStore& anchors = model_.anchors;
    for (std::uint32_t i = 0; i < anchors.described.size(); ++i) {
      const double strength = anchors.described[i].strength;
      if (!std::isfinite(strength)) continue;
      if (pulls_.empty()) find_pulls();
      if (!s_.anchors.is_at_limit(i, s_.position[anchors.slot[i]], s_.settings.contact_tolerance))
        continue;
      take({.what = {Tear::anchor, i, length(pulls_[anchors.slot[i]])},
            .slots = {anchors.slot[i], anchors.slot[i]}},
           strength);
    }
  }
  /// N, per slot: of all that is joined to the particle, and of its weight.
  void find_pulls() {
    pulls_.resize(model_.slots());
    for (std::uint32_t slot = 0; slot < model_.slots(); ++slot)
      pulls_[slot] = model_.mass[slot] * s_.gravity;
    const ConstraintStore& s = model_.constraints;
    const auto& x = s_.position;
    for (std::size_t c = 0; c < carried_.constraints.size(); ++c) {
      const Vector d = x[s.b[c]] - x[s.a[c]];
      const Vector pull = carried_.constraints[c] * direction(d, length(d));
      pulls_[s.a[c]] = pulls_[s.a[c]] + pull;
      pulls_[s.b[c]] = pulls_[s.b[c]] - pull;
    }
    for (std::size_t i = 0; i < model_.membrane.size(); ++i) {
      const reference::MembraneShape& shape = model_.membrane.element[i].shape;
      const Tension tension = tension_of(i);
      const auto& [a, b, c] = model_.membrane.slots[i];
      const reference::Deformation f = deformation(shape, x[b] - x[a], x[c] - x[a]);
      const Vector u = tension.times(direction(f.u, length(f.u))),
                   v = tension.times(direction(f.v, length(f.v)));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t slot = model_.membrane.slots[i][k];
        pulls_[slot] = pulls_[slot] - shape.area * (shape.u[k] * u + shape.v[k] * v);
      }
    }
  }

  // Overloaded particles that an edge joins are side by side.

  Partition join_all() const {
    std::vector<bool> is_overloaded(model_.slots());
    for (const Overload& each : found_)
      for (const std::uint32_t slot : each.slots) is_overloaded[slot] = true;
    Partition joined(model_.slots());
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
      if (is_overloaded[a] && is_overloaded[b]) joined.join(a, b);
    };
    for (const Overload& each : found_) join(each.slots[0], each.slots[1]);
    const ConstraintStore& s = model_.constraints;
    for (std::size_t c = 0; c < s.size(); ++c) join(s.a[c], s.b[c]);
    for (const auto* triangles : {&model_.membrane.slots, &model_.surface}) {
      for (const auto& [a, b, c] : *triangles) {
        join(a, b);
        join(b, c);
        join(c, a);
      }
    }
    return joined;
  }

  const State& s_;
  const Model& model_;
  const Carried& carried_;
  std::vector<Overload> found_;
  std::vector<Vector> pulls_;
};

/// The threads of the present step go on with the state.
void go_on_torn(State& s, TornModel&& torn) {
  State next(torn.model, s.settings);
  next.go_on_from(s);
  next.seams.tear(*torn.model);
  for (const Torn& each : torn.torn) {
    if (each.kind == Tear::anchor)
      next.anchors.limit(
          each.index, {.max_distance = std::numeric_limits<double>::infinity(), .backstop = false});
  }
  let_gas_out(next.pressures, torn.model->surface);
  next.make_room_for_pressure();
  next.displaced = s.displaced;
  next.wake();
  if (s.team_state) {
    next.team_state = std::move(s.team_state);
    next.arena_run = std::move(s.arena_run);
  }
  next.is_in_batch = s.is_in_batch;
  next.body_report = std::move(s.body_report);
  s = std::move(next);
  s.torn = std::move(torn.torn);
}

/// By its law, where the spring is now.
bool is_near_strength(const State& s, std::size_t c) {
  const ConstraintStore& store = s.model->constraints;
  const double longer =
      length(s.position[store.b[c]] - s.position[store.a[c]]) - store.rest_length[c];
  return longer > tuning::kNearStrength * store.strength[c] * store.compliance[c];
}
bool is_triangle_near_strength(const State& s, std::size_t i) {
  const MembraneStore& store = s.model->membrane;
  const reference::Deformation f = deformation_of(store, s.position, i);
  const auto& stiffness = store.element[i].stiffness;
  const double most = std::max(stiffness[0] * (length(f.u) - 1), stiffness[1] * (length(f.v) - 1));
  return most > tuning::kNearStrength * store.strength[i];
}

}  // namespace
}  // namespace tearing

double substep_length_for_strengths(const State& s) {
  double square = std::numeric_limits<double>::infinity();  // s^2, in which the fastest swings
  const ConstraintStore& springs = s.model->constraints;
  for (std::size_t c = 0; springs.has_springs() && c < springs.strength.size(); ++c) {
    const bool may_break = std::isfinite(springs.strength[c]) && springs.compliance[c] > 0;
    if (may_break && tearing::is_near_strength(s, c))
      square = std::min(square, springs.compliance[c] * springs.effective_mass[c]);
  }
  const MembraneStore& triangles = s.model->membrane;
  for (std::size_t i = 0; i < triangles.strength.size(); ++i) {
    if (!std::isfinite(triangles.strength[i]) || !tearing::is_triangle_near_strength(s, i))
      continue;
    const reference::MembraneElement& e = triangles.element[i];
    const double stiffness = std::max(e.stiffness[0], e.stiffness[1]) * e.shape.area;
    // Its three laws and its neighbors move the same corners: half of the time that one alone
    // takes.
    square = std::min(square, 0.25 / (stiffness * e.mobility.most()));
  }
  return tuning::kTearingTurn * std::sqrt(square);
}

bool tear(State& s) {
  const std::vector<std::uint32_t> apart = flanks_apart(s);
  tearing::Overloads overloads(s);
  if (!overloads.any() && apart.empty()) return false;
  TornModel torn = torn_model(*s.model, overloads.groups(), apart, s.position);
  if (torn.model == nullptr) return false;
  tearing::go_on_torn(s, std::move(torn));
  return !s.torn.empty();
}

}  // namespace weft
