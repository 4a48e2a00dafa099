#include "engine/solvers/sweeps/simd_system.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/bytes_of.h"
#include "engine/measure/simd_layout.h"
#include "engine/solvers/sweeps/pull_layout.h"

namespace weft {
void ContactLanes::resize(std::size_t size) {
  a.resize(size);
  b.resize(size);
  contact.resize(size);
  blocks.resize(size / kernels::kLanes);
  impulse.resize(size);
  distance.resize(size);
  scale.resize(size);
}

std::size_t ContactLanes::bytes() const {
  return bytes_of(spheres) + bytes_of(a) + bytes_of(b) + bytes_of(contact) + bytes_of(blocks) +
         bytes_of(impulse) + bytes_of(distance) + bytes_of(scale);
}

void SpringLanes::resize(std::size_t n) {
  for (auto* values : {&target, &softness, &multiplier, &unit, &rest}) values->resize(n);
  for (auto* values : {&compliance_share, &held}) values->resize(n);
}

std::size_t SpringLanes::bytes() const {
  return bytes_of(target) + bytes_of(softness) + bytes_of(multiplier) + bytes_of(unit) +
         bytes_of(rest) + bytes_of(compliance_share) + bytes_of(held);
}

SimdSystem::SimdSystem(const Model& model, const Settings& settings, const simd::Table& table)
    : model_(model),
      layout_(model.simd()),
      neighbours_(model.chunk_neighbours()),
      settings_(settings),
      table_(table) {
  const std::size_t size = layout_.constraint_slots;
  allocate_displacements();
  // With a fixed number of iterations errors are measured in rest lengths and nothing is tolerated.
  const bool fixed_iterations = settings.iterations > 0;
  positions_ =
      scaled([&](double rest) { return fixed_iterations ? rest : settings.tolerance * rest; });
  if (settings.velocity_correction) {
    velocities_ =
        scaled([&](double) { return fixed_iterations ? 1 : settings.velocity_tolerance; });
  }
  if (settings.measuring.anticipate_products) pulls_.emplace(model.pulls());
  if (layout_.has_ropes || model.constraints.has_springs()) impulse_.resize(size);
  if (model.constraints.has_springs()) {
    springs_.emplace().resize(size);
    springs_->rest = layout_.rest_length;
  }
  if (settings.measuring.skip && settings.iterations == 0) {
    if (!settings.measuring.anticipate && !springs_) mask_.resize(layout_.slots);
    changed_.resize(layout_.chunks.size());
    stale_.resize(layout_.chunks.size());
  }
  sweeps_.resize(std::max(
      {model.ordering.tiles.size(), layout_.seams.size(), layout_.chunks.size() / kPiece + 1}));
  open_seam_.assign(layout_.seams.size(), 1);
  corrections_.resize(layout_.chunks.size());
}

/// In quads if there are no runs.
void SimdSystem::allocate_displacements() {
  if (model_.ordering.runs.empty()) {
    u_step_ = 4;
    u_stride_ = 1;
    u_.resize(4 * layout_.slots);
  } else {
    u_step_ = 1;
    u_stride_ = layout_.slots + kernels::kLanes;  // no power of two: axes in different cache sets
    u_.resize(3 * u_stride_);
  }
}

/// tau(rest length): in m of positions, in m/s of velocities.
template <class Tolerance>
ScaledConstraints SimdSystem::scaled(Tolerance&& tolerance) const {
  const std::size_t size = layout_.constraint_slots;
  ScaledConstraints scaled;
  scaled.blocks.resize(size / kernels::kLanes);
  scaled.scale.resize(size);
  for (std::size_t c = 0; c < size; ++c) {
    if (layout_.constraint_at[c] == kNoIndex) continue;
    const double tau = tolerance(layout_.rest_length[c]);
    scaled.scale[c] = 1 / tau;
    simd::ConstraintBlock& block = scaled.blocks[c / kernels::kLanes];
    block.gain_a[c % kernels::kLanes] = static_cast<float>(-tau * tau * layout_.share_a[c]);
    block.gain_b[c % kernels::kLanes] = static_cast<float>(tau * tau * layout_.share_b[c]);
  }
  if (settings_.measuring.anticipate_products)
    scaled.weight = model_.pulls().weights(scaled.blocks);
  return scaled;
}

std::size_t ScaledConstraints::bytes() const {
  return bytes_of(blocks) + bytes_of(scale) + bytes_of(weight);
}

/// Padding does not change.
void SimdSystem::take_laws(const SpringLaws& laws, bool first_round) {
  SpringLanes& s = *springs_;
  for (std::size_t c = 0; c < layout_.constraint_slots; ++c) {
    const std::uint32_t constraint = layout_.constraint_at[c];
    if (constraint == kNoIndex) continue;
    const double tau =
        settings_.iterations > 0 ? layout_.rest_length[c] : laws.tolerance[constraint];
    const double inverse_masses = 1 / model_.constraints.effective_mass[constraint];
    const double all = inverse_masses + laws.softness[constraint];
    const double gain = tau * tau * inverse_masses / all;
    positions_.scale[c] = 1 / tau;
    simd::ConstraintBlock& block = positions_.blocks[c / kernels::kLanes];
    block.gain_a[c % kernels::kLanes] = static_cast<float>(-gain * layout_.share_a[c]);
    block.gain_b[c % kernels::kLanes] = static_cast<float>(gain * layout_.share_b[c]);
    s.target[c] = laws.target[constraint];
    s.softness[c] = laws.softness[constraint];
    s.compliance_share[c] = static_cast<float>(s.softness[c] / all);
    s.unit[c] = tau / all;
    if (first_round) s.multiplier[c] = 0;
  }
}

/// Corrections since the last renewal go into the multipliers.
void SimdSystem::renew_multipliers() {
  SpringLanes& s = *springs_;
  for (std::size_t c = 0; c < layout_.constraint_slots; ++c) {
    if (s.unit[c] == 0) continue;
    s.multiplier[c] += s.unit[c] * static_cast<double>(impulse_[c]);
    impulse_[c] = 0;
    s.held[c] = static_cast<float>(s.multiplier[c] / s.unit[c]);
    s.rest[c] = s.target[c] + s.softness[c] * s.multiplier[c];
  }
}

void SimdSystem::keep_multipliers(SpringLaws& laws) const {
  for (std::size_t c = 0; c < layout_.constraint_slots; ++c) {
    const std::uint32_t constraint = layout_.constraint_at[c];
    if (constraint != kNoIndex) laws.multiplier[constraint] = springs_->multiplier[c];
  }
}

/// The search lists them sphere by sphere; what it missed stands behind.
void SimdSystem::order_contacts(const SphereContacts& store) {
  contact_order_.resize(store.count());
  std::iota(contact_order_.begin(), contact_order_.end(), 0u);
  if (std::ranges::is_sorted(store.sphere)) return;
  std::ranges::sort(contact_order_, {},
                    [&](std::uint32_t k) { return std::pair(store.sphere[k], k); });
}

/// Brings the contacts of each sphere side by side.
void SimdSystem::place_contacts(const SphereContacts& store, double tau, bool keep_impulses) {
  contact_impulse_.resize(store.count());
  if (!keep_impulses) std::ranges::fill(contact_impulse_, 0.f);
  contacts_.resize(kernels::round_up(store.count(), kernels::kLanes) +
                   kernels::kLanes * model_.spheres.size());
  contacts_.spheres.clear();
  std::uint32_t next = 0;
  const auto put = [&](std::uint32_t s, std::uint32_t p, std::uint32_t contact) {
    const double ws = model_.inverse_mass[s], wp = model_.inverse_mass[p];
    const bool real = contact != kNoIndex;
    const double split = real ? tau * tau / (wp + kernels::kLanes * ws) : 0;
    contacts_.a[next] = s;
    contacts_.b[next] = p;
    contacts_.contact[next] = contact;
    simd::ConstraintBlock& block = contacts_.blocks[next / kernels::kLanes];
    block.gain_a[next % kernels::kLanes] = static_cast<float>(-split * ws);
    block.gain_b[next % kernels::kLanes] = static_cast<float>(split * wp);
    contacts_.impulse[next] = real ? contact_impulse_[contact] : 0;
    contacts_.distance[next] = real ? store.distance[contact] : 1;
    contacts_.scale[next] = real ? 1 / tau : 0;
    ++next;
  };
  order_contacts(store);
  for (auto k = contact_order_.begin(); k != contact_order_.end();) {
    const std::uint32_t s = store.sphere[*k], first = next;
    for (; k != contact_order_.end() && store.sphere[*k] == s; ++k) put(s, store.particle[*k], *k);
    const std::uint32_t last_contact = next;
    // Padding stands on padding slots, each its own: lanes of a block must not share a particle.
    for (std::uint32_t spare = 0; next % kernels::kLanes != 0; ++spare) {
      put(s, model_.spare_slots + spare, kNoIndex);
    }
    contacts_.spheres.push_back({first, next, last_contact - first});
  }
}

/// Ropes and contacts take part in the velocity loop where they are taut or touch.
void SimdSystem::choose_active(kernels::VectorsView x) {
  const bool fixed_iterations = settings_.iterations > 0;  // then tolerances have no say
  const double tau = fixed_iterations ? 1 : settings_.velocity_tolerance;
  const double slack = fixed_iterations ? 0 : settings_.tolerance;
  const double gap = fixed_iterations ? 0 : settings_.contact_tolerance;
  for (std::size_t c = 0; layout_.has_ropes && c < layout_.constraint_slots; ++c) {
    const std::uint32_t constraint = layout_.constraint_at[c];
    if (constraint == kNoIndex || constraint < model_.constraints.bilateral) continue;
    const double l = length(x[layout_.a[c]] - x[layout_.b[c]]);
    const bool taut = l >= (1 - slack) * layout_.rest_length[c];
    velocities_.scale[c] = taut ? 1 / tau : 0;
  }
  for (const ContactLanes::Range& range : contacts_.spheres) {
    for (std::size_t k = range.first; k < range.last; ++k) {
      if (contacts_.contact[k] == kNoIndex) continue;
      const double l = length(x[contacts_.a[k]] - x[contacts_.b[k]]);
      const bool touching = l <= contacts_.distance[k] + gap;
      contacts_.scale[k] = touching ? 1 / tau : 0;
    }
  }
}

simd::BlockRelaxation SimdSystem::relaxation(ScaledConstraints& constraints) {
  simd::BlockRelaxation r;
  r.u = {u_.data(), u_stride_, u_step_};
  r.blocks = constraints.blocks.data();
  r.impulse = impulse_.data();
  if (springs_) {
    r.compliance_share = springs_->compliance_share.data();
    r.held = springs_->held.data();
  }
  r.a = layout_.a.data();
  r.b = layout_.b.data();
  r.mask = mask_.data();
  r.threshold = settings_.iterations > 0 ? 0 : 1;
  r.from_memory = bytes_of(constraints.blocks) > kernels::kCachedBytes;
  return r;
}

simd::Geometry SimdSystem::geometry(kernels::VectorsView x,
                                    const ScaledConstraints& constraints) const {
  return {x,
          springs_ ? springs_->rest.data() : layout_.rest_length.data(),
          layout_.inverse_square.data(),
          constraints.scale.data(),
          layout_.a.data(),
          layout_.b.data()};
}

std::size_t SimdSystem::bytes() const {
  return bytes_of(u_) + bytes_of(impulse_) + positions_.bytes() + velocities_.bytes() +
         bytes_of(mask_) + bytes_of(changed_) + bytes_of(stale_) + bytes_of(corrections_) +
         bytes_of(sweeps_) + bytes_of(open_seam_) + contacts_.bytes() + bytes_of(contact_impulse_) +
         bytes_of(contact_order_) + (pulls_ ? pulls_->bytes() : 0) +
         (springs_ ? springs_->bytes() : 0);
}

}  // namespace weft
