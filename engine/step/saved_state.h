/// States of a cloth as bytes (Cloth::save_state).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/saving/sealed.h"
#include "engine/step/state.h"

namespace weft {

/// The version changes with whatever is written here, and in the functions visit_fields.
inline constexpr Kind kSavedState{{'w', 'e', 'f', 't', 's', 't', 'a', 't'}, "state", 13};
std::vector<std::byte> save_state(const State& state);

/// A state that was read, and is one of the model.
struct SavedState {
  Settings settings;  // memory_settings alone
  LastingState lasting;
  std::vector<std::byte> past;  // of small steps, if there were some
};
Result<SavedState> read_state(std::span<const std::byte> bytes, const Model& model);

/// The state goes on where the saved one was. An error changes nothing.
Result<void> restore(State& state, SavedState&& saved);

}  // namespace weft
