/// The inside of a Cloth, for the files that define its functions.
#pragma once

#include <weft/weft.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "engine/model/model.h"
#include "engine/step/state.h"

namespace weft {

struct Cloth::Impl {
  const Settings asked;  // by the caller; those of the state are resolved
  State state;

  Impl(std::shared_ptr<const Model> model, const Settings& wanted, const Settings& resolved)
      : asked(wanted), state(std::move(model), resolved) {}
  /// A new state of the model by what is asked for of this one.
  Result<std::unique_ptr<Impl>> of(const std::shared_ptr<const Model>& other) const;
  /// That goes on from this one.
  Result<std::unique_ptr<Impl>> going_on(const std::shared_ptr<const Model>& other) const;
  /// A new state that may have what small steps alone know: an automatic solver becomes that one.
  Result<std::unique_ptr<Impl>> by_small_steps(std::string_view what) const;

  std::uint32_t slot(std::uint32_t particle) const {
    return state.model->ordering.slot_of[particle];
  }
  /// Gives `to` the value, and wakes the cloth if that is another one.
  void set(kernels::Vector& to, Vec3 value);
  void set(kernels::Vectors& vectors, std::uint32_t particle, Vec3 value);
};

}  // namespace weft
