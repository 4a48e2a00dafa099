#include "engine/step/creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace weft {
namespace {

using FourParticles = std::array<std::uint32_t, 4>;

std::size_t count_of_creases(const Model& model) {
  return model.bending.may_yield() ? model.bending.size() + model.inert.bending.size() : 0;
}

/// The particle that was there before the model was torn.
std::uint32_t before_split(const Model& model, std::uint32_t slot) {
  const std::uint32_t particle = model.ordering.particle_at[slot];
  const std::size_t before = model.particles - model.split_from.size();
  return particle < before ? particle : model.split_from[particle - before];
}

FourParticles particles_of(const Model& model, std::size_t element) {
  FourParticles particles{};
  for (std::size_t k = 0; k < 4; ++k)
    particles[k] = before_split(model, model.bending.slots[element][k]);
  return particles;
}

}  // namespace

Creases::Creases(const Model& model) : all_(count_of_creases(model)) {
  const auto begin = [&](std::uint32_t described, double arm, double fold) {
    if (arm > 0) all_[described].angle = reference::angle_of_fold(arm, fold);
  };
  if (all_.empty()) return;
  for (std::size_t i = 0; i < model.bending.size(); ++i)
    begin(model.bending.described[i], model.bending.yielding[i].arm, model.bending.fold[i]);
  for (const auto& [described, element] : model.inert.bending)
    begin(described, element.arm, element.fold);
}

Creases::Creases(const Creases& from, const Model& its_model, const Model& model) : Creases(model) {
  const std::size_t old = std::min(all_.size(), from.all_.size());
  std::copy_n(from.all_.begin(), old, all_.begin());
  if (all_.size() == old) return;
  std::map<FourParticles, std::vector<std::uint32_t>> sources;
  std::map<FourParticles, std::size_t> taken;
  for (std::size_t i = 0; i < its_model.bending.size(); ++i) {
    FourParticles particles{};
    for (std::size_t k = 0; k < 4; ++k)
      particles[k] = its_model.ordering.particle_at[its_model.bending.slots[i][k]];
    sources[particles].push_back(its_model.bending.described[i]);
  }
  for (std::size_t i = 0; i < model.bending.size(); ++i) {
    const std::uint32_t own = model.bending.described[i];
    if (own < old) continue;
    const FourParticles particles = particles_of(model, i);
    const auto found = sources.find(particles);
    if (found == sources.end()) continue;
    all_[own] = from.all_[found->second[taken[particles]++ % found->second.size()]];
  }
}

bool Creases::fit(const Model& model) const {
  constexpr double kMostAngle = 1.001 * std::numbers::pi;
  return all_.size() == count_of_creases(model) &&
         std::ranges::all_of(all_, [](const Crease& crease) {
           return std::abs(crease.angle) <= kMostAngle && crease.worked >= 0 &&
                  std::isfinite(crease.worked);
         });
}

}  // namespace weft
