#include "engine/contacts.h"

#include <algorithm>

namespace weft {
namespace {

constexpr double kMargin = 0.1;  // of the sphere's radius

bool joined(const Model& m, std::uint32_t a, std::uint32_t b) {
  const ConstraintStore& s = m.constraints;
  return std::ranges::any_of(m.adjacent[a],
                             [&](std::uint32_t c) { return s.a[c] == b || s.b[c] == b; });
}

/// Calls visit(sphere, particle, distance) for every pair nearer than its reach. A pair of spheres
/// is seen once. Pairs that cannot move, and pairs joined by a constraint, do not collide.
template <class Reach, class Visit>
void for_each_pair(const Model& m, const kernels::Vectors& x, Reach&& reach, Visit&& visit) {
  for (const std::uint32_t s : m.spheres) {
    const kernels::Vector centre = x[s];
    for (std::uint32_t p = 0; p < m.particles; ++p) {
      const double limit = reach(s, p);
      const kernels::Vector d = centre - x[p];
      if (limit <= 0 || !(dot(d, d) < limit * limit)) continue;
      if (p == s || m.inverse_mass[s] + m.inverse_mass[p] == 0) continue;
      const bool other_is_sphere = m.hub[p] && std::ranges::find(m.spheres, p) != m.spheres.end();
      if ((other_is_sphere && p < s) || joined(m, s, p)) continue;
      visit(s, p, length(d));
    }
  }
}

bool listed(const State& state, std::uint32_t s, std::uint32_t p) {
  const std::size_t base = state.model->constraints.size();
  for (auto k = state.contacts.first[p]; k != reference::kNoContact; k = state.contacts.next[k]) {
    if (state.constraints.a[base + k] == s) return true;
  }
  return false;
}

void append(State& state, std::uint32_t s, std::uint32_t p) {
  const Model& m = *state.model;
  ContactStore& contacts = state.contacts;
  const auto k = static_cast<std::uint32_t>(contacts.count++);
  if (contacts.count > contacts.next.size()) state.reserve_contacts(2 * contacts.count);
  const std::size_t c = m.constraints.size() + k;
  state.constraints.a[c] = s;
  state.constraints.b[c] = p;
  state.constraints.target[c] = m.radius[s] + m.radius[p];
  state.constraints.effective_mass[c] = 1 / (m.inverse_mass[s] + m.inverse_mass[p]);
  state.constraints.impulse[c] = 0;
  contacts.next[k] = contacts.first[p];
  contacts.first[p] = k;
}

}  // namespace

void find_contacts(State& state) {
  const Model& m = *state.model;
  const std::size_t base = m.constraints.size();
  for (std::size_t k = 0; k < state.contacts.count; ++k) {
    state.contacts.first[state.constraints.b[base + k]] = reference::kNoContact;
  }
  state.contacts.count = 0;
  const auto reach = [&](std::uint32_t s, std::uint32_t p) {
    return m.radius[s] + m.radius[p] + kMargin * m.radius[s];
  };
  for_each_pair(m, state.solved, reach,
                [&](std::uint32_t s, std::uint32_t p, double) { append(state, s, p); });
}

std::size_t add_missed_contacts(State& state) {
  const Model& m = *state.model;
  const std::size_t before = state.contacts.count;
  const auto reach = [&](std::uint32_t s, std::uint32_t p) {
    return m.radius[s] + m.radius[p] - state.settings.contact_tolerance;
  };
  for_each_pair(m, state.solved, reach, [&](std::uint32_t s, std::uint32_t p, double) {
    if (!listed(state, s, p)) append(state, s, p);
  });
  return state.contacts.count - before;
}

double max_penetration(const Model& m, const kernels::Vectors& position) {
  double deepest = 0;
  const auto reach = [&](std::uint32_t s, std::uint32_t p) { return m.radius[s] + m.radius[p]; };
  for_each_pair(m, position, reach, [&](std::uint32_t s, std::uint32_t p, double distance) {
    deepest = std::max(deepest, reach(s, p) - distance);
  });
  return deepest;
}

}  // namespace weft
