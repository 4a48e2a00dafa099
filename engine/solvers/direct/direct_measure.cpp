#include "engine/solvers/direct/direct_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/solvers/direct/direct_layout.h"

namespace weft {
namespace {

using kernels::Vector;
using kernels::VectorsView;

/// The state of a constraint before it is decided whether it takes part.
struct Reading {
  Vector n{};
  double error = 0, tolerance = 0;
  bool near = true;  // a one-sided constraint that is taut or touches, so that it may act
};

/// Decides which constraints take part, counts them, and finds the largest error.
struct Judge {
  DirectSystem& system;
  double worst = 0;

  bool operator()(std::uint32_t index, const Reading& r) {
    bool active = true, violated = true;
    if (index >= system.model.constraints.bilateral) {
      const double outwards = system.side(index) * r.error;
      const bool acted = system.total[index] != 0;
      active = r.near && (outwards > 0 || acted);
      violated = r.near && (outwards > 0 || (acted && outwards < -r.tolerance));
    }
    system.active += active;
    // An error that is not a number fails both comparisons, and must not pass for solved.
    if (violated || !std::isfinite(r.error)) worsen(std::abs(r.error) / r.tolerance);
    return active;
  }
  void worsen(double size) {
    worst = size <= std::numeric_limits<double>::max() ? std::max(worst, size)
                                                       : std::numeric_limits<double>::infinity();
  }
};

template <class Read>
void measure_rows(DirectSystem& s, Judge& takes_part, Read&& read) {
  const DirectLayout& layout = s.layout;
  for (std::size_t row = 0; row < layout.rows(); ++row) {
    const std::uint32_t c = layout.row_constraint[row];
    const Reading r = read(c, layout.a[row], layout.b[row], s.target(c));
    const bool active = takes_part(c, r);
    const Vector n = active ? r.n : Vector{0, 0, 0};
    s.turned |= n.x != s.nx[row] || n.y != s.ny[row] || n.z != s.nz[row];
    s.nx[row] = n.x;
    s.ny[row] = n.y;
    s.nz[row] = n.z;
    s.lambda[row] = active ? r.error : 0;
  }
}

template <class Read>
void measure_links(DirectSystem& s, Judge& takes_part, Read&& read) {
  const ConstraintStore& constraints = s.model.constraints;
  s.ties.clear();
  for (const std::uint32_t c : s.layout.links) {
    const std::uint32_t a = constraints.a[c], b = constraints.b[c];
    const Reading r = read(c, a, b, s.target(c));
    if (takes_part(c, r)) s.ties.push_back({c, a, b, r.n, r.error});
  }
}

/// The deepest of several contacts of one particle is its touch.
void add_contact(DirectSystem& s, const Tie& contact) {
  const std::uint32_t p = contact.b;
  if (s.layout.body_of[p] != kNoIndex || s.model.inverse_mass[p] == 0) {
    s.ties.push_back(contact);
  } else if (s.touch_of[p] == kNoIndex) {
    s.touches.push_back(contact);  // before touch_of, because it may throw
    s.touch_of[p] = static_cast<std::uint32_t>(s.touches.size() - 1);
  } else {
    Tie& holding = s.touches[s.touch_of[p]];
    s.seconds.push_back(contact);
    if (contact.error < holding.error) std::swap(holding, s.seconds.back());
  }
}

template <class Read>
void measure_contacts(DirectSystem& s, const SphereContacts& contacts, Judge& takes_part,
                      Read&& read) {
  s.turned |= !s.touches.empty();
  for (const Tie& touch : s.touches) s.touch_of[touch.b] = kNoIndex;
  s.touches.clear();
  s.seconds.clear();
  for (std::uint32_t k = 0; k < contacts.count(); ++k) {
    const auto index = static_cast<std::uint32_t>(s.model.constraints.size() + k);
    const std::uint32_t a = contacts.sphere[k], b = contacts.particle[k];
    const Reading r = read(index, a, b, contacts.distance[k]);
    if (takes_part(index, r)) add_contact(s, {index, a, b, r.n, r.error});
  }
  s.turned |= !s.touches.empty();
}

/// read(index, a, b, target) returns the Reading of a constraint or contact.
template <class Read>
double measure(DirectSystem& system, const SphereContacts& contacts, Read&& read) {
  Judge takes_part{system};
  system.active = 0;
  measure_rows(system, takes_part, read);
  measure_links(system, takes_part, read);
  measure_contacts(system, contacts, takes_part, read);
  return takes_part.worst;
}

}  // namespace

double measure_positions(DirectSystem& system, VectorsView x, VectorsView start,
                         const SphereContacts& contacts) {
  const std::size_t constraints = start.x == nullptr ? 0 : system.model.constraints.size();
  return measure(system, contacts,
                 [&](std::uint32_t index, std::uint32_t a, std::uint32_t b, double target) {
                   const Vector d = x[a] - x[b];
                   const double l = length(d), tolerance = system.tolerance(index);
                   if (index >= constraints) return Reading{direction(d, l), l - target, tolerance};
                   const Vector from = start[a] - start[b];
                   return Reading{direction(from, length(from)), l - target, tolerance};
                 });
}

/// One-sided constraints take part only where they are taut or touch at x.
double measure_velocities(DirectSystem& system, VectorsView x, VectorsView v,
                          const SphereContacts& contacts) {
  return measure(system, contacts,
                 [&](std::uint32_t index, std::uint32_t a, std::uint32_t b, double target) {
                   const Vector d = x[a] - x[b];
                   const double l = length(d);
                   const Vector n = direction(d, l);
                   const bool near = system.side(index) * (l - target) >= -system.tolerance(index);
                   return Reading{n, dot(n, v[a] - v[b]), system.settings.velocity_tolerance, near};
                 });
}

}  // namespace weft
