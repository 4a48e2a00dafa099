#include "engine/step/saved_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/model/pressures.h"
#include "engine/model/saved_model.h"
#include "engine/solvers/small_steps/small_steps.h"
#include "engine/validation.h"

namespace weft {
namespace {

void visit_settings(auto& settings, auto& archive) {
  std::apply([&](auto&... each) { archive(each...); }, memory_settings(settings));
}

bool are_finite(const kernels::Vectors& vectors) {
  const auto is_finite = [](double x) { return std::isfinite(x); };
  return std::ranges::all_of(vectors.x, is_finite) && std::ranges::all_of(vectors.y, is_finite) &&
         std::ranges::all_of(vectors.z, is_finite);
}

bool are_finite(const LastingState& s) {
  for (const kernels::Vector v : {s.gravity, s.wind, s.way.moved, s.way.turned}) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  }
  for (const double x : {s.lost_energy, s.elastic_energy, s.give_per_mass, s.longest_substep}) {
    if (!std::isfinite(x)) return false;
  }
  return are_finite(s.position) && are_finite(s.velocity) && are_finite(s.force);
}

/// The first part that no state of the model has; null: none.
const char* fault_of(const LastingState& s, const Model& model) {
  constexpr double kMostRefinement = 64;  // far more than there are parts or substeps
  const auto has_slots = [&](const kernels::Vectors& v) { return v.size() == model.slots(); };
  const bool has_force = s.force.size() > 0;
  if (!has_slots(s.position) || !has_slots(s.velocity) || (has_force && !has_slots(s.force)))
    return "particles";
  if (!are_finite(s) || !(std::abs(s.refinement) <= kMostRefinement) || !s.lengthening.is_valid())
    return "numbers";
  const auto place = [&](std::uint32_t slot) { return s.position[slot]; };
  for (const Pressure& part : s.pressures) {
    if (part.gas && !(part.volume > 0)) return "pressures";
  }
  const auto is_finite = [](double each) { return std::isfinite(each); };
  if (s.gas.size() != s.pressures.size() || !std::ranges::all_of(s.gas, is_finite))
    return "pressures";
  if (!validate_pressures(s.pressures, {}, model.surface, place)) return "pressures";
  if (!s.pins.fit(model)) return "pins";
  if (!s.anchors.fit(model)) return "anchors";
  if (!s.seams.fit(model)) return "seams";
  if (!s.sliders.fit(model)) return "sliders";
  if (!s.creases.fit(model)) return "creases";
  if (!s.bodies.are_valid()) return "bodies";
  if (!s.rest.fits(model)) return "rest";
  if (s.asleep.status > Status::non_finite) return "report";
  return nullptr;
}

}  // namespace

std::vector<std::byte> save_state(const State& state) {
  ArchiveWriter past;
  if (state.small_steps) state.small_steps->save_past(past);
  ArchiveWriter archive;
  archive(fingerprint(*state.model));
  visit_settings(state.settings, archive);
  archive(static_cast<const LastingState&>(state), std::move(past).bytes());
  return seal(kSavedState, std::move(archive).bytes());
}

Result<SavedState> read_state(std::span<const std::byte> bytes, const Model& model) {
  const auto content = unseal(kSavedState, bytes);
  if (!content) return Error{content.error()};
  ArchiveReader archive(content.value());
  std::uint64_t its_model = 0;
  archive(its_model);
  if (its_model != fingerprint(model)) {
    return refuse("state", "is of another model",
                  "this one has " + std::to_string(model.particles) + " particles");
  }
  SavedState saved{.settings = {}, .lasting = LastingState(model), .past = {}};
  visit_settings(saved.settings, archive);
  archive(saved.lasting, saved.past);
  const char* fault = archive.is_done() ? fault_of(saved.lasting, model) : "content";
  if (fault != nullptr) return refuse("state", "holds what cannot be", fault);
  return saved;
}

Result<void> restore(State& state, SavedState&& saved) {
  if (state.small_steps && alike(state.settings, saved.settings)) {
    ArchiveReader past(saved.past);
    if (!state.small_steps->load_past(past)) return refuse("state", "holds what cannot be", "past");
  } else if (state.small_steps) {
    state.small_steps->forget_past();
  }
  state.take(std::move(saved.lasting), saved.settings);
  return {};
}

}  // namespace weft
