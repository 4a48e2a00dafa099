/// The memory of a LaneStore: taken over from another cloth, or from a changed one, or turned.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/model/change.h"
#include "engine/solvers/small_steps/lane_store.h"
#include "engine/tuning.h"

namespace weft {

/// The past of the last frame that was kept.
SmallStepsPast LaneStore::last_past() const {
  SmallStepsPast past = past_;
  if (!is_new_) past.base = base_;
  return past;
}

void LaneStore::set_past(SmallStepsPast&& past) {
  past_ = std::move(past);
  std::ranges::copy(past_.base, base_.begin());
  is_new_ = false;
  is_unmeasured_ = true;
}

void LaneStore::take_past(const LaneStore& from) { set_past(from.last_past()); }

bool LaneStore::load_past(ArchiveReader& archive) {
  SmallStepsPast past;
  archive(past);
  const bool has_sizes = std::ranges::all_of(
      std::array{past.v.size(), past.v_before.size(), past.moved.size(), past.base.size()},
      [&](std::size_t size) { return size == layout_.floats; });
  const bool is_past = has_sizes && past.at_limit.size() == past_.at_limit.size() &&
                       are_slots(model_, past.misplaced.inside) &&
                       are_slots(model_, past.misplaced.crossing) && past.contacts.is_whole() &&
                       past.dt_substep >= 0 && std::isfinite(past.dt_substep) &&
                       past.since_renewal >= 0 && past.since_renewal <= tuning::kRenewal;
  if (!archive.is_done() || !is_past) return false;
  set_past(std::move(past));
  return true;
}

/// Floats are carried to other places as they are. A base of other cells is of no use.
void LaneStore::go_on_from(const LaneStore& other, kernels::VectorsView v,
                           kernels::Vector gravity) {
  const SmallStepsPast& its = other.past_;
  const auto& its_base = other.is_new_ ? its.base : other.base_;
  past_.dt_substep = its.dt_substep;
  if (model_.anchors.slot == other.model_.anchors.slot)
    past_.at_limit = its.at_limit;
  else
    past_.at_limit.assign(anchors_.at_limit().size(), 0);
  past_.since_renewal = layout_.cell == other.layout_.cell ? its.since_renewal : tuning::kRenewal;
  past_.misplaced.clear();
  past_.misplaced.tangled = its.misplaced.tangled;  // triangles keep their numbers
  past_.contacts = its.contacts;                    // and so do edges, but in a tear
  if (model_.tears != other.model_.tears) past_.contacts.clear();
  const YarnPlaces &places = layout_.places(), &its_places = other.layout_.places();
  for_each_particle(model_, other.model_, [&](std::uint32_t slot, std::uint32_t its_slot) {
    std::size_t to = places.of(slot), at = its_places.of(its_slot);
    for (int axis = 0; axis < 3; ++axis, to += places.stride, at += its_places.stride) {
      base_[to] = past_.base[to] = its_base[at];
      past_.v[to] = its.v[at];
      past_.v_before[to] = its.v_before[at];
      past_.moved[to] = its.moved[at];
    }
    past_.misplaced.take_over(its.misplaced, its_slot, slot);
    const bool is_free = model_.inverse_mass[slot] > 0;
    if (is_free == (other.model_.inverse_mass[its_slot] > 0)) return;
    write_past(slot,
               is_free ? ParticlePast::flight(v[slot], gravity, past_.dt_substep) : ParticlePast{});
  });
  past_.misplaced.sort();
}

void LaneStore::write_past(std::uint32_t slot, const ParticlePast& past) {
  const YarnPlaces& places = layout_.places();
  const auto write = [&](auto& to, kernels::Vector vector) {
    std::size_t at = places.of(slot);
    for (const double component : {vector.x, vector.y, vector.z}) {
      to[at] = static_cast<float>(component);
      at += places.stride;
    }
  };
  write(past_.v, past.v);
  write(past_.v_before, past.v_before);
  write(past_.moved, past.moved);
}

void LaneStore::turn(const Turn& by) {
  const YarnPlaces& places = layout_.places();
  for (std::uint32_t slot = 0; slot < model_.slots(); ++slot) {
    if (!model_.is_particle(slot)) continue;
    const std::size_t x = places.of(slot), y = x + places.stride, z = y + places.stride;
    for (auto* v : {&past_.v, &past_.v_before, &past_.moved}) {
      float* const of = v->data();
      const kernels::Vector to = by({double{of[x]}, double{of[y]}, double{of[z]}});
      of[x] = static_cast<float>(to.x);
      of[y] = static_cast<float>(to.y);
      of[z] = static_cast<float>(to.z);
    }
  }
  past_.since_renewal = tuning::kRenewal;
  past_.contacts.turn(by);
}

}  // namespace weft
